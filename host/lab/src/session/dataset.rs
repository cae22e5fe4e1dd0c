//! A data set of LeRobot as a log of a session: its files in a folder among the logs.

use super::LabSession;
use super::data::{LONGEST_NAME, numbered, plain_letters};
use crate::error::{Error, Result};
use crate::log::lerobot::dataset_files;
use crate::output::write_new_bytes;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Whether a path leads to a file of a data set, and nowhere else: `meta/info.json`.
fn stays_inside(file: &str) -> bool {
    let mut parts = Path::new(file).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}

/// A path with slashes on every system.
fn slashed(path: &Path) -> String {
    let parts = path
        .components()
        .map(|part| part.as_os_str().to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

impl LabSession {
    /// Copies a data set into the session, as one log.
    ///
    /// # Errors
    /// Too many logs, the system's refusal.
    pub(super) fn keep_dataset(&self, folder: &Path, files: &[PathBuf]) -> Result<()> {
        let mut contents = BTreeMap::new();
        for file in files {
            let from = folder.join(file);
            let bytes = std::fs::read(&from).map_err(|why| Error::file(&from, "read", why))?;
            contents.insert(slashed(file), bytes);
        }
        let absolute = std::path::absolute(folder).unwrap_or_default();
        let name = absolute.file_name().unwrap_or_default().to_string_lossy();
        let name = self.write_dataset(&name, &contents)?;
        self.take_log(&name)
    }

    /// Writes a data set's files, by their paths in it, into a folder among the logs; the name
    /// that the folder got.
    ///
    /// # Errors
    /// A path that leads out of the folder, too many logs, the system's refusal.
    pub(super) fn write_dataset(
        &self,
        name: &str,
        files: &BTreeMap<String, Vec<u8>>,
    ) -> Result<String> {
        self.has_room()?;
        if let Some(file) = files.keys().find(|file| !stays_inside(file)) {
            let what = format!("{name}: {file} leads out of the data set");
            return Err(Error::usage(what, "save the session again"));
        }
        // A folder has no ending.
        let plain = plain_letters(name).replace('.', "_");
        let stem: String = plain.chars().take(LONGEST_NAME).collect();
        let stem = if stem.is_empty() { "dataset" } else { &stem };
        let Some(name) = numbered(stem).find(|name| !self.log_path(name).exists()) else {
            unreachable!("there is no end to the names")
        };
        for (file, bytes) in files {
            let path = self.log_path(&name).join(file);
            let folder = path.parent().unwrap_or(Path::new(""));
            std::fs::create_dir_all(folder).map_err(|why| Error::file(folder, "make", why))?;
            write_new_bytes(&path, bytes, false)?;
        }
        Ok(name)
    }

    /// The files that a log of the session is made of, below the folder of logs: those of a data
    /// set, or the one.
    pub(super) fn files_of_log(&self, log: &str) -> Vec<String> {
        let parts = dataset_files(&self.log_path(log)).ok().flatten();
        match parts {
            Some(files) => files
                .iter()
                .map(|file| format!("{log}/{}", slashed(file)))
                .collect(),
            None => vec![log.to_string()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_stays_in_the_data_set() {
        for (path, stays) in [
            ("meta/info.json", true),
            ("../info.json", false),
            ("/etc/passwd", false),
            ("data/../../x", false),
        ] {
            assert_eq!(stays_inside(path), stays, "{path}");
        }
    }
}
