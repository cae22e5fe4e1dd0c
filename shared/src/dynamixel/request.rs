//! What the host asks of a servo.

use super::packet::{Packet, emit};
use super::{BROADCAST, WHOLE_SUM};

/// Instruction byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Instruction {
    /// Are you there?
    Ping = 0x01,
    /// Send registers.
    Read = 0x02,
    /// Set registers.
    Write = 0x03,
    /// Set registers when told to.
    RegWrite = 0x04,
    /// Do what was registered.
    Action = 0x05,
    /// Back to factory settings.
    Reset = 0x06,
    /// Set the same registers of several servos.
    SyncWrite = 0x83,
}

/// A request's content; whom it is for stands beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request<'a> {
    /// Answered with an empty status.
    Ping,
    /// Answered with `count` bytes from `address` on.
    Read {
        /// First register.
        address: u8,
        /// Bytes, at least 1.
        count: u8,
    },
    /// Sets registers at once.
    Write {
        /// First register.
        address: u8,
        /// Bytes, at least one.
        data: &'a [u8],
    },
    /// Sets registers at the next [`Request::Action`].
    RegWrite {
        /// First register.
        address: u8,
        /// Bytes, at least one.
        data: &'a [u8],
    },
    /// Carries out what was registered.
    Action,
    /// Factory settings, id 1 included.
    Reset,
    /// Sets the same registers of several servos; not answered.
    SyncWrite {
        /// First register.
        address: u8,
        /// Bytes per servo.
        width: u8,
        /// Per servo its id and `width` bytes.
        blocks: &'a [u8],
    },
}

/// Why a sound packet is no request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RequestError {
    /// Not one of the seven instructions.
    Instruction(u8),
    /// Parameters do not fit the instruction.
    Parameters,
}

impl<'a> Request<'a> {
    /// Reads a packet as a request.
    pub fn parse(packet: Packet<'a>) -> Result<Self, RequestError> {
        let wrong = Err(RequestError::Parameters);
        Ok(match (packet.code(), packet.parameters()) {
            (0x01, []) => Request::Ping,
            (0x02, &[address, count]) if count > 0 => Request::Read { address, count },
            (0x03, &[address, ref data @ ..]) if !data.is_empty() => {
                Request::Write { address, data }
            }
            (0x04, &[address, ref data @ ..]) if !data.is_empty() => {
                Request::RegWrite { address, data }
            }
            (0x05, []) => Request::Action,
            (0x06, []) => Request::Reset,
            (0x83, &[address, width, ref blocks @ ..]) if is_whole(blocks, width) => {
                Request::SyncWrite {
                    address,
                    width,
                    blocks,
                }
            }
            (0x01..=0x06 | 0x83, _) => return wrong,
            (code, _) => return Err(RequestError::Instruction(code)),
        })
    }

    /// Its instruction.
    pub fn instruction(&self) -> Instruction {
        match self {
            Request::Ping => Instruction::Ping,
            Request::Read { .. } => Instruction::Read,
            Request::Write { .. } => Instruction::Write,
            Request::RegWrite { .. } => Instruction::RegWrite,
            Request::Action => Instruction::Action,
            Request::Reset => Instruction::Reset,
            Request::SyncWrite { .. } => Instruction::SyncWrite,
        }
    }

    /// Writes it as a packet for servo `id` into `out`; the packet's length, or nothing if it does
    /// not fit.
    pub fn emit(&self, id: u8, out: &mut [u8]) -> Option<usize> {
        let (head, data): ([u8; 2], &[u8]) = match *self {
            Request::Ping | Request::Action | Request::Reset => ([0, 0], &[]),
            Request::Read { address, count } => ([address, count], &[]),
            Request::Write { address, data } | Request::RegWrite { address, data } => {
                ([address, 0], data)
            }
            Request::SyncWrite {
                address,
                width,
                blocks,
            } => ([address, width], blocks),
        };
        let of_head = match self {
            Request::Ping | Request::Action | Request::Reset => 0,
            Request::Write { .. } | Request::RegWrite { .. } => 1,
            Request::Read { .. } | Request::SyncWrite { .. } => 2,
        };
        let head = head.get(..of_head).unwrap_or(&[]);
        emit(out, id, self.instruction() as u8, head, data)
    }
}

/// The packet of a READ, which is sent most: built without loops, for the time of a slow processor.
pub const fn read_packet(id: u8, address: u8, count: u8) -> [u8; 8] {
    let sum = id
        .wrapping_add(4)
        .wrapping_add(Instruction::Read as u8)
        .wrapping_add(address)
        .wrapping_add(count);
    [
        0xff,
        0xff,
        id,
        4,
        Instruction::Read as u8,
        address,
        count,
        !sum,
    ]
}

/// The first bytes of a SYNC_WRITE to at most 50 `servos`: a block of id and `width` bytes for
/// each, and [`check_byte`], follow.
pub const fn sync_write_head(address: u8, width: u8, servos: u8) -> [u8; 7] {
    let blocks = servos.wrapping_mul(width.wrapping_add(1));
    [
        0xff,
        0xff,
        BROADCAST,
        blocks.wrapping_add(4),
        Instruction::SyncWrite as u8,
        address,
        width,
    ]
}

/// The last byte of a packet whose other bytes, the header included, sum up to `sum`.
pub const fn check_byte(sum: u8) -> u8 {
    WHOLE_SUM.wrapping_sub(sum)
}

/// Whether the blocks of a SYNC_WRITE are all of id and `width` bytes. Counted, for the AVR divides
/// slowly.
fn is_whole(blocks: &[u8], width: u8) -> bool {
    let block = usize::from(width) + 1;
    let mut left = blocks.len();
    while left >= block {
        left -= block;
    }
    left == 0 && width > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bytes(id: u8, request: Request) -> ([u8; 64], usize) {
        let mut out = [0; 64];
        let length = request.emit(id, &mut out).unwrap();
        assert_eq!(
            Request::parse(Packet::new(&out[..length]).unwrap()),
            Ok(request)
        );
        (out, length)
    }

    #[test]
    fn the_manuals_packets() {
        let is = |id, request, expected: &[u8]| {
            let (out, length) = bytes(id, request);
            assert_eq!(&out[..length], expected);
        };
        is(1, Request::Ping, &[0xff, 0xff, 0x01, 0x02, 0x01, 0xfb]);
        let read = Request::Read {
            address: 0x2b,
            count: 1,
        };
        is(1, read, &[0xff, 0xff, 0x01, 0x04, 0x02, 0x2b, 0x01, 0xcc]);
        let blocks = &[0x00, 0x10, 0x00, 0x50, 0x01, 0x01, 0x20, 0x02, 0x60, 0x03];
        let sync = Request::SyncWrite {
            address: 0x1e,
            width: 4,
            blocks,
        };
        is(
            BROADCAST,
            sync,
            &[
                0xff, 0xff, 0xfe, 0x0e, 0x83, 0x1e, 0x04, 0x00, 0x10, 0x00, 0x50, 0x01, 0x01, 0x20,
                0x02, 0x60, 0x03, 0x67,
            ],
        );
        is(
            BROADCAST,
            Request::Action,
            &[0xff, 0xff, 0xfe, 0x02, 0x05, 0xfa],
        );
    }

    #[test]
    fn a_wrong_byte_anywhere_in_a_short_packet_is_refused() {
        let good = [0xff, 0xff, 0x01, 0x04, 0x02, 0x2b, 0x01, 0xcc];
        for at in 0..good.len() {
            for wrong in (0..=255).filter(|byte| *byte != good[at]) {
                let mut bad = good;
                bad[at] = wrong;
                assert!(Packet::new(&bad).is_err(), "{bad:02x?}");
            }
        }
    }

    #[test]
    fn parameters_that_do_not_fit_are_no_request() {
        let parsed = |code: u8, parameters: &[u8]| {
            let mut packet = [0; 32];
            let length = parameters.len() as u8 + 2;
            packet[..5].copy_from_slice(&[0xff, 0xff, 1, length, code]);
            let end = 5 + parameters.len();
            packet[5..end].copy_from_slice(parameters);
            let sum = packet[..end]
                .iter()
                .fold(0u8, |sum, b| sum.wrapping_add(*b));
            packet[end] = check_byte(sum);
            let packet = Packet::new(&packet[..=end]).unwrap();
            Request::parse(packet).map(|request| request.instruction())
        };
        let wrong = Err(RequestError::Parameters);
        assert_eq!(parsed(2, &[36, 1]), Ok(Instruction::Read));
        for (code, parameters) in [
            (1, &[0][..]),
            (2, &[36]),
            (2, &[36, 0]),
            (3, &[36]),
            (4, &[36]),
            (5, &[0]),
            (0x83, &[30]),
            (0x83, &[30, 0]),
            (0x83, &[30, 0, 1, 2]),
            (0x83, &[30, 2, 1, 2]),
            (0x83, &[30, 2, 1, 2, 3, 4]),
        ] {
            assert_eq!(parsed(code, parameters), wrong, "{code} {parameters:?}");
        }
        assert_eq!(parsed(0x83, &[30, 2, 1, 2, 3]), Ok(Instruction::SyncWrite));
        assert_eq!(parsed(7, &[]), Err(RequestError::Instruction(7)));
    }

    #[test]
    fn what_does_not_fit_is_not_written() {
        assert_eq!(Request::Ping.emit(1, &mut [0; 5]), None);
        let long = [0; 255];
        let write = Request::Write {
            address: 0,
            data: &long,
        };
        assert_eq!(write.emit(1, &mut [0; 300]), None);
    }

    proptest! {
        #[test]
        fn every_request_survives(id in 0..=BROADCAST, address: u8, count in 1u8.., data in proptest::collection::vec(any::<u8>(), 1..50)) {
            let (out, length) = bytes(id, Request::Read { address, count });
            prop_assert_eq!(&out[..length], read_packet(id, address, count));
            let width = 4;
            let blocks = &data[..data.len() / 5 * 5];
            if !blocks.is_empty() {
                let whole = bytes(BROADCAST, Request::SyncWrite { address, width, blocks });
                let mut pieces = sync_write_head(address, width, (blocks.len() / 5) as u8).to_vec();
                pieces.extend_from_slice(blocks);
                let sum = pieces.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
                pieces.push(check_byte(sum));
                prop_assert_eq!(&whole.0[..whole.1], &pieces[..]);
            }
            for request in [
                Request::Ping, Request::Action, Request::Reset, Request::Read { address, count },
                Request::Write { address, data: &data }, Request::RegWrite { address, data: &data },
                Request::SyncWrite { address, width, blocks },
            ] {
                bytes(id, request);
            }
        }
    }
}
