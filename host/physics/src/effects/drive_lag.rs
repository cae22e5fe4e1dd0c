//! Lag of the drive: a filter lies between the input that arrives and the one that is obeyed.

use super::memory::Obeyed;
use super::{
    EffectInfo, Law, MemoryCell, Needs, OnSlide, Parameter, Scope, Site, StartUnknown, StepState,
};

/// T v' + v = u: a first-order low-pass filter, solved exactly for an input that stays over a step.
/// It remembers v, the input that it has reached.
#[derive(Debug)]
pub struct DriveLag;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "drive_lag",
    title: "lag of the drive",
    aliases: &[
        "lag",
        "actuator lag",
        "actuator dynamics",
        "activation filter",
        "input filter",
        "command filter",
        "current loop",
        "current loop bandwidth",
        "low-pass",
        "first-order lag",
    ],
    site: Site::Command,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "time_constant_s * d(obeyed)/dt + obeyed = input",
    parameters: &[
        Parameter::of("time_constant_s", "time constant of the filter")
            .off(0.0)
            .typical(0.01, 0.2)
            .bounds(0.0, 2.0)
            .starts(&[0.03, 0.1]),
    ],
    looks_like: "the motion trails the command and rounds off its steps; a fall after the torque \
     is off is not late",
    confused_with: &[
        "delay: both are late after a step; a delay rounds nothing off",
        "slew_limit: both arrive as a ramp; a filter takes the same time for small and large steps",
        "sensor_lag: both trail and round off; a filter of the reading trails a free fall, too",
        "gear_compliance: both answer late; only a spring rings",
    ],
    experiment: "drive a chirp, then switch the torque off in mid-motion: a filter of the input \
     shrinks what is fast, and the fall is on time",
    reference: "MuJoCo documentation, actuator, dyntype \"filter\"; Ljung, System Identification, \
     2nd ed., section 4.2",
};

impl Law for DriveLag {
    fn remembers(&self) -> bool {
        true
    }

    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Input { is_slow: true })
    }

    /// Not a number: the first input had long been there.
    fn recall(&self, _values: &[f64], _at: &StepState) -> MemoryCell {
        Obeyed { input: f64::NAN }.into()
    }

    fn recall_unknown(&self, _values: &[f64], input: f64, _at: &StepState) -> MemoryCell {
        Obeyed { input }.into()
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, step_s: f64) {
        let way = at.input - Obeyed::from(*memory).input;
        let input = if at.energised && values[0] > 0.0 && !way.is_nan() {
            at.input - way * (-step_s / values[0]).exp()
        } else {
            at.input
        };
        *memory = Obeyed { input }.into();
    }

    /// The mean over the step.
    fn obey(&self, values: &[f64], memory: MemoryCell, input: f64, step_s: f64) -> f64 {
        let way = input - Obeyed::from(memory).input;
        if way.is_nan() || values[0] <= 0.0 || step_s <= 0.0 {
            return input;
        }
        let steps = step_s / values[0];
        input + way * (-steps).exp_m1() / steps
    }
}
