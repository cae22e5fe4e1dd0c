//! Writing samples as they come: a crash costs at most the last second.

use super::csv::CsvWriter;
#[cfg(feature = "ros")]
use super::mcap::McapWriter;
use super::sample::RobotSample;
use crate::error::{Error, Result};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A file's format, by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// Text, a row per sample.
    Csv,
    /// MCAP with ROS 2 joint states.
    #[cfg(feature = "ros")]
    Mcap,
}

impl FileFormat {
    /// Of this file.
    ///
    /// # Errors
    /// Another ending, or one of a format that this build leaves out.
    pub fn of(path: &Path) -> Result<FileFormat> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("csv") => Ok(FileFormat::Csv),
            #[cfg(feature = "ros")]
            Some("mcap") => Ok(FileFormat::Mcap),
            #[cfg(not(feature = "ros"))]
            Some("mcap") => Err(Error::usage(
                format!("{}: this build leaves out MCAP", path.display()),
                "end the name in .csv, or build with the cargo feature `ros`",
            )),
            _ => Err(Error::usage(
                format!("{}: unknown format", path.display()),
                "end the name in .csv or .mcap",
            )),
        }
    }
}

/// What a format does with samples.
pub(super) trait Writer: Send {
    /// Adds one.
    fn write(&mut self, sample: &RobotSample) -> std::io::Result<()>;
    /// Hands all of it to the system.
    fn flush(&mut self) -> std::io::Result<()>;
    /// Closes the file's structure.
    fn finish(&mut self) -> std::io::Result<()>;
}

/// Twice as often as a second, for a sync may itself take its time on a busy disk.
const SYNC_EVERY: Duration = Duration::from_millis(500);

/// A file that grows by samples and is brought to the disk twice a second.
pub struct RobotRecorder {
    path: PathBuf,
    file: File,
    writer: Box<dyn Writer>,
    synced: Instant,
    /// Samples written.
    pub samples: u64,
}

impl RobotRecorder {
    /// A new file for these servos.
    ///
    /// # Errors
    /// [`Error::Usage`] if it exists and `force` is false, or its ending says no format;
    /// [`Error::File`] if the system refuses.
    pub fn create(path: &Path, ids: &[u8], force: bool) -> Result<RobotRecorder> {
        let format = FileFormat::of(path)?;
        let refused = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => Error::usage(
                format!("{} exists", path.display()),
                "choose another name or pass --force",
            ),
            _ => Error::file(path, "write", error),
        };
        // Under its own name from the start: a crash must leave it where it is looked for.
        let file = if force {
            File::create(path)
        } else {
            File::create_new(path)
        }
        .map_err(refused)?;
        let own = file.try_clone().map_err(refused)?;
        let writer: Box<dyn Writer> = match format {
            FileFormat::Csv => Box::new(CsvWriter::new(own, ids)),
            #[cfg(feature = "ros")]
            FileFormat::Mcap => Box::new(McapWriter::new(own, ids).map_err(refused)?),
        };
        Ok(RobotRecorder {
            path: path.to_path_buf(),
            file,
            writer,
            synced: Instant::now(),
            samples: 0,
        })
    }

    /// Adds a sample; twice a second all is brought to the disk.
    ///
    /// # Errors
    /// [`Error::File`] if the system refuses.
    pub fn write(&mut self, sample: &RobotSample) -> Result<()> {
        self.writer
            .write(sample)
            .map_err(|error| self.refused(error))?;
        self.samples += 1;
        if self.synced.elapsed() >= SYNC_EVERY {
            self.sync()?;
        }
        Ok(())
    }

    /// Closes the file.
    ///
    /// # Errors
    /// [`Error::File`] if the system refuses.
    pub fn finish(mut self) -> Result<()> {
        self.writer.finish().map_err(|error| self.refused(error))?;
        self.file.sync_all().map_err(|error| self.refused(error))
    }

    fn sync(&mut self) -> Result<()> {
        self.synced = Instant::now();
        self.writer.flush().map_err(|error| self.refused(error))?;
        self.file.sync_data().map_err(|error| self.refused(error))
    }

    fn refused(&self, error: std::io::Error) -> Error {
        Error::file(&self.path, "write", error)
    }
}
