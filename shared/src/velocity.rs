//! Velocity from positions: the difference of two, or that smoothed by one pole.

use crate::fixed::{saturate, shift_right};

/// Places that the memory keeps below the estimate's step.
const FRACTION: u8 = 6;

/// How velocities are estimated: v = (position - position before) / Ts, then v' += share (v - v') /
/// 256.
///
/// The estimate's step is that of the position, per sample, over 2^`fraction`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Velocity {
    /// Binary places below one step of position per sample, at most 7.
    pub fraction: u8,
    /// 256 for the plain difference; less smooths, the pole being 1 - share / 256.
    pub share: u16,
}

/// What an estimate remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Memory {
    before: Option<i16>,
    smooth: i32,
}

impl Memory {
    /// Of no position.
    pub const NONE: Memory = Memory {
        before: None,
        smooth: 0,
    };
}

impl Velocity {
    /// The plain difference of positions: the paper's (theta(t) - theta(t-1)) / Ts.
    pub const DIFFERENCE: Velocity = Velocity {
        fraction: 0,
        share: 256,
    };

    /// Takes the next position; gives the velocity, 0 for the first position. Saturates.
    #[inline]
    pub fn estimate(&self, memory: &mut Memory, position: i16) -> i16 {
        let before = memory.before.replace(position).unwrap_or(position);
        let difference = i32::from(position) - i32::from(before);
        // |difference| < 2^16 and fraction <= 7: below 2^23.
        let velocity = saturate(difference << (self.fraction & 7), i16::MIN, i16::MAX);
        if self.share >= 256 {
            memory.smooth = i32::from(velocity) << FRACTION;
            return velocity;
        }
        // |velocity - smooth| < 2^16 steps: 2^22, times at most 255: below 2^30.
        let off = (i32::from(velocity) << FRACTION) - memory.smooth;
        let step = off.wrapping_mul(i32::from(self.share));
        memory.smooth += shift_right(step + 128, 8);
        let rounded = shift_right(memory.smooth + (1 << (FRACTION - 1)), FRACTION);
        saturate(rounded, i16::MIN, i16::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn differences() {
        let mut memory = Memory::default();
        let positions = [500, 503, 503, 490, i16::MAX, i16::MIN];
        let expected = [0, 3, 0, -13, i16::MAX - 490, i16::MIN];
        for (position, expected) in positions.into_iter().zip(expected) {
            assert_eq!(
                Velocity::DIFFERENCE.estimate(&mut memory, position),
                expected
            );
        }
    }

    #[test]
    fn a_steady_speed_is_found_whole() {
        let smooth = Velocity {
            fraction: 4,
            share: 64,
        };
        let mut memory = Memory::default();
        let last = (0..100).map(|k| smooth.estimate(&mut memory, 7 * k)).last();
        assert_eq!(last, Some(7 << 4));
    }

    proptest! {
        /// Within one step of the same filter in real numbers, for any positions.
        #[test]
        fn the_pole_is_where_it_should_be(
            fraction in 0u8..8,
            share in 1u16..=256,
            positions in prop::collection::vec(any::<i16>(), 2..200),
        ) {
            let velocity = Velocity { fraction, share };
            let mut memory = Memory::default();
            let (mut before, mut smooth) = (f64::from(positions[0]), 0.0);
            for &position in &positions {
                let found = f64::from(velocity.estimate(&mut memory, position));
                let scale = f64::from(1 << fraction);
                let plain = (scale * (f64::from(position) - before)).clamp(-32_768.0, 32_767.0);
                before = f64::from(position);
                smooth += f64::from(share) / 256.0 * (plain - smooth);
                // Each step rounds by half of 2^-6 at most; the pole lets 256 / share of them add
                // up.
                let slack = 0.5 + 0.5 / 64.0 * 256.0 / f64::from(share);
                prop_assert!((found - smooth).abs() <= slack + 1e-6, "{found} {smooth}");
            }
        }
    }
}
