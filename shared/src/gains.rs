//! A table of gains in fixed point, its proof against overflow, and its fingerprint.

use crate::crc::extend32;

/// One input's gains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row<const N: usize> {
    /// Gains, in steps of (input step) / (state step) / 2^shift.
    pub k: [i16; N],
    /// The input at the operating point times 2^shift, plus the half that makes the shift round.
    pub bias: i32,
    /// Places by which the sum is shifted right; 0, 8 and 16 cost an 8-bit machine nothing.
    pub shift: u8,
    /// Least input, in steps.
    pub low: i16,
    /// Greatest input, in steps.
    pub high: i16,
}

/// Gains of `M` inputs on `N` states: u = sat(u0 - K (x - x0)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GainTable<const M: usize, const N: usize> {
    /// One per input.
    pub rows: [Row<N>; M],
    /// The operating point, in steps of the states.
    pub x0: [i16; N],
}

/// Version of the canonical bytes.
pub const VERSION: u8 = 1;

/// A state's departure is at most 2^15 steps: [`i16::saturating_sub`] gives no larger one.
const MOST_BITS: u8 = 15;

impl<const N: usize> Row<N> {
    /// Largest magnitude that the sum can reach for any states at all; `None` above `u32`.
    pub fn peak(&self) -> Option<u32> {
        let sum = self
            .k
            .iter()
            .try_fold(0_u32, |sum, k| sum.checked_add(u32::from(k.unsigned_abs())))?;
        if sum > u32::MAX >> MOST_BITS {
            return None;
        }
        (sum << MOST_BITS).checked_add(self.bias.unsigned_abs())
    }
}

impl<const M: usize, const N: usize> GainTable<M, N> {
    /// A table from arrays, as a generated file has them.
    pub const fn new(
        k: [[i16; N]; M],
        bias: [i32; M],
        shift: [u8; M],
        limits: [[i16; 2]; M],
        x0: [i16; N],
    ) -> Self {
        let mut rows = [Row {
            k: [0; N],
            bias: 0,
            shift: 0,
            low: 0,
            high: 0,
        }; M];
        let mut i = 0;
        while i < M {
            rows[i] = Row {
                k: k[i],
                bias: bias[i],
                shift: shift[i],
                low: limits[i][0],
                high: limits[i][1],
            };
            i += 1;
        }
        GainTable { rows, x0 }
    }

    /// Whether no state whatever overflows the 32-bit sum, and limits and shifts make sense.
    pub fn is_safe(&self) -> bool {
        self.rows.iter().all(|row| {
            row.shift < 31
                && row.low <= row.high
                && row.peak().is_some_and(|peak| peak <= i32::MAX as u32)
        })
    }

    /// Number of canonical bytes.
    pub const LENGTH: usize = 3 + M * (2 * N + 9) + 2 * N;

    /// Hands the canonical bytes to `sink`: version, M, N, then each row (gains, bias, shift,
    /// limits), then x0; little-endian.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        let mut put = |bytes: &[u8]| bytes.iter().for_each(|byte| sink(*byte));
        put(&[VERSION, M as u8, N as u8]);
        for row in &self.rows {
            row.k.iter().for_each(|k| put(&k.to_le_bytes()));
            put(&row.bias.to_le_bytes());
            put(&[row.shift]);
            put(&row.low.to_le_bytes());
            put(&row.high.to_le_bytes());
        }
        self.x0.iter().for_each(|x| put(&x.to_le_bytes()));
    }

    /// A table of zeros.
    pub const ZERO: Self = GainTable::new([[0; N]; M], [0; M], [0; M], [[0; 2]; M], [0; N]);

    /// A table from its canonical bytes; `None` if they are of another version or size. Ask
    /// [`GainTable::is_safe`] before using what came over a line.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut bytes = bytes.iter().copied();
        let mut table = Self::ZERO;
        table.fill(&mut bytes)?;
        bytes.next().is_none().then_some(table)
    }

    /// Overwrites the table by the next canonical bytes, without room for a second one; `None` if
    /// they end early or are of another version or size, and the table is then spoilt.
    // Many bytes of code each: inlined, they outgrow the AVR's short jumps.
    #[inline(never)]
    pub fn fill(&mut self, from: &mut impl Iterator<Item = u8>) -> Option<()> {
        if take(from)? != [VERSION, M as u8, N as u8] {
            return None;
        }
        for row in &mut self.rows {
            for k in &mut row.k {
                *k = i16::from_le_bytes(take(from)?);
            }
            row.bias = i32::from_le_bytes(take(from)?);
            [row.shift] = take(from)?;
            row.low = i16::from_le_bytes(take(from)?);
            row.high = i16::from_le_bytes(take(from)?);
        }
        for x in &mut self.x0 {
            *x = i16::from_le_bytes(take(from)?);
        }
        Some(())
    }

    /// CRC-32 of the canonical bytes: two tables with one fingerprint are the same gains.
    pub fn fingerprint(&self) -> u32 {
        let mut crc = u32::MAX;
        self.bytes(|byte| crc = extend32(crc, &[byte]));
        !crc
    }
}

/// The next `L` bytes.
pub(crate) fn take<const L: usize>(from: &mut impl Iterator<Item = u8>) -> Option<[u8; L]> {
    let mut bytes = [0; L];
    for byte in &mut bytes {
        *byte = from.next()?;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    pub(crate) const TABLE: GainTable<2, 3> = GainTable::new(
        [[-32_768, 5, 7], [100, -200, 300]],
        [1 << 20, -(3 << 8) + 128],
        [16, 8],
        [[-2000, 2000], [i16::MIN, i16::MAX]],
        [1, -1, 0],
    );

    #[test]
    fn bytes_are_the_same_for_ever() {
        let mut bytes = Vec::new();
        TABLE.bytes(|byte| bytes.push(byte));
        assert_eq!(
            bytes,
            [
                1, 2, 3, 0, 128, 5, 0, 7, 0, 0, 0, 16, 0, 16, 48, 248, 208, 7, 100, 0, 56, 255, 44,
                1, 128, 253, 255, 255, 8, 0, 128, 255, 127, 1, 0, 255, 255, 0, 0
            ]
        );
        assert_eq!(GainTable::from_bytes(&bytes), Some(TABLE));
        assert_eq!(bytes.len(), GainTable::<2, 3>::LENGTH);
        assert_eq!(TABLE.fingerprint(), crate::crc::crc32(&bytes));
        for length in 0..bytes.len() {
            assert_eq!(GainTable::<2, 3>::from_bytes(&bytes[..length]), None);
        }
        assert_eq!(GainTable::<3, 2>::from_bytes(&bytes), None);
    }

    #[test]
    fn the_peak_is_reached_and_no_more() {
        let row = TABLE.rows[0];
        assert_eq!(row.peak(), Some(32_780 * 32_768 + (1 << 20)));
        assert!(TABLE.is_safe());
        let mut heavy = TABLE;
        heavy.rows[0].k = [i16::MIN, i16::MAX, 1];
        assert_eq!(heavy.rows[0].peak(), Some((1 << 31) + (1 << 20)));
        assert!(!heavy.is_safe());
        // As many gains as 32 bits hold, and one step more.
        let row = |last| Row {
            k: [i16::MIN, i16::MIN, i16::MIN, last],
            bias: 0,
            shift: 0,
            low: 0,
            high: 0,
        };
        assert_eq!(row(i16::MAX).peak(), Some(131_071 << 15));
        assert_eq!(row(i16::MIN).peak(), None);
        for (shift, limits, is_safe) in [
            (30, [-5, -5], true),
            (31, [-5, -5], false),
            (30, [-4, -5], false),
        ] {
            let mut table = TABLE;
            [table.rows[1].low, table.rows[1].high] = limits;
            table.rows[1].shift = shift;
            assert_eq!(table.is_safe(), is_safe, "{shift} {limits:?}");
        }
        heavy.rows[0].k = [i16::MIN; 3];
        assert!(!heavy.is_safe());
    }

    #[test]
    fn limits_in_the_wrong_order_are_not_safe() {
        let mut table = TABLE;
        table.rows[1].low = 5;
        table.rows[1].high = 4;
        assert!(!table.is_safe());
    }
}
