//! The first link's attitude: the host's, or the gyro's rate and its sum.

use super::Balance;
use crate::design::{GYRO_RAIL_CODES, GYRO_ZERO_CODES, REST_RATE, REST_TICKS};
use handstand_shared::message::Attitude;
use handstand_shared::plan::{Gyro, Plan};

/// The ADC's largest code.
const ADC_MAX: u16 = 1023;

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
        self.rest.add(gyro, self.plan.gyro.scale);
    }

    /// What was at rest may have been moved since.
    pub fn forget_rest(&mut self) {
        self.rest = Rest::NONE;
    }

    /// Whether the gyro, if it is what the plan balances with, was heard at rest near its zero.
    pub fn is_at_rest(&self) -> bool {
        self.plan.gyro.from_host || self.rest.is_near(self.plan.gyro.zero)
    }

    /// Whether this code is a rate of a gyro that is there, if the plan balances with one.
    pub fn has_gyro(&self, code: u16) -> bool {
        self.plan.gyro.from_host || is_off_rails(code)
    }

    /// Takes the first link's attitude: the host's, if the plan wants it, or the gyro's rate and
    /// its sum.
    pub fn sense(&mut self, host: Attitude, gyro: u16) {
        if self.plan.gyro.from_host {
            self.rate = host.rate;
            self.angle = host.angle;
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
        let sum = self.rate_sum.saturating_add(i32::from(self.rate));
        self.rate_sum = sum.clamp(-320_000, 320_000);
        self.angle = (self.rate_sum / 10) as i16;
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

/// Whether a code is one of a gyro that is connected and within what it measures.
fn is_off_rails(code: u16) -> bool {
    (GYRO_RAIL_CODES..=ADC_MAX - GYRO_RAIL_CODES).contains(&code)
}

/// The gyro's codes since it came to rest. All zeros if there were none, as all of
/// [`Balance::NONE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rest {
    lowest: u16,
    highest: u16,
    ticks: u8,
}

impl Rest {
    pub(super) const NONE: Rest = Rest {
        lowest: 0,
        highest: 0,
        ticks: 0,
    };

    /// Another tick's code of a gyro with this scale, rate steps per code times 16.
    fn add(&mut self, code: u16, scale: i16) {
        let (lowest, highest) = (self.lowest.min(code), self.highest.max(code));
        let spread = u32::from(highest - lowest);
        let rate = spread * u32::from(scale.unsigned_abs()) / 16;
        if self.ticks == 0 || (spread > 1 && rate > u32::from(REST_RATE)) {
            (self.lowest, self.highest, self.ticks) = (code, code, 1);
        } else {
            (self.lowest, self.highest) = (lowest, highest);
            self.ticks = self.ticks.saturating_add(1);
        }
    }

    fn is_near(&self, zero: u16) -> bool {
        let is_sound = |code: u16| is_off_rails(code) && code.abs_diff(zero) <= GYRO_ZERO_CODES;
        self.ticks >= REST_TICKS && is_sound(self.lowest) && is_sound(self.highest)
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

    /// Ten ticks of this gyro's codes, every second one another.
    fn rested(scale: i16, spread: u16) -> Balance {
        let mut balance = Balance::NONE;
        balance.plan.gyro = Gyro {
            from_host: false,
            zero: 512,
            scale,
        };
        (0..u16::from(REST_TICKS)).for_each(|tick| balance.rest(512 + (tick & 1) * spread));
        balance
    }

    /// A code to and fro is rounding, however much of a rate it is; two are a motion where they are
    /// more than the rate at rest.
    #[test]
    fn rest_is_a_rate_below_its_limit() {
        let at_limit = (16 * REST_RATE / 2) as i16;
        for (scale, spread, is_at_rest) in [
            (i16::MAX, 1, true),
            (at_limit, 2, true),
            (at_limit + 16, 2, false),
            (at_limit, 3, false),
        ] {
            assert_eq!(
                rested(scale, spread).is_at_rest(),
                is_at_rest,
                "{scale} {spread}"
            );
        }
    }

    #[test]
    fn what_may_have_been_moved_must_come_to_rest_again() {
        let mut balance = rested(279, 0);
        assert!(balance.is_at_rest());
        balance.forget_rest();
        assert!(!balance.is_at_rest());
        (1..REST_TICKS).for_each(|_| balance.rest(512));
        assert!(!balance.is_at_rest());
        balance.rest(512);
        assert!(balance.is_at_rest());
    }
}
