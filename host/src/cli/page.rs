//! Pages: what they were made from, and writing them.

use super::Console;
use handstand::motion::Split;
use handstand::report::{HashedModel, ReportProvenance, file_name, file_names};
use handstand::{Error, Result, output};
use std::path::{Path, PathBuf};

/// Where a page goes.
#[derive(Debug, clap::Args)]
pub struct PageFile {
    /// Write a page with pictures
    #[arg(long = "report", value_name = "FILE.html")]
    file: Option<PathBuf>,
    /// Replace the page if it exists
    #[arg(long)]
    force: bool,
}

impl PageFile {
    /// Whether one is wanted.
    pub fn is_wanted(&self) -> bool {
        self.file.is_some()
    }

    /// Whether files are replaced.
    pub fn is_forced(&self) -> bool {
        self.force
    }

    /// Refuses a name that is taken before the work begins, not after it.
    ///
    /// # Errors
    /// As [`output::vacant`].
    pub fn vacant(&self) -> Result<()> {
        let vacant = |file: &PathBuf| output::vacant(file, self.force);
        self.file.as_ref().map_or(Ok(()), vacant)
    }

    /// Writes what `page` makes, if a page is wanted.
    ///
    /// # Errors
    /// Those of `page`, and as [`output::write_new`].
    pub fn write(&self, page: impl FnOnce() -> Result<String>, console: &Console) -> Result<()> {
        match &self.file {
            Some(file) => console.write(file, &page()?, self.force),
            None => Ok(()),
        }
    }
}

/// What a report was made from: files with their hashes, and the command line.
///
/// # Errors
/// A model file that cannot be read again.
pub fn provenance(
    models: &[&PathBuf],
    split: &Split,
    console: &Console,
) -> Result<ReportProvenance> {
    let named = models.iter().zip(file_names(models));
    let model_files: Result<Vec<HashedModel>> =
        named.map(|(file, name)| hashed_as(name, file)).collect();
    Ok(ReportProvenance::new(model_files?, split, &console.command))
}

/// Name and hash of a model file.
///
/// # Errors
/// [`Error::File`] if it cannot be read.
pub fn hashed(file: &Path) -> Result<HashedModel> {
    hashed_as(file_name(file), file)
}

fn hashed_as(name: String, file: &Path) -> Result<HashedModel> {
    let bytes = std::fs::read(file).map_err(|error| Error::file(file, "read", error))?;
    Ok(HashedModel::of(name, &bytes))
}
