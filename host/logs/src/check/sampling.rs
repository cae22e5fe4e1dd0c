//! Sampling times: order, jitter, gaps, unit.

use super::finding::Findings;
use crate::LogReason;
use crate::error::Place;
use crate::model::{Dimension, Unit};
use crate::row::LogRow;

/// Bins per e-fold of the interval: 2 % each.
const BINS_PER_E: f64 = 50.0;
/// The shortest interval told from shorter ones, s.
const SHORTEST_S: f64 = 1e-15;
/// Bins from there to some 10^9 s.
const BINS: usize = 2800;
/// Gaps remembered with their place.
const LARGEST: usize = 3;
/// Samples of a joint lie so far apart, s.
const PLAUSIBLE_S: std::ops::RangeInclusive<f64> = 50e-6..=1.0;
/// An interval of more medians than this is a gap.
const GAP: f64 = 5.0;

/// Intervals between samples of one file, in a histogram.
pub(super) struct Sampling {
    bins: Vec<u64>,
    previous_s: Option<f64>,
    /// Longest first.
    largest: Vec<(f64, Place)>,
}

impl Default for Sampling {
    fn default() -> Self {
        Sampling {
            bins: vec![0; BINS],
            previous_s: None,
            largest: Vec::new(),
        }
    }
}

impl Sampling {
    /// Takes a sample; false if its time does not lie after the previous one's.
    pub fn take(&mut self, row: &LogRow, fresh: bool, findings: &mut Findings) -> bool {
        let previous = self.previous_s.filter(|_| !fresh);
        let Some(previous) = previous else {
            self.previous_s = Some(row.time_s);
            return true;
        };
        let interval = row.time_s - previous;
        let place = || row.place(row.fields.time);
        if interval <= 0.0 {
            let reason = LogReason::TimeNotIncreasing {
                time_s: row.time_s,
                previous_s: previous,
            };
            findings.refuse("time", place(), &reason);
            // After a restart the new time counts, so that one restart is one finding.
            self.previous_s = Some(row.time_s);
            return false;
        }
        self.previous_s = Some(row.time_s);
        let bin = ((interval / SHORTEST_S).ln() * BINS_PER_E).max(0.0);
        self.bins[(bin as usize).min(BINS - 1)] += 1;
        let shortest = self.largest.last().map_or(0.0, |(length, _)| *length);
        if self.largest.len() < LARGEST || interval > shortest {
            let at = self
                .largest
                .partition_point(|(length, _)| *length >= interval);
            self.largest.insert(at, (interval, place()));
            self.largest.truncate(LARGEST);
        }
        true
    }

    /// Median interval, s, to 1 %.
    fn median_s(&self) -> Option<f64> {
        let total: u64 = self.bins.iter().sum();
        let mut below = 0;
        let bin = self.bins.iter().position(|count| {
            below += count;
            2 * below >= total.max(1)
        })?;
        Some(centre_s(bin))
    }

    /// Says what the intervals show; times are declared in `unit`.
    pub fn judge(&mut self, place: &Place, unit: Unit, findings: &mut Findings) {
        let Some(median) = self.median_s() else {
            return;
        };
        let shown = duration(median);
        if !PLAUSIBLE_S.contains(&median) {
            let question = match likelier(median, unit) {
                Some(other) => format!("{} declared as {}?", spelt(other), spelt(unit)),
                None => format!(
                    "no unit of time explains that; declared are {}",
                    spelt(unit)
                ),
            };
            let what = format!("samples {shown} apart: {question}");
            let remedy = "check the time column's unit in the model's [log]";
            findings.warn("unit", place.clone(), (what, remedy));
        }
        let (mut regular, mut squares, mut gaps) = (0.0, 0.0, 0);
        for (bin, count) in self
            .bins
            .iter()
            .enumerate()
            .filter(|(_, count)| **count > 0)
        {
            let medians = centre_s(bin) / median;
            if medians > GAP {
                gaps += *count as usize;
            } else {
                regular += *count as f64;
                squares += *count as f64 * (medians - 1.0).powi(2);
            }
        }
        let jitter = (squares / regular.max(1.0)).sqrt();
        if jitter > 0.2 {
            let what = format!(
                "sampling jitters by {:.0} % rms of its {shown}",
                100.0 * jitter
            );
            let remedy = "simulation follows the logged times; are they the times of measuring?";
            findings.note("jitter", place.clone(), (what, remedy));
        }
        self.gaps(median, gaps, findings);
    }

    fn gaps(&mut self, median: f64, total: usize, findings: &mut Findings) {
        self.largest.retain(|(length, _)| length / median > GAP);
        let hidden = total.saturating_sub(self.largest.len());
        self.largest.sort_by_key(|(_, place)| place.line);
        for (index, (length, place)) in self.largest.drain(..).enumerate() {
            let more = match (index, hidden) {
                (0, 1..) => format!(", and {hidden} shorter ones elsewhere"),
                _ => String::new(),
            };
            let what = format!(
                "a gap of {} before this sample, {:.0} times the usual {}{more}",
                duration(length),
                length / median,
                duration(median)
            );
            let remedy = "set split_at_gap_s in the model's [log] to begin a new motion there";
            findings.warn("gap", place, (what, remedy));
        }
    }
}

fn centre_s(bin: usize) -> f64 {
    SHORTEST_S * ((bin as f64 + 0.5) / BINS_PER_E).exp()
}

/// The unit of numbers in which samples that lie `median` seconds apart, read in `declared`, would
/// lie as far apart as a joint's do.
fn likelier(median: f64, declared: Unit) -> Option<Unit> {
    let numbers = |unit: &Unit| unit.name != "iso8601";
    if !numbers(&declared) {
        return None;
    }
    let likely = |unit: &Unit| PLAUSIBLE_S.contains(&(median / declared.si * unit.si));
    let distance = |unit: &Unit| (median / declared.si * unit.si / 0.01).ln().abs();
    let units = Dimension::Time.plain_units().filter(numbers).filter(likely);
    units.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn spelt(unit: Unit) -> &'static str {
    match unit.name {
        "s" => "seconds",
        "ms" => "milliseconds",
        "us" => "microseconds",
        "ns" => "nanoseconds",
        _ => "time stamps",
    }
}

/// In the unit of time that shows it.
fn duration(seconds: f64) -> String {
    match seconds {
        ..1e-9 => format!("{seconds:.1e} s"),
        ..1e-6 => format!("{:.3} ns", 1e9 * seconds),
        ..50e-6 => format!("{:.3} us", 1e6 * seconds),
        _ => format!("{:.3} ms", 1e3 * seconds),
    }
}
