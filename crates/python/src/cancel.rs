//! The switch that stops work.

use pyo3::prelude::*;

/// A switch that stops the work it is given to.
///
/// Pass it as `cancel=` and call `cancel()` from another thread or from the progress callback: the
/// call ends with `Cancelled` within 0.2 s. A switch stays thrown; take a new one for new work.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Cancel {
    switch: bonemesh::Cancel,
}

#[pymethods]
impl Cancel {
    #[new]
    fn new() -> Self {
        Self {
            switch: bonemesh::Cancel::default(),
        }
    }

    /// Ask the work to stop.
    fn cancel(&self) {
        self.switch.cancel();
    }

    /// Whether `cancel()` was called.
    #[getter]
    fn is_cancelled(&self) -> bool {
        self.switch.is_cancelled()
    }

    fn __repr__(&self) -> String {
        let state = if self.switch.is_cancelled() {
            "thrown"
        } else {
            "not thrown"
        };
        format!("<bonemesh.Cancel, {state}>")
    }
}

impl Cancel {
    /// The switch itself.
    pub(crate) fn switch(&self) -> bonemesh::Cancel {
        self.switch.clone()
    }
}
