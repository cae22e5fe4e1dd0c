//! Who may ask: a browser on this machine that was given the token, on a page of this server.

use super::reply::{as_page, refusal};
use super::server::LabState;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;
use rand::RngCore as _;
use sha2::{Digest as _, Sha256};
use std::sync::Arc;

/// The secret that the printed address carries.
#[derive(Debug, Clone)]
pub(super) struct AccessToken(String);

impl AccessToken {
    /// 128 random bits in hexadecimal.
    pub fn random() -> AccessToken {
        let mut bytes = [0; 16];
        rand::rng().fill_bytes(&mut bytes);
        AccessToken(crate::output::number::hex(bytes))
    }

    /// As the address carries it.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Whether `given` is the token. Hashes are compared, so that the time taken tells nothing of
    /// how many characters are right.
    pub fn is(&self, given: &str) -> bool {
        Sha256::digest(given) == Sha256::digest(&self.0)
    }
}

/// Only this server's own scripts, styles, pictures and connections.
const POLICY: &str = "default-src 'self'; base-uri 'none'; form-action 'self'; \
                      frame-ancestors 'self'; object-src 'none'; img-src 'self' data:";

/// Checks host, origin and token, and adds the headers that keep a page to itself.
pub(super) async fn guard(
    State(lab): State<Arc<LabState>>,
    request: Request,
    next: Next,
) -> Response {
    // Style and scripts are no secrets, and a refusal needs its style.
    let path = request.uri().path();
    let open = path == "/enter" || path.starts_with("/assets/");
    let accept = request.headers().get(header::ACCEPT);
    let to_page = request.method() == Method::GET
        && accept.is_some_and(|kinds| kinds.to_str().is_ok_and(|it| it.contains("text/html")));
    let mut response = match refused(&lab, request.method(), request.headers(), open) {
        Some((status, why)) => refusal(status, why),
        None if to_page => as_page(next.run(request).await),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_FRAME_OPTIONS, "SAMEORIGIN"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    headers
        .entry(header::CACHE_CONTROL)
        .or_insert(HeaderValue::from_static("no-store"));
    response
}

/// Why a request is not answered, if it is not.
fn refused(
    lab: &LabState,
    method: &Method,
    headers: &HeaderMap,
    open: bool,
) -> Option<(StatusCode, &'static str)> {
    let text = |name| headers.get(name).map(|value| value.to_str().unwrap_or(""));
    // A name that was made to point at this machine would carry its own name here.
    if !text(header::HOST).is_some_and(|host| lab.is_own_host(host)) {
        return Some((
            StatusCode::MISDIRECTED_REQUEST,
            "this server answers to its own address alone",
        ));
    }
    let origin = text(header::ORIGIN);
    if origin.is_some_and(|origin| !lab.is_own_origin(origin)) {
        return Some((StatusCode::FORBIDDEN, "another page asks"));
    }
    // Browsers name the origin of every request that changes something.
    if origin.is_none() && ![Method::GET, Method::HEAD].contains(method) {
        return Some((StatusCode::FORBIDDEN, "the request names no origin"));
    }
    let known = cookie(headers, &lab.cookie_name()).is_some_and(|token| lab.token.is(token));
    if !open && !known {
        return Some((
            StatusCode::UNAUTHORIZED,
            "open the address that `handstand lab` printed: it carries the token",
        ));
    }
    None
}

/// The value of a cookie.
pub(super) fn cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let lines = headers.get_all(header::COOKIE).iter();
    let pairs = lines
        .filter_map(|line| line.to_str().ok())
        .flat_map(|line| line.split(';'));
    let mut values = pairs.filter_map(|pair| pair.trim().split_once('='));
    values.find(|(key, _)| *key == name).map(|(_, value)| value)
}
