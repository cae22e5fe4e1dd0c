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
mod on_slide;
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
mod viscous;

pub mod signature;

#[cfg(test)]
mod tests;

pub use base_compliance::BaseSpring;
pub use effect::{Effect, SMOOTH_DIFFERENCE};
pub use gear::{Coupling, Gear};
pub use info::{Axis, Confusion, EffectInfo, Needs, Parameter, Scope, Site, ValueBehind};
pub use look_up::{NameMatch, listed, look_up};
pub use on_slide::on_axis;
pub use placebo::PLACEBO;
pub use probe::{Probe, ProbeVariable};
pub use state::{
    AtRest, DriveState, Encoded, FrictionState, JointState, MemoryCell, Rig, SenseMemory, Slope,
    StepState,
};
pub use torque_scale::TorqueScale;

/// Every effect there is, in the order in which those of one site act.
pub const EFFECTS: &[&dyn Effect] = &[
    &delay::Delay,
    &slew_limit::SlewLimit,
    &dead_zone::DeadZone,
    &supply_sensitivity::SupplySensitivity,
    &supply_sag::SupplySag,
    &torque_scale::TorqueScale,
    &speed_limit::SpeedLimit,
    &torque_saturation::TorqueSaturation,
    &thermal_drift::ThermalDrift,
    &fold_back::FoldBack,
    &gear_compliance::GearCompliance,
    &gear_backlash::GearBacklash,
    &coulomb::Coulomb,
    &stribeck::Stribeck,
    &load_friction::LoadFriction,
    &drive_asymmetry::DriveAsymmetry,
    &bearing_friction::BearingFriction,
    &direction_asymmetry::DirectionAsymmetry,
    &position_friction::PositionFriction,
    &viscous::Viscous,
    &air_drag::AirDrag,
    &cable_spring::CableSpring,
    &cogging::Cogging,
    &torque_offset::TorqueOffset,
    &pre_sliding::PreSliding,
    &com_angle::ComAngle,
    &mass::Mass,
    &armature::Armature,
    &base_tilt::BaseTilt,
    &base_compliance::BaseCompliance,
    &encoder_scale::EncoderScale,
    &encoder_zero::EncoderZero,
    &grip_slip::GripSlip,
    &backlash::Backlash,
    &sensor_lag::SensorLag,
    &time_offset::TimeOffset,
    &rate_scale::RateScale,
    &rate_bias::RateBias,
    &rate_lag::RateLag,
];

/// Not physics: what diagnosis runs along to learn what chance gains.
pub const CONTROLS: &[&dyn Effect] = &[
    &placebo::Placebo,
    &probe::TIMING_PROBE,
    &probe::DRIVE_PROBE,
    &probe::JOINT_PROBE,
    &probe::BODY_PROBE,
    &probe::ENCODER_PROBE,
    &probe::SENSOR_PROBE,
];

/// The effect (or control) of this id, or what a model file last defined by this name.
pub fn named(id: &str) -> Option<&'static dyn Effect> {
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
    let kinds = kinds.filter_map(|axis| on_axis(effect, axis));
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
