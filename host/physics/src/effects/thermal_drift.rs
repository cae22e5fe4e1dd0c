//! Thermal drift: the winding warms up under load, its resistance rises, and the torque falls.

use super::memory::remembered;
use super::{
    AtRest, DriveState, EffectInfo, Law, MemoryCell, Needs, OnSlide, Parameter, Scope, Site, Slope,
    StartUnknown, StepState,
};

/// tau / (1 + r x), T x' = u^2 - x. It remembers x, the warmth: 0 cold, 1 after long at full duty.
#[derive(Debug)]
pub struct ThermalDrift;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "thermal_drift",
    title: "thermal drift of the motor",
    aliases: &[
        "heating",
        "motor heating",
        "temperature",
        "winding temperature",
        "warm-up",
        "thermal derating",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "torque / (1 + rise * x), time_constant_s * dx/dt = u^2 - x, x = 0 where a log \
     begins",
    parameters: &[
        Parameter::of(
            "rise",
            "relative rise of the winding's resistance once warm from full duty",
        )
        .off(0.0)
        .typical(0.5, 5.0)
        .bounds(0.0, 300.0)
        .starts(&[3.0, 15.0]),
        Parameter::of(
            "time_constant_s",
            "time in which the winding warms up by 63 %",
        )
        .typical(5.0, 120.0)
        .bounds(1.0, 3600.0)
        .starts(&[10.0, 40.0]),
    ],
    looks_like: "the same command gives less torque the longer the log; cold again, it is as at \
     first",
    confused_with: &[
        "torque_scale: both weaken every command; a scale is there from the first second",
        "supply_sag: both weaken strong commands; sag is there at once and gone at once",
        "fold_back: both come after a while; folding back comes at one instant",
    ],
    experiment: "repeat one motion without a break until nothing changes any more, let the motor \
     cool, and repeat it once",
    reference: "Mellor, Roberts, Turner, IEE Proceedings B 138 (1991) 205, with one body",
};

/// How warm the motor is: the mean square of the duty, the latest counting most.
struct Warmth {
    mean_square: f64,
}
remembered!(Warmth { mean_square });

impl Law for ThermalDrift {
    fn remembers(&self) -> bool {
        true
    }

    /// A motor that is warm before a log, and stays so, is weaker by a factor: every wrong stall
    /// torque would have this law beside it.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Nothing)
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, step_s: f64) {
        let share = 1.0 - (-step_s / values[1]).exp();
        let Warmth { mean_square } = Warmth::from(*memory);
        let mean_square = mean_square + share * (at.duty.powi(2) - mean_square);
        *memory = Warmth { mean_square }.into();
    }

    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        torque_nm / (1.0 + values[0] * Warmth::from(at.memory).mean_square)
    }

    /// Cold.
    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}
