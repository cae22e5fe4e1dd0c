//! Answers: pages, data, refusals with their remedy.

use super::pages::frame;
use crate::error::Error;
use axum::body::Body;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use maud::Markup;
use serde::Serialize;
use serde_json::{Value, json};

/// What a route gives.
pub(super) type Answer = Result<Response, LabError>;

/// Why a request was not carried out.
#[derive(Debug)]
pub(super) enum LabError {
    /// Something of the library refused.
    Library(Error),
    /// There is no such session, file or step.
    NotFound(&'static str),
    /// Too much was sent.
    TooLarge(String),
    /// The request cannot be carried out now.
    Conflict(String),
}

impl From<Error> for LabError {
    fn from(error: Error) -> Self {
        LabError::Library(error)
    }
}

impl LabError {
    fn status(&self) -> StatusCode {
        match self {
            LabError::Library(Error::Usage(_) | Error::Data { .. } | Error::Design { .. }) => {
                StatusCode::UNPROCESSABLE_ENTITY
            }
            LabError::Library(_) => StatusCode::INTERNAL_SERVER_ERROR,
            LabError::NotFound(_) => StatusCode::NOT_FOUND,
            LabError::TooLarge(_) => StatusCode::PAYLOAD_TOO_LARGE,
            LabError::Conflict(_) => StatusCode::CONFLICT,
        }
    }

    /// What was found, and the remedy where one is known.
    pub fn words(&self) -> (String, String) {
        match self {
            LabError::Library(error) => {
                let remedy = error.remedy().map(|remedy| remedy.into_owned());
                (error.to_string(), remedy.unwrap_or_default())
            }
            LabError::NotFound(what) => (format!("there is no such {what}"), String::new()),
            LabError::TooLarge(why) | LabError::Conflict(why) => (why.clone(), String::new()),
        }
    }
}

impl IntoResponse for LabError {
    fn into_response(self) -> Response {
        let (found, remedy) = self.words();
        let data = json!({ "error": found, "remedy": remedy });
        let mut response = data_reply(self.status(), &data);
        response
            .extensions_mut()
            .insert(RefusalText { found, remedy });
        response
    }
}

/// What a refusal says, for the page that a browser shows.
#[derive(Debug, Clone)]
struct RefusalText {
    found: String,
    remedy: String,
}

/// A refusal as a page, for a browser that goes to an address; other answers stay as they are.
pub(super) fn as_page(response: Response) -> Response {
    let status = response.status();
    if !(status.is_client_error() || status.is_server_error()) {
        return response;
    }
    let found = match response.extensions().get::<RefusalText>() {
        Some(said) => said.clone(),
        None => RefusalText {
            found: match status {
                StatusCode::BAD_REQUEST => "this is no address of the lab".into(),
                _ => "this was not carried out".into(),
            },
            remedy: String::new(),
        },
    };
    let title = match status {
        StatusCode::NOT_FOUND | StatusCode::BAD_REQUEST => "There is nothing here",
        _ => "This cannot be shown",
    };
    (
        status,
        page(frame::refused(title, &[&found.found, &found.remedy], true)),
    )
        .into_response()
}

/// A page.
pub(super) fn page(markup: Markup) -> Response {
    typed("text/html; charset=utf-8", markup.into_string())
}

/// A body of this type.
pub(super) fn typed(kind: &'static str, body: impl Into<Body>) -> Response {
    ([(header::CONTENT_TYPE, kind)], body.into()).into_response()
}

/// A file to keep.
pub(super) fn download(kind: &'static str, name: &str, body: String) -> Response {
    let disposition = format!("attachment; filename=\"{name}\"");
    let headers = [
        (header::CONTENT_TYPE, kind.to_string()),
        (header::CONTENT_DISPOSITION, disposition),
    ];
    (headers, body).into_response()
}

/// Data for a script.
pub(super) fn data(value: &impl Serialize) -> Response {
    data_reply(StatusCode::OK, value)
}

fn data_reply(status: StatusCode, value: &impl Serialize) -> Response {
    let text = serde_json::to_string(value).unwrap_or_else(|_| Value::Null.to_string());
    (status, [(header::CONTENT_TYPE, "application/json")], text).into_response()
}

/// Goes on to another page.
pub(super) fn go(path: &str) -> Response {
    (StatusCode::SEE_OTHER, [(header::LOCATION, path)]).into_response()
}

/// Says why nobody is let in.
pub(super) fn refusal(status: StatusCode, why: &str) -> Response {
    (status, page(frame::refused("Refused", &[why], false))).into_response()
}
