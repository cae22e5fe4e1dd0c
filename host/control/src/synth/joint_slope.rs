//! One joint at the operating point: what holds it, and the first-order change of its torque.

use super::error::DesignError;
use super::omitted::OmittedEffect;
use crate::effects::{
    AtRest, CONTROLS, DriveState, EFFECTS, Effect, JointState, MemoryCell, Site, Slope, StepState,
};
use crate::model::{Drive, EffectInstance, JointNames, Model};

/// Most steps of Newton's iteration for the duty that holds a torque.
const MOST_STEPS: usize = 50;

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

/// A joint that is held in its pose.
pub(super) struct HeldJoint {
    pub slope: JointSlope,
    /// Input that holds it; none of a passive joint.
    pub input: Option<f64>,
    pub omitted: Vec<OmittedEffect>,
}

/// One joint and what acts on it.
pub(super) struct JointAt<'a> {
    model: &'a Model,
    joint: usize,
    /// Of its place, speed and torque.
    units: [&'static str; 3],
    drive: &'a Drive,
    effects: Vec<&'a EffectInstance>,
    angle_rad: f64,
    pose_rad: f64,
}

impl<'a> JointAt<'a> {
    pub fn new(
        model: &'a Model,
        joint: usize,
        relative_rad: &[f64],
        pose_rad: &[f64],
    ) -> JointAt<'a> {
        // Those of one site act in the library's order, however the file lists them.
        let mut effects = Vec::new();
        for effect in EFFECTS.iter().chain(CONTROLS) {
            effects.extend(model.effects_at(joint).filter(|e| e.effect == *effect));
        }
        let users = |e: &&EffectInstance| e.effect.is_users() && e.joint == Some(joint);
        effects.extend(model.effects.iter().filter(users));
        effects
            .retain(|e| !matches!(e.effect.info().site, Site::Body | Site::Timing) && !vanishes(e));
        JointAt {
            model,
            joint,
            units: model.joints[joint].units(),
            drive: &model.joints[joint].drive,
            effects,
            angle_rad: relative_rad[joint] - model.zero_rad(joint),
            pose_rad: pose_rad[joint],
        }
    }

    /// Effects of a site with their values and slopes; one without a slope is added to `omitted`.
    fn slopes(
        &self,
        site: Site,
        at: AtRest,
        omitted: &mut Vec<OmittedEffect>,
    ) -> Vec<(Effect, &'a [f64], Slope)> {
        let mut slopes = Vec::new();
        for e in self.effects.iter().filter(|e| e.effect.info().site == site) {
            match e.effect.slope(&e.values, &at) {
                Some(slope) => slopes.push((e.effect, e.values.as_slice(), slope)),
                None => omitted.push(OmittedEffect::new(e.effect, Some(self.joint))),
            }
        }
        slopes
    }

    /// What messages call it.
    fn label(&self) -> String {
        JointNames::of(self.model).label(self.joint)
    }

    fn at_rest(&self) -> AtRest {
        AtRest {
            angle_rad: self.angle_rad,
            duty: 0.0,
            torque_nm: 0.0,
            full_torque_nm: self.drive.motor().map_or(1.0, |m| m.stall_torque_nm),
        }
    }

    /// Torque of the smooth joint effects, N m, and its slope; those that are not smooth are added
    /// to `omitted`.
    pub fn torque(&self, omitted: &mut Vec<OmittedEffect>) -> (f64, Slope) {
        let mut state = JointState::undriven(self.angle_rad, 0.0);
        let at = StepState::at_rest(self.angle_rad);
        let (mut torque_nm, mut sum) = (0.0, Slope::NONE);
        for (effect, values, slope) in self.slopes(Site::Joint, self.at_rest(), omitted) {
            state.memory = effect.recall(values, &at);
            torque_nm += effect.torque(values, &state);
            sum.per_rad += slope.per_rad;
            sum.per_rad_s += slope.per_rad_s;
        }
        (torque_nm, sum)
    }

    /// Slopes, and the input that holds `gravity_nm`; a passive joint must balance within
    /// `slack_nm`.
    pub fn held(&self, gravity_nm: f64, slack_nm: f64) -> Result<HeldJoint, DesignError> {
        let (at, mut omitted) = (self.at_rest(), Vec::new());
        for site in [Site::Command, Site::Gear, Site::Friction, Site::Sensor] {
            self.slopes(site, at, &mut omitted);
        }
        let (own_nm, own) = self.torque(&mut omitted);
        let mut slope = JointSlope {
            per_rad: own.per_rad,
            per_rad_s: own.per_rad_s,
            reading: 1.0,
            ..JointSlope::default()
        };
        let mut reading_rad = self.pose_rad;
        for (effect, values, encoder) in self.slopes(Site::Encoder, at, &mut omitted) {
            slope.reading *= encoder.gain;
            reading_rad = effect.encode(values, reading_rad);
        }
        let needed_nm = gravity_nm - own_nm;
        let input = if self.drive.is_driven() {
            let (duty, drive) = self.duty(needed_nm, &mut omitted)?;
            slope.per_rad_s += drive.per_rad_s;
            Some(self.input(duty, drive.per_duty, reading_rad, &mut slope))
        } else if needed_nm.abs() <= slack_nm {
            None
        } else {
            let [angle_unit, _, torque_unit] = self.units;
            return Err(DesignError::model(
                format!(
                    "joint {} is passive and {needed_nm:.3e} {torque_unit} would have to hold it \
                     at {} {angle_unit}: the pose is no equilibrium",
                    self.label(),
                    self.pose_rad
                ),
                "choose a pose in which every passive joint balances; --balance finds the nearest",
            ));
        };
        Ok(HeldJoint {
            slope,
            input,
            omitted,
        })
    }

    /// Duty that makes `needed_nm` and the torque's slope there, by Newton's iteration: one step
    /// where the torque is linear in the duty.
    fn duty(
        &self,
        needed_nm: f64,
        omitted: &mut Vec<OmittedEffect>,
    ) -> Result<(f64, Slope), DesignError> {
        let mut at = self.at_rest();
        let (full_torque_nm, motor) = (at.full_torque_nm, self.drive.motor());
        at.duty = needed_nm / full_torque_nm;
        for _ in 0..MOST_STEPS {
            let mut without = Vec::new();
            let (torque_nm, slope) = self.driven(at, &mut without);
            let off_nm = needed_nm - torque_nm;
            if off_nm.abs() <= 1e-12 * full_torque_nm.max(needed_nm.abs()) {
                if motor.is_some() && at.duty.abs() >= 1.0 {
                    break;
                }
                omitted.extend(without);
                return Ok((at.duty, slope));
            }
            at.duty += off_nm / slope.per_duty;
        }
        Err(DesignError::model(
            format!(
                "joint {} needs {needed_nm:.3} {} to hold the pose, more than its drive can give",
                self.label(),
                self.units[2]
            ),
            "choose a pose that asks less of it",
        ))
    }

    /// Torque of the drive at a duty, N m, with its slope. An effect without a slope still limits
    /// the torque: beyond a limit nothing holds the pose.
    fn driven(&self, mut at: AtRest, omitted: &mut Vec<OmittedEffect>) -> (f64, Slope) {
        let state = DriveState {
            speed_rad_s: 0.0,
            duty: at.duty,
            full_torque_nm: at.full_torque_nm,
            supply_ratio: 1.0,
            memory: MemoryCell::EMPTY,
        };
        at.torque_nm = at.full_torque_nm * at.duty;
        let no_load = self.drive.motor().map(|m| m.no_load_speed_rad_s);
        let mut sum = Slope {
            per_duty: at.full_torque_nm,
            per_rad_s: no_load.map_or(0.0, |speed| -at.full_torque_nm / speed),
            ..Slope::NONE
        };
        let at_drive = |e: &&&EffectInstance| e.effect.info().site == Site::Drive;
        for e in self.effects.iter().filter(at_drive) {
            let slope = e.effect.slope(&e.values, &at).unwrap_or_else(|| {
                omitted.push(OmittedEffect::new(e.effect, Some(self.joint)));
                Slope::NONE
            });
            at.torque_nm = e.effect.drive(&e.values, at.torque_nm, &state);
            sum.per_duty = slope.gain * sum.per_duty + slope.per_duty;
            sum.per_rad_s = slope.gain * sum.per_rad_s + slope.per_rad_s;
        }
        (at.torque_nm, sum)
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
    let parameters = instance.effect.info().parameters.iter();
    let values = parameters.zip(&instance.values);
    let mut off = values.filter_map(|(parameter, value)| Some(parameter.off? == *value));
    off.next().is_some_and(|first| first && off.all(|off| off))
}
