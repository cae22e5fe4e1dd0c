//! Python's `handstand`: the library's measuring loop and gains on numpy arrays.
//!
//! Every function calls the library as the command line does; results carry the same keys as
//! `--json`. Long work runs on a thread of its own without the interpreter's lock, tells how far it
//! is, and ends on Ctrl-C.

mod arrays;
mod compare;
mod diagnose;
mod discover;
mod draft;
mod drift;
mod effects;
mod errors;
mod experiment;
mod gains;
mod log_check;
mod logs;
mod model;
mod motion;
mod refit;
mod simulate;
mod value;
mod work;

/// The extension module behind the package `handstand`.
#[pyo3::pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use crate::compare::{Comparison, compare};
    #[pymodule_export]
    use crate::diagnose::{Diagnosis, diagnose};
    #[pymodule_export]
    use crate::discover::{Discovery, discover};
    #[pymodule_export]
    use crate::draft::{Draft, init};
    #[pymodule_export]
    use crate::drift::drift;
    #[pymodule_export]
    use crate::effects::effects;
    #[pymodule_export]
    use crate::experiment::{Proposal, next};
    #[pymodule_export]
    use crate::gains::{Gains, gains};
    #[pymodule_export]
    use crate::log_check::{LogCheck, log_check};
    #[pymodule_export]
    use crate::logs::read_log;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::motion::Motion;
    #[pymodule_export]
    use crate::refit::{Refit, add, fit};
    #[pymodule_export]
    use crate::simulate::simulate;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn version(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
