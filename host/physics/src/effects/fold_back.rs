//! Protective fold-back: a servo that has pushed hard for too long gives less.

use super::memory::remembered;
use super::{
    AtRest, DriveState, EffectInfo, Law, MemoryCell, Needs, OnSlide, Parameter, Scope, Site, Slope,
    StartUnknown, StepState,
};

/// tau s once |u| has been above a level for a time, which runs backwards below the level, from 0
/// to at most twice as long. It remembers that time, s, and for which share of the next step the
/// torque is folded back if the duty stays, for it may be within the step that it falls.
#[derive(Debug)]
pub struct FoldBack;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "fold_back",
    title: "protective fold-back of the torque",
    aliases: &[
        "overload protection",
        "current limit",
        "derating",
        "protection",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "torque * remaining_share once |u| > level for after_s; as long below the level ends it",
    parameters: &[
        Parameter::of("remaining_share", "share of the torque that remains")
            .off(1.0)
            .typical(0.2, 0.7)
            .bounds(0.0, 1.0)
            .starts(&[0.5]),
        Parameter::of("level", "duty above which the time counts")
            .typical(0.1, 0.9)
            .bounds(0.02, 0.99)
            .starts(&[0.1, 0.25, 0.05, 0.5]),
        Parameter::of("after_s", "time above the level until the torque falls")
            .typical(0.1, 2.0)
            .bounds(0.02, 30.0)
            .starts(&[0.3, 0.15, 1.0]),
    ],
    looks_like: "under a strong, lasting command the torque falls at one instant, and comes back \
     only after a rest",
    confused_with: &[
        "thermal_drift: both weaken a strong command that lasts; a motor warms slowly",
        "torque_saturation: both hold strong commands down; a limit does so from the first instant",
    ],
    experiment: "hold a load for some seconds at three commands; the strong ones must give way at \
     one instant, the weak ones never",
    reference: "ROBOTIS AX-12 manual, alarm shutdown by overload; its torque limit falls",
};

/// How long the drive has been overloaded, less how long it has rested since, and in which share of
/// the step to come it is folded back.
struct Overload {
    overload_s: f64,
    folded_share: f64,
}
remembered!(Overload {
    overload_s,
    folded_share
});

impl Law for FoldBack {
    fn difference(&self) -> f64 {
        2e-2
    }

    fn remembers(&self) -> bool {
        true
    }

    /// The time.
    fn start_unknown(&self, values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Amount {
            most: 2.0 * values[2],
        })
    }

    fn recall_unknown(&self, values: &[f64], unknown: f64, _at: &StepState) -> MemoryCell {
        Overload {
            overload_s: unknown,
            folded_share: f64::from(unknown >= values[2]),
        }
        .into()
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, step_s: f64) {
        let (level, after_s) = (values[1], values[2]);
        let way_s = if at.duty.abs() > level {
            step_s
        } else {
            -step_s
        };
        let passed = |from_s: f64| (from_s + way_s).max(0.0).min(2.0 * after_s);
        let overload_s = passed(Overload::from(*memory).overload_s);
        let folded_share = share_above(after_s, overload_s, passed(overload_s));
        *memory = Overload {
            overload_s,
            folded_share,
        }
        .into();
    }

    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        let folded_share = Overload::from(at.memory).folded_share;
        torque_nm * (1.0 - (1.0 - values[0]) * folded_share)
    }

    /// Rested.
    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}

/// Share of a way from one time to another that lies above a third.
fn share_above(limit_s: f64, from_s: f64, to_s: f64) -> f64 {
    let (low_s, high_s) = (from_s.min(to_s), from_s.max(to_s));
    if high_s > low_s {
        ((high_s - limit_s) / (high_s - low_s)).clamp(0.0, 1.0)
    } else {
        f64::from(from_s >= limit_s)
    }
}
