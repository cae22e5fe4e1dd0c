//! Supply sag: the source gives way under the current the drive draws.

use super::{AtRest, DriveState, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// tau (1 - d |u|).
#[derive(Debug)]
pub struct SupplySag;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "supply_sag",
    title: "supply sag",
    aliases: &[
        "voltage drop",
        "sag",
        "voltage sag",
        "battery sag",
        "internal resistance",
        "brownout",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "torque * (1 - drop_share * |u|)",
    parameters: &[
        Parameter::of("drop_share", "share of the supply lost at full duty")
            .off(0.0)
            .typical(0.05, 0.35)
            .bounds(0.0, 0.9)
            .starts(&[0.1, 0.25]),
    ],
    looks_like: "strong commands give less than their share of torque; the torque bends over duty, \
     alike in both directions",
    confused_with: &[
        "thermal_drift: both weaken strong commands; sag is there at once and gone at once",
        "supply_sensitivity: both weaken the torque as the volts fall; log the volts and repeat \
         from a stiff source",
        "torque_saturation: both bend the torque at strong commands; sag bends from zero on, a \
         limit only above one torque",
        "speed_limit: strong commands are fast ones too; hold a load at rest, where only sag \
         remains",
        "torque_scale: the same at one duty; compare weak and strong commands",
    ],
    experiment: "hold a heavy and a light load at rest and compare the duties; then repeat from a \
     supply with less resistance",
    reference: "Horowitz, Hill, The Art of Electronics, 3rd ed., chapter 1 (source resistance)",
};

impl Law for SupplySag {
    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        torque_nm * (1.0 - values[0] * at.duty.abs())
    }

    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        Some(Slope {
            gain: 1.0 - values[0] * at.duty.abs(),
            per_duty: -at.torque_nm * values[0] * at.duty.signum(),
            ..Slope::NONE
        })
    }
}
