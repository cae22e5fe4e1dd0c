//! Sampling times: jitter, gaps, unit.

use super::LoggedFile;
use super::finding::Findings;
use crate::model::{Dimension, Unit};

/// Gaps shown with their place.
const LARGEST: usize = 3;
/// Samples of a joint lie so far apart, s.
const PLAUSIBLE_S: std::ops::RangeInclusive<f64> = 50e-6..=1.0;
/// An interval of more medians than this is a gap.
const GAP: f64 = 5.0;

/// Says what the intervals between a file's samples show; times are declared in `unit`.
pub(super) fn judge(file: &LoggedFile, unit: Unit, findings: &mut Findings) {
    // Each with the line of its end.
    let mut intervals: Vec<(f64, usize)> = Vec::new();
    for cut in &file.cut.motions {
        let lengths = cut.motion.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        intervals.extend(lengths.zip(cut.lines.iter().skip(1).copied()));
    }
    let mut lengths: Vec<f64> = intervals.iter().map(|(length, _)| *length).collect();
    let Some(middle) = lengths.len().checked_sub(1).map(|last| last / 2) else {
        return;
    };
    let median = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
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
        findings.warn("unit", file.place(), (what, remedy));
    }
    let is_gap = |(length, _): &(f64, usize)| length / median > GAP;
    let (gaps, regular): (Vec<_>, Vec<_>) = intervals.into_iter().partition(is_gap);
    let off = regular.iter().map(|(length, _)| length / median - 1.0);
    let jitter = (off.map(|off| off * off).sum::<f64>() / regular.len() as f64).sqrt();
    if jitter > 0.2 {
        let what = format!(
            "sampling jitters by {:.0} % rms of its {shown}",
            100.0 * jitter
        );
        let remedy = "simulation follows the logged times; are they the times of measuring?";
        findings.note("jitter", file.place(), (what, remedy));
    }
    judge_gaps(file, gaps, median, findings);
}

fn judge_gaps(
    file: &LoggedFile,
    mut gaps: Vec<(f64, usize)>,
    median: f64,
    findings: &mut Findings,
) {
    let hidden = gaps.len().saturating_sub(LARGEST);
    gaps.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    gaps.truncate(LARGEST);
    gaps.sort_by_key(|(_, line)| *line);
    for (index, (length, line)) in gaps.into_iter().enumerate() {
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
        findings.warn("gap", file.at(line, file.cut.fields.time), (what, remedy));
    }
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
