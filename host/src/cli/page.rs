//! Pages: what they were made from, and writing them.

use super::Talk;
use handstand::log::{Motion, Split};
use handstand::output::number::hex;
use handstand::report::{LogFile, ModelFile, ReportProvenance};
use handstand::{Error, Result, output};
use sha2::{Digest as _, Sha256};
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
    pub fn write(&self, page: impl FnOnce() -> Result<String>, talk: &Talk) -> Result<()> {
        match &self.file {
            Some(file) => talk.write(file, &page()?, self.force),
            None => Ok(()),
        }
    }
}

/// What a report was made from: files with their hashes, and the command line.
///
/// # Errors
/// A model file that cannot be read again.
pub fn provenance(models: &[&PathBuf], split: &Split, talk: &Talk) -> Result<ReportProvenance> {
    let mut logs = Vec::new();
    add_logs(&mut logs, &split.training, false);
    add_logs(&mut logs, &split.held_out, true);
    let model_files: Result<Vec<ModelFile>> = models.iter().map(|file| hashed(file)).collect();
    Ok(ReportProvenance {
        program_version: env!("CARGO_PKG_VERSION").to_string(),
        model_files: model_files?,
        logs,
        command: talk.command.clone(),
    })
}

/// Name and hash of a model file.
///
/// # Errors
/// [`Error::File`] if it cannot be read.
pub fn hashed(file: &Path) -> Result<ModelFile> {
    let bytes = std::fs::read(file).map_err(|error| Error::file(file, "read", error))?;
    Ok(ModelFile {
        name: file_name(file),
        sha256: hex(Sha256::digest(&bytes)),
    })
}

fn add_logs(logs: &mut Vec<LogFile>, motions: &[Motion], held_out: bool) {
    for motion in motions {
        let name = file_name(&motion.source.path);
        let same = |log: &&mut LogFile| log.name == name && log.held_out == held_out;
        match logs.iter_mut().find(same) {
            Some(log) => log.samples += motion.len(),
            None => logs.push(LogFile {
                name,
                sha256: motion.source.sha256.clone(),
                samples: motion.len(),
                held_out,
            }),
        }
    }
}

/// The last part of a file's path.
pub fn file_name(file: &Path) -> String {
    file.file_name()
        .unwrap_or(file.as_os_str())
        .to_string_lossy()
        .into_owned()
}
