//! What the sensors read at a state of the plant, and which state makes them read that.

use super::Plant;
use crate::sim::joint_plan::ActiveEffect;
use crate::sim::run::StartState;

impl Plant {
    /// What the encoders read at these relative angles (joint 1 from hanging), rad in the log's
    /// convention, before any effect with memory.
    pub(in crate::sim) fn encoded_rad(&self, joint: usize, angle_rad: &[f64]) -> f64 {
        let true_angle = if self.absolute {
            angle_rad[..=joint].iter().sum::<f64>() - self.zero_rad
        } else {
            angle_rad[joint] - self.zeros_rad[joint]
        };
        self.joints[joint]
            .encode
            .iter()
            .fold(true_angle, |angle, e| e.effect.encode(e.values(), angle))
    }

    /// What a joint's encoder reads at a state and how fast that changes, rad and rad/s, before any
    /// effect with memory.
    pub fn reading(&self, joint: usize, state: &StartState) -> (f64, f64) {
        let angle_rad = self.encoded_rad(joint, &state.angle_rad);
        (angle_rad, self.encoded_rad_s(joint, &state.speed_rad_s))
    }

    /// How fast those readings change, rad/s, at these relative speeds; of a joint whose rate alone
    /// is logged, what its sensor reads.
    pub(in crate::sim) fn encoded_rad_s(&self, joint: usize, speed_rad_s: &[f64]) -> f64 {
        let read_rad_s = self.encoded_slope_rad_s(joint, speed_rad_s);
        self.rate_scale(joint) * read_rad_s + self.rate_bias_rad_s(joint)
    }

    /// How fast what a joint's own encoder reads changes, rad/s, at these relative speeds.
    pub(in crate::sim) fn encoded_slope_rad_s(&self, joint: usize, speed_rad_s: &[f64]) -> f64 {
        let true_speed = if self.absolute {
            speed_rad_s[..=joint].iter().sum::<f64>()
        } else {
            speed_rad_s[joint]
        };
        self.joints[joint].reading_slope() * true_speed
    }

    /// What is read per rate of a joint whose rate alone is logged.
    pub(super) fn rate_scale(&self, joint: usize) -> f64 {
        if self.rates[joint] {
            self.joints[joint].rate_scale
        } else {
            1.0
        }
    }

    /// What is read at rest as the rate of a joint whose rate alone is logged, rad/s.
    pub(super) fn rate_bias_rad_s(&self, joint: usize) -> f64 {
        if self.rates[joint] {
            self.joints[joint].rate_bias_rad_s
        } else {
            0.0
        }
    }

    /// What the log holds at a stretch's first sample, how fast that changes and how fast that
    /// does, carried to the time at which the simulation of the stretch begins, for columns that
    /// are off in time by different times.
    pub fn at_begin(&self, [reading, speed, acceleration]: [&[f64]; 3]) -> [Vec<f64>; 2] {
        let moved = |joint: usize| {
            let by_s = self.joints[joint].offset_s - self.late_s;
            let change = by_s * acceleration[joint];
            let reading = reading[joint] + by_s * (speed[joint] + 0.5 * change);
            (reading, speed[joint] + change)
        };
        let (reading, speed) = (0..self.len()).map(moved).unzip();
        [reading, speed]
    }

    /// What the encoders would read without the sensors that trail, where these read `reading_rad`
    /// and the readings change by `speed_rad_s`.
    pub fn ahead_rad(&self, reading_rad: &[f64], speed_rad_s: &[f64]) -> Vec<f64> {
        let ahead = |joint: usize| {
            if self.rates[joint] {
                reading_rad[joint]
            } else {
                reading_rad[joint] + self.trail(joint, speed_rad_s[joint])
            }
        };
        (0..self.len()).map(ahead).collect()
    }

    /// How fast they would change, rad/s, where they change by `speed_rad_s` and that by
    /// `acceleration_rad_s2`.
    pub fn ahead_rad_s(&self, speed_rad_s: &[f64], acceleration_rad_s2: &[f64]) -> Vec<f64> {
        let rates = speed_rad_s.iter().zip(acceleration_rad_s2).enumerate();
        let ahead =
            |(joint, (speed, change)): (usize, (&f64, &f64))| speed + self.trail(joint, *change);
        rates.map(ahead).collect()
    }

    /// By how much a joint's sensors trail behind what has long changed by `slope` a second.
    fn trail(&self, joint: usize, slope: f64) -> f64 {
        let trail = |e: &ActiveEffect| e.effect.trail_rad(e.values(), slope);
        self.joints[joint].sense.iter().filter_map(trail).sum()
    }

    /// How fast what the log holds of each signal changes, from how fast the joints' readings
    /// change and how fast that does.
    pub fn reading_slopes(&self, speed_rad_s: &[f64], acceleration_rad_s2: &[f64]) -> Vec<f64> {
        let slope = |joint: usize| {
            if self.rates[joint] {
                acceleration_rad_s2[joint]
            } else {
                speed_rad_s[joint]
            }
        };
        let of_joints = (0..self.len()).map(slope);
        if self.rate_readings.is_empty() {
            return of_joints.collect();
        }
        let relative_rad_s2 = self.turned_rad(&self.unscaled(acceleration_rad_s2, |_| 0.0));
        let rates = self.rate_readings.iter();
        of_joints
            .chain(rates.map(|rate| rate.slope(&relative_rad_s2)))
            .collect()
    }

    /// What the log holds of a joint at a state, before any effect with memory: rad, or rad/s where
    /// it holds the rate alone.
    pub(in crate::sim) fn encoded(
        &self,
        joint: usize,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
    ) -> f64 {
        if self.rates[joint] {
            self.encoded_rad_s(joint, speed_rad_s)
        } else {
            self.encoded_rad(joint, angle_rad)
        }
    }

    /// Relative joint speeds, rad/s, at which the encoders' readings change by `rate_rad_s`.
    pub fn decode_rad_s(&self, rate_rad_s: &[f64]) -> Vec<f64> {
        self.turned_rad(&self.unscaled(rate_rad_s, |joint| self.rate_bias_rad_s(joint)))
    }

    /// Per joint, what is read without a bias and without the scale of a sensor of rates.
    fn unscaled(&self, read: &[f64], bias: impl Fn(usize) -> f64) -> Vec<f64> {
        let read = read.iter().enumerate();
        read.map(|(joint, read)| (read - bias(joint)) / self.rate_scale(joint))
            .collect()
    }

    /// By how much the joints turn, rad, where the encoders' readings change by `read_rad`.
    pub(in crate::sim) fn turned_rad(&self, read_rad: &[f64]) -> Vec<f64> {
        let joints = self.joints.iter().zip(read_rad);
        let mut turned: Vec<f64> = joints.map(|(plan, d)| d / plan.reading_slope()).collect();
        if self.absolute {
            for joint in (1..turned.len()).rev() {
                turned[joint] -= turned[joint - 1];
            }
        }
        turned
    }

    /// Relative angles (joint 1 from hanging) that make the encoders read `reading_rad`; undoes
    /// `encoded_rad`.
    pub fn decode_rad(&self, reading_rad: &[f64]) -> Vec<f64> {
        let mut angles = Vec::with_capacity(reading_rad.len());
        let mut before = self.zero_rad;
        for (joint, &reading) in self.joints.iter().zip(reading_rad) {
            let (at_zero, at_one) = (joint.line(0.0), joint.line(1.0));
            let angle = (reading - at_zero) / (at_one - at_zero);
            if self.absolute {
                angles.push(angle + self.zero_rad - if angles.is_empty() { 0.0 } else { before });
                before = angle + self.zero_rad;
            } else {
                angles.push(angle + self.zeros_rad[angles.len()]);
            }
        }
        angles
    }
}
