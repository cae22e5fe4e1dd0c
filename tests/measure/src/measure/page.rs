//! Printing what was measured, and writing it to `docs/measured` when asked.

use handstand_measure::measured::{Measured, Provenance};
use handstand_xtask::root;
use serde_json::Value;

/// What is done with the tables.
#[derive(Debug, clap::Args)]
pub(super) struct Page {
    /// Write the tables to the page of docs/measured too
    #[arg(long)]
    write: bool,
}

impl Page {
    /// Puts the tables into a document of `docs` too, if they are to be written; whether that could
    /// be done.
    pub(super) fn insert(&self, measured: &Measured, document: &str) -> bool {
        if !self.write {
            return true;
        }
        let file = root().join("docs").join(document);
        let inserted = measured.insert(&file, &Provenance::here());
        if let Err(why) = &inserted {
            eprintln!("{why}");
        }
        inserted.is_ok()
    }

    /// Prints the tables, or the JSON where that is asked for, and writes docs/measured/NAME.md if
    /// asked; whether that could be done.
    pub(super) fn show(
        &self,
        json: Option<Value>,
        measured: &Measured,
        name: &str,
        title: &str,
    ) -> bool {
        print(json, measured);
        self.keep(&Provenance::here(), measured, name, title)
    }

    /// Writes the tables to docs/measured/NAME.md if asked; whether that could be done.
    pub(super) fn keep(
        &self,
        from: &Provenance,
        measured: &Measured,
        name: &str,
        title: &str,
    ) -> bool {
        if !self.write {
            return true;
        }
        let folder = root().join("docs/measured");
        match measured.write(&folder, name, title, from) {
            Ok(path) => {
                eprintln!("Written: {}", path.display());
                true
            }
            Err(why) => {
                eprintln!("{why}");
                false
            }
        }
    }
}

/// Prints the tables, or the JSON where that is asked for.
pub(super) fn print(json: Option<Value>, measured: &Measured) {
    match json {
        Some(json) => println!("{json}"),
        None => println!("{}", measured.text().trim_end()),
    }
}
