//! What becomes of a commanded torque.

/// The drives: all alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuator {
    /// Torque of the full range, N m: what the dead zone and the resolution are shares of.
    pub full_torque_nm: f64,
    /// Whether no more than the full range can be had.
    pub saturates: bool,
    /// Commands up to this share of the full range do nothing.
    pub dead_zone: f64,
    /// Smallest step of a command as a share of the full range; 0 takes every value.
    pub resolution: f64,
    /// Supply over the supply for which the drives were measured; scales every torque.
    pub supply: f64,
    /// Periods from sample to effect; a fraction is a part of a period.
    pub delay_periods: f64,
}

impl Actuator {
    /// Gives what is asked at once, in any size.
    pub const IDEAL: Actuator = Actuator {
        full_torque_nm: 2.0,
        saturates: false,
        dead_zone: 0.0,
        resolution: 0.0,
        supply: 1.0,
        delay_periods: 0.0,
    };

    /// Torque at the joint, N m, for a commanded one.
    #[inline]
    pub fn torque_nm(&self, command_nm: f64) -> f64 {
        let mut share = command_nm / self.full_torque_nm;
        if self.saturates {
            share = share.clamp(-1.0, 1.0);
        }
        if self.resolution > 0.0 {
            share = (share / self.resolution).round() * self.resolution;
        }
        if share.abs() <= self.dead_zone {
            return 0.0;
        }
        share * self.full_torque_nm * self.supply
    }
}

#[cfg(test)]
mod tests {
    use super::Actuator;
    use crate::effects::named;

    #[test]
    fn the_dead_zone_is_the_library_s() {
        let effect = named("dead_zone").unwrap();
        let actuator = Actuator {
            dead_zone: 0.1,
            saturates: true,
            ..Actuator::IDEAL
        };
        for k in -300..=300 {
            let duty = 0.005 * f64::from(k);
            let theirs = 2.0 * effect.command(&[0.1, 0.0], duty.clamp(-1.0, 1.0));
            assert!((actuator.torque_nm(2.0 * duty) - theirs).abs() < 1e-12);
        }
    }
}
