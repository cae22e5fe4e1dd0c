//! Speed limit: the back-EMF of the motor takes torque away as the joint turns.

use super::{AtRest, DriveState, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// tau - tau_full w / w_0, with the no-load speed w_0.
#[derive(Debug)]
pub struct SpeedLimit;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "speed_limit",
    title: "speed limit by back-EMF",
    aliases: &[
        "back-EMF",
        "counter-EMF",
        "BEMF",
        "back EMF constant",
        "torque-speed curve",
        "speed-torque curve",
        "electrical damping",
        "no-load speed",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque - full_torque * w / no_load_speed_rad_s, while energised",
    parameters: &[Parameter::of(
        "no_load_speed_rad_s",
        "speed at which full duty leaves no torque",
    )
    .off(f64::INFINITY)
    .typical(4.0, 12.0)
    .bounds(0.5, 10000.0)
    .starts(&[8.0, 20.0])],
    looks_like: "at full duty the arm accelerates less the faster it turns; the residual torque is \
     linear in speed, but only while the drive is energised",
    confused_with: &[
        "viscous: both are linear in speed; repeat the drop with the torque on and off: back-EMF \
         needs the energised drive",
        "supply_sag: strong commands are fast ones too; hold a load at rest, where only sag \
         remains",
        "torque_saturation: both cap the acceleration at full duty; a torque limit acts at rest \
         too",
        "torque_scale: both weaken the drive; a scale acts at rest too",
    ],
    experiment: "drive at full duty from rest to the top speed, then drop the arm with the torque \
     off",
    reference: "Siciliano, Sciavicco, Villani, Oriolo, Robotics: Modelling, Planning and Control \
     (2009), chapter 5",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force - full force * w / no_load_speed_m_s, while energised",
    parameters: &[Parameter::of(
        "no_load_speed_m_s",
        "speed at which full duty leaves no force",
    )
    .off(f64::INFINITY)
    .typical(0.1, 5.0)
    .bounds(0.005, 10000.0)
    .starts(&[1.0, 4.0])],
    ..INFO
};

impl Law for SpeedLimit {
    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        torque_nm - at.full_torque_nm * at.speed_rad_s / values[0]
    }

    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        Some(Slope {
            per_rad_s: -at.full_torque_nm / values[0],
            ..Slope::NONE
        })
    }
}
