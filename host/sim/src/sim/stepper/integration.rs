//! A step between two events, in which no contact changes.

use super::{Contact, Stepper};
use crate::sim::drive::DriveInput;
use crate::sim::forces::StateView;
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;

impl<R: Rows> Stepper<R> {
    /// Advances by `h` s under constant inputs.
    pub(super) fn step(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        self.forces.half_step_s = 0.5 * h;
        if plant.has_auxiliary() {
            return self.step_with_auxiliary(plant, inputs, h);
        }
        if self.rests() {
            return;
        }
        let (forces, contact) = (&mut self.forces, self.contact.as_ref());
        let known = std::mem::replace(&mut self.slope_is_known, false);
        let first = known.then_some(&mut self.slope).map(|slope| {
            hold(slope.as_mut(), contact);
            &*slope
        });
        let state = (&mut self.angle, &mut self.speed);
        if forces.step(plant, inputs, contact, state, h, first) {
            return;
        }
        self.runge_kutta.step(
            &mut self.angle,
            &mut self.speed,
            h,
            first,
            #[inline(always)]
            |angle, speed, slope: &mut R::Of<f64>| {
                let (angle, speed) = (angle.as_ref(), speed.as_ref());
                let at = StateView {
                    angle,
                    speed,
                    contact,
                };
                forces.accelerate(plant, inputs, at, slope.as_mut());
                hold(slope.as_mut(), contact);
            },
        );
    }

    /// Advances joints, motors behind gears that give, and a base that gives way by `h` s.
    fn step_with_auxiliary(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        let known = std::mem::replace(&mut self.slope_is_known, false);
        let (forces, contact) = (&mut self.forces, self.contact.as_ref());
        let joints = contact.len();
        let [place, speed, slope] = &mut self.together;
        slope[..joints].copy_from_slice(self.slope.as_ref());
        slope[joints..].copy_from_slice(&forces.auxiliary.slope);
        hold(&mut slope[..joints], contact);
        let first = known.then_some(&*slope);
        place[..joints].copy_from_slice(self.angle.as_ref());
        place[joints..].copy_from_slice(&forces.auxiliary.place);
        speed[..joints].copy_from_slice(self.speed.as_ref());
        speed[joints..].copy_from_slice(&forces.auxiliary.speed);
        (self.with_auxiliary).step(place, speed, h, first, |place, speed, slope| {
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

/// Joints that friction holds do not speed up.
#[inline(always)]
pub(super) fn hold(slope: &mut [f64], contact: &[Contact]) {
    for (slope, contact) in slope.iter_mut().zip(contact) {
        if *contact == Contact::Held {
            *slope = 0.0;
        }
    }
}
