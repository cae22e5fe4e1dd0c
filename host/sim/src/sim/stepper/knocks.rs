//! Steps of joints and the bodies beside the links together, which end where flanks meet or part.
//!
//! Flanks that push are a spring and a damper, flanks apart nothing: a step across the corner
//! between them, or one that looks for the first push of a held joint across it, misses it by a
//! part of the step, and a knock decides all that follows.

use super::crossing::Crossing;
use super::{Stepper, hold};
use crate::effects::{Coupling, Flank};
use crate::sim::drive::DriveInput;
use crate::sim::forces::StateView;
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;

/// A step that was taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taken {
    /// How long it was, s.
    pub span_s: f64,
    /// The joint whose flanks meet or part at its end.
    pub knock: Option<usize>,
}

impl<R: Rows> Stepper<R> {
    /// Advances by `h` s under constant inputs, or until flanks meet or part, which they have yet
    /// to [do](Self::meet_or_part).
    #[inline]
    pub(super) fn step_to_knock(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) -> Taken {
        if plant.has_flanks {
            return self.step_to_first_knock(plant, inputs, h);
        }
        self.step(plant, inputs, h);
        Taken {
            span_s: h,
            knock: None,
        }
    }

    fn step_to_first_knock(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) -> Taken {
        for joint in 0..self.len() {
            self.start_pressed_rad[joint] = self.pressed_rad(joint);
        }
        self.step(plant, inputs, h);
        let Some((joint, crossing)) = self.first_knock() else {
            let (span_s, knock) = (h, None);
            return Taken { span_s, knock };
        };
        self.step_again(plant, inputs, crossing.share * h);
        let crossing = crossing.bent(self.pressed_rad(joint));
        let span_s = crossing.share * h;
        self.step_again(plant, inputs, span_s);
        let knock = Some(joint);
        Taken { span_s, knock }
    }

    /// By how much a gear's flanks are pressed, rad; far apart without a gap.
    fn pressed_rad(&self, joint: usize) -> f64 {
        let auxiliary = &self.forces.auxiliary;
        let [wound, winding] = auxiliary.wound(joint, [self.angle[joint], self.speed[joint]]);
        let gapped = auxiliary.coupling[joint].filter(Coupling::has_gap);
        gapped.map_or(f64::NEG_INFINITY, |coupling| {
            coupling.pressed_rad(auxiliary.flank[joint], wound, winding)
        })
    }

    /// The joint whose flanks first meet or part in the step just taken.
    fn first_knock(&self) -> Option<(usize, Crossing)> {
        let crossings = (0..self.len()).filter_map(|joint| {
            let pushes = self.forces.auxiliary.flank[joint] != Flank::None;
            let ends = [self.start_pressed_rad[joint], self.pressed_rad(joint)];
            // What met or parted at the step's beginning lies on either side of it by a rounding.
            let crosses = (ends[1] > 0.0) != pushes;
            crosses.then(|| (joint, Crossing::between(ends)))
        });
        crossings.min_by(|(_, a), (_, b)| a.share.total_cmp(&b.share))
    }

    /// Goes on with the other of a flank that pushes and none.
    pub(super) fn meet_or_part(&mut self, joint: usize) {
        let auxiliary = &mut self.forces.auxiliary;
        let [wound, _] = auxiliary.wound(joint, [self.angle[joint], self.speed[joint]]);
        auxiliary.flank[joint] = match auxiliary.flank[joint] {
            Flank::None => Flank::Of(wound.signum()),
            Flank::Of(_) => Flank::None,
        };
    }

    /// Advances joints, motors behind gears that give, and a base that gives way by `h` s.
    pub(super) fn step_with_auxiliary(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        let (forces, contact) = (&mut self.forces, self.contact.as_ref());
        let joints = contact.len();
        let [place, speed] = &mut self.together;
        place[..joints].copy_from_slice(self.angle.as_ref());
        place[joints..].copy_from_slice(&forces.auxiliary.place);
        speed[..joints].copy_from_slice(self.speed.as_ref());
        speed[joints..].copy_from_slice(&forces.auxiliary.speed);
        (self.with_auxiliary).step(place, speed, h, None, |place, speed, slope| {
            let (angle, own_place) = place.split_at(joints);
            let (speed, own_speed) = speed.split_at(joints);
            let (slope, own_slope) = slope.split_at_mut(joints);
            forces.auxiliary.place.copy_from_slice(own_place);
            forces.auxiliary.speed.copy_from_slice(own_speed);
            let at = StateView {
                angle,
                speed,
                contact,
            };
            forces.accelerate(plant, inputs, at, slope);
            hold(slope, contact);
            own_slope.copy_from_slice(&forces.auxiliary.slope);
        });
        self.angle.as_mut().copy_from_slice(&place[..joints]);
        self.speed.as_mut().copy_from_slice(&speed[..joints]);
        forces.auxiliary.place.copy_from_slice(&place[joints..]);
        forces.auxiliary.speed.copy_from_slice(&speed[joints..]);
    }
}
