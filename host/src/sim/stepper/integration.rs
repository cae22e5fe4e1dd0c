//! A step between two events, in which no contact changes.

use super::{Contact, Stepper};
use crate::sim::drive::DriveInput;
use crate::sim::forces::At;
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;

impl<R: Rows> Stepper<R> {
    /// Advances by `h` s under constant inputs.
    pub(super) fn step(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        let (forces, contact) = (&mut self.forces, self.contact.as_ref());
        let state = (&mut self.angle, &mut self.speed);
        if plant.has_motors() {
            return self.step_with_motors(plant, inputs, h);
        }
        if forces.step(plant, inputs, contact, state, h) {
            return;
        }
        self.runge_kutta.step(
            &mut self.angle,
            &mut self.speed,
            h,
            #[inline(always)]
            |angle, speed, slope: &mut R::Of<f64>| {
                let (angle, speed) = (angle.as_ref(), speed.as_ref());
                let at = At {
                    angle,
                    speed,
                    contact,
                };
                forces.accelerate(plant, inputs, at, slope.as_mut());
                hold(slope.as_mut(), contact);
            },
        );
    }

    /// The same for joints and motors together.
    fn step_with_motors(&mut self, plant: &Plant, inputs: &[DriveInput], h: f64) {
        let (forces, contact) = (&mut self.forces, self.contact.as_ref());
        let joints = contact.len();
        let mut angle = [self.angle.as_ref(), &forces.motors.angle].concat();
        let mut speed = [self.speed.as_ref(), &forces.motors.speed].concat();
        (self.with_motors).step(&mut angle, &mut speed, h, |angle, speed, slope| {
            let (angle, motor_angle) = angle.split_at(joints);
            let (speed, motor_speed) = speed.split_at(joints);
            let (slope, motor_slope) = slope.split_at_mut(joints);
            forces.motors.angle.copy_from_slice(motor_angle);
            forces.motors.speed.copy_from_slice(motor_speed);
            let at = At {
                angle,
                speed,
                contact,
            };
            forces.accelerate(plant, inputs, at, slope);
            hold(slope, contact);
            motor_slope.copy_from_slice(&forces.motors.slope);
        });
        let (joint_angle, motor_angle) = angle.split_at(joints);
        let (joint_speed, motor_speed) = speed.split_at(joints);
        self.angle.as_mut().copy_from_slice(joint_angle);
        self.speed.as_mut().copy_from_slice(joint_speed);
        forces.motors.angle.copy_from_slice(motor_angle);
        forces.motors.speed.copy_from_slice(motor_speed);
    }
}

/// Joints that friction holds do not speed up.
#[inline(always)]
fn hold(slope: &mut [f64], contact: &[Contact]) {
    for (slope, contact) in slope.iter_mut().zip(contact) {
        if *contact == Contact::Held {
            *slope = 0.0;
        }
    }
}
