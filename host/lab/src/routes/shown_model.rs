//! The model that the page which asks shows: what it asks for is meant for that one.

use crate::reply::LabError;
use crate::session::{SavedSession, model_sha256};
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use std::convert::Infallible;

/// Name of the header in which pages say it.
const HEADER: &str = "handstand-model";

/// SHA-256 of the model that the page shows, empty without one; nothing from what is no page.
#[derive(Debug)]
pub(super) struct ShownModel(Option<String>);

impl<S: Sync> FromRequestParts<S> for ShownModel {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        let said = parts.headers.get(HEADER);
        let said = said.and_then(|value| value.to_str().ok());
        Ok(ShownModel(said.map(String::from)))
    }
}

impl ShownModel {
    /// Refuses what was meant for another model than the one in force: another tab went on.
    pub fn check(&self, saved: &SavedSession) -> Result<(), LabError> {
        let own = saved
            .step()
            .map_or(String::new(), |step| model_sha256(&step.toml));
        match &self.0 {
            Some(shown) if *shown != own => Err(LabError::Conflict(format!(
                "this page shows another model than the one in force by now, which is {}; nothing \
                 was done: reload the page, and press again",
                match saved.step() {
                    Some(step) => format!("model {}: {}", saved.current, step.title),
                    None => "none".into(),
                }
            ))),
            _ => Ok(()),
        }
    }
}
