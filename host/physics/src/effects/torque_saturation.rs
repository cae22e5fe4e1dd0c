//! Torque saturation: the drive gives no more than a limit.

use super::{AtRest, DriveState, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// max(-limit, min(limit, tau)).
#[derive(Debug)]
pub struct TorqueSaturation;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "torque_saturation",
    title: "torque saturation",
    aliases: &[
        "saturation",
        "torque limit",
        "clipping",
        "current limit",
        "force limit",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque clipped to -limit_nm..limit_nm",
    parameters: &[
        Parameter::of("limit_nm", "largest torque in either direction")
            .off(f64::INFINITY)
            .typical(0.5, 2.0)
            .bounds(0.001, 10000.0)
            .starts(&[0.3, 1.0, 3.0, 0.1, 0.03]),
    ],
    looks_like: "flat tops: beyond some command the arm answers no more; the residual torque is \
     zero below it",
    confused_with: &[
        "slew_limit: both blunt strong commands; a ramp ends while the command stays",
        "fold_back: both hold strong commands down; folding back comes after a while",
        "supply_sag: both bend the torque at strong commands; sag bends from zero on, a limit \
         only above one torque",
        "speed_limit: both cap the acceleration at full duty; a torque limit acts at rest too",
    ],
    experiment: "hold a load that grows step by step until the arm gives way, then repeat at \
     another supply",
    reference: "ROBOTIS AX-12 manual, stall torque and torque limit",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force clipped to -limit_n..limit_n",
    parameters: &[
        Parameter::of("limit_n", "largest force in either direction")
            .off(f64::INFINITY)
            .typical(1.0, 100.0)
            .bounds(0.001, 100000.0)
            .starts(&[3.0, 10.0, 30.0, 1.0, 0.3]),
    ],
    ..INFO
};

impl Law for TorqueSaturation {
    fn drive(&self, values: &[f64], torque_nm: f64, _at: &DriveState) -> f64 {
        torque_nm.clamp(-values[0], values[0])
    }

    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        (at.torque_nm.abs() < values[0]).then_some(Slope::NONE)
    }
}
