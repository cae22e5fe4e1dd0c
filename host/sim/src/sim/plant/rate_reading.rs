//! Rate sensors that joints have beside those of their angles: gyros and tachometers.

use super::Plant;
use crate::model::Model;
use crate::sim::joint_plan::ActiveEffect;

/// What such a sensor reads.
#[derive(Debug, Clone)]
pub(in crate::sim) struct RateReading {
    /// The hinges whose speeds add up to the rate that it feels.
    turning: Vec<usize>,
    scale: f64,
    bias_rad_s: f64,
    /// What the rate is read through, with memory.
    pub sense: Vec<ActiveEffect>,
}

impl RateReading {
    fn of(model: &Model, plant: &Plant, joint: usize) -> RateReading {
        let plan = &plant.joints[joint];
        RateReading {
            turning: model.turning(model.log.joints[joint].rate_sensor, joint),
            scale: plan.rate_scale,
            bias_rad_s: plan.rate_bias_rad_s,
            sense: plan.rate_sense.clone(),
        }
    }

    /// What it reads at these relative speeds, rad/s, before any effect with memory.
    #[inline]
    pub fn encoded_rad_s(&self, speed_rad_s: &[f64]) -> f64 {
        self.slope(speed_rad_s) + self.bias_rad_s
    }

    /// How fast that changes, rad/s^2, at these relative accelerations; of which angle it is the
    /// rate, rad, at these relative angles.
    pub fn slope(&self, change: &[f64]) -> f64 {
        let felt = self.turning.iter().map(|hinge| change[*hinge]);
        self.scale * felt.sum::<f64>()
    }
}

impl Plant {
    /// The same with the rate sensors that joints have beside those of their angles.
    pub(super) fn with_rate_sensors(mut self, model: &Model) -> Plant {
        self.rate_joints = model.log.rate_joints();
        let reading = |joint: &usize| RateReading::of(model, &self, *joint);
        self.rate_readings = self.rate_joints.iter().map(reading).collect();
        if !self.rate_readings.is_empty() {
            // Their column is on time, so no run may begin after a sample's own time.
            self.late_s = self.late_s.max(0.0);
        }
        self.senses |= self.rate_readings.iter().any(|rate| !rate.sense.is_empty());
        self
    }

    /// Angle of which a signal is the rate, rad, its scale included, at these relative angles; none
    /// of a signal that is an angle.
    pub(in crate::sim) fn turned_of(&self, signal: usize, angle_rad: &[f64]) -> Option<f64> {
        match signal.checked_sub(self.len()) {
            Some(sensor) => Some(self.rate_readings[sensor].slope(angle_rad)),
            None if self.rates[signal] => {
                Some(self.rate_scale(signal) * self.encoded_rad(signal, angle_rad))
            }
            None => None,
        }
    }

    /// What a signal that is a rate reads at rest, rad/s.
    pub(in crate::sim) fn rate_bias_of(&self, signal: usize) -> f64 {
        match signal.checked_sub(self.len()) {
            Some(sensor) => self.rate_readings[sensor].bias_rad_s,
            None => self.rate_bias_rad_s(signal),
        }
    }

    /// By how much later than it was read the log holds a signal, s.
    pub(in crate::sim) fn offset_s(&self, signal: usize) -> f64 {
        self.joints.get(signal).map_or(0.0, |joint| joint.offset_s)
    }
}
