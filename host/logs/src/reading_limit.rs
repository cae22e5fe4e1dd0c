//! The limit of what a sensor gives, for columns that a model explains and for raw ones.

use super::fault::quoted;
use super::init::name_guess;
use super::request::LogRequest;
use super::table::LogTable;
use crate::error::{Place, Problem, Result};
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
) -> Option<Problem> {
    let is_beyond = dimension != Dimension::Time && si.abs() > LARGEST_READING;
    is_beyond.then(|| {
        let (found, unit) = (quoted(&found()), dimension.si_unit());
        Problem::new(
            format!(
                "{column}: {found} is {si:.3e} {unit}, beyond the {LARGEST_READING:.0} {unit} \
                 that a reading may be"
            ),
            "check the column's unit in the model's [log], or in its name where there is no \
             model; of a broken cell, delete the value, which leaves a gap",
        )
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

    /// Refuses a number of a row, counted from 0, that no sensor gives.
    ///
    /// # Errors
    /// The first such number.
    pub fn hold(&self, table: &LogTable, row: usize) -> Result<()> {
        if !self.request.wants(row) {
            return Ok(());
        }
        for (index, unit) in self.units.iter().enumerate() {
            let Some(unit) = unit else { continue };
            let si = unit.to_si(table.columns[index][row]);
            let found = || table.text(row, index).into();
            let name = &table.names[index];
            if let Some(problem) = beyond_readings(name, si, unit.dimension, found) {
                let place = Place::at(&self.request.path, table.line(row), index + 1);
                return Err(problem.at(place));
            }
        }
        Ok(())
    }
}
