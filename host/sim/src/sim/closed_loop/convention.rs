//! Angles of a plant about its pose: its balance, and what they are in the model's convention.

use super::PosedPlant;
use crate::dynamics::EquationsOfMotion;
use std::f64::consts::{PI, TAU};

impl PosedPlant {
    /// Deviations from the pose, rad, at which it stands without torque: what holds eccentric
    /// masses in balance. None where joints slide, or in space: no controller
    /// that asks for it takes such.
    pub fn balanced_rad(&self) -> Vec<f64> {
        let rig = &self.plant.rig;
        if rig.chain.slides() || rig.tree.is_some() {
            return vec![0.0; self.joints()];
        }
        let moments = EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad).moments_kg_m();
        let upright = |[along, across]: &[f64; 2]| PI - across.atan2(*along) + rig.gravity_turn_rad;
        let absolute: Vec<f64> = moments.iter().map(upright).collect();
        let relative = |i: usize| absolute[i] - if i > 0 { absolute[i - 1] } else { 0.0 };
        let off = (0..absolute.len()).map(|i| relative(i) - self.pose_rad[i]);
        // The nearest turn.
        off.map(|a| a - TAU * (a / TAU).round()).collect()
    }

    /// Deviations of the joints, rad, as deviations in the model's convention of angles.
    pub fn in_convention(&self, angle_rad: &[f64]) -> Vec<f64> {
        let carry = if self.plant.absolute { 1.0 } else { 0.0 };
        let sum = |sum: &mut f64, angle: &f64| {
            *sum = carry * *sum + angle;
            Some(*sum)
        };
        angle_rad.iter().scan(0.0, sum).collect()
    }

    /// Angles and speeds of the joints as deviations from the pose, each relative to the link
    /// before, rad and rad/s, where the encoders read `reading_rad`, rad in the model's
    /// convention, and their readings change by `rate_rad_s`.
    pub fn deviations(&self, reading_rad: &[f64], rate_rad_s: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut angle_rad = self.plant.decode_rad(reading_rad);
        for (angle, pose) in angle_rad.iter_mut().zip(&self.pose_rad) {
            *angle -= pose;
        }
        (angle_rad, self.plant.decode_rad_s(rate_rad_s))
    }

    /// What the encoders read at the pose, rad in the model's convention.
    pub fn pose_reading_rad(&self) -> Vec<f64> {
        let reading = |joint| self.plant.encoded_rad(joint, &self.pose_rad);
        (0..self.joints()).map(reading).collect()
    }
}
