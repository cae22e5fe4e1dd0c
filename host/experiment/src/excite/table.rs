//! The motions of a plan one after the other.

use super::goals::{Excitation, ExcitedMotion};
use super::limits::{JointLimits, no_servo};
use super::multisine::multisine;
use super::path::{PosePath, samples_between};
use super::{ExcitationKind, ExcitePlan};
use crate::error::{Error, Result};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Rest between two kinds, s, at the middle of the ranges.
const REST_S: f64 = 0.5;
/// Share of the speed limit at which a kind is slow.
const SLOW: f64 = 0.15;
/// How long a pose and a level are held, s.
const HOLD_S: f64 = 1.5;
const LEVEL_S: f64 = 0.7;
/// Speed at which a drop is prepared and poses are changed, as a share of the limit.
const GENTLE: f64 = 0.5;
/// Least time to fall, s.
const FALL_S: f64 = 2.0;

/// Goals of the motions that the plan asks for; equal plans give equal goals.
///
/// # Errors
/// Limits that cannot be held, and too little time.
pub fn excite(plan: &ExcitePlan) -> Result<Excitation> {
    check(plan)?;
    let middle: Vec<f64> = plan.joints.iter().map(JointLimits::middle_rad).collect();
    let samples = |seconds: f64| (seconds * plan.hz).round() as usize;
    let mut path = PosePath::default();
    let mut motions = Vec::new();
    let mut falls_at = None;
    path.hold(&middle, samples(REST_S));
    for &kind in &plan.kinds {
        let mut random = ChaCha8Rng::seed_from_u64(plan.seed);
        random.set_stream(kind as u64);
        let begin = path.rows.len();
        let end = begin + samples(plan.each_s);
        match kind {
            ExcitationKind::Multisine => sines(plan, end - begin, &mut random, &mut path),
            ExcitationKind::Steps => steps(plan, end, &mut random, &mut path),
            ExcitationKind::Triangles => triangles(plan, end, &mut path),
            ExcitationKind::Holds => holds(plan, end, &mut random, &mut path),
            ExcitationKind::Drop => falls_at = Some(raised(plan, end, &mut path)),
        }
        motions.push(ExcitedMotion {
            kind,
            begin_s: begin as f64 / plan.hz,
            end_s: path.rows.len() as f64 / plan.hz,
        });
        if kind != ExcitationKind::Drop {
            path.hold(&middle, samples(REST_S));
        }
    }
    let count = path.rows.len();
    Ok(Excitation {
        time_s: (0..count).map(|k| k as f64 / plan.hz).collect(),
        angle_rad: path.rows,
        torque_on: (0..count)
            .map(|k| falls_at.is_none_or(|at| k < at))
            .collect(),
        motions,
        joints: plan.joints.clone(),
    })
}

fn check(plan: &ExcitePlan) -> Result<()> {
    if plan.joints.is_empty() {
        return Err(no_servo());
    }
    plan.joints.iter().try_for_each(JointLimits::check)?;
    let mut seen = Vec::new();
    for &servo in plan.joints.iter().flat_map(|joint| &joint.servos) {
        if seen.contains(&servo) {
            return Err(Error::usage(
                format!("servo {servo} is named twice"),
                "name each servo once",
            ));
        }
        seen.push(servo);
    }
    let sorted = plan.kinds.windows(2).all(|pair| pair[0] < pair[1]);
    if plan.kinds.is_empty() || !sorted {
        return Err(Error::usage(
            "no kind of motion, or one twice",
            "name each once: multisine,steps,triangles,holds,drop",
        ));
    }
    if !(10.0..=1000.0).contains(&plan.hz) {
        return Err(Error::usage(
            format!("{} samples per second", plan.hz),
            "give 10 to 1000 samples per second",
        ));
    }
    let (low_hz, high_hz) = plan.band_hz;
    if !(low_hz > 0.0 && low_hz < high_hz && 10.0 * high_hz <= plan.hz) {
        return Err(Error::usage(
            format!(
                "frequencies {low_hz} to {high_hz} Hz at {} samples per second",
                plan.hz
            ),
            "give a lower and a higher frequency, ten samples to a period at least",
        ));
    }
    for &kind in &plan.kinds {
        let (given_s, needed_s) = (plan.each_s, needed_s(plan, kind));
        if !(given_s >= needed_s && given_s.is_finite()) {
            let needed_s = (10.0 * needed_s).ceil() / 10.0;
            return Err(Error::usage(
                format!("{} within {given_s} s", kind.name()),
                format!("give {needed_s} s at least for each kind, a higher speed or less range"),
            ));
        }
    }
    Ok(())
}

/// Seconds that a kind needs at least to say anything.
fn needed_s(plan: &ExcitePlan, kind: ExcitationKind) -> f64 {
    let joints = plan.joints.iter();
    let across = joints.map(|joint| 2.0 * joint.half_rad() / joint.speed_rad_s);
    let across_s = across.fold(0.0, f64::max);
    match kind {
        ExcitationKind::Multisine => 2.0 / plan.band_hz.0 + 2.0,
        ExcitationKind::Steps => 4.0 * (across_s + LEVEL_S),
        ExcitationKind::Triangles => 4.0 * across_s,
        ExcitationKind::Holds => 2.0 * (across_s / GENTLE + HOLD_S),
        ExcitationKind::Drop => across_s / GENTLE + REST_S + FALL_S,
    }
}

fn sines(plan: &ExcitePlan, samples: usize, random: &mut ChaCha8Rng, path: &mut PosePath) {
    let count = plan.joints.len();
    let joints = plan.joints.iter().enumerate();
    let each: Vec<Vec<f64>> = joints
        .map(|(at, joint)| multisine(joint, (at, count), (samples, plan.hz), plan.band_hz, random))
        .collect();
    let row = |k: usize| each.iter().map(|values| values[k]).collect();
    path.rows.extend((0..samples).map(row));
}

fn middle(plan: &ExcitePlan) -> Vec<f64> {
    plan.joints.iter().map(JointLimits::middle_rad).collect()
}

/// A pose within the ranges.
fn drawn(plan: &ExcitePlan, random: &mut ChaCha8Rng) -> Vec<f64> {
    let joints = plan.joints.iter();
    joints
        .map(|joint| random.random_range(joint.low_rad..=joint.high_rad))
        .collect()
}

/// Poses one after the other, each held, as long as there is time to come back to the middle.
fn visit(
    plan: &ExcitePlan,
    end: usize,
    (share, hold_s): (f64, f64),
    path: &mut PosePath,
    mut next: impl FnMut() -> Vec<f64>,
) {
    let centre = middle(plan);
    let between =
        |from: &[f64], to: &[f64]| samples_between(&plan.joints, (from, to), share, plan.hz);
    let hold = (hold_s * plan.hz).round() as usize;
    loop {
        let (from, to) = (path.last_or(&centre).to_vec(), next());
        let there = between(&from, &to);
        if path.rows.len() + there + hold + between(&to, &centre) > end {
            path.go(&from, &centre, between(&from, &centre));
            let left = end.saturating_sub(path.rows.len());
            path.hold(&centre, left);
            return;
        }
        path.go(&from, &to, there);
        path.hold(&to, hold);
    }
}

fn steps(plan: &ExcitePlan, end: usize, random: &mut ChaCha8Rng, path: &mut PosePath) {
    visit(plan, end, (1.0, LEVEL_S), path, || drawn(plan, random));
}

fn holds(plan: &ExcitePlan, end: usize, random: &mut ChaCha8Rng, path: &mut PosePath) {
    visit(plan, end, (GENTLE, HOLD_S), path, || drawn(plan, random));
}

/// As slow as the time allows up to 15 % of the speed limit; the second joint turns when the first
/// is at its middle, so that not all turn at once.
fn triangles(plan: &ExcitePlan, end: usize, path: &mut PosePath) {
    let samples = end - path.rows.len();
    let duration_s = samples as f64 / plan.hz;
    let joints = plan.joints.iter();
    // Once to and fro is four half ranges.
    let slow = joints.map(|j| 4.0 * j.half_rad() / (SLOW * j.speed_rad_s));
    let period_s = slow.fold(0.0, f64::max).clamp(1.0, duration_s);
    let cycles = (duration_s / period_s).floor().max(1.0);
    let row = |k: usize| {
        let phase = cycles * k as f64 / samples as f64;
        let joints = plan.joints.iter().enumerate();
        joints
            .map(|(at, joint)| {
                let shifted = match at % 2 {
                    0 => triangle(phase),
                    // Begins and ends at its middle too, and turns at other times.
                    _ => triangle(2.0 * phase),
                };
                joint.middle_rad() + joint.half_rad() * shifted
            })
            .collect()
    };
    path.rows.extend((1..=samples).map(row));
}

/// A triangle of period 1 and amplitude 1 that begins at 0.
fn triangle(phase: f64) -> f64 {
    let phase = (phase + 0.25).rem_euclid(1.0);
    if phase < 0.5 {
        4.0 * phase - 1.0
    } else {
        3.0 - 4.0 * phase
    }
}

/// To the highest angles, and from then on let go: the sample at which torque goes off.
fn raised(plan: &ExcitePlan, end: usize, path: &mut PosePath) -> usize {
    let centre = middle(plan);
    let high: Vec<f64> = plan.joints.iter().map(|joint| joint.high_rad).collect();
    let from = path.last_or(&centre).to_vec();
    let samples = samples_between(&plan.joints, (&from, &high), GENTLE, plan.hz);
    path.go(&from, &high, samples);
    path.hold(&high, (REST_S * plan.hz).round() as usize);
    let falls_at = path.rows.len();
    path.hold(&high, end.saturating_sub(falls_at));
    falls_at
}
