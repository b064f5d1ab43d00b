//! Reports on their way from Rust to a `dict`: the same JSON that the command prints.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

/// `report` as one JSON object.
pub(crate) fn json(report: &impl Serialize) -> String {
    serde_json::to_string(report)
        .expect("reports have text keys and plain values: anything else is a bug")
}

/// The JSON object `report` as a new dict.
pub(crate) fn dict<'py>(py: Python<'py>, report: &str) -> PyResult<Bound<'py, PyDict>> {
    let value = py.import("json")?.call_method1("loads", (report,))?;
    Ok(value.cast_into::<PyDict>()?)
}

/// The JSON object `report` as a value.
pub(crate) fn value(report: &str) -> serde_json::Value {
    serde_json::from_str(report).expect("made by `json`: anything else is a bug")
}
