//! The library's errors as exceptions.

use handstand::Error;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::{PyErr, create_exception};

create_exception!(
    handstand,
    HandstandError,
    PyException,
    "Nothing came of the work: no design follows, or the logs do not determine what was asked."
);
create_exception!(
    handstand,
    UsageError,
    PyValueError,
    "An argument that makes no sense, with the remedy."
);
create_exception!(
    handstand,
    DataError,
    PyValueError,
    "A file or an array whose content is refused: the place, what was found, and the remedy."
);

/// The exception for an error: what was found, and the remedy on a line of its own.
pub fn exception(error: impl Into<Error>) -> PyErr {
    let error = error.into();
    let said = match error.remedy() {
        Some(remedy) => format!("{error}\nremedy: {remedy}"),
        None => error.to_string(),
    };
    match error {
        Error::Usage(_) => UsageError::new_err(said),
        Error::Data { .. } => DataError::new_err(said),
        Error::File { .. } => PyOSError::new_err(said),
        _ => HandstandError::new_err(said),
    }
}

/// An argument that makes no sense.
pub fn usage(what: impl Into<String>, remedy: impl Into<String>) -> PyErr {
    exception(Error::usage(what, remedy))
}
