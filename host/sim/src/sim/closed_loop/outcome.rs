//! A run in figures, and what counts as stabilised.

use super::PosedPlant;
use serde::Serialize;

/// What counts as fallen, as stabilised and as settled: one definition for every study. Of joints
/// that slide, 1 mm counts as 1 mrad, and none falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StabilityCriteria {
    /// A link that leans further off its pose than this has fallen, rad; of a robot in space a
    /// joint that is so far off.
    pub fall_rad: f64,
    /// Stabilised is a robot that does not fall and keeps every joint this near to its pose at the
    /// end, rad, ..
    pub stable_rad: f64,
    /// .. for this long, s; in a shorter run for its second half.
    pub stable_s: f64,
    /// Settled while every joint stays this near to its pose, rad.
    pub settle_rad: f64,
}

impl Default for StabilityCriteria {
    fn default() -> Self {
        StabilityCriteria {
            fall_rad: 45f64.to_radians(),
            stable_rad: 10f64.to_radians(),
            stable_s: 2.0,
            settle_rad: 0.5f64.to_radians(),
        }
    }
}

impl StabilityCriteria {
    /// Whether a link of `plant` leans too far, or the numbers have run away.
    #[inline]
    pub fn has_fallen(&self, plant: &PosedPlant, angle_rad: &[f64], speed_rad_s: &[f64]) -> bool {
        let mut lean = 0.0;
        let mut upright = true;
        for (joint, angle) in angle_rad.iter().enumerate() {
            // Links that slide lean as those before them; in space angles about different axes
            // make no sum.
            lean = match (plant.slides(joint), plant.is_in_space()) {
                (true, true) => 0.0,
                (true, false) => lean,
                (false, true) => *angle,
                (false, false) => lean + angle,
            };
            upright &= f64::abs(lean) <= self.fall_rad && angle.is_finite();
        }
        !upright || !speed_rad_s.iter().all(|speed| speed.is_finite())
    }
}

/// A run in figures, taken at the samples. Angles are deviations from the pose, joint by joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Outcome {
    /// When it fell, s; none if it never did.
    pub fell_s: Option<f64>,
    /// Whether it was stabilised, as [`StabilityCriteria`] define it.
    pub stabilised: bool,
    /// Whether friction held it: from the same start it stays without any command. Studies find
    /// that out; such a robot does not count as stabilised.
    pub held: bool,
    /// Root mean square angle over all joints and samples, rad.
    pub rms_angle_rad: f64,
    /// Root mean square torque over all drives and time, N m: the control effort.
    pub rms_torque_nm: f64,
    /// Largest angle of any joint, rad.
    pub largest_rad: f64,
    /// Peak to peak of the joint that swings most over the last second (or, of a shorter run, the
    /// last half), rad: the limit cycle. None if it fell.
    pub limit_cycle_rad: Option<f64>,
    /// When the last joint came within the settling band to stay, s; none if it never did.
    pub settle_s: Option<f64>,
}

/// Gathers a run's figures.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    samples: usize,
    squares: f64,
    torque_squares_s: f64,
    largest: f64,
    /// Time of the last sample beyond the settling band, and beyond the stable one, s; below 0 if
    /// there was none.
    unsettled_s: f64,
    unstable_s: f64,
}

impl Tally {
    pub(super) fn new() -> Self {
        Tally {
            samples: 0,
            squares: 0.0,
            torque_squares_s: 0.0,
            largest: 0.0,
            unsettled_s: -1.0,
            unstable_s: -1.0,
        }
    }

    /// Notes a sample; `ends` keeps the lowest and highest angles from `late` on.
    #[inline]
    pub(super) fn sample(
        &mut self,
        time_s: f64,
        angle_rad: &[f64],
        limits: &StabilityCriteria,
        late: bool,
        ends: &mut [[f64; 2]],
    ) {
        let mut largest = 0.0_f64;
        for angle in angle_rad {
            self.squares += angle * angle;
            largest = largest.max(angle.abs());
        }
        self.samples += angle_rad.len();
        self.largest = self.largest.max(largest);
        if largest > limits.settle_rad {
            self.unsettled_s = time_s;
        }
        if largest > limits.stable_rad {
            self.unstable_s = time_s;
        }
        if late {
            for (ends, &angle) in ends.iter_mut().zip(angle_rad) {
                *ends = [ends[0].min(angle), ends[1].max(angle)];
            }
        }
    }

    /// Notes torques that acted for `span_s`.
    #[inline]
    pub(super) fn torque(&mut self, torque_nm: &[f64], span_s: f64) {
        let squares: f64 = torque_nm.iter().map(|t| t * t).sum();
        self.torque_squares_s += squares * span_s;
    }

    /// The run's figures when it ends at `end_s`.
    pub(super) fn outcome(
        &self,
        end_s: f64,
        fell: bool,
        drives: usize,
        limits: &StabilityCriteria,
        ends: &[[f64; 2]],
    ) -> Outcome {
        let swing = ends.iter().map(|[low, high]| high - low);
        let time_s = drives as f64 * end_s;
        let stable_from_s = (end_s - limits.stable_s).max(end_s / 2.0);
        Outcome {
            stabilised: !fell && self.unstable_s < stable_from_s,
            held: false,
            fell_s: fell.then_some(end_s),
            rms_angle_rad: (self.squares / self.samples.max(1) as f64).sqrt(),
            rms_torque_nm: if time_s > 0.0 {
                (self.torque_squares_s / time_s).sqrt()
            } else {
                0.0
            },
            largest_rad: self.largest,
            limit_cycle_rad: (!fell).then(|| swing.fold(0.0, f64::max)),
            settle_s: match self.unsettled_s {
                _ if fell => None,
                none if none < 0.0 => Some(0.0),
                last if last < end_s - 1e-9 => Some(last),
                _ => None,
            },
        }
    }
}
