//! Curves for the charts: a description in JSON, then numbers of four bytes.
//!
//! The body is the length of the description (u32, little-endian), the description padded with
//! blanks to a multiple of four bytes, then the arrays end to end (f32, little-endian). 18 joints
//! over 60 s at 100 Hz, measured and predicted, take 0.9 MB.

use crate::reply::typed;
use axum::response::Response;
use serde_json::{Value, json};

/// Named arrays with a description.
#[derive(Debug, Default)]
pub(super) struct Arrays {
    names: Vec<(String, usize)>,
    bytes: Vec<u8>,
}

impl Arrays {
    /// Adds an array; what is not finite stays so.
    pub fn push(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) {
        let begin = self.bytes.len();
        for value in values {
            self.bytes.extend_from_slice(&(value as f32).to_le_bytes());
        }
        self.names
            .push((name.into(), (self.bytes.len() - begin) / 4));
    }

    /// The body; `meta` is what else the page needs to know.
    pub fn reply(self, meta: &Value) -> Response {
        let names: Vec<Value> = self
            .names
            .iter()
            .map(|(name, length)| json!({ "name": name, "length": length }))
            .collect();
        let mut head = json!({ "meta": meta, "arrays": names })
            .to_string()
            .into_bytes();
        head.resize(head.len().next_multiple_of(4), b' ');
        let mut body = (head.len() as u32).to_le_bytes().to_vec();
        body.extend(head);
        body.extend(self.bytes);
        typed("application/octet-stream", body)
    }
}
