//! The rig at rest in a pose: what holds it there, and how every drive and effect answers small changes.

use super::equations::Equations;
use super::pose::{check_size, relative};
use crate::effects::{AtRest, CONTROLS, DriveState, EFFECTS, Effect, JointState, Rig, Site, Slope};
use crate::error::{Error, Result};
use crate::model::{Drive, EffectInstance, Model};

/// Share of the largest gravity torque that a passive joint may be off balance.
const BALANCED: f64 = 1e-6;
/// A rig at rest.
#[derive(Debug, Clone)]
pub struct Rest {
    /// The pose in the model's own convention, rad.
    pub pose_rad: Vec<f64>,
    /// Inputs of the driven joints that hold it, each in the SI unit of its drive.
    pub inputs: Vec<f64>,
    /// Relative angles, the first from hanging, rad.
    pub(super) relative_rad: Vec<f64>,
    pub(super) equations: Equations,
    pub(super) joints: Vec<JointSlope>,
}

/// First-order change of the torque at a joint.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct JointSlope {
    /// Per relative angle, N m/rad.
    pub per_rad: f64,
    /// Per angle in the model's convention, N m/rad.
    pub per_pose_rad: f64,
    /// Per speed, N m s/rad.
    pub per_rad_s: f64,
    /// Per input.
    pub per_input: f64,
    /// Reading per angle in the model's convention.
    pub reading: f64,
}

/// The delay of the drives, s: the same for all of them.
///
/// # Errors
/// Drives that differ in delay.
pub fn input_delay_s(model: &Model) -> Result<f64> {
    let delay = |joint: usize| -> f64 {
        let at = model.effects.iter().filter(|e| e.joint == Some(joint));
        // An empty sum would be -0.
        at.fold(0.0, |sum, e| sum + e.effect.delay_s(&e.values))
    };
    let driven = (0..model.link_count()).filter(|&joint| model.joints[joint].drive.is_driven());
    let delays: Vec<f64> = driven.map(delay).collect();
    let first = delays.first().copied().unwrap_or(0.0);
    match delays.iter().find(|&&delay| delay != first) {
        None => Ok(first),
        Some(other) => Err(Error::design(
            format!("the drives differ in delay: {first} s and {other} s"),
            "give every driven joint the same delay, or choose one with --delay",
        )),
    }
}

impl Rest {
    /// The rig of a model at rest in `pose_rad` (the model's convention of angles).
    ///
    /// # Errors
    /// A pose that nothing holds, or an effect that has no slope there.
    pub fn of(model: &Model, pose_rad: &[f64]) -> Result<Rest> {
        check_size(model, pose_rad)?;
        let n = model.link_count();
        let relative_rad = relative(model, pose_rad);
        let equations = Equations::of(&Rig::of(model, false));
        let gravity_nm = equations.gravity(&relative_rad);
        let scale_nm = (0..n).fold(0.0, |most: f64, joint| {
            let mut level = relative_rad.clone();
            level[0] += std::f64::consts::FRAC_PI_2;
            most.max(gravity_nm[joint].abs())
                .max(equations.gravity(&level)[joint].abs())
        });
        let mut rest = Rest {
            pose_rad: pose_rad.to_vec(),
            inputs: Vec::new(),
            relative_rad,
            equations,
            joints: Vec::new(),
        };
        for (joint, &gravity_nm) in gravity_nm.iter().enumerate() {
            let at = At::new(model, joint, &rest.relative_rad, pose_rad);
            let (slope, input) = at.held(gravity_nm, BALANCED * scale_nm)?;
            rest.inputs.extend(input);
            rest.joints.push(slope);
        }
        Ok(rest)
    }
}

/// What acts at a joint besides gravity and its drive.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Own {
    pub torque_nm: f64,
    pub per_rad: f64,
    pub per_rad_s: f64,
}

/// One joint and what acts on it.
pub(super) struct At<'a> {
    joint: usize,
    drive: &'a Drive,
    effects: Vec<&'a EffectInstance>,
    angle_rad: f64,
    pose_rad: f64,
}

impl<'a> At<'a> {
    pub fn new(model: &'a Model, joint: usize, relative_rad: &[f64], pose_rad: &[f64]) -> At<'a> {
        // Those of one site act in the library's order, however the file lists them.
        let mut effects = Vec::new();
        for effect in EFFECTS.iter().chain(CONTROLS) {
            let here = |e: &&EffectInstance| e.effect == *effect && e.joint == Some(joint);
            effects.extend(model.effects.iter().filter(here));
        }
        effects
            .retain(|e| !matches!(e.effect.info().site, Site::Body | Site::Timing) && !vanishes(e));
        let zero = if joint == 0 {
            model.angle_zero.from_hanging_rad()
        } else {
            0.0
        };
        At {
            joint,
            drive: &model.joints[joint].drive,
            effects,
            angle_rad: relative_rad[joint] - zero,
            pose_rad: pose_rad[joint],
        }
    }

    fn of(&self, site: Site) -> impl Iterator<Item = (&'static dyn Effect, &'a [f64])> + '_ {
        let there = move |e: &&&EffectInstance| e.effect.info().site == site;
        let effects = self.effects.iter().filter(there);
        effects.map(|e| (e.effect, e.values.as_slice()))
    }

    fn slope(&self, effect: &dyn Effect, values: &[f64], at: &AtRest) -> Result<Slope> {
        effect.slope(values, at).ok_or_else(|| {
            let info = effect.info();
            Error::design(
                format!(
                    "{} at joint {} has no slope at rest: {}",
                    info.title,
                    self.joint + 1,
                    info.law
                ),
                format!("design without it: --without {}", info.id),
            )
        })
    }

    /// Torques of springs and the like, with their slopes.
    pub fn own(&self) -> Result<Own> {
        let at = AtRest {
            angle_rad: self.angle_rad,
            duty: 0.0,
            torque_nm: 0.0,
            full_torque_nm: 1.0,
        };
        let state = JointState::undriven(self.angle_rad, 0.0);
        let mut own = Own::default();
        for (effect, values) in self.of(Site::Joint) {
            let slope = self.slope(effect, values, &at)?;
            own.torque_nm += effect.torque(values, &state);
            own.per_rad += slope.per_rad;
            own.per_rad_s += slope.per_rad_s;
        }
        Ok(own)
    }

    /// Slopes, and the input that holds `gravity_nm`; a passive joint must balance within `slack_nm`.
    fn held(&self, gravity_nm: f64, slack_nm: f64) -> Result<(JointSlope, Option<f64>)> {
        let mut at = AtRest {
            angle_rad: self.angle_rad,
            duty: 0.0,
            torque_nm: 0.0,
            full_torque_nm: self.drive.motor().map_or(1.0, |m| m.stall_torque_nm),
        };
        let mut slope = JointSlope {
            reading: 1.0,
            ..JointSlope::default()
        };
        for (effect, values) in self.of(Site::Friction).chain(self.of(Site::Sensor)) {
            self.slope(effect, values, &at)?;
        }
        let own = self.own()?;
        slope.per_rad += own.per_rad;
        slope.per_rad_s += own.per_rad_s;
        let mut reading_rad = self.pose_rad;
        for (effect, values) in self.of(Site::Encoder) {
            slope.reading *= self.slope(effect, values, &at)?.gain;
            reading_rad = effect.encode(values, reading_rad);
        }
        let needed_nm = gravity_nm - own.torque_nm;
        if !self.drive.is_driven() {
            if needed_nm.abs() > slack_nm {
                return Err(Error::design(
                    format!(
                        "joint {} is passive and {needed_nm:.3e} N m would have to hold it at {} rad: the pose is no equilibrium",
                        self.joint + 1,
                        self.pose_rad
                    ),
                    "choose a pose in which every passive joint balances; --balance finds the nearest",
                ));
            }
            return Ok((slope, None));
        }
        let (duty, per_duty, per_rad_s) = self.duty(needed_nm, &mut at)?;
        slope.per_rad_s += per_rad_s;
        let input = self.input(duty, per_duty, reading_rad, &mut slope);
        Ok((slope, Some(input)))
    }

    /// Duty that makes `needed_nm`, and the torque's slopes per duty and per speed there.
    fn duty(&self, needed_nm: f64, at: &mut AtRest) -> Result<(f64, f64, f64)> {
        let no_load = self.drive.motor().map(|m| m.no_load_speed_rad_s);
        for (effect, values) in self.of(Site::Command) {
            self.slope(effect, values, at)?;
        }
        at.duty = needed_nm / at.full_torque_nm;
        // Newton; at once where the torque is a straight line of the duty.
        for _ in 0..50 {
            let mut torque_nm = at.full_torque_nm * at.duty;
            let (mut per_duty, mut per_rad_s) = (
                at.full_torque_nm,
                no_load.map_or(0.0, |speed| -at.full_torque_nm / speed),
            );
            for (effect, values) in self.of(Site::Drive) {
                at.torque_nm = torque_nm;
                let slope = self.slope(effect, values, at)?;
                let state = DriveState {
                    speed_rad_s: 0.0,
                    duty: at.duty,
                    full_torque_nm: at.full_torque_nm,
                    supply_ratio: 1.0,
                };
                torque_nm = effect.drive(values, torque_nm, &state);
                per_duty = slope.gain * per_duty + slope.per_duty;
                per_rad_s = slope.gain * per_rad_s + slope.per_rad_s;
            }
            let off_nm = needed_nm - torque_nm;
            if off_nm.abs() <= 1e-12 * at.full_torque_nm.max(needed_nm.abs()) {
                if no_load.is_some() && at.duty.abs() >= 1.0 {
                    break;
                }
                return Ok((at.duty, per_duty, per_rad_s));
            }
            at.duty += off_nm / per_duty;
        }
        Err(Error::design(
            format!(
                "joint {} needs {needed_nm:.3} N m to hold the pose, more than its drive can give",
                self.joint + 1
            ),
            "choose a pose that asks less of it",
        ))
    }

    /// The input that makes `duty`; completes the slopes.
    fn input(&self, duty: f64, per_duty: f64, reading_rad: f64, slope: &mut JointSlope) -> f64 {
        match self.drive {
            Drive::Passive => 0.0,
            Drive::Torque | Drive::Duty(_) => {
                slope.per_input = per_duty;
                duty
            }
            Drive::Position { gain_per_rad, .. } => {
                slope.per_input = per_duty * gain_per_rad;
                slope.per_pose_rad = -per_duty * gain_per_rad * slope.reading;
                reading_rad + duty / gain_per_rad
            }
            Drive::Speed {
                gain_s_per_rad,
                motor,
            } => {
                let forward = 1.0 / motor.no_load_speed_rad_s;
                slope.per_input = per_duty * (forward + gain_s_per_rad);
                slope.per_rad_s -= per_duty * gain_s_per_rad;
                duty / (forward + gain_s_per_rad)
            }
        }
    }
}

/// Whether an effect's values are those at which it does nothing.
fn vanishes(instance: &EffectInstance) -> bool {
    let mut off = instance
        .effect
        .info()
        .parameters
        .iter()
        .zip(&instance.values);
    let mut any = false;
    let none = off.all(|(parameter, &value)| match parameter.off {
        Some(off) => {
            any = true;
            value == off
        }
        None => true,
    });
    any && none
}
