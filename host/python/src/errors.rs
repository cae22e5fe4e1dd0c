//! The library's errors as the exceptions of `handstand._errors`.

use handstand::Error;
use pyo3::prelude::*;
use std::io::ErrorKind;

/// The exception for an error: what was found, and the remedy on a line of its own.
pub fn exception(error: impl Into<Error>) -> PyErr {
    let error = error.into();
    let said = match error.remedy() {
        Some(remedy) => format!("{error}\nremedy: {remedy}"),
        None => error.to_string(),
    };
    match &error {
        Error::Usage(_) => raised("UsageError", said),
        Error::Data { .. } => raised("DataError", said),
        Error::File { path, refusal, .. } => of_file(
            refusal.raw_os_error().or(number(refusal.kind())),
            said,
            &path.to_string_lossy(),
        ),
        _ => raised("HandstandError", said),
    }
}

/// An argument that makes no sense.
pub fn usage(what: impl Into<String>, remedy: impl Into<String>) -> PyErr {
    exception(Error::usage(what, remedy))
}

/// An address that names no value.
pub fn no_address(what: &str, remedy: &str) -> PyErr {
    raised("AddressError", format!("{what}\nremedy: {remedy}"))
}

/// Nothing came of the work.
pub fn failed(said: impl Into<String>) -> PyErr {
    raised("HandstandError", said.into())
}

/// The number of a refusal that has none of its own.
fn number(kind: ErrorKind) -> Option<i32> {
    match kind {
        ErrorKind::NotFound => Some(2),
        ErrorKind::PermissionDenied => Some(13),
        ErrorKind::AlreadyExists => Some(17),
        ErrorKind::IsADirectory => Some(21),
        _ => None,
    }
}

fn raised(name: &str, said: String) -> PyErr {
    Python::attach(|py| {
        let made = || {
            py.import("handstand._errors")?
                .getattr(name)?
                .call1((said,))
        };
        made().map_or_else(|fault| fault, PyErr::from_value)
    })
}

fn of_file(errno: Option<i32>, said: String, path: &str) -> PyErr {
    Python::attach(|py| {
        let made = || {
            let module = py.import("handstand._errors")?;
            module.getattr("file_error")?.call1((errno, said, path))
        };
        made().map_or_else(|fault| fault, PyErr::from_value)
    })
}
