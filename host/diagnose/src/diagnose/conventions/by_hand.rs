//! A rig that a hand holds before it lets go, or catches at the end: it stands still where gravity
//! pulls it away and nothing drives it.
//!
//! Most free swings made by hand begin so, for the recorder runs first. No effect of the rig
//! explains such rows, and every fit gives way to them.

use super::correction::LogColumn;
use super::leave_out::{LeaveOut, Unusable};
use crate::fitting::{FitProblem, Horizon, guessed_window_starts, predicted};
use crate::log::LEAST_ROWS;
use crate::model::Model;
use crate::motion::Motion;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// A joint stands still while it stays within so many standard deviations of its reading.
const STILL: f64 = 4.0;
/// A hand trembles and tires: it also holds what stays within so many times that, as long as the
/// model falls as much further.
const TREMBLES: [f64; 3] = [1.0, 4.0, 16.0];
/// A hold that a wider band shows counts where it lasts longer than within a narrower one by a
/// quarter and so many samples: the begin of a fall stays within a wide band.
const LONGER: usize = 4;
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
        let sigma = FitProblem::new(model, vec![motion.clone()], Horizon::Whole).sigma;
        let still = Still {
            motion,
            sigma: &sigma,
            trembles: 1.0,
        };
        let in_bands = TREMBLES.map(|trembles| Still { trembles, ..still });
        let held = in_bands.iter().filter_map(|still| {
            let run = still.at_start()?;
            is_held(model, still, &run).then_some(run)
        });
        let is_longer =
            |run: &Range<usize>, than: &Range<usize>| 4 * run.len() > 5 * than.len() + 4 * LONGER;
        let first = held.reduce(|narrow, wide| {
            if is_longer(&wide, &narrow) {
                wide
            } else {
                narrow
            }
        });
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
#[derive(Clone, Copy)]
struct Still<'a> {
    motion: &'a Motion,
    sigma: &'a [f64],
    /// How many times the noise of a rest a joint moves while it is held.
    trembles: f64,
}

impl Still<'_> {
    /// How far a joint moves that stands still, rad.
    fn band_rad(&self, joint: usize) -> f64 {
        STILL * self.trembles * self.sigma[joint]
    }

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
                count == 0 || (angle - mean).abs() <= self.band_rad(joint)
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
    let data = FitProblem::new(model, vec![part], Horizon::Whole);
    let joints = model.link_count();
    let mut window_starts = guessed_window_starts(&data);
    // At rest: the slope of a few noisy samples is none.
    window_starts[0].unknowns.rows_mut(joints, joints).fill(0.0);
    let paths = predicted(model, &data, &window_starts, 0);
    let (Some(path), Some(window)) = (paths.first(), data.windows.first()) else {
        return false;
    };
    let samples = window.samples.len();
    (0..joints).any(|joint| {
        let signal = &path[joint * samples..(joint + 1) * samples];
        let moved = (signal[samples - 1] - signal[0]).abs();
        moved.is_finite() && moved > FALLS * still.band_rad(joint)
    })
}

/// Whether the rig stands still at first although it falls, and then moves by itself: had friction
/// held it, it would stand there still.
fn is_held(model: &Model, still: &Still, run: &Range<usize>) -> bool {
    let after = (run.end + AFTER).min(still.motion.len());
    is_off(model, still.motion, &(run.start..after)) && falls(model, still, run)
}

/// Whether friction cannot have stopped a rig of one joint where it stands still at last: it turned
/// round nearer to its rest, where less pulls it, and swung on; or it stopped from full motion
/// where more pulls it than friction took from its swings.
fn is_caught(model: &Model, still: &Still, run: &Range<usize>) -> bool {
    let is_arm = model.link_count() == 1 && !model.is_in_space();
    if !is_arm || !is_off(model, still.motion, &(0..still.motion.len())) {
        return false;
    }
    let swing = Swing {
        motion: still.motion,
        pull: Pull::of(model, still.motion),
        sigma_rad: still.sigma[0],
    };
    let turning = swing.turning(run.start);
    let held_rad_s2 = swing.pull.at(swing.angle(run.start));
    let nearer = |k: &usize| swing.pull.at(swing.angle(*k)) < 0.9 * held_rad_s2;
    let was_nearer = turning.iter().any(nearer);
    let is_stopped = swing.stops_at(run.start, held_rad_s2)
        && swing.least_friction_rad_s2(&turning) < RUBS * held_rad_s2;
    (was_nearer || is_stopped) && falls(model, still, run)
}

/// Friction that holds takes at least this share of itself from a swing: once it moves it may be
/// less.
const RUBS: f64 = 0.5;
/// Gravity and such friction stop a joint within steps of so many times what its pull alone gives.
const STEPS: f64 = 2.5;

/// Gravity's pull on a single link, as an acceleration.
struct Pull {
    /// At right angles, rad/s^2.
    most_rad_s2: f64,
    /// Angle that it hangs at, from the log's zero, rad.
    hanging_rad: f64,
}

impl Pull {
    fn of(model: &Model, motion: &Motion) -> Pull {
        let link = &model.links[0];
        let inertia = link.inertia_kg_m2 + link.mass_kg * link.com_m * link.com_m;
        let torque = model.gravity_m_s2 * link.mass_kg * link.com_m;
        let turned = if motion.turned { PI } else { 0.0 };
        Pull {
            most_rad_s2: (torque / inertia.max(1e-12)).abs(),
            hanging_rad: turned - model.angle_zero.from_hanging_rad(),
        }
    }

    /// Angle from hanging, -pi to pi.
    fn off_hanging(&self, angle_rad: f64) -> f64 {
        let angle = angle_rad - self.hanging_rad;
        angle - TAU * (angle / TAU).round()
    }

    /// Its size, rad/s^2.
    fn at(&self, angle_rad: f64) -> f64 {
        (self.most_rad_s2 * self.off_hanging(angle_rad).sin()).abs()
    }

    /// What it has given at rest, from hanging up to an angle, rad^2/s^2.
    fn energy(&self, angle_rad: f64) -> f64 {
        self.most_rad_s2 * (1.0 - self.off_hanging(angle_rad).cos())
    }
}

/// A free swing of one joint.
struct Swing<'a> {
    motion: &'a Motion,
    pull: Pull,
    sigma_rad: f64,
}

impl Swing<'_> {
    fn angle(&self, sample: usize) -> f64 {
        self.motion.position_rad[0][sample]
    }

    /// Samples before this one at which it turns round and moves on.
    fn turning(&self, end: usize) -> Vec<usize> {
        let turns = |k: &usize| {
            let before = self.angle(k - 1) - self.angle(*k);
            let after = self.angle(k + 1) - self.angle(*k);
            before * after > 0.0 && before.abs().max(after.abs()) > self.sigma_rad
        };
        let moves_on = |k: &usize| k + 2 * LEAST_HOLD < end;
        let all = 1..end.saturating_sub(1);
        all.filter(turns).filter(moves_on).collect()
    }

    /// Whether it comes to rest at a sample in a step that nothing but a hand or a stop ends.
    fn stops_at(&self, sample: usize, held_rad_s2: f64) -> bool {
        let Some(before) = sample.checked_sub(1) else {
            return false;
        };
        let step_rad = (self.angle(sample) - self.angle(before)).abs();
        let step_s = self.motion.time_s[sample] - self.motion.time_s[before];
        step_rad > STEPS * held_rad_s2 * step_s * step_s + STILL * self.sigma_rad
    }

    /// The least friction, rad/s^2, that any swing from one side to the other shows; infinite of
    /// none.
    fn least_friction_rad_s2(&self, turning: &[usize]) -> f64 {
        let swings = turning.windows(2).filter_map(|pair| {
            let [from, to] = [pair[0], pair[1]].map(|k| self.angle(k));
            let [begin, end] = [from, to].map(|angle| self.pull.off_hanging(angle));
            let lost = self.pull.energy(from) - self.pull.energy(to);
            (begin * end < 0.0).then(|| lost.max(0.0) / (begin.abs() + end.abs()))
        });
        swings.fold(f64::INFINITY, f64::min)
    }
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
    use crate::model::Drive;
    use handstand_model::fixture;

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
        let omega = (9.81 * 0.3 * 0.1 / (1e-4 + 0.3 * 0.01_f64)).sqrt();
        let period = TAU / omega / PERIOD_S;
        for eighth in 0..8_u8 {
            let swings = 8.0 + f64::from(eighth) / 8.0;
            let free = (swings * period).round() as usize;
            let found = runs(swing(0, free, 50));
            // At the top friction may hold it, at the bottom nothing pulls.
            if eighth % 2 == 0 {
                assert_eq!(found, [], "{eighth}");
                continue;
            }
            let [(0, run)] = &found[..] else {
                panic!("{eighth}: {found:?}");
            };
            assert!(
                run.end == free + 50 && run.start.abs_diff(free) <= 2,
                "{eighth}: {run:?}"
            );
        }
    }

    #[test]
    fn a_hand_that_trembles_and_sinks_holds_all_the_same() {
        for held in [40, 100] {
            let mut motion = swing(held, 500, 0);
            for k in 0..held {
                let t = PERIOD_S * k as f64;
                motion.position_rad[0][k] += 0.004 * (9.0 * t).sin() - 0.004 * (1.0 - t);
            }
            let found = runs(motion);
            let [(0, run)] = &found[..] else {
                panic!("{held}: {found:?}");
            };
            assert!((held..=held + 8).contains(&run.end), "{held}: {run:?}");
        }
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
