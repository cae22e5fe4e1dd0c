//! Which column of a log is its time, and why a log has none, or no joint.

use super::Guess;
use super::coding::coding;
use super::columns::GuessReader;
use super::log_guess::ColumnGuess;
use super::name::{Role, name_guess};
use super::unused::quoted;
use super::values::{range, time_unit};
use crate::RawLog;
use crate::error::{Error, Place, Result};
use crate::output::shortened;

impl GuessReader<'_> {
    /// The time: what is named so, else what only grows.
    ///
    /// # Errors
    /// No such column, or one without a number.
    pub(super) fn time(&self, file: &str, said: &mut Vec<Guess>) -> Result<ColumnGuess> {
        let has_numbers = |index: &usize| range(&self.log.columns[*index]).is_some();
        let named = (0..self.names.len()).filter(|i| self.names[*i].role == Some(Role::Time));
        let named: Vec<usize> = named.collect();
        let found = named.iter().copied().find(has_numbers);
        let found = found.or_else(|| self.log.time().filter(has_numbers));
        let index = match (found, named.first()) {
            (Some(index), _) => index,
            (None, Some(empty)) => return Err(self.no_number(file, *empty)),
            (None, None) => {
                return Err(Error::data(
                    Place::file(file),
                    format!(
                        "no column is named time, and none only grows: {}",
                        listed(self.log)
                    ),
                    "add a column time_s; rows a fixed period apart are their number times the \
                     period",
                ));
            }
        };
        if !self.log.called_time(index) && !named.contains(&index) {
            said.push(Guess::new(
                "time",
                format!("column {:?}", shortened(&self.log.names[index])),
                "a guess: none is named time, and this is the first that only grows",
            ));
        }
        let unit = match self.log.iso.get(index) {
            Some(true) => "iso8601",
            _ => time_unit(&self.log.columns[index]),
        };
        let why = match unit {
            "iso8601" => "its values are time stamps",
            _ => "the middle step between rows",
        };
        let mut column = self.with_unit(index, "time", (unit, None), why, said);
        if unit == "iso8601" {
            column.unit = unit;
        }
        Ok(column)
    }

    /// Why no angle and no speed was found.
    pub(super) fn no_joint(&self, file: &str) -> Error {
        let moving = [Role::Position, Role::Velocity].map(Some);
        let mut named = (0..self.names.len()).filter(|i| moving.contains(&self.names[*i].role));
        if let Some(index) = named.next() {
            let Some(coding) = coding(&self.log.columns[index], &[], None) else {
                return self.no_number(file, index);
            };
            let name = shortened(&self.log.names[index]);
            let what = format!("column '{name}': {}", coding.words());
            return Error::data(Place::file(file), what, coding.remedy());
        }
        let is_moving = |(name, _): &&(String, String)| moving.contains(&name_guess(name).role);
        if let Some((name, holds)) = self.log.left_out.iter().find(is_moving) {
            return Error::data(
                Place::file(file),
                format!("column '{}' holds {holds}", shortened(name)),
                "save it as numbers, one a row",
            );
        }
        Error::data(
            Place::file(file),
            format!(
                "no column is named as an angle or a speed: {}",
                listed(self.log)
            ),
            "name the angle's column angle_rad, q1_rad or position, or write the model by hand: \
             docs/model.md",
        )
    }

    /// A column of the right name that holds no number.
    fn no_number(&self, file: &str, index: usize) -> Error {
        let name = shortened(&self.log.names[index]);
        let words = self.log.words.get(index).and_then(Option::as_deref);
        let holds = words.map_or(String::new(), |words| {
            format!(", but words such as '{}'", shortened(words))
        });
        let remedy = match self.names[index].role {
            Some(Role::Time) => {
                "save times as numbers, or as stamps such as 2026-03-01T12:00:00.25Z or 12:00:00.25"
            }
            _ => "save it as numbers with a decimal point",
        };
        let what = format!("column '{name}' holds no number{holds}");
        Error::data(Place::file(file), what, remedy)
    }
}

fn listed(log: &RawLog) -> String {
    quoted(log.names.iter().map(String::as_str))
}
