//! A model made ready for one motion: effects sorted by site, conditions of the motion applied.

mod rate_reading;
mod readings;

use super::hidden::HiddenUnknown;
use super::joint_plan::JointPlan;
use crate::dynamics::SpatialEquations;
use crate::effects::{
    BaseSpring, CONTROLS, Coupling, EFFECTS, Needs, PLACEBO, REMEMBERED_STEP_S, Rig,
};
use crate::model::{Angles, Drive, MeasuredSignal, Model};
use crate::motion::Motion;
pub(super) use rate_reading::RateReading;

/// A model compiled for one motion.
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) rig: Rig,
    /// The equations of a robot in space.
    pub(super) tree: Option<SpatialEquations>,
    pub(super) joints: Vec<JointPlan>,
    /// Of each joint, whether it slides.
    pub(super) slides: Vec<bool>,
    /// Stands for gravity: see [`Chain::base_m_s2`].
    pub(super) base_m_s2: [f64; 2],
    /// Angle from hanging of the zero of the log's angles, rad, where these are from the world.
    pub(super) zero_rad: f64,
    /// Per joint, relative angle at which the log's is zero, rad.
    pub(super) zeros_rad: Vec<f64>,
    pub(super) absolute: bool,
    /// Per joint: whether the log holds its rate alone, which is then what is predicted.
    pub(super) rates: Vec<bool>,
    /// What rate sensors read that joints have beside those of their angles, in the joints' order.
    pub(super) rate_readings: Vec<RateReading>,
    /// The joints that have one.
    rate_joints: Vec<usize>,
    /// Whether any reading has a memory that must follow every step.
    pub(super) senses: bool,
    /// By how much the inputs of drives are late, each other than 0 once, s.
    pub(super) delays_s: Vec<f64>,
    /// Whether the log holds any reading of another time than its row's.
    pub(super) has_offsets: bool,
    /// By how much the log's latest column is late, s; below 0 where all are early. The simulation
    /// of a stretch begins so much before its first sample.
    pub(super) late_s: f64,
    /// How many cells its effects remember things in.
    pub(super) remembers: usize,
    /// What no reading tells of where a stretch begins.
    pub(super) hidden: Vec<HiddenUnknown>,
    /// A base that gives way, and the place of the first of its two cells.
    pub(super) base: Option<(BaseSpring, usize)>,
    /// Longest step that follows gears and a base that give way, s; infinite where all are rigid.
    pub(super) auxiliary_step_s: f64,
    /// Whether any gear has a gap, whose flanks meet and part.
    pub(super) has_flanks: bool,
    /// Whether the flanks of any do not give.
    pub(super) has_rigid_flanks: bool,
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
        Plant::read_by(model, motion, rates).with_rate_sensors(model)
    }

    /// The same where `rates` says of which joints the rate is read, not the angle.
    fn read_by(model: &Model, motion: &Motion, rates: Vec<bool>) -> Plant {
        let mut joints: Vec<JointPlan> = model
            .joints
            .iter()
            .map(|j| JointPlan::ideal(&j.drive))
            .collect();
        let rig = model.rig_with(motion.turned, motion.payload_kg);
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
            joint.motor_step_s = joint.longest_motor_step_s();
        }
        let of_rates = joints.iter_mut().zip(&rates).filter(|(_, rate)| **rate);
        of_rates.for_each(|(joint, _)| joint.keep_rate_sensors());
        let of_joints = joints
            .iter_mut()
            .fold(0, |next, joint| joint.place_memory(next));
        let base = rig.base_spring.map(|spring| (spring, of_joints));
        let mut delays_s: Vec<f64> = joints.iter().map(|joint| joint.delay_s).collect();
        delays_s.retain(|delay_s| *delay_s != 0.0);
        delays_s.sort_by(f64::total_cmp);
        delays_s.dedup();
        let senses = joints.iter().any(|j| !j.sense.is_empty());
        let offsets_s = || joints.iter().map(|joint| joint.offset_s);
        Plant {
            slides: each(model, |joint| model.joints[joint].slide.is_some()),
            rates,
            rate_readings: Vec::new(),
            rate_joints: Vec::new(),
            senses,
            delays_s,
            has_offsets: offsets_s().any(|offset_s| offset_s != 0.0),
            late_s: offsets_s().reduce(f64::max).unwrap_or(0.0),
            remembers: of_joints + if base.is_some() { 2 } else { 0 },
            hidden: HiddenUnknown::all(&joints),
            auxiliary_step_s: auxiliary_step_s(&joints, rig.base_spring),
            has_flanks: any_coupling(&joints, |coupling| coupling.has_gap()),
            has_rigid_flanks: any_coupling(&joints, |coupling| coupling.has_rigid_flanks),
            base,
            tree: rig.tree.as_ref().map(SpatialEquations::new),
            base_m_s2: rig.chain.base_m_s2(rig.gravity_turn_rad),
            rig,
            zero_rad: model.angle_zero.from_hanging_rad(),
            zeros_rad: each(model, |joint| model.zero_rad(joint)),
            absolute: model.angles == Angles::Absolute,
            step_s: step_s(model.step_s, &joints),
            torques_stay: joints.iter().all(JointPlan::torque_stays),
            needs_gear_load: needs.contains(&Needs::GearLoad),
            needs_bearing_load: needs.contains(&Needs::BearingLoad),
            shuffled_rad_s: shuffled(model, motion),
            joints,
        }
    }

    /// Whether two runs whose readings have come as near as noise cannot tell stay so: a drive
    /// holds each joint to its goal, each reading is that of an angle in its own row, nothing else
    /// is remembered, and nothing hidden where they begin.
    ///
    /// Where no drive holds a joint, what friction took away of a difference grows again as the
    /// joint passes upright.
    pub fn forgets_its_start(&self) -> bool {
        let holds = |joint: &JointPlan| matches!(joint.drive, Drive::Position { .. });
        let remembers = self.remembers > 0 || self.senses || !self.hidden.is_empty();
        let reads_angles = !self.has_offsets && !self.rates.contains(&true);
        self.joints.iter().all(holds) && !remembers && reads_angles
    }

    /// Compiles `model` for a simulation without a log: no payload, not turned.
    pub fn without_log(model: &Model) -> Plant {
        let angles = vec![false; model.link_count()];
        Plant::read_by(model, &Motion::default(), angles)
    }

    /// The plant as a loop reads it, whose sensors know nothing of the times of a log's columns.
    pub fn read_on_time(mut self) -> Plant {
        for joint in &mut self.joints {
            joint.offset_s = 0.0;
        }
        (self.has_offsets, self.late_s) = (false, 0.0);
        self
    }

    /// Whether any motor turns apart from its joint, or the base gives way.
    pub(super) fn has_auxiliary(&self) -> bool {
        self.has_rigid_flanks || self.auxiliary_step_s.is_finite()
    }

    /// How many bodies move beside the links: a motor a joint, and a base that gives way in two
    /// directions; none where all are rigid.
    pub(super) fn auxiliary_bodies(&self) -> usize {
        match (self.has_auxiliary(), &self.base) {
            (false, _) => 0,
            (true, None) => self.len(),
            (true, Some(_)) => self.len() + 2,
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

    /// Number of signals that are predicted: one a joint, and behind those the rate sensors that
    /// joints have beside those of their angles.
    pub fn signals(&self) -> usize {
        self.joints.len() + self.rate_readings.len()
    }

    /// The joints of those rate sensors, in their order.
    pub fn rate_joints(&self) -> &[usize] {
        &self.rate_joints
    }

    /// Whether there is no joint.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }
}

fn each<T>(model: &Model, value: impl Fn(usize) -> T) -> Vec<T> {
    (0..model.link_count()).map(value).collect()
}

/// Longest step, in parts of the time in which a motor swings against its joint by 1 rad, that
/// integrates it well; so for a base.
const AUXILIARY_STEP: f64 = 0.4;

/// The model's longest step, s, or that of the laws that remember from step to step.
fn step_s(of_model_s: f64, joints: &[JointPlan]) -> f64 {
    let of_joint = |joint: &JointPlan| {
        let remembering = joint.remembering().map(|(active, _)| active);
        let laws = remembering.chain(&joint.sense);
        let of_gear = joint.gear_cell.map(|_| REMEMBERED_STEP_S);
        laws.map(|active| active.effect.longest_step_s())
            .chain(of_gear)
            .fold(f64::INFINITY, f64::min)
    };
    joints.iter().map(of_joint).fold(of_model_s, f64::min)
}

/// Whether any joint has such a gear.
fn any_coupling(joints: &[JointPlan], is: impl Fn(&Coupling) -> bool) -> bool {
    joints
        .iter()
        .any(|joint| joint.coupling.as_ref().is_some_and(&is))
}

/// See [`Plant::auxiliary_step_s`].
fn auxiliary_step_s(joints: &[JointPlan], base: Option<BaseSpring>) -> f64 {
    let motors = joints.iter().filter_map(|joint| joint.coupling);
    let giving = motors.filter(|coupling| !coupling.has_rigid_flanks);
    let natural_rad_s = giving.map(|coupling| coupling.natural_rad_s);
    let base = base.map(|base| base.natural_rad_s());
    let steps = natural_rad_s
        .chain(base)
        .map(|natural_rad_s| AUXILIARY_STEP / natural_rad_s);
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn laws_that_remember_go_on_in_short_steps() {
        let toml = r#"
[rig]
name = "arm"
angle_zero = "hanging"
step_s = 0.01

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 0.002

[[joint]]
drive = "torque"

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad" }
input = { column = "u", unit = "N m" }
"#;
        let step_s = |effect: &str| {
            let model = Model::parse(&format!("{toml}{effect}"), Path::new("arm.toml")).unwrap();
            Plant::without_log(&model).step_s
        };
        assert_eq!(step_s(""), 0.01);
        let viscous = "[[effect]]\nkind = \"viscous\"\njoint = 1\ncoefficient_nm_s_rad = 0.01\n";
        assert_eq!(step_s(viscous), 0.01);
        let lag = "[[effect]]\nkind = \"drive_lag\"\njoint = 1\ntime_constant_s = 0.05\n";
        assert_eq!(step_s(lag), REMEMBERED_STEP_S);
        let trails = "[[effect]]\nkind = \"sensor_lag\"\njoint = 1\ntime_constant_s = 0.05\n";
        assert_eq!(step_s(trails), REMEMBERED_STEP_S);
    }
}
