//! Bringing data: logs into the session's folder, a model in force, what the check finds.

use super::LabSession;
use super::bring::MODEL_ENDINGS;
use super::saved::{SavedLog, SavedSession, SavedStep};
use crate::error::{Error, Result};
use crate::log::{LogFormat, LogRequest, LogSet, RawLog};
use crate::model::Model;
use crate::motion::{Split, split};
use crate::output::number::hex;
use crate::output::write_new_bytes;
use serde::Deserialize;
use sha2::{Digest as _, Sha256};
use std::path::{Path, PathBuf};

/// Most bytes of a log.
pub const MOST_BYTES: usize = 256 << 20;
/// Most logs of a session.
const MOST_LOGS: usize = 64;
/// Longest file name, characters.
pub(super) const LONGEST_NAME: usize = 80;

/// A part of a file that is a log by itself.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct LogPart {
    /// First and last data row, counted from 0; all without.
    pub rows: Option<(usize, usize)>,
    /// Whether it judges and is not fitted.
    pub held_out: bool,
}

impl LabSession {
    /// The path of one of its logs.
    pub fn log_path(&self, file: &str) -> PathBuf {
        self.folder().join("logs").join(file)
    }

    /// Adds a log that was sent, under the last part of the name it came with.
    ///
    /// # Errors
    /// A kind of file that is not read, a table that cannot be read, too many logs, the system's
    /// refusal.
    pub fn add_log(&self, name: &str, bytes: &[u8]) -> Result<String> {
        let file = self.keep_log(name, bytes)?;
        // What is wrong with text is shown beside it; a table that cannot be read has nothing to
        // show.
        let path = self.log_path(&file);
        let is_text = matches!(LogFormat::of(&path), LogFormat::Csv | LogFormat::Bam);
        if !is_text && let Err(error) = RawLog::read(&path) {
            std::fs::remove_file(&path).map_err(|why| Error::file(&path, "remove", why))?;
            return Err(error);
        }
        self.take_log(&file)?;
        Ok(file)
    }

    /// Writes a log into the session's folder; the name it got.
    pub(super) fn keep_log(&self, name: &str, bytes: &[u8]) -> Result<String> {
        let (name, path) = self.vacant_log(name)?;
        write_new_bytes(&path, bytes, false)?;
        Ok(name)
    }

    /// The name that a log gets which came with this one, and the path to write it to.
    ///
    /// # Errors
    /// A kind of file that is not read, too many logs, the system's refusal.
    pub fn vacant_log(&self, name: &str) -> Result<(String, PathBuf)> {
        let file = plain_name(name)?;
        self.has_room()?;
        let folder = self.folder().join("logs");
        std::fs::create_dir_all(&folder).map_err(|why| Error::file(&folder, "make", why))?;
        match numbered(&file).find(|name| !folder.join(name).exists()) {
            Some(name) => Ok((name.clone(), folder.join(name))),
            None => unreachable!("there is no end to the names"),
        }
    }

    /// Refuses one more log where there are as many as a session holds.
    pub(super) fn has_room(&self) -> Result<()> {
        if self.saved().logs.len() < MOST_LOGS {
            return Ok(());
        }
        Err(Error::usage(
            format!("the session holds {MOST_LOGS} logs already"),
            "remove one, or begin another session",
        ))
    }

    /// Takes a file that was written to the path of [`LabSession::vacant_log`] as a log.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn take_log(&self, file: &str) -> Result<()> {
        self.take_rows(file, None)
    }

    /// Takes these rows of a file of the session as a log; all of them without. A log of that name
    /// that the session lacked keeps its role.
    pub(super) fn take_rows(&self, file: &str, rows: Option<(usize, usize)>) -> Result<()> {
        let sha256 = self.sha256_of(file)?;
        self.change(|saved| {
            let lacked = saved.logs.iter_mut().filter(|log| log.file == file);
            let lacked = lacked.map(|log| log.sha256.clone_from(&sha256)).count();
            if lacked == 0 {
                saved.logs.push(SavedLog {
                    file: file.to_string(),
                    rows,
                    held_out: false,
                    sha256,
                });
            }
            Ok(())
        })
    }

    /// SHA-256 of a log's bytes, in hexadecimal; of a data set's files one after the other.
    fn sha256_of(&self, log: &str) -> Result<String> {
        let mut hash = Sha256::new();
        for file in self.files_of_log(log) {
            let path = self.log_path(&file);
            let refused = |why| Error::file(&path, "read", why);
            let mut part = std::fs::File::open(&path).map_err(refused)?;
            std::io::copy(&mut part, &mut hash).map_err(refused)?;
        }
        Ok(hex(hash.finalize()))
    }

    /// Fills in what a session of an earlier version of the program did not keep.
    pub(super) fn take_up(&self, saved: &mut SavedSession) {
        for log in saved.logs.iter_mut().filter(|log| log.sha256.is_empty()) {
            // A log that is gone is said to be where logs are listed.
            log.sha256 = self.sha256_of(&log.file).unwrap_or_default();
        }
        if let (true, Some(said)) = (saved.kept.is_empty(), saved.diagnosis.clone())
            && let Some(of) = saved.files_of(said.step)
        {
            saved.keep_diagnosis(of, said);
        }
        saved.recall();
    }

    /// Takes a log out, by its name with its rows; its file stays in the folder.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn remove_log(&self, name: &str) -> Result<()> {
        self.change(|saved| {
            saved.logs.retain(|log| log.name() != name);
            Ok(())
        })
    }

    /// Makes a log one to judge by, or one to learn from.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn hold_out(&self, name: &str, held_out: bool) -> Result<()> {
        self.change(|saved| {
            let logs = saved.logs.iter_mut().filter(|log| log.name() == name);
            logs.for_each(|log| log.held_out = held_out);
            Ok(())
        })
    }

    /// Divides a file's rows into parts, in place of the logs that there are of it; a single part
    /// without rows is the whole file again.
    ///
    /// # Errors
    /// Rows that the file has not or that run backwards; a file that is none of the session's.
    pub fn divide_log(&self, file: &str, parts: &[LogPart]) -> Result<()> {
        let rows = RawLog::read(&self.log_path(file))?
            .columns
            .first()
            .map_or(0, Vec::len);
        let fits = |part: &LogPart| {
            part.rows
                .is_none_or(|(first, last)| first <= last && last < rows)
        };
        if parts.is_empty() || parts.len() > MOST_LOGS || !parts.iter().all(fits) {
            return Err(Error::usage(
                format!("these are no parts of the {rows} rows of {file}"),
                "select a stretch of the chart again",
            ));
        }
        self.change(|saved| {
            let own = saved.logs.iter().position(|log| log.file == file);
            let at = own.ok_or_else(|| Error::usage("there is no such log", "reload the page"))?;
            let sha256 = saved.logs[at].sha256.clone();
            saved.logs.retain(|log| log.file != file);
            let parts = parts.iter().map(|part| SavedLog {
                file: file.to_string(),
                rows: part.rows,
                held_out: part.held_out,
                sha256: sha256.clone(),
            });
            saved.logs.splice(at..at, parts);
            Ok(())
        })
    }

    /// Takes a model as the first step; those before are gone.
    ///
    /// # Errors
    /// A text that is no model.
    pub fn begin_model(&self, title: &str, toml: &str) -> Result<()> {
        Model::parse(toml, &self.model_path(0))?;
        self.change(|saved| {
            saved.steps = vec![SavedStep::by_hand(title, toml)];
            saved.current = 0;
            Ok(())
        })?;
        self.write_models()
    }

    /// Its logs in their roles. Without any to learn from, those to judge by are learned from.
    pub fn log_set(&self, saved: &SavedSession) -> LogSet {
        let request = |log: &SavedLog| LogRequest {
            path: self.log_path(&log.file),
            rows: log.rows,
        };
        let of = |held_out: bool| -> Vec<LogRequest> {
            let logs = saved.logs.iter().filter(|log| log.held_out == held_out);
            logs.map(request).collect()
        };
        if saved.logs.iter().all(|log| log.held_out) {
            LogSet {
                training: of(true),
                held_out: Vec::new(),
            }
        } else {
            LogSet {
                training: of(false),
                held_out: of(true),
            }
        }
    }

    /// Its motions in their roles, as a diagnosis splits them.
    ///
    /// # Errors
    /// Logs that cannot be read.
    pub fn split(&self, saved: &SavedSession, model: &Model) -> Result<Split> {
        let named = self.log_set(saved).read(&model.log)?;
        Ok(split(named.training, named.held_out))
    }

    /// Where a step's model file is; what it names is looked up beside it.
    pub fn model_path(&self, step: usize) -> PathBuf {
        self.folder().join(model_file(step))
    }

    /// The model in force, if there is one.
    ///
    /// # Errors
    /// A text that is no model.
    pub fn model(&self, saved: &SavedSession) -> Result<Option<Model>> {
        let parse = |toml: &str| Model::parse(toml, &self.model_path(saved.current));
        saved.step().map(|step| parse(&step.toml)).transpose()
    }
}

/// Name of a step's model file, in the session's folder.
pub(super) fn model_file(step: usize) -> PathBuf {
    PathBuf::from(format!("model-{step}.toml"))
}

/// A name in letters that no file system and no page can misread, not hidden.
pub(super) fn plain_letters(name: &str) -> String {
    let plain = |c: char| match c {
        c if c.is_ascii_alphanumeric() || "._-".contains(c) => c,
        _ => '_',
    };
    let plain: String = name.chars().map(plain).collect();
    plain.trim_start_matches('.').to_string()
}

/// A file's name, then the same with 2, 3, .. before its ending, without end.
pub(super) fn numbered(file: &str) -> impl Iterator<Item = String> {
    let (stem, ending) = match file.rsplit_once('.') {
        Some((stem, ending)) => (stem.to_string(), format!(".{ending}")),
        None => (file.to_string(), String::new()),
    };
    let others = (2..).map(move |count| format!("{stem}-{count}{ending}"));
    std::iter::once(file.to_string()).chain(others)
}

/// The last part of a name, in letters that no file system and no page can misread.
fn plain_name(name: &str) -> Result<String> {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = plain_letters(last);
    let (stem, ending) = plain.rsplit_once('.').unwrap_or((&plain, ""));
    let ending = ending.to_ascii_lowercase();
    if stem.is_empty() || !LogFormat::is_log(Path::new(&plain)) {
        let endings: Vec<&str> = LogFormat::endings().collect();
        return Err(Error::usage(
            format!("`{last}` is no log that can be read"),
            format!(
                "bring a log that ends in {}, a model that ends in {}, or a saved session",
                endings.join(", "),
                MODEL_ENDINGS.join(", ")
            ),
        ));
    }
    let stem: String = stem.chars().take(LONGEST_NAME).collect();
    Ok(format!("{stem}.{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_leave_its_folder() {
        for (given, kept) in [
            ("drop.csv", "drop.csv"),
            ("../../etc/passwd.csv", "passwd.csv"),
            ("..\\..\\x.CSV", "x.csv"),
            ("<img src=x>.csv", "_img_src_x_.csv"),
            ("...hidden.json", "hidden.json"),
            ("run.MCAP", "run.mcap"),
            ("bag/bag_0.db3", "bag_0.db3"),
            ("drop.mat", "drop.mat"),
        ] {
            assert_eq!(plain_name(given).unwrap(), kept, "{given}");
        }
        for given in ["", "..", ".csv", "a.exe", "/", "a.csv/"] {
            assert!(plain_name(given).is_err(), "{given}");
        }
    }
}
