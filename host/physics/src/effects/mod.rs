//! The library of physical effects: each states its law once, and describes itself for people.
//!
//! Adding one is a file with an `INFO` and the hook of its site, and a line in [`EFFECTS`], which
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
mod drive_lag;
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
mod memory;
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
pub use effect::{Effect, Law, REMEMBERED_STEP_S, SMOOTH_DIFFERENCE};
pub use gear::{Coupling, Flank, Gear};
pub use info::{Axis, Confusion, EffectInfo, Needs, OnSlide, Parameter, Scope, Site, ValueBehind};
pub use look_up::{NameMatch, listed, look_up};
pub use memory::{BodyState, MemoryCell, SenseMemory};
pub use placebo::PLACEBO;
pub use probe::ProbeVariable;
pub use state::{
    AtRest, DriveState, Encoded, FrictionState, JointState, Rig, Signals, Slope, StartUnknown,
    StepState,
};
pub use torque_scale::TORQUE_SCALE;
pub use unit_suffix::split_unit;

/// Every effect there is, in the order in which those of one site act.
pub static EFFECTS: &[Effect] = &[
    Effect::of(&delay::Delay, &delay::INFO),
    Effect::of(&slew_limit::SlewLimit, &slew_limit::INFO),
    Effect::of(&drive_lag::DriveLag, &drive_lag::INFO),
    Effect::of(&dead_zone::DeadZone, &dead_zone::INFO),
    Effect::of(
        &supply_sensitivity::SupplySensitivity,
        &supply_sensitivity::INFO,
    ),
    Effect::of(&supply_sag::SupplySag, &supply_sag::INFO),
    TORQUE_SCALE,
    Effect::of(&speed_limit::SpeedLimit, &speed_limit::INFO),
    Effect::of(
        &torque_saturation::TorqueSaturation,
        &torque_saturation::INFO,
    ),
    Effect::of(&thermal_drift::ThermalDrift, &thermal_drift::INFO),
    Effect::of(&fold_back::FoldBack, &fold_back::INFO),
    Effect::of(&gear_compliance::GearCompliance, &gear_compliance::INFO),
    Effect::of(&gear_backlash::GearBacklash, &gear_backlash::INFO),
    Effect::of(&coulomb::Coulomb, &coulomb::INFO),
    Effect::of(&stribeck::Stribeck, &stribeck::INFO),
    Effect::of(&load_friction::LoadFriction, &load_friction::INFO),
    Effect::of(&drive_asymmetry::DriveAsymmetry, &drive_asymmetry::INFO),
    Effect::of(&bearing_friction::BearingFriction, &bearing_friction::INFO),
    Effect::of(
        &direction_asymmetry::DirectionAsymmetry,
        &direction_asymmetry::INFO,
    ),
    Effect::of(
        &position_friction::PositionFriction,
        &position_friction::INFO,
    ),
    Effect::of(&viscous::Viscous, &viscous::INFO),
    Effect::of(&air_drag::AirDrag, &air_drag::INFO),
    Effect::of(&cable_spring::CableSpring, &cable_spring::INFO),
    Effect::of(&cogging::Cogging, &cogging::INFO),
    Effect::of(&torque_offset::TorqueOffset, &torque_offset::INFO),
    Effect::of(&pre_sliding::PreSliding, &pre_sliding::INFO),
    Effect::of(&com_angle::ComAngle, &com_angle::INFO),
    Effect::of(&mass::Mass, &mass::INFO),
    Effect::of(&armature::Armature, &armature::INFO),
    Effect::of(&base_tilt::BaseTilt, &base_tilt::INFO),
    Effect::of(&base_compliance::BaseCompliance, &base_compliance::INFO),
    Effect::of(&encoder_scale::EncoderScale, &encoder_scale::INFO),
    Effect::of(&encoder_zero::EncoderZero, &encoder_zero::INFO),
    Effect::of(&grip_slip::GripSlip, &grip_slip::INFO),
    Effect::of(&backlash::Backlash, &backlash::INFO),
    Effect::of(&sensor_lag::SensorLag, &sensor_lag::INFO),
    Effect::of(&time_offset::TimeOffset, &time_offset::INFO),
    Effect::of(&rate_scale::RateScale, &rate_scale::INFO),
    Effect::of(&rate_bias::RateBias, &rate_bias::INFO),
    Effect::of(&rate_lag::RateLag, &rate_lag::INFO),
];

/// Not physics: what diagnosis runs along to learn what chance gains.
pub static CONTROLS: &[Effect] = &[
    Effect::of(&placebo::Placebo, &placebo::INFO),
    probe::TIMING_PROBE,
    probe::DRIVE_PROBE,
    probe::JOINT_PROBE,
    probe::BODY_PROBE,
    probe::ENCODER_PROBE,
    probe::SENSOR_PROBE,
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
