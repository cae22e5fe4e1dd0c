//! Bringing data: logs into the session's folder, a model in force, what the check finds.

use super::LabSession;
use super::saved::{SavedLog, SavedSession, SavedStep};
use crate::error::{Error, Result};
use crate::log::{LogFormat, LogRequest, LogSet, RawLog, Split, split};
use crate::model::Model;
use crate::output::write_new_bytes;
use std::path::{Path, PathBuf};

/// Most bytes of a log.
pub const MOST_BYTES: usize = 256 << 20;
/// Most logs of a session.
const MOST_LOGS: usize = 64;
/// Longest file name, characters.
const LONGEST_NAME: usize = 80;

/// What a log holds, as far as it can be read.
#[derive(Debug, Clone)]
pub struct LogFacts {
    /// The log.
    pub log: SavedLog,
    /// Motions and samples by the model in force, or why it cannot be read.
    pub content: std::result::Result<(usize, usize, f64), (String, String)>,
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
        if self.saved().logs.len() >= MOST_LOGS {
            return Err(Error::usage(
                format!("the session holds {MOST_LOGS} logs already"),
                "remove one, or begin another session",
            ));
        }
        let folder = self.folder().join("logs");
        std::fs::create_dir_all(&folder).map_err(|why| Error::file(&folder, "make", why))?;
        let (stem, ending) = file.rsplit_once('.').unwrap_or((&file, ""));
        let mut names = std::iter::once(file.clone())
            .chain((2..).map(|count| format!("{stem}-{count}.{ending}")));
        match names.find(|name| !folder.join(name).exists()) {
            Some(name) => Ok((name.clone(), folder.join(name))),
            None => unreachable!("there is no end to the names"),
        }
    }

    /// Takes a file that was written to the path of [`LabSession::vacant_log`] as a log.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn take_log(&self, file: &str) -> Result<()> {
        self.change(|saved| {
            saved.logs.push(SavedLog {
                file: file.to_string(),
                rows: None,
                held_out: false,
            });
            saved.diagnosis = None;
            Ok(())
        })
    }

    /// Takes a log out; its file stays in the folder.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn remove_log(&self, file: &str) -> Result<()> {
        self.change(|saved| {
            saved.logs.retain(|log| log.file != file);
            saved.diagnosis = None;
            Ok(())
        })
    }

    /// Makes a log one to judge by, or one to learn from.
    ///
    /// # Errors
    /// As [`LabSession::change`].
    pub fn hold_out(&self, file: &str, held_out: bool) -> Result<()> {
        self.change(|saved| {
            let logs = saved.logs.iter_mut().filter(|log| log.file == file);
            logs.for_each(|log| log.held_out = held_out);
            saved.diagnosis = None;
            Ok(())
        })
    }

    /// Takes a model as the first step; those before are gone.
    ///
    /// # Errors
    /// A text that is no model.
    pub fn begin_model(&self, title: &str, toml: &str) -> Result<()> {
        Model::parse(toml, Path::new("model-0.toml"))?;
        self.change(|saved| {
            saved.steps = vec![SavedStep {
                title: title.to_string(),
                toml: toml.to_string(),
                command: None,
                note: String::new(),
            }];
            saved.current = 0;
            saved.diagnosis = None;
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
        match saved.logs.iter().all(|log| log.held_out) {
            true => LogSet {
                training: of(true),
                held_out: Vec::new(),
            },
            false => LogSet {
                training: of(false),
                held_out: of(true),
            },
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

    /// The model in force, if there is one.
    ///
    /// # Errors
    /// A text that is no model.
    pub fn model(&self, saved: &SavedSession) -> Result<Option<Model>> {
        let parse = |toml: &str| Model::parse(toml, &model_file(saved.current));
        saved.step().map(|step| parse(&step.toml)).transpose()
    }

    /// What each log holds by the model in force.
    pub fn log_facts(&self, saved: &SavedSession, model: Option<&Model>) -> Vec<LogFacts> {
        let facts = |log: &SavedLog| {
            let request = LogRequest {
                path: self.log_path(&log.file),
                rows: log.rows,
            };
            let content = match model {
                None => Err(("no model reads it yet".into(), String::new())),
                Some(model) => crate::log::read(&[request], &model.log)
                    .map(|motions| {
                        let samples = motions.iter().map(|m| m.len()).sum();
                        let seconds = motions.iter().map(|m| m.duration_s()).sum();
                        (motions.len(), samples, seconds)
                    })
                    .map_err(|error| {
                        let remedy = error.remedy().unwrap_or_default().into_owned();
                        (self.shortened(&error.to_string()), remedy)
                    }),
            };
            LogFacts {
                log: log.clone(),
                content,
            }
        };
        saved.logs.iter().map(facts).collect()
    }
}

/// Name of a step's model file.
pub(super) fn model_file(step: usize) -> PathBuf {
    PathBuf::from(format!("model-{step}.toml"))
}

/// The last part of a name, in letters that no file system and no page can misread.
fn plain_name(name: &str) -> Result<String> {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = |c: char| match c.is_ascii_alphanumeric() || "._-".contains(c) {
        true => c,
        false => '_',
    };
    let plain: String = last.chars().map(plain).collect();
    let plain = plain.trim_start_matches('.');
    let (stem, ending) = plain.rsplit_once('.').unwrap_or((plain, ""));
    let ending = ending.to_ascii_lowercase();
    if stem.is_empty() || !LogFormat::is_log(Path::new(plain)) {
        let endings: Vec<&str> = LogFormat::endings().collect();
        return Err(Error::usage(
            format!("`{last}` is no log that can be read"),
            format!("bring a file that ends in {}", endings.join(", ")),
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
