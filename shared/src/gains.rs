//! A table of gains in fixed point, its proof against overflow, and its fingerprint.

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

/// Largest magnitude of a state's departure, in steps: [`i16::saturating_sub`] gives no larger one.
const MOST: u32 = 1 << 15;

impl<const N: usize> Row<N> {
    /// Largest magnitude that the sum can reach for any states at all; `None` above `u32`.
    pub fn peak(&self) -> Option<u32> {
        let sum = self.k.iter().try_fold(0_u32, |sum, k| {
            sum.checked_add(u32::from(k.unsigned_abs()))
        })?;
        // A comparison instead of a checked product: see `fixed`.
        if sum > u32::MAX / MOST {
            return None;
        }
        (sum * MOST).checked_add(self.bias.unsigned_abs())
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

    /// Hands the canonical bytes to `sink`: version, M, N, then each row (gains, bias, shift, limits), then x0;
    /// little-endian.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        [VERSION, M as u8, N as u8].map(&mut sink);
        for row in &self.rows {
            row.k.map(|k| k.to_le_bytes().map(&mut sink));
            row.bias.to_le_bytes().map(&mut sink);
            sink(row.shift);
            row.low.to_le_bytes().map(&mut sink);
            row.high.to_le_bytes().map(&mut sink);
        }
        self.x0.map(|x| x.to_le_bytes().map(&mut sink));
    }

    /// A table from its canonical bytes; `None` if they are of another version or size.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut bytes = bytes.iter().copied();
        let head = [bytes.next()?, bytes.next()?, bytes.next()?];
        if head != [VERSION, M as u8, N as u8] {
            return None;
        }
        let mut table = GainTable::new([[0; N]; M], [0; M], [0; M], [[0; 2]; M], [0; N]);
        let mut word = || Some(i16::from_le_bytes([bytes.next()?, bytes.next()?]));
        for row in &mut table.rows {
            for k in &mut row.k {
                *k = word()?;
            }
            let [a, b] = word()?.to_le_bytes();
            let [c, d] = word()?.to_le_bytes();
            row.bias = i32::from_le_bytes([a, b, c, d]);
            let [shift, low] = word()?.to_le_bytes();
            let [low_high, high] = word()?.to_le_bytes();
            row.shift = shift;
            row.low = i16::from_le_bytes([low, low_high]);
            // The row has an odd number of bytes: the last word starts here.
            row.high = i16::from_le_bytes([high, 0]);
        }
        Some(table)
    }

    /// CRC-32 (ISO-HDLC) of the canonical bytes: two tables with one fingerprint are the same gains.
    pub fn fingerprint(&self) -> u32 {
        let mut crc = u32::MAX;
        self.bytes(|byte| {
            crc ^= u32::from(byte);
            for _ in 0..8 {
                let odd = crc & 1 != 0;
                crc >>= 1;
                if odd {
                    crc ^= 0xEDB8_8320;
                }
            }
        });
        !crc
    }
}
