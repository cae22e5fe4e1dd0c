//! A model made ready for one motion: effects sorted by site, conditions of the motion applied.

use super::joint_plan::{ActiveEffect, JointPlan};
use super::run::Start;
use crate::effects::{BaseSpring, CONTROLS, EFFECTS, Needs, PLACEBO, Rig};
use crate::log::Motion;
use crate::model::{Angles, MeasuredSignal, Model};

/// A model compiled for one motion.
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) rig: Rig,
    pub(super) joints: Vec<JointPlan>,
    /// Stands for gravity: see [`Chain::base_m_s2`].
    pub(super) base_m_s2: [f64; 2],
    /// Angle from hanging of the zero of the log's angles, rad, where these are from the world.
    pub(super) zero_rad: f64,
    /// Per joint, relative angle at which the log's is zero, rad.
    pub(super) zeros_rad: Vec<f64>,
    pub(super) absolute: bool,
    /// Per joint: whether the log holds its rate alone, which is then what is predicted.
    pub(super) rates: Vec<bool>,
    /// Whether any reading has a memory that must follow every step.
    pub(super) senses: bool,
    /// How many cells its effects remember things in.
    pub(super) remembers: usize,
    /// A base that gives way, and the place of the first of its two cells.
    pub(super) base: Option<(BaseSpring, usize)>,
    /// Longest step that follows motors which turn apart from their joints, and a base that gives
    /// way, s; infinite without.
    pub(super) auxiliary_step_s: f64,
    pub(super) step_s: f64,
    /// Whether every torque stays until an input changes or a joint stops or starts.
    pub(super) torques_stay: bool,
    pub(super) needs_gear_load: bool,
    pub(super) needs_bearing_load: bool,
    /// Per joint, per sample: the measured speed of another moment; empty without a placebo.
    pub(super) shuffled_rad_s: Vec<Vec<f64>>,
}

impl Plant {
    /// Compiles `model` for the conditions of `motion` (payload, attitude).
    pub fn new(model: &Model, motion: &Motion) -> Plant {
        let columns = model.log.joints.iter();
        let mut rates: Vec<bool> = columns
            .map(|columns| columns.signal() == MeasuredSignal::Rate)
            .collect();
        rates.resize(model.link_count(), false);
        Plant::read_by(model, motion, rates)
    }

    /// The same where `rates` says of which joints the rate is read, not the angle.
    fn read_by(model: &Model, motion: &Motion, rates: Vec<bool>) -> Plant {
        let mut joints: Vec<JointPlan> = model
            .joints
            .iter()
            .map(|j| JointPlan::ideal(&j.drive))
            .collect();
        let mut rig = model.rig(motion.turned);
        if motion.payload_kg > 0.0 {
            rig.chain.bolt_on(motion.payload_kg, model.log.payload_at_m);
        }
        // Those of one site act in the library's order, however the file lists them.
        let mut needs = Vec::new();
        for effect in EFFECTS.iter().chain(CONTROLS) {
            for instance in model.effects.iter().filter(|e| e.effect == *effect) {
                for (index, joint) in joints.iter_mut().enumerate() {
                    if instance.acts_on(index, &model.joints[index]) {
                        joint.add(instance.effect, &instance.values);
                        needs.push(effect.info().needs);
                    }
                }
            }
        }
        for instance in model.effects.iter().filter(|e| e.effect.is_users()) {
            for (index, joint) in joints.iter_mut().enumerate() {
                if instance.acts_on(index, &model.joints[index]) {
                    joint.add(instance.effect, &instance.values);
                }
            }
        }
        for joint in &mut joints {
            joint.follows_input = joint.coupling.is_none() && joint.torque_is_held();
        }
        let of_rates = joints.iter_mut().zip(&rates).filter(|(_, rate)| **rate);
        of_rates.for_each(|(joint, _)| joint.keep_rate_sensors());
        let of_joints = joints
            .iter_mut()
            .fold(0, |next, joint| joint.place_memory(next));
        let base = rig.base_spring.map(|spring| (spring, of_joints));
        let senses = joints.iter().any(|j| !j.sense.is_empty());
        Plant {
            rates,
            senses,
            remembers: of_joints + if base.is_some() { 2 } else { 0 },
            auxiliary_step_s: auxiliary_step_s(&joints, rig.base_spring),
            base,
            base_m_s2: rig.chain.base_m_s2(rig.gravity_turn_rad),
            rig,
            zero_rad: model.angle_zero.from_hanging_rad(),
            zeros_rad: (0..joints.len())
                .map(|joint| model.zero_rad(joint))
                .collect(),
            absolute: model.angles == Angles::Absolute,
            step_s: model.step_s,
            torques_stay: joints.iter().all(JointPlan::torque_stays),
            needs_gear_load: needs.contains(&Needs::GearLoad),
            needs_bearing_load: needs.contains(&Needs::BearingLoad),
            shuffled_rad_s: shuffled(model, motion),
            joints,
        }
    }

    /// Compiles `model` for a simulation without a log: no payload, not turned.
    pub fn without_log(model: &Model) -> Plant {
        let angles = vec![false; model.link_count()];
        Plant::read_by(model, &Motion::default(), angles)
    }

    /// Whether any motor turns apart from its joint, or the base gives way.
    pub(super) fn has_auxiliary(&self) -> bool {
        self.auxiliary_step_s.is_finite()
    }

    /// How many bodies move beside the links: a motor a joint, and the base in two directions; none
    /// where all are rigid.
    pub(super) fn auxiliary_bodies(&self) -> usize {
        if self.has_auxiliary() {
            self.len() + 2
        } else {
            0
        }
    }

    /// Whether the log's angles are measured from the world.
    pub fn is_absolute(&self) -> bool {
        self.absolute
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is no joint.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// What the encoders read at these relative angles (joint 1 from hanging), rad in the log's
    /// convention, before any effect with memory.
    pub(super) fn encoded_rad(&self, joint: usize, angle_rad: &[f64]) -> f64 {
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
    pub fn reading(&self, joint: usize, state: &Start) -> (f64, f64) {
        let angle_rad = self.encoded_rad(joint, &state.angle_rad);
        (angle_rad, self.encoded_rad_s(joint, &state.speed_rad_s))
    }

    /// How fast those readings change, rad/s, at these relative speeds; of a joint whose rate alone
    /// is logged, what its sensor reads.
    pub(super) fn encoded_rad_s(&self, joint: usize, speed_rad_s: &[f64]) -> f64 {
        let true_speed = match self.absolute {
            true => speed_rad_s[..=joint].iter().sum::<f64>(),
            false => speed_rad_s[joint],
        };
        self.joints[joint].reading_slope() * true_speed + self.rate_bias_rad_s(joint)
    }

    /// What is read at rest as the rate of a joint whose rate alone is logged, rad/s.
    fn rate_bias_rad_s(&self, joint: usize) -> f64 {
        match self.rates[joint] {
            true => self.joints[joint].rate_bias_rad_s,
            false => 0.0,
        }
    }

    /// What the encoders would read without the sensors that trail, where these read `reading_rad`
    /// and the readings change by `speed_rad_s`.
    pub fn ahead_rad(&self, reading_rad: &[f64], speed_rad_s: &[f64]) -> Vec<f64> {
        let ahead = |joint: usize| match self.rates[joint] {
            true => reading_rad[joint],
            false => reading_rad[joint] + self.trail(joint, speed_rad_s[joint]),
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

    /// How fast what the log holds of each joint changes, from how fast its readings change and how
    /// fast that does.
    pub fn reading_slopes(&self, speed_rad_s: &[f64], acceleration_rad_s2: &[f64]) -> Vec<f64> {
        let slope = |joint: usize| match self.rates[joint] {
            true => acceleration_rad_s2[joint],
            false => speed_rad_s[joint],
        };
        (0..self.len()).map(slope).collect()
    }

    /// What the log holds of a joint at a state, before any effect with memory: rad, or rad/s where
    /// it holds the rate alone.
    pub(super) fn encoded(&self, joint: usize, angle_rad: &[f64], speed_rad_s: &[f64]) -> f64 {
        match self.rates[joint] {
            true => self.encoded_rad_s(joint, speed_rad_s),
            false => self.encoded_rad(joint, angle_rad),
        }
    }

    /// Relative joint speeds, rad/s, at which the encoders' readings change by `rate_rad_s`.
    pub fn decode_rad_s(&self, rate_rad_s: &[f64]) -> Vec<f64> {
        let rates = rate_rad_s.iter().enumerate();
        let unbiased = rates.map(|(joint, rate)| rate - self.rate_bias_rad_s(joint));
        self.turned_rad(&unbiased.collect::<Vec<_>>())
    }

    /// By how much the joints turn, rad, where the encoders' readings change by `read_rad`.
    pub(super) fn turned_rad(&self, read_rad: &[f64]) -> Vec<f64> {
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

/// Longest step, in parts of the time in which a motor swings against its joint by 1 rad, that
/// integrates it well; so for a base.
const AUXILIARY_STEP: f64 = 0.4;

/// See [`Plant::auxiliary_step_s`].
fn auxiliary_step_s(joints: &[JointPlan], base: Option<BaseSpring>) -> f64 {
    let motors = joints.iter().filter_map(|joint| joint.coupling);
    let frequencies = motors.map(|coupling| coupling.natural_rad_s);
    let frequencies = frequencies.chain(base.map(|base| base.natural_rad_s()));
    let steps = frequencies.map(|natural_rad_s| AUXILIARY_STEP / natural_rad_s);
    steps.fold(f64::INFINITY, f64::min)
}

/// Measured speeds of a motion, turned in time by a bit more than a third of it.
fn shuffled(model: &Model, motion: &Motion) -> Vec<Vec<f64>> {
    if !model.effects.iter().any(|e| e.effect.info().id == PLACEBO) {
        return Vec::new();
    }
    let joints = motion.position_rad.iter().enumerate();
    joints
        .map(|(joint, position)| {
            let last = position.len() - 1;
            let reach = 3.min(last);
            let logged = motion.velocity_rad_s[joint].as_ref();
            let logged = logged.filter(|_| position.iter().all(|angle| angle.is_nan()));
            let speed = |k: usize| {
                if let Some(logged) = logged {
                    return if logged[k].is_finite() {
                        logged[k]
                    } else {
                        0.0
                    };
                }
                let (a, b) = (k.saturating_sub(reach), (k + reach).min(last));
                let speed = (position[b] - position[a]) / (motion.time_s[b] - motion.time_s[a]);
                if speed.is_finite() { speed } else { 0.0 }
            };
            (0..=last)
                .map(|k| speed((k + 3 * (last + 1) / 8) % (last + 1)))
                .collect()
        })
        .collect()
}
