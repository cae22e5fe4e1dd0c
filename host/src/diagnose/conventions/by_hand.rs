//! A rig that a hand holds before it lets go, or catches at the end: it stands still where gravity
//! pulls it away and nothing drives it.
//!
//! Most free swings made by hand begin so, for the recorder runs first. No effect of the rig
//! explains such rows, and every fit gives way to them.

use super::leave_out::{LeaveOut, Unusable};
use super::remedy::LogColumn;
use crate::fitting::{FitData, Horizon, guessed_nodes, predicted};
use crate::log::{LEAST_ROWS, Motion};
use crate::model::Model;
use std::ops::Range;

/// A joint stands still while it stays within so many standard deviations of its reading.
const STILL: f64 = 4.0;
/// Least samples of a hold. Fewer say nothing of noise.
const LEAST_HOLD: usize = 3;
/// The model must move so many times further than that while it is held.
const FALLS: f64 = 3.0;
/// Samples after a release in which no drive may push: what moves then was held before.
const AFTER: usize = 3;

/// Runs of samples at the beginning or end of a motion in which a hand holds the rig.
pub(super) fn held_by_hand(model: &Model, motions: &[Motion]) -> Option<LeaveOut> {
    let mut runs = Vec::new();
    for (index, motion) in motions.iter().enumerate() {
        let sigma = FitData::new(model, vec![motion.clone()], Horizon::Whole).sigma;
        let still = Still {
            motion,
            sigma: &sigma,
        };
        let first = still.at_start().filter(|run| is_held(model, &still, run));
        let last = still.at_end().filter(|run| is_caught(model, &still, run));
        runs.extend([first, last].into_iter().flatten().map(|run| (index, run)));
    }
    let lasts_s = |(index, run): &(usize, Range<usize>)| {
        let time_s = &motions[*index].time_s;
        time_s[run.end - 1] - time_s[run.start]
    };
    let longest_s = runs.iter().map(lasts_s).reduce(f64::max)?;
    Some(LeaveOut {
        why: Unusable::HeldByHand,
        column: LogColumn::Position(0),
        runs,
        longest_s,
        before: f64::NAN,
        after: f64::NAN,
        before_rad: f64::NAN,
        after_rad: f64::NAN,
    })
}

/// A motion and the noise of its angles, rad.
struct Still<'a> {
    motion: &'a Motion,
    sigma: &'a [f64],
}

impl Still<'_> {
    fn at_start(&self) -> Option<Range<usize>> {
        let run = 0..self.still(0..self.motion.len());
        self.is_part(&run).then_some(run)
    }

    fn at_end(&self) -> Option<Range<usize>> {
        let count = self.motion.len();
        let run = count - self.still((0..count).rev())..count;
        self.is_part(&run).then_some(run)
    }

    /// Long enough to be seen, and something else is left.
    fn is_part(&self, run: &Range<usize>) -> bool {
        run.len() >= LEAST_HOLD && run.len() + LEAST_ROWS <= self.motion.len()
    }

    /// How many of the samples, in this order, every joint stays where it is.
    fn still(&self, samples: impl Iterator<Item = usize>) -> usize {
        let joints = self.motion.position_rad.len();
        let (mut sums, mut count) = (vec![0.0; joints], 0);
        for sample in samples {
            let stays = |joint: usize| {
                let angle = self.motion.position_rad[joint][sample];
                let mean = sums[joint] / f64::from(count.max(1));
                count == 0 || (angle - mean).abs() <= STILL * self.sigma[joint]
            };
            if !(0..joints).all(stays) {
                break;
            }
            for (sum, angle) in sums.iter_mut().zip(&self.motion.position_rad) {
                *sum += angle[sample];
            }
            count += 1;
        }
        count as usize
    }
}

/// Whether the model, let go where the rig stands, would be seen to move.
fn falls(model: &Model, still: &Still, run: &Range<usize>) -> bool {
    let part = still.motion.part(run.clone());
    let data = FitData::new(model, vec![part], Horizon::Whole);
    let joints = model.link_count();
    let mut nodes = guessed_nodes(&data);
    // At rest: the slope of a few noisy samples is none.
    nodes[0].unknowns.rows_mut(joints, joints).fill(0.0);
    let paths = predicted(model, &data, &nodes, 0);
    let (Some(path), Some(window)) = (paths.first(), data.windows.first()) else {
        return false;
    };
    let samples = window.samples.len();
    (0..joints).any(|joint| {
        let signal = &path[joint * samples..(joint + 1) * samples];
        let moved = (signal[samples - 1] - signal[0]).abs();
        moved.is_finite() && moved > FALLS * STILL * still.sigma[joint]
    })
}

/// Whether the rig stands still at first although it falls, and then moves by itself: had friction
/// held it, it would stand there still.
fn is_held(model: &Model, still: &Still, run: &Range<usize>) -> bool {
    let after = (run.end + AFTER).min(still.motion.len());
    is_off(model, still.motion, &(run.start..after)) && falls(model, still, run)
}

/// Whether a rig of one joint stands still at last although it turned round nearer to its rest,
/// where less pulls it, and swung on: friction cannot have stopped it.
fn is_caught(model: &Model, still: &Still, run: &Range<usize>) -> bool {
    if model.link_count() != 1 || !is_off(model, still.motion, &(0..still.motion.len())) {
        return false;
    }
    let angle = &still.motion.position_rad[0][..run.start];
    let turns = |k: &usize| {
        let (before, after) = (angle[k - 1] - angle[*k], angle[k + 1] - angle[*k]);
        before * after > 0.0 && before.abs().max(after.abs()) > still.sigma[0]
    };
    let moves_on = |k: &usize| k + 2 * LEAST_HOLD < run.start;
    let pull = |angle: f64| pull_rad_s2(model, still.motion, angle);
    let held = pull(still.motion.position_rad[0][run.start]);
    let count = angle.len().saturating_sub(1);
    let mut turning = (1..count).filter(turns).filter(moves_on);
    turning.any(|k| pull(angle[k]) < 0.9 * held) && falls(model, still, run)
}

/// Size of gravity's pull on a single link, as an acceleration, rad/s^2.
fn pull_rad_s2(model: &Model, motion: &Motion, angle_rad: f64) -> f64 {
    let from_hanging = angle_rad + model.angle_zero.from_hanging_rad();
    let side = if motion.turned { -1.0 } else { 1.0 };
    let link = &model.links[0];
    let inertia = link.inertia_kg_m2 + link.mass_kg * link.com_m * link.com_m;
    let torque = model.gravity_m_s2 * link.mass_kg * link.com_m * (side * from_hanging).sin();
    (torque / inertia.max(1e-12)).abs()
}

/// Whether nothing drives the rig in these samples: joints are passive, switched off, or their
/// input is zero, which for a goal it never is.
fn is_off(model: &Model, motion: &Motion, samples: &Range<usize>) -> bool {
    if let Some(on) = &motion.torque_on
        && on[samples.clone()].iter().all(|on| !on)
    {
        return true;
    }
    let joints = model.joints.iter().zip(&motion.input);
    joints.into_iter().all(|(joint, input)| {
        let follows = ["position", "speed"].contains(&joint.drive.name());
        let zero = || {
            let input = input.as_ref().map(|input| &input[samples.clone()]);
            input.is_some_and(|input| input.iter().all(|u| *u == 0.0))
        };
        !joint.drive.is_driven() || !follows && zero()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::tests::fixture;
    use crate::model::Drive;

    const PERIOD_S: f64 = 0.02;
    const NOISE_RAD: f64 = 1e-3;

    /// A free pendulum of the fixture's link.
    fn pendulum() -> Model {
        let mut columns = fixture::columns();
        columns.joints[0].input = None;
        fixture::model(Drive::Passive, columns)
    }

    /// A swing that decays: held for some samples, free, and still again at the end where the
    /// `caught` phase of its last period is.
    fn swing(held: usize, free: usize, caught: usize) -> Motion {
        let omega = (9.81 * 0.3 * 0.1 / (1e-4 + 0.3 * 0.01_f64)).sqrt();
        let place = |k: usize| {
            let into_s = k.clamp(held, held + free) as f64 - held as f64;
            let t = PERIOD_S * into_s;
            0.4 * (-0.2 * t).exp() * (omega * t).cos()
        };
        let noise = |k: usize| NOISE_RAD * ((k * 7919 % 101) as f64 / 50.0 - 1.0);
        let count = held + free + caught;
        let mut motion = fixture::motion("swing", count);
        motion.time_s = (0..count).map(|k| PERIOD_S * k as f64).collect();
        motion.position_rad = vec![(0..count).map(|k| place(k) + noise(k)).collect()];
        motion.input = vec![None];
        motion
    }

    fn runs(motion: Motion) -> Vec<(usize, Range<usize>)> {
        held_by_hand(&pendulum(), &[motion]).map_or(Vec::new(), |found| found.runs)
    }

    #[test]
    fn a_swing_that_is_held_before_its_release_is_told_from_one_that_begins_with_it() {
        for held in [8, 40, 100] {
            let found = runs(swing(held, 500, 0));
            let [(0, run)] = &found[..] else {
                panic!("{held}: {found:?}");
            };
            assert_eq!(run.start, 0);
            assert!((held..=held + 4).contains(&run.end), "{held}: {run:?}");
        }
        assert_eq!(runs(swing(0, 500, 0)), []);
    }

    #[test]
    fn a_catch_beyond_where_it_turned_round_is_a_hand_and_a_stop_at_the_bottom_is_none() {
        // The last turning point is nearer to the rest than where it is caught: at the top.
        let omega = (9.81 * 0.3 * 0.1 / (1e-4 + 0.3 * 0.01_f64)).sqrt();
        let period = std::f64::consts::TAU / omega / PERIOD_S;
        let whole = (4.0 * period).round() as usize;
        let caught = runs(swing(0, 500, 50));
        let slow = runs(swing(0, whole, 50));
        assert!(caught.len() <= 1);
        assert_eq!(slow, [], "it stopped where it turned round least far");
    }

    #[test]
    fn a_driven_joint_is_held_by_its_drive() {
        let mut motion = swing(40, 500, 0);
        motion.input = vec![Some(vec![0.1; motion.len()])];
        let model = fixture::model(Drive::Torque, fixture::columns());
        assert!(held_by_hand(&model, &[motion.clone()]).is_none());
        motion.torque_on = Some(vec![false; motion.len()]);
        assert!(held_by_hand(&model, &[motion]).is_some());
    }
}
