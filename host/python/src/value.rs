//! Results as plain Python objects, and as pages in a notebook.

use pyo3::prelude::*;
use serde_json::Value;

/// Dictionaries, lists, numbers and texts.
pub fn plain<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?
        .call_method1("loads", (value.to_string(),))
}

/// A page within a notebook's page: its styles and scripts stay its own.
pub fn framed(page: &str) -> String {
    let escaped = page.replace('&', "&amp;").replace('"', "&quot;");
    format!(
        "<iframe srcdoc=\"{escaped}\" style=\"width: 100%; height: 45em; border: 0\" \
         sandbox=\"allow-scripts\"></iframe>"
    )
}

/// "1 joint", "2 joints".
pub fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
