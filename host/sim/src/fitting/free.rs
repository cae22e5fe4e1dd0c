//! Which values of a model are fitted: those named, or those the model frees.

use crate::error::Error;
use crate::model::{Model, ParameterPath};

/// Why values cannot be fitted.
#[derive(Debug, thiserror::Error)]
pub enum FreeError {
    /// What was named is no address.
    #[error(transparent)]
    Address(#[from] Error),
    /// The model has no such value.
    #[error("`{0}` is not in this model")]
    NotInModel(String),
    /// A fit needs a finite value to start from.
    #[error("`{0}` is infinite, so nothing can be fitted")]
    Infinite(String),
    /// Nothing was named, and the model frees nothing.
    #[error("no value is free to be fitted")]
    Nothing,
}

impl From<FreeError> for Error {
    fn from(error: FreeError) -> Error {
        let remedy = match error {
            FreeError::Address(error) => return error,
            FreeError::NotInModel(_) => {
                "add its link, drive or effect to the model, or name another value"
            }
            FreeError::Infinite(_) => "give it a value to start from in the model",
            FreeError::Nothing => "name one by --free link1.com_m, or under [fit] in the model",
        };
        Error::usage(error.to_string(), remedy)
    }
}

/// Addresses of the values to fit: those in `named`, of which the model then takes nothing for
/// known beforehand, or the model's own.
///
/// # Errors
/// As [`FreeError`] says.
pub fn freed(model: &mut Model, named: &[String]) -> Result<Vec<ParameterPath>, FreeError> {
    let free = free_parameters(model, named)?;
    if !named.is_empty() {
        model.forget(&free);
    }
    Ok(free)
}

/// Addresses of the values to fit: those in `named`, each once, or the model's own.
///
/// # Errors
/// As [`FreeError`] says.
pub fn free_parameters(model: &Model, named: &[String]) -> Result<Vec<ParameterPath>, FreeError> {
    let mut free: Vec<ParameterPath> = Vec::new();
    for text in named {
        let path = ParameterPath::read(text, model)?;
        let value = path
            .get(model)
            .ok_or_else(|| FreeError::NotInModel(text.clone()))?;
        if !value.is_finite() {
            return Err(FreeError::Infinite(text.clone()));
        }
        if !free.contains(&path) {
            free.push(path);
        }
    }
    if named.is_empty() {
        free.clone_from(&model.free);
    }
    if free.is_empty() {
        Err(FreeError::Nothing)
    } else {
        Ok(free)
    }
}
