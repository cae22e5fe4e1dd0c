//! Transport delay: the drive acts on an input that is some time old.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, StartUnknown};

/// u(t - T).
#[derive(Debug)]
pub struct Delay;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "delay",
    title: "transport delay",
    aliases: &[
        "latency",
        "lag",
        "dead time",
        "time delay",
        "transport lag",
        "input delay",
        "communication delay",
    ],
    site: Site::Timing,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "the drive applies u(t - delay_s)",
    parameters: &[Parameter::of("delay_s", "age of the input when it acts")
        .off(0.0)
        .typical(0.005, 0.1)
        .bounds(0.0, 0.5)
        .starts(&[0.02, 0.08])],
    looks_like: "the simulated motion runs ahead of the measured one by the same time at every \
     speed; input and residual correlate best at that lag",
    confused_with: &[
        "gear_compliance: both answer late; only a spring rings",
        "drive_lag: both are late after a step; a delay rounds nothing off",
        "slew_limit: both are late after a step; a delay is the same for small and large ones",
        "sensor_lag: both lag; a filter also flattens fast motion, and it lags a free swing too",
        "time_offset: a late input and a late reading look alike while the drive moves the joint; \
         what needs no input, a fall after the torque is off or a passive joint, is then not late",
        "viscous: both trail the input; friction trails less as the motion slows",
    ],
    experiment: "drive a chirp: only a delay's phase grows in proportion to the frequency",
    reference: "Ljung, System Identification, 2nd ed., section 4.2",
};

impl Law for Delay {
    fn delay_s(&self, values: &[f64]) -> f64 {
        values[0]
    }

    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Input { is_slow: false })
    }
}
