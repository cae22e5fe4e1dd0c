//! The text of a model file, which knows the line and column of every complaint.

use crate::error::{Error, Place, Result};
use std::ops::Range;
use std::path::Path;

/// The text a table came from, and its name for errors.
#[derive(Debug)]
pub(crate) struct Source<'a> {
    pub text: &'a str,
    pub file: &'a Path,
}

impl Source<'_> {
    /// Parses the text, keeping where everything stands.
    ///
    /// # Errors
    /// TOML that does not parse, at the place where it stops making sense.
    pub fn document(&self) -> Result<toml_edit::Document<&str>> {
        toml_edit::Document::parse(self.text).map_err(|error| {
            let what = error.message().trim().replace('\n', ", ");
            self.error(error.span(), format!("not TOML: {what}"), SYNTAX)
        })
    }

    /// A complaint about the text at `span`.
    pub fn error(
        &self,
        span: Option<Range<usize>>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Error {
        let mut start = span.map_or(0, |span| span.start).min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let before = &self.text[..start];
        let line = before.matches('\n').count() + 1;
        let last = before.rsplit('\n').next().unwrap_or("");
        let place = Place::at(self.file, line, last.chars().count() + 1);
        Error::data(place, what, remedy)
    }
}

const SYNTAX: &str = "write `key = value` lines under `[table]` headings; text needs quotes";
