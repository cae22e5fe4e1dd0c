//! What an effect may change: a hook for each site, on the axis of its joint.

use super::{
    AtRest, Axis, DriveState, EffectInfo, Encoded, FrictionState, Gear, JointState, MemoryCell,
    OnSlide, Rig, SenseMemory, Site, Slope, StartUnknown, StepState, ValueBehind,
};
use std::{fmt, ops};

/// Relative step of a finite difference in the values of a smooth law.
pub const SMOOTH_DIFFERENCE: f64 = 2e-4;

/// Longest step over which most laws that remember from step to step go on well, s.
pub const REMEMBERED_STEP_S: f64 = 0.0051;

/// A law by which joints depart from the rigid chain with ideal drives and sensors.
///
/// It is one law for both kinds of joint: in rad and N m where the joint turns, in m and N where it
/// slides. Every hook's default is identity; an effect overrides that of its site. `values` are in
/// its parameters' order.
pub trait Law: Sync + fmt::Debug {
    /// Whether a model file defines it: see [`super::expression`].
    fn is_users(&self) -> bool {
        false
    }

    /// Relative step of a finite difference in its values: large where the law jumps, so that a
    /// difference sees the jumps pass.
    fn difference(&self) -> f64 {
        SMOOTH_DIFFERENCE
    }

    /// Longest step over which what it remembers from step to step goes on well, s.
    fn longest_step_s(&self) -> f64 {
        REMEMBERED_STEP_S
    }

    /// Whether it comes with the servo; `None` where its site tells. See [`Effect::is_of_servo`].
    fn comes_with_servo(&self) -> Option<bool> {
        None
    }

    /// The value of the model that it changes where that is all it does: measured on the rig, such
    /// a value leaves nothing for the effect.
    fn value_behind(&self) -> Option<ValueBehind> {
        None
    }

    /// Whether it has a meaning where the robot is one in space, not a planar chain.
    fn acts_in_space(&self) -> bool {
        true
    }

    /// Body: changes the rig's constants before a motion is simulated.
    fn body(&self, _values: &[f64], _joint: usize, _rig: &mut Rig) {}

    /// Timing: seconds by which the drive's input arrives late.
    fn delay_s(&self, _values: &[f64]) -> f64 {
        0.0
    }

    /// Command: the duty (share of full range, -1 to 1) the drive really applies.
    fn command(&self, _values: &[f64], duty: f64) -> f64 {
        duty
    }

    /// Command: the mean of [`Law::command`] over the duties up to `spread` to either side of this
    /// one, as a step sees it through which the duty moves so far. A law that jumps says it, so
    /// that where within a step it jumps counts.
    fn mean_command(&self, values: &[f64], duty: f64, _spread: f64) -> f64 {
        self.command(values, duty)
    }

    /// Command: by how much the duty jumps that the drive applies.
    fn command_jump(&self, _values: &[f64]) -> f64 {
        0.0
    }

    /// Drive: the torque that arrives at the joint, N m, while the drive is energised.
    fn drive(&self, _values: &[f64], torque_nm: f64, _at: &DriveState) -> f64 {
        torque_nm
    }

    /// Gear: changes what lies between a motor and its joint.
    fn gear(&self, _values: &[f64], _gear: &mut Gear) {}

    /// Joint: a torque on the joint, N m, smooth in angle and speed.
    fn torque(&self, _values: &[f64], _at: &JointState) -> f64 {
        0.0
    }

    /// Friction: magnitude opposing the motion, N m, not below zero in sum. At `speed_rad_s = 0` it
    /// is the breakaway torque: a joint at rest is held until pushed harder than that.
    fn friction(&self, _values: &[f64], _at: &FrictionState) -> f64 {
        0.0
    }

    /// Friction: whether it is the same at every speed and load until the joint turns back, which
    /// is simulated faster.
    fn friction_is_constant(&self) -> bool {
        false
    }

    /// Command, drive or joint, with memory: whether what it does depends on what was before. It
    /// then has a [`MemoryCell`] at each joint, which comes with the state of the hook of its site;
    /// a type of its own says what is in it.
    fn remembers(&self) -> bool {
        false
    }

    /// What it remembers where a motion begins in this state and nothing earlier is known.
    fn recall(&self, _values: &[f64], _at: &StepState) -> MemoryCell {
        MemoryCell::EMPTY
    }

    /// What of the time before a simulation neither its start state nor any reading tells, and a
    /// fit estimates. What remembers, trails or is late says so, [`StartUnknown::Nothing`] too.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        None
    }

    /// Command, drive or joint, with memory: what it remembers where its unknown is so much in this
    /// state.
    fn recall_unknown(&self, values: &[f64], _unknown: f64, at: &StepState) -> MemoryCell {
        self.recall(values, at)
    }

    /// The unknown displacement that it remembers.
    fn displacement(&self, _memory: MemoryCell) -> f64 {
        0.0
    }

    /// What it remembers after a step of `step_s` that ended in this state.
    fn remember(&self, _values: &[f64], _memory: &mut MemoryCell, _at: &StepState, _step_s: f64) {}

    /// Command, with memory: the mean input followed during a step in which `input` arrives.
    fn obey(&self, _values: &[f64], _memory: MemoryCell, input: f64, _step_s: f64) -> f64 {
        input
    }

    /// Encoder: what it reads at this joint angle, rad.
    fn encode(&self, _values: &[f64], angle_rad: f64) -> f64 {
        angle_rad
    }

    /// Rate: what a sensor of rates reads at rest, rad/s.
    fn rate_bias_rad_s(&self, _values: &[f64]) -> f64 {
        0.0
    }

    /// Rate: what a sensor of rates reads per rate.
    fn rate_scale(&self, _values: &[f64]) -> f64 {
        1.0
    }

    /// Sensor or rate, with memory: how far the reading trails, rad, while the encoded angle has
    /// long changed by `speed_rad_s`; of a rate rad/s and rad/s^2. `None` where the past decides.
    fn trail_rad(&self, _values: &[f64], _speed_rad_s: f64) -> Option<f64> {
        None
    }

    /// Sensor, of the log: by how much later than the encoder read it a row holds a reading, s;
    /// `None` where the rows' times are right. It moves what is logged and acts in no loop.
    fn reading_offset_s(&self, _values: &[f64]) -> Option<f64> {
        None
    }

    /// Derivative of the law with the rig at rest, for linear models; `None` where the law has
    /// none. Bodies and delays need none: they are taken as they are.
    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        None
    }

    /// Sensor or rate, with memory: the reading after `step_s` at whose end the shaft is `encoded`.
    /// `memory` is the effect's own, of the call before; `None` before the first call of a motion,
    /// which reads the angle itself.
    fn sense(
        &self,
        _values: &[f64],
        _memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        _step_s: f64,
    ) -> f64 {
        encoded.angle_rad
    }

    /// Sensor, with memory: by how much the encoded angle has come to be ahead of the reading by
    /// what was before, rad, and how fast it draws away, rad/s.
    fn slipped(&self, _memory: SenseMemory) -> [f64; 2] {
        [0.0; 2]
    }

    /// Sensor whose displacement is hidden: what it remembers where it has [slipped](Self::slipped)
    /// by as much, as far as it goes.
    fn slip(&self, _values: &[f64], _slipped: [f64; 2]) -> SenseMemory {
        SenseMemory::default()
    }
}

/// A departure from the rigid chain with ideal drives and sensors: a law, what there is to say of
/// it, and how the joints move whose units its values have.
#[derive(Clone, Copy)]
pub struct Effect {
    law: &'static dyn Law,
    info: &'static EffectInfo,
    axis: Axis,
}

impl Effect {
    /// The effect of a law at joints that turn.
    pub(super) const fn of(law: &'static dyn Law, info: &'static EffectInfo) -> Effect {
        Effect {
            law,
            info,
            axis: Axis::Hinge,
        }
    }

    /// What people and tools need to know of it at a joint of its axis.
    pub fn info(self) -> &'static EffectInfo {
        match (self.axis, self.info.on_slide) {
            (Axis::Slide, OnSlide::Own(info)) => info,
            _ => self.info,
        }
    }

    /// Whether it comes with the servo or its driver, so that joints of one servo type may share
    /// it with the same values; else with the link, the bearing or the calibration of one joint.
    pub fn is_of_servo(self) -> bool {
        use Site::{Command, Drive, Friction, Gear, Sensor, Timing};
        let by_site = || {
            matches!(
                self.info.site,
                Timing | Command | Drive | Gear | Friction | Sensor
            )
        };
        self.law.comes_with_servo().unwrap_or_else(by_site)
    }

    /// The joints whose units its values have.
    pub fn axis(self) -> Axis {
        self.axis
    }

    /// It at a joint of this kind; none where it cannot act.
    pub fn on(self, axis: Axis) -> Option<Effect> {
        let acts = axis == Axis::Hinge || !matches!(self.info.on_slide, OnSlide::Never);
        acts.then_some(Effect { axis, ..self })
    }
}

impl ops::Deref for Effect {
    type Target = dyn Law;

    fn deref(&self) -> &Self::Target {
        self.law
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Effect) -> bool {
        self.info.id == other.info.id
    }
}

impl fmt::Debug for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({:?})", self.info.id, self.axis)
    }
}
