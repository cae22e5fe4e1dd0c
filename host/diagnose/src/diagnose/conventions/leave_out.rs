//! Samples that no change of the model file mends: a joint that stands still, an input cut off at
//! a limit.

use super::by_hand::held_by_hand;
use super::correction::LogColumn;
use super::rating::{ModelReading, Rating};
use super::search::is_doubtful_time;
use super::trial::Effort;
use crate::model::Model;
use crate::motion::{Motion, excerpts};
use std::ops::Range;

/// A position that does not change for so long is no measurement of a motion, s.
const STALLED_S: f64 = 20.0;
/// Share of its samples from which an input sits at a limit, and least run of such samples.
const CLIPPED_SHARE: f64 = 0.04;
const CLIPPED_RUN: usize = 3;
/// Windows in which clipped samples are told from others, s.
const CLIPPED_WINDOW_S: f64 = 0.25;
/// The error without the samples over the error with them, to be believed.
const CLEARLY_LOWER: f64 = 0.8;
/// Windows that must be on either side for that.
const LEAST_WINDOWS: usize = 3;
/// Samples looked at.
const SAMPLES: usize = 6000;

/// Why samples are to be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unusable {
    /// The position does not change for 20 s or more.
    Stalled,
    /// The input sits at a limit, and the rig did something else.
    Clipped,
    /// A hand holds the rig: it stands still where it would fall.
    HeldByHand,
}

/// Samples to leave out, with the proof.
#[derive(Debug, Clone, PartialEq)]
pub struct LeaveOut {
    /// Why.
    pub why: Unusable,
    /// The column that shows it.
    pub column: LogColumn,
    /// Motion, and its samples.
    pub runs: Vec<(usize, Range<usize>)>,
    /// Duration of the longest run, s.
    pub longest_s: f64,
    /// Share of the motion unexplained with the samples and without, as in [`super::Trial`]; not a
    /// number where no fit is the proof.
    pub before: f64,
    /// See `before`.
    pub after: f64,
    /// Root-mean-square error with them, rad.
    pub before_rad: f64,
    /// Root-mean-square error without them, rad.
    pub after_rad: f64,
}

/// Everything that should be left out of the motions.
pub fn leave_out(model: &Model, motions: &[Motion]) -> Vec<LeaveOut> {
    if is_doubtful_time(model, motions) {
        return Vec::new();
    }
    let joints = 0..model.link_count();
    let stalled = joints
        .clone()
        .filter_map(|joint| stalled(model, motions, joint));
    let mut found: Vec<LeaveOut> = stalled.collect();
    found.extend(joints.filter_map(|joint| clipped(model, motions, joint)));
    found.extend(held_by_hand(model, motions));
    found
}

fn stalled(model: &Model, motions: &[Motion], joint: usize) -> Option<LeaveOut> {
    let runs = stalled_runs(motions, joint);
    if runs.is_empty() {
        return None;
    }
    let reading = ModelReading::new(model.clone(), motions.to_vec());
    proven(
        &reading,
        motions,
        runs,
        Unusable::Stalled,
        LogColumn::Position(joint),
    )
}

/// The runs of samples in which a joint stands still for too long.
fn stalled_runs(motions: &[Motion], joint: usize) -> Vec<(usize, Range<usize>)> {
    let mut runs = Vec::new();
    for (index, motion) in motions.iter().enumerate() {
        let still = equal_runs(&motion.position_rad[joint], |a, b| a == b);
        let lasts_s = |run: &Range<usize>| motion.time_s[run.end - 1] - motion.time_s[run.start];
        let long = still.into_iter().filter(|run| lasts_s(run) >= STALLED_S);
        runs.extend(long.map(|run| (index, run)));
    }
    runs
}

/// The motions without the samples in which a joint stalls; as they are where nothing else is left.
pub(super) fn without_stalled(model: &Model, motions: &[Motion]) -> Vec<Motion> {
    let joints = 0..model.link_count();
    let mut runs: Vec<_> = joints.flat_map(|j| stalled_runs(motions, j)).collect();
    runs.sort_by_key(|(motion, run)| (*motion, run.start));
    let mut rest = Vec::new();
    for (index, motion) in motions.iter().enumerate() {
        let own = runs.iter().filter(|(of, _)| *of == index);
        let end = motion.len()..motion.len();
        let mut from = 0;
        for run in own.map(|(_, run)| run).chain([&end]) {
            if run.start > from + 1 {
                rest.push(motion.part(from..run.start));
            }
            from = from.max(run.end);
        }
    }
    if rest.is_empty() {
        motions.to_vec()
    } else {
        rest
    }
}

fn clipped(model: &Model, motions: &[Motion], joint: usize) -> Option<LeaveOut> {
    let column = LogColumn::Input(joint);
    column.column(model)?;
    let limits = limits(motions, joint);
    let few = excerpts(motions, SAMPLES);
    let runs = runs_at(&few, joint, &limits);
    if runs.is_empty() {
        return None;
    }
    let reading = ModelReading::cut(model.clone(), few.clone(), CLIPPED_WINDOW_S);
    let found = proven(&reading, &few, runs, Unusable::Clipped, column)?;
    Some(LeaveOut {
        runs: runs_at(motions, joint, &limits),
        ..found
    })
}

/// The input's extremes at which many of its samples lie, and how near to one counts as at it.
fn limits(motions: &[Motion], joint: usize) -> Vec<(f64, f64)> {
    let inputs = motions
        .iter()
        .filter_map(|motion| motion.input[joint].as_ref());
    let all: Vec<f64> = inputs.flatten().copied().collect();
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let near = 1e-9 * (high - low);
    let crowded = |limit: &f64| {
        let at = all
            .iter()
            .filter(|value| (**value - limit).abs() <= near)
            .count();
        at as f64 >= CLIPPED_SHARE * all.len() as f64
    };
    let extremes = [low, high].into_iter();
    let limits = extremes.filter(|limit| *limit != 0.0 && low < high && crowded(limit));
    limits.map(|limit| (limit, near)).collect()
}

/// The runs of samples at the limits.
fn runs_at(motions: &[Motion], joint: usize, limits: &[(f64, f64)]) -> Vec<(usize, Range<usize>)> {
    let mut runs = Vec::new();
    for (limit, near) in limits {
        let at = |value: f64| (value - limit).abs() <= *near;
        for (index, motion) in motions.iter().enumerate() {
            let Some(input) = &motion.input[joint] else {
                continue;
            };
            let equal = equal_runs(input, |a, b| at(a) && at(b));
            let long = equal.into_iter().filter(|run| run.len() >= CLIPPED_RUN);
            runs.extend(long.map(|run| (index, run)));
        }
    }
    runs.sort_by_key(|(motion, run)| (*motion, run.start));
    runs
}

/// The samples with their proof, where the error without them is clearly lower.
fn proven(
    reading: &ModelReading,
    motions: &[Motion],
    runs: Vec<(usize, Range<usize>)>,
    why: Unusable,
    column: LogColumn,
) -> Option<LeaveOut> {
    let lasts_s = |(motion, run): &(usize, Range<usize>)| {
        motions[*motion].time_s[run.end - 1] - motions[*motion].time_s[run.start]
    };
    let longest_s = runs.iter().map(lasts_s).fold(0.0, f64::max);
    let inside = |window: &crate::fitting::Window| {
        runs.iter().any(|(motion, run)| {
            let (from, to) = (
                run.start.max(window.samples.start),
                run.end.min(window.samples.end),
            );
            *motion == window.motion && from < to
        })
    };
    let windows = &reading.data.windows;
    let free: Vec<_> = windows
        .iter()
        .filter(|window| !inside(window))
        .cloned()
        .collect();
    let touched = windows.len() - free.len();
    let rated = |reading: &ModelReading| reading.rated(Effort::Starts);
    let all: Rating = rated(reading);
    let rest = rated(&reading.cut_as(&free));
    // The yardstick is that of all samples: a rest is no motion to measure by.
    let share = all.share()?;
    let kept = windows
        .iter()
        .zip(&all.shares)
        .filter(|(window, _)| !inside(window));
    let kept: Vec<f64> = kept
        .flat_map(|(_, shares)| shares.iter().flatten().map(|s| s * s))
        .collect();
    let after = (kept.iter().sum::<f64>() / kept.len().max(1) as f64).sqrt();
    let proven =
        after < CLEARLY_LOWER * share && touched >= LEAST_WINDOWS && free.len() >= LEAST_WINDOWS;
    (proven || why == Unusable::Stalled).then_some(LeaveOut {
        why,
        column,
        runs,
        longest_s,
        before: share,
        after,
        before_rad: all.rms_rad,
        after_rad: rest.rms_rad,
    })
}

/// Maximal runs of neighbours that are alike.
fn equal_runs(values: &[f64], alike: impl Fn(f64, f64) -> bool) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for k in 1..=values.len() {
        if k == values.len() || !alike(values[k - 1], values[k]) {
            if k > start {
                runs.push(start..k);
            }
            start = k;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Motions, bench};
    use crate::log::{LogRequest, read};

    /// The motions of a bench arm's first log.
    fn arm() -> (Model, Vec<Motion>) {
        let bench = bench(Motions::Arm, 1, &[]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, &bench.logs[0].csv).unwrap();
        let model = Model::parse(&bench.model_toml, std::path::Path::new("arm.toml")).unwrap();
        let motions = read(&[LogRequest::whole(&path)], &model.log).unwrap();
        (model, motions)
    }

    #[test]
    fn what_lies_beside_a_stall_is_kept() {
        let (model, mut motions) = arm();
        assert_eq!(without_stalled(&model, &motions).len(), motions.len());
        let motion = &mut motions[0];
        let count = motion.len();
        // The middle third takes 25 s, at one place.
        let stall = count / 3..2 * count / 3;
        let time_s = motion.time_s.clone();
        let lasts_s = time_s[stall.end] - time_s[stall.start];
        for k in stall.start..count {
            let into_s = time_s[k.min(stall.end)] - time_s[stall.start];
            motion.time_s[k] += into_s * (25.0 / lasts_s - 1.0);
        }
        motion.position_rad[0][stall.clone()].fill(0.25);
        let rest = without_stalled(&model, &motions[..1]);
        let lengths: Vec<usize> = rest.iter().map(Motion::len).collect();
        assert_eq!(lengths, [stall.start, count - stall.end]);
    }
}
