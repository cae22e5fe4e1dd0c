//! The limit of what a sensor gives, for columns that a model explains and for raw ones.

use super::init::name_guess;
use super::raw::RawLog;
use super::reason::LogReason;
use super::request::LogRequest;
use crate::error::{Error, Place, Result};
use crate::model::{Dimension, Unit};

/// No angle, speed, torque, voltage or mass is read beyond this, SI: 160,000 turns. Larger numbers
/// come of damaged bytes or of another unit, and their squares drown those of all other samples.
pub(super) const LARGEST_READING: f64 = 1e6;

/// Why a value is none that a sensor gives, if it is none: what is `found` in `column` is `si` of
/// this dimension. Times are as large as they like.
pub(super) fn beyond_readings(
    column: &str,
    si: f64,
    dimension: Dimension,
    found: impl FnOnce() -> String,
) -> Option<LogReason> {
    let is_beyond = dimension != Dimension::Time && si.abs() > LARGEST_READING;
    is_beyond.then(|| LogReason::NoReading {
        column: column.to_string(),
        found: found(),
        si,
        unit: dimension.si_unit(),
    })
}

/// What no sensor gives is refused in the rows asked for, where columns' names tell readings.
pub(super) struct ReadingLimit<'a> {
    request: &'a LogRequest,
    units: Vec<Option<Unit>>,
}

impl<'a> ReadingLimit<'a> {
    /// For columns of these names.
    pub fn new(request: &'a LogRequest, names: &[String]) -> Self {
        let units = names.iter().map(|name| name_guess(name).reading_unit());
        ReadingLimit {
            request,
            units: units.collect(),
        }
    }

    /// Refuses a row that has more fields than there are names: which is which nothing tells.
    ///
    /// # Errors
    /// Always.
    pub fn refuse_wide(&self, line: usize, found: usize, expected: usize) -> Result<()> {
        let place = Place::at(&self.request.path, line, expected + 1);
        Err(Error::refused(
            place,
            LogReason::FieldCount { found, expected },
        ))
    }

    /// Refuses a value of a row, counted from 0, that is `found` at this line of the column.
    ///
    /// # Errors
    /// A number that no sensor gives.
    pub fn hold(
        &self,
        row: usize,
        line: usize,
        (name, column): (&str, usize),
        value: f64,
        found: impl FnOnce() -> String,
    ) -> Result<()> {
        let unit = self.units[column].filter(|_| self.request.wants(row));
        let refusal =
            unit.and_then(|unit| beyond_readings(name, unit.to_si(value), unit.dimension, found));
        match refusal {
            Some(reason) => {
                let place = Place::at(&self.request.path, line, column + 1);
                Err(Error::refused(place, reason))
            }
            None => Ok(()),
        }
    }

    /// Refuses the first such value of a table, whose rows count as lines.
    ///
    /// # Errors
    /// A number that no sensor gives.
    pub fn hold_table(&self, log: &RawLog) -> Result<()> {
        for row in 0..log.columns.first().map_or(0, Vec::len) {
            for (index, (name, column)) in log.names.iter().zip(&log.columns).enumerate() {
                let found = || column[row].to_string();
                self.hold(row, row + 1, (name, index), column[row], found)?;
            }
        }
        Ok(())
    }
}
