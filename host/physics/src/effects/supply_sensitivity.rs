//! Supply sensitivity: the torque follows the volts.

use super::{AtRest, DriveState, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// tau (1 + s (V / V_n - 1)).
#[derive(Debug)]
pub struct SupplySensitivity;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "supply_sensitivity",
    title: "torque depends on the supply",
    aliases: &["supply voltage", "battery voltage", "voltage dependence"],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Supply,
    on_slide: OnSlide::Same,
    law: "torque * (1 + sensitivity * (V / V_nominal - 1))",
    parameters: &[Parameter::of(
        "sensitivity",
        "relative change of torque over relative change of supply",
    )
    .off(0.0)
    .typical(0.5, 1.2)
    .bounds(0.0, 3.0)
    .starts(&[1.0, 0.6])],
    looks_like: "the same command gives more motion on a full battery; the residual follows the \
     logged volts",
    confused_with: &[
        "supply_sag: both weaken the torque as the volts fall; sag follows the duty even where no \
         volts are logged",
        "torque_scale: the same at one supply; repeat at a second one",
    ],
    experiment: "repeat one motion at two supplies a volt or more apart, with the volts logged",
    reference: "Siciliano, Sciavicco, Villani, Oriolo, Robotics: Modelling, Planning and Control \
     (2009), chapter 5",
};

impl Law for SupplySensitivity {
    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        torque_nm * (1.0 + values[0] * (at.supply_ratio - 1.0))
    }

    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        // Linear models hold at the nominal supply.
        Some(Slope::NONE)
    }
}
