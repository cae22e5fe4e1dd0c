//! The first link's attitude: the host's, or the gyro's rate and its sum.

use super::Balance;
use handstand_shared::message::Attitude;
use handstand_shared::plan::{Gyro, Plan};

/// Binary places of the gyro's mean code.
pub(super) const ZERO_PLACES: u8 = 16;

/// The mean forgets with a time constant of 2^5 ticks, 0.32 s.
const REST_SHIFT: u8 = 5;

/// Binary places of the gyro's code that the rate is computed with: times any scale it stays within
/// 32 bits.
const CODE_PLACES: u8 = 4;

impl Balance {
    /// Torque is off: the gyro's code goes into the mean of those at rest.
    pub fn rest(&mut self, gyro: u16) {
        // Both below 2^26.
        let off = (i32::from(gyro as i16) << ZERO_PLACES).wrapping_sub(self.zero);
        self.zero = self.zero.wrapping_add(off >> REST_SHIFT);
    }

    /// Takes the first link's attitude: the host's, if the plan wants it, or the gyro's rate and
    /// its sum.
    pub fn sense(&mut self, host: Attitude, gyro: u16) {
        if self.plan.gyro.from_host {
            self.rate = host.rate;
            self.angle = i32::from(host.angle) * 10;
            return;
        }
        let code = i32::from(gyro as i16) << CODE_PLACES;
        // Rounded: the mean comes near a code from below, and cut off it would stay 1/16 off.
        const DROPPED: u8 = ZERO_PLACES - CODE_PLACES;
        let zero = self.zero.wrapping_add(1 << (DROPPED - 1)) >> DROPPED;
        let code = code.wrapping_sub(zero);
        let rate = code.wrapping_mul(i32::from(self.plan.gyro.scale)) >> (4 + CODE_PLACES);
        self.rate = rate.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16;
        // 1e-3 rad/s for 10 ms are 1e-5 rad: 1/10 of the angle's step.
        let angle = self.angle.saturating_add(i32::from(self.rate));
        self.angle = angle.clamp(-320_000, 320_000);
    }

    /// Whether the host must say the first link's attitude.
    pub fn needs_attitude(&self) -> bool {
        self.plan.gyro.from_host
    }

    /// The gyro as the plan has it, its zero as measured since; zero and scale are 0 without a
    /// plan.
    pub fn gyro(&self) -> Gyro {
        match self.fingerprint {
            Some(_) => Gyro {
                zero: ((self.zero + (1 << (ZERO_PLACES - 1))) >> ZERO_PLACES) as u16,
                ..self.plan.gyro
            },
            None => Plan::ZERO.gyro,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From either side, so that no rate is seen at rest; a code more is one.
    #[test]
    fn the_zero_is_the_code_at_rest() {
        for code in [505, 511, 512, 513, 520] {
            let mut balance = Balance::NONE;
            balance.plan.gyro = Gyro {
                from_host: false,
                zero: 512,
                scale: 2793,
            };
            balance.zero = 512 << ZERO_PLACES;
            (0..300).for_each(|_| balance.rest(code));
            balance.sense(Attitude::default(), code);
            assert_eq!((balance.rate, balance.angle), (0, 0), "{code}");
            balance.sense(Attitude::default(), code + 1);
            assert_eq!(balance.rate, 2793 >> 4, "{code}");
        }
    }
}
