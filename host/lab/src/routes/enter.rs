//! Coming in: the token becomes a cookie, the browser gets a session.

use super::{blocking, session};
use crate::guard::cookie;
use crate::pages::{enter as pages, frame};
use crate::reply::{Answer, LabError, data, go, page, refusal};
use crate::server::LabState;
use axum::Json;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use serde::Deserialize;
use serde_json::json;
use std::sync::Arc;

/// Longest name of a session, characters.
const LONGEST_NAME: usize = 80;

#[derive(Debug, Deserialize)]
pub(super) struct Entrance {
    token: Option<String>,
}

/// Takes the token from the address and keeps it as a cookie. The page goes on by itself: a
/// redirect of a link that another page held would come without the cookie.
pub(super) async fn enter(
    State(lab): State<Arc<LabState>>,
    Query(entrance): Query<Entrance>,
) -> Response {
    if !entrance.token.is_some_and(|token| lab.token.is(&token)) {
        let why = "the token is missing or wrong: copy the whole address that was printed";
        return refusal(StatusCode::UNAUTHORIZED, why);
    }
    let mut response = page(frame::entrance());
    set_cookie(&mut response, &lab.cookie_name(), lab.token.text());
    response
}

fn set_cookie(response: &mut Response, name: &str, value: &str) {
    let cookie = format!("{name}={value}; Path=/; HttpOnly; SameSite=Strict");
    if let Ok(cookie) = HeaderValue::from_str(&cookie) {
        response.headers_mut().append(header::SET_COOKIE, cookie);
    }
}

/// Name of the cookie that says which session a browser works in.
fn session_cookie(lab: &LabState) -> String {
    format!("handstand_lab_{}_session", lab.port)
}

/// The browser's own session, or a new one; the list where earlier ones wait.
pub(super) async fn home(State(lab): State<Arc<LabState>>, headers: HeaderMap) -> Answer {
    let own = cookie(&headers, &session_cookie(&lab)).and_then(|own| own.parse().ok());
    if let Some(own) = own.filter(|own| session(&lab, *own).is_ok()) {
        lab.store.take(own);
        return Ok(go(&format!("/s/{own}/data")));
    }
    let store = lab.clone();
    let new = blocking(move || Ok(store.store.for_newcomer()?)).await?;
    let Some(new) = new else {
        return Ok(go("/sessions"));
    };
    let mut response = go(&format!("/s/{}/data", new.number));
    set_cookie(
        &mut response,
        &session_cookie(&lab),
        &new.number.to_string(),
    );
    Ok(response)
}

/// The sessions to choose from.
pub(super) async fn sessions(State(lab): State<Arc<LabState>>) -> Answer {
    Ok(page(pages::sessions(&lab.store)))
}

/// A new session.
pub(super) async fn begin(State(lab): State<Arc<LabState>>) -> Answer {
    let store = lab.clone();
    let new = blocking(move || store.store.begin().map_err(LabError::from)).await?;
    let mut response = data(&json!({ "go": format!("/s/{}/data", new.number) }));
    set_cookie(
        &mut response,
        &session_cookie(&lab),
        &new.number.to_string(),
    );
    Ok(response)
}

#[derive(Debug, Deserialize)]
pub(super) struct Name {
    name: String,
}

/// Names a session; nothing takes its name away.
pub(super) async fn name(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    Json(name): Json<Name>,
) -> Answer {
    let session = session(&lab, number)?;
    let name: String = name.name.trim().chars().take(LONGEST_NAME).collect();
    blocking(move || {
        Ok(session.change(|saved| {
            saved.name = name;
            Ok(())
        })?)
    })
    .await?;
    Ok(data(&json!({ "go": "/sessions" })))
}

#[derive(Debug, Deserialize)]
pub(super) struct Chosen {
    number: u32,
}

/// Deletes a session, its models and its copies of the logs.
pub(super) async fn delete(State(lab): State<Arc<LabState>>, Json(chosen): Json<Chosen>) -> Answer {
    blocking(move || Ok(lab.store.delete(chosen.number)?)).await?;
    Ok(data(&json!({ "go": "/sessions" })))
}
