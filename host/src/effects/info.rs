//! What an effect says of itself.

/// Where in the chain command -> drive -> joint -> body -> sensor an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// On the way to the drive.
    Timing,
    /// On the duty.
    Command,
    /// On the torque the drive makes.
    Drive,
    /// On the joint, as friction.
    Friction,
    /// On the joint, as any other torque.
    Joint,
    /// On masses and gravity.
    Body,
    /// On what is read, at once.
    Encoder,
    /// On what is read, with memory.
    Sensor,
}

/// Which joints an effect can act on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Every joint.
    AnyJoint,
    /// Joints that are driven.
    DrivenJoint,
    /// Joints that swing freely.
    PassiveJoint,
    /// Once for the whole rig.
    WholeRig,
}

/// What must be logged or known for an effect to be a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Nothing beyond angles and inputs.
    Nothing,
    /// The supply, logged and varying, and the motor's nominal supply.
    Supply,
    /// The torque through the gear, computed along with the dynamics.
    GearLoad,
    /// The force in the bearing, computed along with the dynamics.
    BearingLoad,
}

/// One value of an effect.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Key in model files, with its unit: `torque_nm`.
    pub key: &'static str,
    /// Unit as shown to people: `N m`.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Value at which the effect vanishes; `None` for a shape parameter, which has none.
    pub off: Option<f64>,
    /// Range met in practice on servo arms of this size.
    pub typical: (f64, f64),
    /// Physically possible range: signs are enforced by it.
    pub bounds: (f64, f64),
    /// Values to start a fit from, the first being the default.
    pub starts: &'static [f64],
}

/// Another effect that looks alike.
#[derive(Debug, Clone, Copy)]
pub struct Confusion {
    /// Its id.
    pub with: &'static str,
    /// Why they look alike and what tells them apart.
    pub why: &'static str,
}

/// The whole description of an effect.
#[derive(Debug, Clone, Copy)]
pub struct EffectInfo {
    /// Name in commands and model files: `coulomb`.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// Where it acts.
    pub site: Site,
    /// Which joints it can act on.
    pub scope: Scope,
    /// What it takes to be a candidate.
    pub needs: Needs,
    /// The law in one line.
    pub law: &'static str,
    /// Its values.
    pub parameters: &'static [Parameter],
    /// What a log shows.
    pub looks_like: &'static str,
    /// What it is taken for.
    pub confused_with: &'static [Confusion],
    /// The experiment that reveals it.
    pub experiment: &'static str,
    /// Where the law comes from.
    pub reference: &'static str,
}
