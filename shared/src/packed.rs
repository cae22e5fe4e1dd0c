//! Codes of 10 or 11 bits for all servos, packed without gaps, the lowest bit first.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Servos a frame has room for.
pub const SERVOS: usize = 18;

/// A code per servo, `BITS` wide, in `BYTES` bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packed<const BITS: usize, const BYTES: usize>(pub [u8; BYTES]);

/// Positions, 0..=1023 each.
pub type Positions = Packed<10, 23>;
/// Commands in wheel mode, as [`crate::raw::Signed`].
pub type Speeds = Packed<11, 25>;

impl<const BITS: usize, const BYTES: usize> Default for Packed<BITS, BYTES> {
    fn default() -> Self {
        Packed([0; BYTES])
    }
}

impl<const BITS: usize, const BYTES: usize> Packed<BITS, BYTES> {
    const MASK: u32 = (1 << BITS) - 1;

    /// Packs the first [`SERVOS`] codes; missing ones are 0, upper bits are cut.
    pub fn pack(codes: impl IntoIterator<Item = u16>) -> Self {
        let mut packed = Self::default();
        let mut bytes = packed.0.iter_mut();
        let (mut pending, mut bits) = (0u32, 0);
        for code in codes.into_iter().take(SERVOS) {
            pending |= (u32::from(code) & Self::MASK) << bits;
            bits += BITS;
            while bits >= 8 {
                if let Some(byte) = bytes.next() {
                    *byte = pending as u8;
                }
                pending >>= 8;
                bits -= 8;
            }
        }
        if let Some(byte) = bytes.next() {
            *byte = pending as u8;
        }
        packed
    }

    /// The codes of all [`SERVOS`].
    pub fn codes(&self) -> impl Iterator<Item = u16> {
        let mut bytes = self.0.iter();
        let (mut pending, mut bits) = (0u32, 0);
        (0..SERVOS).map(move |_| {
            while bits < BITS {
                pending |= bytes.next().map_or(0, |&byte| u32::from(byte)) << bits;
                bits += 8;
            }
            let code = (pending & Self::MASK) as u16;
            pending >>= BITS;
            bits -= BITS;
            code
        })
    }
}

impl Positions {
    /// The code of one servo; 0 beyond [`SERVOS`].
    // A code lies within two bytes, and shifts by constants cost the AVR little.
    pub fn get(&self, place: usize) -> u16 {
        let at = place + place / 4;
        let [low, high] = match self.0.get(at..at + 2) {
            Some(&[low, high]) => [low, high],
            _ => [0; 2],
        };
        let both = u16::from_le_bytes([low, high]);
        let code = match place % 4 {
            0 => both,
            1 => both >> 2,
            2 => both >> 4,
            _ => both >> 6,
        };
        code & 0x3ff
    }

    /// Sets the code of one servo; upper bits are cut, places beyond [`SERVOS`] ignored.
    pub fn set(&mut self, place: usize, code: u16) {
        let at = place + place / 4;
        let Some([low, high]) = self.0.get_mut(at..at + 2) else {
            return;
        };
        let code = code & 0x3ff;
        let (mask, code) = match place % 4 {
            0 => (0x3ff, code),
            1 => (0x3ff << 2, code << 2),
            2 => (0x3ff << 4, code << 4),
            _ => (0x3ff << 6, code << 6),
        };
        let both = u16::from_le_bytes([*low, *high]) & !mask | code;
        [*low, *high] = both.to_le_bytes();
    }
}

// serde derives arrays of known length only.
macro_rules! as_bytes {
    ($Packed:ty) => {
        impl Serialize for $Packed {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                self.0.serialize(to)
            }
        }

        impl<'de> Deserialize<'de> for $Packed {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                Deserialize::deserialize(from).map(Packed)
            }
        }
    };
}
as_bytes!(Positions);
as_bytes!(Speeds);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_first_bits_lie_where_they_are_said_to() {
        let packed = Positions::pack([0x3ff, 0, 0x155]);
        assert_eq!(packed.0[..5], [0xff, 0x03, 0x50, 0x15, 0]);
    }

    proptest! {
        #[test]
        fn codes_survive(codes: [u16; SERVOS]) {
            prop_assert!(Positions::pack(codes).codes().eq(codes.map(|c| c & 0x3ff)));
            prop_assert!(Speeds::pack(codes).codes().eq(codes.map(|c| c & 0x7ff)));
        }

        #[test]
        fn one_code_is_set_and_got_without_the_others(codes: [u16; SERVOS], place in 0..SERVOS + 8, code: u16) {
            let mut packed = Positions::pack(codes);
            packed.set(place, code);
            let mut changed = codes.map(|c| c & 0x3ff);
            if let Some(slot) = changed.get_mut(place) {
                *slot = code & 0x3ff;
            }
            prop_assert_eq!(packed, Positions::pack(changed));
            prop_assert!((0..SERVOS).all(|at| packed.get(at) == changed[at]));
            prop_assert_eq!(packed.get(SERVOS + place), 0);
        }
    }
}
