//! The library of physical effects: each states its law once, and describes itself for people.
//!
//! Adding one is a file with an `info()` and the hook of its site, and a line in [`EFFECTS`], which
//! simulator, effect pages, candidates, the fit's bounds and the law tests iterate.

mod air_drag;
mod armature;
mod backlash;
mod base_compliance;
mod base_tilt;
mod bearing_friction;
mod cable_spring;
mod cogging;
mod com_angle;
mod coulomb;
mod dead_zone;
mod delay;
mod direction_asymmetry;
mod drive_asymmetry;
mod effect;
mod encoder_scale;
mod encoder_zero;
pub mod expression;
mod fold_back;
mod gear;
mod gear_backlash;
mod gear_compliance;
mod grip_slip;
mod info;
mod load_friction;
mod look_up;
mod mass;
mod placebo;
mod position_friction;
mod pre_sliding;
mod probe;
mod rate_bias;
mod rate_lag;
mod rate_scale;
mod sensor_lag;
mod slew_limit;
mod speed_limit;
mod state;
mod stribeck;
mod supply_sag;
mod supply_sensitivity;
mod thermal_drift;
mod time_offset;
mod torque_offset;
mod torque_saturation;
mod torque_scale;
mod unit_suffix;
mod viscous;

pub mod signature;

#[cfg(test)]
mod tests;

pub use base_compliance::BaseSpring;
pub use effect::{Effect, Law, SMOOTH_DIFFERENCE};
pub use gear::{Coupling, Gear};
pub use info::{Axis, Confusion, EffectInfo, Needs, OnSlide, Parameter, Scope, Site, ValueBehind};
pub use look_up::{NameMatch, listed, look_up};
pub use placebo::PLACEBO;
pub use probe::{Probe, ProbeVariable};
pub use state::{
    AtRest, DriveState, Encoded, FrictionState, JointState, MemoryCell, Rig, SenseMemory, Slope,
    StepState,
};
pub use torque_scale::TorqueScale;
pub use unit_suffix::split_unit;

/// Every effect there is, in the order in which those of one site act.
pub static EFFECTS: &[Effect] = &[
    Effect::of(&delay::Delay),
    Effect::of(&slew_limit::SlewLimit),
    Effect::of(&dead_zone::DeadZone),
    Effect::of(&supply_sensitivity::SupplySensitivity),
    Effect::of(&supply_sag::SupplySag),
    Effect::of(&torque_scale::TorqueScale),
    Effect::of(&speed_limit::SpeedLimit),
    Effect::of(&torque_saturation::TorqueSaturation),
    Effect::of(&thermal_drift::ThermalDrift),
    Effect::of(&fold_back::FoldBack),
    Effect::of(&gear_compliance::GearCompliance),
    Effect::of(&gear_backlash::GearBacklash),
    Effect::of(&coulomb::Coulomb),
    Effect::of(&stribeck::Stribeck),
    Effect::of(&load_friction::LoadFriction),
    Effect::of(&drive_asymmetry::DriveAsymmetry),
    Effect::of(&bearing_friction::BearingFriction),
    Effect::of(&direction_asymmetry::DirectionAsymmetry),
    Effect::of(&position_friction::PositionFriction),
    Effect::of(&viscous::Viscous),
    Effect::of(&air_drag::AirDrag),
    Effect::of(&cable_spring::CableSpring),
    Effect::of(&cogging::Cogging),
    Effect::of(&torque_offset::TorqueOffset),
    Effect::of(&pre_sliding::PreSliding),
    Effect::of(&com_angle::ComAngle),
    Effect::of(&mass::Mass),
    Effect::of(&armature::Armature),
    Effect::of(&base_tilt::BaseTilt),
    Effect::of(&base_compliance::BaseCompliance),
    Effect::of(&encoder_scale::EncoderScale),
    Effect::of(&encoder_zero::EncoderZero),
    Effect::of(&grip_slip::GripSlip),
    Effect::of(&backlash::Backlash),
    Effect::of(&sensor_lag::SensorLag),
    Effect::of(&time_offset::TimeOffset),
    Effect::of(&rate_scale::RateScale),
    Effect::of(&rate_bias::RateBias),
    Effect::of(&rate_lag::RateLag),
];

/// Not physics: what diagnosis runs along to learn what chance gains.
pub static CONTROLS: &[Effect] = &[
    Effect::of(&placebo::Placebo),
    Effect::of(&probe::TIMING_PROBE),
    Effect::of(&probe::DRIVE_PROBE),
    Effect::of(&probe::JOINT_PROBE),
    Effect::of(&probe::BODY_PROBE),
    Effect::of(&probe::ENCODER_PROBE),
    Effect::of(&probe::SENSOR_PROBE),
];

/// The effect (or control) of this id, or what a model file last defined by this name.
pub fn named(id: &str) -> Option<Effect> {
    EFFECTS
        .iter()
        .chain(CONTROLS)
        .copied()
        .find(|effect| effect.info().id == id)
        .or_else(|| expression::named(id))
}

/// A value of an effect by its key, which may be that of a joint that slides.
pub fn parameter(id: &str, key: &str) -> Option<&'static Parameter> {
    let effect = named(id)?;
    let kinds = [Axis::Hinge, Axis::Slide].into_iter();
    let kinds = kinds.filter_map(|axis| effect.on(axis));
    let mut parameters = kinds.flat_map(|effect| effect.info().parameters);
    parameters.find(|parameter| parameter.key == key)
}

/// What follows the id of an effect that acts on no single joint, in addresses: nothing for one of
/// the whole rig, `@all` for one of all driven joints.
pub fn at_all(id: &str) -> &'static str {
    match named(id).map(|effect| effect.info().scope) {
        Some(Scope::WholeRig) | None => "",
        Some(_) => "@all",
    }
}
