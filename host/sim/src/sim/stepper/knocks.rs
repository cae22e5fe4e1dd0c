//! Flanks of gears that meet and part, which ends a step.
//!
//! Flanks that give are a spring and a damper while they push, flanks apart nothing. Rigid ones
//! that meet do not rebound: motor and joint move on together until the flank would have to pull. A
//! step across either misses it by a part of the step, and a knock decides all that follows.

use super::crossing::Crossing;
use super::{Contact, Stepper};
use crate::effects::{Coupling, Flank};
use crate::sim::drive::DriveInput;
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
    /// Advances by `h` s under constant inputs, less where a motor by itself needs shorter steps,
    /// or until flanks meet or part, which they have yet to [do](Self::meet_or_part).
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
        let h = h.min(self.motors_step_s(plant));
        self.start_pressed = self.pressed(plant, inputs);
        self.step(plant, inputs, h);
        let pressed = self.pressed(plant, inputs);
        let Some((joint, crossing)) = self.first_knock(&pressed) else {
            let (span_s, knock) = (h, None);
            return Taken { span_s, knock };
        };
        self.step_again(plant, inputs, crossing.share * h);
        let crossing = crossing.bent(self.pressed(plant, inputs)[joint]);
        let span_s = crossing.share * h;
        self.step_again(plant, inputs, span_s);
        let knock = Some(joint);
        Taken { span_s, knock }
    }

    /// Longest step, s, that follows motors which are between their flanks.
    pub(super) fn motors_step_s(&self, plant: &Plant) -> f64 {
        let flanks = plant.joints.iter().zip(&self.forces.auxiliary.flank);
        let between = flanks.filter(|(_, flank)| **flank == Flank::None);
        let steps = between.map(|(plan, _)| plan.motor_step_s);
        steps.fold(f64::INFINITY, f64::min)
    }

    /// By how much each gear's flanks are pressed, rad, or by which torque, N m, where rigid ones
    /// push; below 0 where they are apart, or would pull; far apart without a gap.
    fn pressed(&mut self, plant: &Plant, inputs: &[DriveInput]) -> R::Of<f64> {
        if self.forces.is_any_joined() && !self.slope_is_known {
            self.find_excess(plant, inputs);
        }
        let mut pressed = R::filled(f64::NEG_INFINITY, self.len());
        for (joint, plan) in plant.joints.iter().enumerate() {
            if let Some(coupling) = plan.coupling.as_ref().filter(|gear| gear.has_gap()) {
                pressed[joint] = self.pressed_at(coupling, joint);
            }
        }
        pressed
    }

    fn pressed_at(&self, coupling: &Coupling, joint: usize) -> f64 {
        let flank = self.forces.auxiliary.flank[joint];
        if let (Flank::Of(direction), true) = (flank, self.forces.is_joined(joint)) {
            return self.forces.pushed_nm(coupling, joint, direction);
        }
        let [wound, winding] = self.wound(joint);
        coupling.pressed_rad(flank, wound, winding)
    }

    /// How far and how fast a motor is ahead of its joint, rad and rad/s.
    fn wound(&self, joint: usize) -> [f64; 2] {
        let at = [self.angle[joint], self.speed[joint]];
        self.forces.auxiliary.wound(joint, at)
    }

    /// The joint whose flanks first meet or part in the step just taken.
    fn first_knock(&self, pressed: &R::Of<f64>) -> Option<(usize, Crossing)> {
        let crossings = (0..self.len()).filter_map(|joint| {
            let pushes = self.forces.auxiliary.flank[joint] != Flank::None;
            let ends = [self.start_pressed[joint], pressed[joint]];
            // What met or parted at the step's beginning lies on either side of it by a rounding.
            let crosses = (ends[1] > 0.0) != pushes;
            crosses.then(|| (joint, Crossing::between(ends)))
        });
        crossings.min_by(|(_, a), (_, b)| a.share.total_cmp(&b.share))
    }

    /// Lets go of motors whose rigid flanks would have to pull, the one that pulls most first.
    pub(super) fn part_pulled(&mut self, plant: &Plant, inputs: &[DriveInput]) {
        while self.forces.is_any_joined() {
            let pressed = self.pressed(plant, inputs);
            let joined = (0..self.len()).filter(|&joint| self.forces.is_joined(joint));
            let pulled = joined
                .filter(|&joint| pressed[joint] < 0.0)
                .min_by(|&a, &b| pressed[a].total_cmp(&pressed[b]));
            let Some(joint) = pulled else { return };
            self.set_flank(plant, joint, Flank::None);
        }
    }

    fn set_flank(&mut self, plant: &Plant, joint: usize, flank: Flank) {
        self.forces.auxiliary.flank[joint] = flank;
        self.forces.join_motors(plant);
        self.slope_is_known = false;
    }

    /// Goes on with the other of a flank that pushes and none.
    pub(super) fn meet_or_part(&mut self, plant: &Plant, joint: usize) {
        let flank = match self.forces.auxiliary.flank[joint] {
            Flank::None => Flank::Of(self.wound(joint)[0].signum()),
            Flank::Of(_) => Flank::None,
        };
        let rigid = plant.joints[joint].rigid_flanks();
        if let (Some(coupling), Flank::Of(direction)) = (rigid, flank) {
            let angle = self.angle[joint];
            self.forces.auxiliary.place[joint] = angle + direction * coupling.half_gap_rad();
            self.knock(plant, joint, coupling.inertia_kg_m2);
        }
        self.set_flank(plant, joint, flank);
    }

    /// Gives motor and joint, which meet, one speed: momentum passes from one to the other. It
    /// takes no time, and friction is no impulse: it holds no joint through it.
    fn knock(&mut self, plant: &Plant, joint: usize, motor_kg_m2: f64) {
        let response = self.forces.response(plant, joint, self.angle.as_ref());
        let [_, winding_rad_s] = self.wound(joint);
        let push_nm_s = winding_rad_s / (response[joint] + 1.0 / motor_kg_m2);
        let joints = self.len();
        for (k, by) in response.iter().enumerate() {
            let by = by * push_nm_s;
            if k >= joints {
                self.forces.auxiliary.speed[k] += by;
                continue;
            }
            self.speed[k] += by;
            if k == joint || self.forces.is_joined(k) {
                self.forces.auxiliary.speed[k] = self.speed[k];
            }
            self.contact[k] = match self.contact[k] {
                Contact::Held if by != 0.0 => Contact::Sliding(by.signum()),
                Contact::Sliding(direction) if direction * self.speed[k] < 0.0 => {
                    Contact::Sliding(-direction)
                }
                contact => contact,
            };
        }
    }

    /// Holds a joint where it is, and a motor that moves with it.
    pub(super) fn stop(&mut self, joint: usize) {
        self.speed[joint] = 0.0;
        self.contact[joint] = Contact::Held;
        if self.forces.is_joined(joint) {
            self.forces.auxiliary.speed[joint] = 0.0;
        }
    }
}
