//! Which values of a model are fitted: those named, or those the model frees.

use crate::error::{Error, Result};
use crate::model::{Model, ParameterPath};

/// Addresses of the values to fit: those in `named`, of which the model then takes nothing for
/// known beforehand, or the model's own.
///
/// # Errors
/// As [`free_parameters`].
pub fn freed(model: &mut Model, named: &[String]) -> Result<Vec<ParameterPath>> {
    let free = free_parameters(model, named)?;
    if !named.is_empty() {
        model.forget(&free);
    }
    Ok(free)
}

/// Addresses of the values to fit: those in `named`, each once, or the model's own.
///
/// # Errors
/// What is no address, not in the model or infinite; nothing free.
pub fn free_parameters(model: &Model, named: &[String]) -> Result<Vec<ParameterPath>> {
    let mut free: Vec<ParameterPath> = Vec::new();
    for text in named {
        let path = ParameterPath::read(text, model)?;
        let Some(value) = path.get(model) else {
            return Err(Error::usage(
                format!("`{text}` is not in this model"),
                "add its link, drive or effect to the model, or name another value",
            ));
        };
        if !value.is_finite() {
            return Err(Error::usage(
                format!("`{text}` is infinite, so nothing can be fitted"),
                "give it a value to start from in the model",
            ));
        }
        if !free.contains(&path) {
            free.push(path);
        }
    }
    if named.is_empty() {
        free.clone_from(&model.free);
    }
    if free.is_empty() {
        Err(Error::usage(
            "no value is free to be fitted",
            "name one by --free link1.com_m, or under [fit] in the model",
        ))
    } else {
        Ok(free)
    }
}
