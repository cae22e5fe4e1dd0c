//! `effects`: the physical effects that the library knows.

use crate::errors::exception;
use crate::value::plain;
use handstand::effects::EFFECTS;
use handstand::fitting::effect_named;
use pyo3::prelude::*;
use serde_json::json;

/// Describes the physical effects that the library knows.
///
/// Parameters
/// ----------
/// name : str
///     One effect, such as `"coulomb"`; all of them without.
///
/// Returns
/// -------
/// dict, or list of dict
///     With the keys of `handstand effects --json`: `id`, `title`, `law`, `parameters`, ..
#[pyfunction]
#[pyo3(signature = (name=None))]
pub fn effects<'py>(py: Python<'py>, name: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
    let found = match name {
        Some(name) => json!(effect_named(name).map_err(exception)?.info()),
        None => json!(
            EFFECTS
                .iter()
                .map(|effect| effect.info())
                .collect::<Vec<_>>()
        ),
    };
    plain(py, &found)
}
