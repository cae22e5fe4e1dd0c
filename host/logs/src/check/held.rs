//! Readings held while the joint moved on: frames that were lost, or a sensor slower than the log.
//!
//! A joint in motion moves about as far from sample to sample as before. Where a reading is
//! repeated and the next one has caught up with the motion, the repeated rows are no measurements:
//! they are wrong by the speed times their age.

use super::LoggedFile;
use super::finding::Findings;
use crate::output::number::percent;

/// A joint moves where it does so by more than so many of its smallest changes a sample: less may
/// be read twice because the sensor is coarse.
const MOVING: f64 = 3.0;
/// The motion goes on if the speed after a repeated reading is that before it within this factor.
const SAME_SPEED: std::ops::RangeInclusive<f64> = 0.6..=1.67;
/// Fewer repeated rows, or a smaller share of those in motion, are chance.
const LEAST_ROWS: usize = 3;
const LEAST_SHARE: f64 = 0.01;
/// From this share on every reading is held, and none was lost.
const SLOW_SENSOR: f64 = 0.3;

/// Counts the rows in which a joint's reading is held.
#[derive(Debug, Default)]
pub(super) struct HeldReadings {
    /// Present reading, where it first stood, and in how many rows it stands.
    present: Option<(f64, usize, usize)>,
    /// Change a row from the reading before to the present one.
    change: f64,
    /// Rows in motion, and those of them that only repeat.
    moving: usize,
    held: usize,
    /// Line of the first that is held.
    first: Option<usize>,
}

impl HeldReadings {
    /// Forgets the motion that has ended.
    pub fn restart(&mut self) {
        self.present = None;
        self.change = 0.0;
    }

    /// Takes a reading; `smallest` is the smallest change seen so far, 0 before any.
    pub fn take(&mut self, value: f64, smallest: f64, line: usize) {
        let Some((present, begin, rows)) = &mut self.present else {
            self.present = Some((value, line, 1));
            return;
        };
        if value == *present {
            *rows += 1;
            return;
        }
        let change = (value - *present) / *rows as f64;
        if change.abs() > MOVING * smallest && SAME_SPEED.contains(&(change / self.change)) {
            self.moving += *rows;
            self.held += *rows - 1;
            if *rows > 1 && self.first.is_none() {
                self.first = Some(*begin);
            }
        }
        self.change = change;
        self.present = Some((value, line, 1));
    }

    /// Says how many rows of a column, its name and field, are held, if they are more than chance.
    pub fn judge(&self, (name, field): (&str, usize), file: &LoggedFile, findings: &mut Findings) {
        let share = self.held as f64 / self.moving.max(1) as f64;
        let Some(line) = self.first else {
            return;
        };
        if self.held < LEAST_ROWS || share < LEAST_SHARE {
            return;
        }
        let shown = percent(share);
        let what = if share < SLOW_SENSOR {
            format!(
                "{name} repeats the reading before in {shown} of the rows in motion, and catches \
             up after: frames were lost"
            )
        } else {
            format!(
                "{name} repeats the reading before in {shown} of the rows in motion: its sensor is \
             slower than the log"
            )
        };
        let remedy = "leave the field empty, or `nan`, where nothing new was read: a held reading \
                      is wrong by the speed times its age";
        findings.warn("held", file.at(line, field), (what, remedy));
    }
}
