//! What limits the drives of a robot, all alike, as effects of its model.

use crate::model::{Drive, Model, Motor};

/// Non-idealities of all drives, as studies vary them. Those of the model itself come on top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drives {
    /// Torque of the full range, N m: what dead zone and command resolution are shares of.
    pub full_torque_nm: f64,
    /// Whether a torque drive gives no more than the full range.
    pub saturates: bool,
    /// Commands up to this share of the full range do nothing.
    pub dead_zone: f64,
    /// Smallest step of a command as a share of the full range; 0 takes every value.
    pub resolution: f64,
    /// Supply over the supply for which the drives were measured; scales every torque.
    pub supply: f64,
    /// Periods of the controller from sample to effect; a fraction is a part of a period.
    pub delay_periods: f64,
}

impl Drives {
    /// Torque at once, in any size; 2 N m of full range.
    pub const IDEAL: Drives = Drives {
        full_torque_nm: 2.0,
        saturates: false,
        dead_zone: 0.0,
        resolution: 0.0,
        supply: 1.0,
        delay_periods: 0.0,
    };

    /// The paper's: a dead zone of 10 %, 2 N m at most, one period of delay.
    pub const PAPER: Drives = Drives {
        saturates: true,
        dead_zone: 0.1,
        delay_periods: 1.0,
        ..Drives::IDEAL
    };

    /// The model with these non-idealities as effects at every driven joint.
    ///
    /// A torque drive that saturates becomes a motor whose torque does not fall with speed; its
    /// dead zone is a share of its full range, that of a drive without a limit a torque.
    pub fn on(&self, model: &Model, period_s: f64) -> Model {
        let mut model = model.clone();
        let delay_s = self.delay_periods * period_s;
        for index in 0..model.joints.len() {
            let drive = &mut model.joints[index].drive;
            if self.saturates && *drive == Drive::Torque {
                *drive = Drive::Duty(Motor {
                    stall_torque_nm: self.full_torque_nm,
                    no_load_speed_rad_s: f64::INFINITY,
                    nominal_supply_v: None,
                });
            }
            let dead_zone = match drive {
                Drive::Passive => continue,
                Drive::Torque => self.dead_zone * self.full_torque_nm,
                _ => self.dead_zone,
            };
            let effects = [
                ("dead_zone", vec![dead_zone, 0.0], dead_zone == 0.0),
                ("torque_scale", vec![self.supply], self.supply == 1.0),
                ("delay", vec![delay_s], delay_s == 0.0),
            ];
            for (id, values, _) in effects.into_iter().filter(|(.., off)| !off) {
                model.add_effect(id, index, values);
            }
        }
        model
    }
}

/// Gives every drive this delay, s, in place of its own.
pub fn set_delay(model: &mut Model, delay_s: f64) {
    model.effects.retain(|e| e.effect.info().id != "delay");
    for joint in model.driven_joints() {
        if delay_s > 0.0 {
            model.add_effect("delay", joint, vec![delay_s]);
        }
    }
}
