//! The text of a TOML file: finds the line and column of every part.

use crate::error::{Error, Place, Result};
use std::ops::Range;
use std::path::Path;

/// The text that a table came from, and its name for errors.
#[derive(Debug)]
pub struct TomlSource<'a> {
    /// All of it.
    pub text: &'a str,
    /// The file as the user named it.
    pub file: &'a Path,
}

impl TomlSource<'_> {
    /// Parses the text, keeping where everything stands.
    ///
    /// # Errors
    /// Text that is not TOML, at the place where the parser stops.
    pub fn document(&self) -> Result<toml_edit::Document<&str>> {
        toml_edit::Document::parse(self.text).map_err(|error| {
            let message = error.message().trim().replace('\n', ", ");
            Error::data(
                self.place(error.span()),
                format!("not TOML: {message}"),
                "write `key = value` lines under `[table]` headings; text needs quotes",
            )
        })
    }

    /// Where a character, counted from 0, of the quoted text at `value` stands.
    pub fn character(&self, value: Range<usize>, at: usize) -> Range<usize> {
        let written = self.text.get(value.clone()).unwrap_or_default();
        let long = ["\"\"\"", "'''"]
            .into_iter()
            .find(|quotes| written.starts_with(quotes));
        let begin = value.start + long.map_or(1, str::len);
        let inside = self.text.get(begin..value.end).unwrap_or_default();
        let offset = inside.char_indices().nth(at);
        let start = begin + offset.map_or(inside.len(), |(offset, _)| offset);
        start..start + 1
    }

    /// Line and column at which `span` starts; the file's start without a span.
    pub fn place(&self, span: Option<Range<usize>>) -> Place {
        let mut start = span.map_or(0, |span| span.start).min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let before = &self.text[..start];
        let line = before.matches('\n').count() + 1;
        let last = before.rsplit('\n').next().unwrap_or("");
        Place::at(self.file, line, last.chars().count() + 1)
    }
}
