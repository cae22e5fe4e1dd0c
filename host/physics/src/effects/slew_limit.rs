//! Slew limit: a servo's profile, or a driver's ramp, lets its input change no faster than so much.

use super::memory::Obeyed;
use super::{
    AtRest, EffectInfo, Law, MemoryCell, Needs, OnSlide, Parameter, Scope, Site, Slope,
    StartUnknown, StepState,
};

/// |d input / dt| <= r. It remembers the input that it has reached.
#[derive(Debug)]
pub struct SlewLimit;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "slew_limit",
    title: "slew limit of the drive",
    aliases: &[
        "slew rate",
        "rate limit",
        "rate limiter",
        "ramp limit",
        "acceleration limit",
    ],
    site: Site::Command,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "the input that is obeyed follows the one that arrives by at most rate_per_s a second",
    parameters: &[Parameter::of(
        "rate_per_s",
        "fastest change of the input: full duties a second, or goal in rad (m) a second",
    )
    .off(f64::INFINITY)
    .typical(1.0, 20.0)
    .bounds(0.01, 10000.0)
    .starts(&[5.0, 2.0, 15.0])],
    looks_like: "small changes of the input are obeyed at once, large steps arrive late and as a \
     ramp; the delay grows with the height of the step",
    confused_with: &[
        "drive_lag: both arrive as a ramp; a filter takes the same time for small and large steps",
        "delay: both are late after a step; a delay is the same for small and large ones",
        "torque_saturation: both blunt strong commands; the limit of torque stays while the \
         command stays, a ramp ends",
    ],
    experiment: "step the input by three heights, from rest: the time until it is obeyed must grow \
     with the height",
    reference: "ROBOTIS e-Manual, XL330-M288, profile acceleration and profile velocity",
};

impl Law for SlewLimit {
    fn remembers(&self) -> bool {
        true
    }

    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Input { is_slow: true })
    }

    /// Not a number: the first input is obeyed at once.
    fn recall(&self, _values: &[f64], _at: &StepState) -> MemoryCell {
        Obeyed { input: f64::NAN }.into()
    }

    fn recall_unknown(&self, _values: &[f64], input: f64, _at: &StepState) -> MemoryCell {
        Obeyed { input }.into()
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, step_s: f64) {
        let before = Obeyed::from(*memory).input;
        let input = if at.energised {
            reached(values[0], before, at.input, step_s)
        } else {
            at.input
        };
        *memory = Obeyed { input }.into();
    }

    /// The mean over the step of a ramp that may end within it.
    fn obey(&self, values: &[f64], memory: MemoryCell, input: f64, step_s: f64) -> f64 {
        let before = Obeyed::from(memory).input;
        let (rate, way) = (values[0], input - before);
        if way.is_nan() || !rate.is_finite() || step_s <= 0.0 {
            return input;
        }
        if way.abs() > rate * step_s {
            before + 0.5 * rate * step_s * way.signum()
        } else {
            input - 0.5 * way * way.abs() / (rate * step_s)
        }
    }

    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}

/// Input that is obeyed at the end of a step.
fn reached(rate: f64, before: f64, input: f64, step_s: f64) -> f64 {
    if (input - before).abs() > rate * step_s {
        before + rate * step_s * (input - before).signum()
    } else {
        input
    }
}
