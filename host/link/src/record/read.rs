//! Reading recordings back, whole or torn.

use super::csv;
#[cfg(feature = "ros")]
use super::mcap;
use super::recorder::FileFormat;
use super::sample::RobotSample;
use crate::error::{Error, Result};
use std::path::Path;

/// What was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Servos, in the order of each sample's joints.
    pub ids: Vec<u8>,
    /// Samples, in time.
    pub samples: Vec<RobotSample>,
    /// Whether the file ended in the middle of something, which was dropped.
    pub torn: bool,
}

impl Recording {
    /// What it says of these servos alone; none if it lacks one.
    pub fn of_servos(&self, ids: &[u8]) -> Option<Recording> {
        let place = |id: &u8| self.ids.iter().position(|own| own == id);
        let places: Vec<usize> = ids.iter().map(place).collect::<Option<_>>()?;
        let sample = |sample: &RobotSample| RobotSample {
            joints: places.iter().map(|place| sample.joints[*place]).collect(),
            ..sample.clone()
        };
        Some(Recording {
            ids: ids.to_vec(),
            samples: self.samples.iter().map(sample).collect(),
            torn: self.torn,
        })
    }
}

/// Reads a CSV or MCAP recording; `-` is CSV from the standard input.
///
/// # Errors
/// [`Error::File`] if it cannot be read, [`Error::Data`] at the place where it is no recording.
pub fn read(path: &Path) -> Result<Recording> {
    let refused = |error| Error::file(path, "read", error);
    if path == Path::new("-") {
        let text = std::io::read_to_string(std::io::stdin()).map_err(refused)?;
        let (ids, samples, torn) = csv::read(&text, path)?;
        return Ok(Recording { ids, samples, torn });
    }
    let (ids, samples, torn) = match FileFormat::of(path)? {
        FileFormat::Csv => csv::read(&std::fs::read_to_string(path).map_err(refused)?, path)?,
        #[cfg(feature = "ros")]
        FileFormat::Mcap => mcap::read(&std::fs::read(path).map_err(refused)?, path)?,
    };
    Ok(Recording { ids, samples, torn })
}
