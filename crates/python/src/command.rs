//! The command `bonemesh`, as the package installs it.

use std::ffi::OsString;
use std::panic::catch_unwind;

use pyo3::prelude::*;

/// Exit code of a failure.
const FAILED: u8 = 1;

/// Run the command with `sys.argv` and give its exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>) -> PyResult<u8> {
    let given: Vec<OsString> = py.import("sys")?.getattr("argv")?.extract()?;
    // However it was started, it is called by its name.
    let name = std::iter::once(OsString::from("bonemesh"));
    let arguments: Vec<OsString> = name.chain(given.into_iter().skip(1)).collect();
    Ok(py.detach(|| {
        catch_unwind(|| bonemesh::cli::run(arguments)).unwrap_or_else(|_| {
            eprintln!(
                "bonemesh: a bug in Bonemesh stopped the work; please report it with what you did"
            );
            FAILED
        })
    }))
}
