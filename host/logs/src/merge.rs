//! Two logs of one motion, by different recorders, as one: the second's clock is moved until a
//! signal that both hold agrees best.

mod align;

use super::RawLog;
use super::init::time_si;
use crate::error::{Error, Result};
use crate::output::number::short;
use align::aligned;
use serde::Serialize;

/// Values further apart than so many of the log's steps are not joined.
const GAP_STEPS: f64 = 5.0;

/// How two logs are put together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MergePlan {
    /// Columns of the first and the second log that hold the same signal; found without.
    pub align: Option<(String, String)>,
    /// What is added to the second log's time, s; estimated without.
    pub offset_s: Option<f64>,
}

/// Where the offset came from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alignment {
    /// Column of the first log.
    pub first: String,
    /// Column of the second log.
    pub second: String,
    /// Correlation of the two at the offset, -1 to 1: negative where they count opposite ways.
    pub correlation: f64,
}

/// Two logs as one.
#[derive(Debug, Clone, PartialEq)]
pub struct MergedLog {
    /// Columns of the first log, then those of the second, at the times of the first.
    pub log: RawLog,
    /// What was added to the second log's time, s.
    pub offset_s: f64,
    /// What it was estimated from; absent where it was given.
    pub alignment: Option<Alignment>,
    /// Rows with values of both.
    pub rows_of_both: usize,
}

/// A log's time, s, and its columns.
struct Timed<'a> {
    log: &'a RawLog,
    time: usize,
    time_s: Vec<f64>,
}

/// Puts two logs together.
///
/// # Errors
/// A log without time, columns that are not there, no signal that both hold, an offset that more
/// than one place fits as well, or logs that do not overlap.
pub fn merge(first: &RawLog, second: &RawLog, plan: &MergePlan) -> Result<MergedLog> {
    let (first, second) = (Timed::of(first, "first")?, Timed::of(second, "second")?);
    let (offset_s, alignment) = match plan.offset_s {
        Some(offset_s) => (offset_s, None),
        None => {
            let found = aligned(&first, &second, plan.align.as_ref())?;
            (found.0, Some(found.1))
        }
    };
    let mut log = first.log.clone();
    if log.iso[first.time] {
        // Its values count in s from the first stamp.
        log.names[first.time] = "time_s".to_string();
        log.iso[first.time] = false;
    }
    let mut rows_of_both = 0;
    for (index, name) in second.log.names.iter().enumerate() {
        if index == second.time {
            continue;
        }
        let times = first.time_s.iter().map(|time_s| time_s - offset_s);
        let column = second.at(index, times);
        rows_of_both = rows_of_both.max(column.iter().filter(|v| v.is_finite()).count());
        let mut own = name.clone();
        while log.names.contains(&own) {
            own += "_2";
        }
        log.names.push(own);
        log.columns.push(column);
        log.iso.push(false);
        log.words.push(None);
    }
    if rows_of_both == 0 {
        return Err(Error::usage(
            format!(
                "at an offset of {} s the logs do not overlap",
                short(offset_s)
            ),
            "give another --offset: it is added to the second log's time",
        ));
    }
    Ok(MergedLog {
        log,
        offset_s,
        alignment,
        rows_of_both,
    })
}

impl<'a> Timed<'a> {
    fn of(log: &'a RawLog, which: &str) -> Result<Self> {
        let time = log.time().ok_or_else(|| {
            Error::usage(
                format!("no column of the {which} log is a time"),
                "name it time_s, or merge logs that hold one",
            )
        })?;
        let time_s = time_si(log, time);
        if time_s.len() < 8
            || time_s
                .windows(2)
                .any(|pair| !matches!(pair, [a, b] if a < b))
        {
            return Err(Error::usage(
                format!("`{}` of the {which} log does not increase", log.names[time]),
                "`handstand log check` says where; cut the log there",
            ));
        }
        Ok(Timed { log, time, time_s })
    }

    fn duration_s(&self) -> f64 {
        self.time_s[self.time_s.len() - 1] - self.time_s[0]
    }

    /// Median step, s.
    fn step_s(&self) -> f64 {
        let mut steps: Vec<f64> = self
            .time_s
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect();
        steps.sort_by(f64::total_cmp);
        steps[steps.len() / 2]
    }

    /// A column at times that grow, by straight lines; not a number outside and in gaps.
    fn at(&self, column: usize, times: impl Iterator<Item = f64>) -> Vec<f64> {
        let values = &self.log.columns[column];
        let known: Vec<usize> = (0..values.len())
            .filter(|k| values[*k].is_finite())
            .collect();
        let gap_s = GAP_STEPS * self.step_s();
        let mut next = 0;
        let value = |time_s: f64| {
            while next < known.len() && self.time_s[known[next]] < time_s {
                next += 1;
            }
            let after = *known.get(next)?;
            if self.time_s[after] == time_s {
                return Some(values[after]);
            }
            let before = *known.get(next.checked_sub(1)?)?;
            let (from, to) = (self.time_s[before], self.time_s[after]);
            let share = (time_s - from) / (to - from);
            let value = values[before] + share * (values[after] - values[before]);
            (to - from <= gap_s).then_some(value)
        };
        times
            .map({
                let mut value = value;
                move |time_s| value(time_s).unwrap_or(f64::NAN)
            })
            .collect()
    }

    /// Columns that may be aligned: those that are no time and that change.
    fn signals(&self) -> Vec<usize> {
        let changes = |column: &Vec<f64>| {
            let mut values = column.iter().filter(|value| value.is_finite());
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let columns = 0..self.log.columns.len();
        columns
            .filter(|index| *index != self.time && changes(&self.log.columns[*index]))
            .collect()
    }

    fn column(&self, name: &str, which: &str) -> Result<usize> {
        let found = self.log.names.iter().position(|own| own == name);
        found.ok_or_else(|| {
            Error::usage(
                format!("the {which} log has no column `{name}`"),
                format!("it has {}", self.log.names.join(", ")),
            )
        })
    }

    /// A column about its mean on a grid from the log's begin, gaps as zeros.
    fn gridded(&self, column: usize, step_s: f64, samples: usize) -> Vec<f64> {
        let begin = self.time_s[0];
        let mut values = self.at(column, (0..samples).map(|k| begin + k as f64 * step_s));
        let known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
        for value in &mut values {
            *value = if value.is_finite() {
                *value - mean
            } else {
                0.0
            };
        }
        values
    }
}

#[cfg(test)]
mod tests;
