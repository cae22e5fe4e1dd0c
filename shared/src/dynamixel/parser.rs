//! Finding packets in a stream of bytes that may hold anything else.

use super::{Packet, PacketError};

/// Collects bytes until they are a packet of at most `N` bytes; searches on within what turned out
/// to be none.
#[derive(Debug, Clone)]
pub struct Parser<const N: usize> {
    bytes: [u8; N],
    used: usize,
    /// The packet handed out last is still in front.
    handed_out: usize,
}

impl<const N: usize> Default for Parser<N> {
    fn default() -> Self {
        Parser {
            bytes: [0; N],
            used: 0,
            handed_out: 0,
        }
    }
}

impl<const N: usize> Parser<N> {
    /// Takes the next byte; the packet it completes, if it does.
    pub fn push(&mut self, byte: u8) -> Option<Packet<'_>> {
        let handed_out = core::mem::take(&mut self.handed_out);
        self.drop_front(handed_out);
        if let Some(slot) = self.bytes.get_mut(self.used) {
            *slot = byte;
            self.used += 1;
        }
        loop {
            match self.look() {
                Look::More => return None,
                Look::None => self.drop_front(1),
                Look::Packet(length) => {
                    self.handed_out = length;
                    return self.bytes.get(..length).and_then(|b| Packet::new(b).ok());
                }
            }
        }
    }

    /// Forgets what was collected, as after a silence.
    pub fn reset(&mut self) {
        self.used = 0;
        self.handed_out = 0;
    }

    fn look(&self) -> Look {
        let bytes = self.bytes.get(..self.used).unwrap_or(&[]);
        match bytes {
            [] | [0xff] | [0xff, 0xff] => Look::More,
            [0xff, 0xff, 0xff, ..] => Look::None,
            [0xff, 0xff, _] => Look::More,
            [0xff, 0xff, _, length, ..] => {
                let whole = usize::from(*length) + 4;
                if *length < 2 || whole > N {
                    Look::None
                } else {
                    match bytes.get(..whole).map(Packet::new) {
                        None => Look::More,
                        Some(Ok(_)) => Look::Packet(whole),
                        Some(Err(
                            PacketError::Header | PacketError::Length | PacketError::Checksum,
                        )) => Look::None,
                    }
                }
            }
            _ => Look::None,
        }
    }

    fn drop_front(&mut self, count: usize) {
        if count == 0 {
            return;
        }
        let kept = self.used.saturating_sub(count);
        for to in 0..kept {
            let byte = self.bytes.get(to + count).copied().unwrap_or(0);
            if let Some(slot) = self.bytes.get_mut(to) {
                *slot = byte;
            }
        }
        self.used = kept;
    }
}

enum Look {
    /// Nothing speaks against a packet yet.
    More,
    /// No packet begins here.
    None,
    /// One does, this long.
    Packet(usize),
}

#[cfg(test)]
mod tests {
    use super::super::{BROADCAST, Request, Status};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_packet_inside_a_false_one_is_found() {
        let mut parser = Parser::<32>::default();
        // The first five bytes announce a packet of 12 bytes; a true one begins inside.
        let stream = [
            0xff, 0xff, 0x01, 0x08, 0x00, 0xff, 0xff, 0x01, 0x02, 0x00, 0xfc, 0x00,
        ];
        let found = stream
            .iter()
            .filter(|byte| parser.push(**byte).is_some_and(|p| p.id() == 1))
            .count();
        assert_eq!(found, 1);
    }

    const PING: [u8; 6] = [0xff, 0xff, 0x01, 0x02, 0x01, 0xfb];

    /// How many PINGs are found in these bytes.
    fn pings<const N: usize>(parser: &mut Parser<N>, bytes: &[u8]) -> usize {
        let found = |byte: &&u8| parser.push(**byte).is_some_and(|p| p.bytes() == PING);
        bytes.iter().filter(found).count()
    }

    #[test]
    fn what_was_begun_is_forgotten() {
        let begun = [0xff, 0xff, 0x01, 0x09, 0x02];
        let mut parser = Parser::<32>::default();
        assert_eq!(pings(&mut parser, &[&begun[..], &PING].concat()), 0);
        let mut parser = Parser::<32>::default();
        assert_eq!(pings(&mut parser, &begun), 0);
        parser.reset();
        assert_eq!(pings(&mut parser, &PING), 1);
    }

    /// A packet as long as the parser holds is found; a length that no packet has, or the parser
    /// does not hold, hides nothing that follows.
    #[test]
    fn lengths_that_cannot_be_hide_nothing() {
        assert_eq!(pings(&mut Parser::<6>::default(), &PING), 1);
        assert_eq!(pings(&mut Parser::<5>::default(), &PING), 0);
        for length in [0, 1, 13, 14, 255] {
            let stream = [&[0xff, 0xff, 0x01, length][..], &PING].concat();
            assert_eq!(pings(&mut Parser::<16>::default(), &stream), 1, "{length}");
        }
    }

    proptest! {
        #[test]
        fn packets_are_found_between_anything_else(
            garbage in proptest::collection::vec(any::<u8>(), 0..40), id in 0..BROADCAST, data in proptest::collection::vec(any::<u8>(), 0..8)
        ) {
            let mut parser = Parser::<16>::default();
            for byte in garbage {
                parser.push(byte);
            }
            let mut out = [0; 16];
            let status = Status { id, error: Default::default(), data: &data };
            let length = status.emit(&mut out).unwrap();
            // What the garbage began may swallow one; what follows is found.
            let mut found = 0;
            for byte in out[..length].iter().cycle().take(4 * length) {
                found += usize::from(parser.push(*byte).is_some_and(|p| p.bytes() == &out[..length]));
            }
            prop_assert!(found >= 2, "{found}");
        }

        #[test]
        fn any_bytes_are_taken_without_a_panic(bytes in proptest::collection::vec(prop_oneof![Just(0xffu8), any::<u8>()], 0..300)) {
            let mut parser = Parser::<24>::default();
            for byte in bytes {
                if let Some(packet) = parser.push(byte) {
                    let _ = (Request::parse(packet), Status::of(packet));
                }
            }
        }
    }
}
