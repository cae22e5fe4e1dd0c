//! Dynamixel protocols behind one set of requests.

use handstand_shared::control_table::TORQUE_ENABLE;
use handstand_shared::dynamixel as one;
use handstand_shared::dynamixel2 as two;
use serde::{Serialize, Serializer};
use std::fmt;

/// Which Dynamixel protocol servos speak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Protocol {
    /// 1.0: AX, and MX as delivered.
    One,
    /// 2.0: X series, and MX with that firmware.
    Two,
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Protocol::One => "1.0",
            Protocol::Two => "2.0",
        })
    }
}

impl Serialize for Protocol {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

/// A request that both protocols have; rebooting is of 2.0 alone.
#[derive(Debug, Clone, Copy)]
pub(super) enum ServoRequest<'a> {
    Ping,
    Read {
        address: u16,
        count: u16,
    },
    Write {
        address: u16,
        data: &'a [u8],
    },
    SyncWrite {
        address: u16,
        width: u8,
        blocks: &'a [u8],
    },
    Reboot,
}

impl Protocol {
    /// The packet of a request; empty where it does not fit or the protocol lacks it.
    pub(super) fn packet(self, id: u8, request: ServoRequest) -> Vec<u8> {
        let mut out = [0; two::MAX_PACKET];
        let length = match self {
            Protocol::One => of_one(request).and_then(|request| request.emit(id, &mut out)),
            Protocol::Two => of_two(request).emit(id, &mut out),
        };
        out[..length.unwrap_or(0)].to_vec()
    }

    /// Bytes of data that a good answer to a request holds.
    pub(super) fn answer_bytes(self, request: ServoRequest) -> usize {
        match (self, request) {
            // Model number and firmware version.
            (Protocol::Two, ServoRequest::Ping) => 3,
            (_, ServoRequest::Read { count, .. }) => usize::from(count),
            _ => 0,
        }
    }

    /// Bytes of a read of `count` and its answer, without stuffing.
    pub(super) fn read_bytes(self, count: u16) -> usize {
        let request = self.packet(1, ServoRequest::Read { address: 0, count });
        request.len() + self.status_length(usize::from(count))
    }

    /// Bytes of a status packet with so many of data.
    pub(super) fn status_length(self, data: usize) -> usize {
        match self {
            Protocol::One => one::OVERHEAD + data,
            Protocol::Two => two::status_length(data),
        }
    }
}

fn of_one(request: ServoRequest) -> Option<one::Request> {
    Some(match request {
        ServoRequest::Ping => one::Request::Ping,
        ServoRequest::Read { address, count } => one::Request::Read {
            address: address.try_into().ok()?,
            count: count.try_into().ok()?,
        },
        ServoRequest::Write { address, data } => one::Request::Write {
            address: address.try_into().ok()?,
            data,
        },
        ServoRequest::SyncWrite {
            address,
            width,
            blocks,
        } => one::Request::SyncWrite {
            address: address.try_into().ok()?,
            width,
            blocks,
        },
        ServoRequest::Reboot => return None,
    })
}

fn of_two(request: ServoRequest) -> two::Request {
    match request {
        ServoRequest::Ping => two::Request::Ping,
        ServoRequest::Read { address, count } => two::Request::Read { address, count },
        ServoRequest::Write { address, data } => two::Request::Write { address, data },
        ServoRequest::SyncWrite {
            address,
            width,
            blocks,
        } => two::Request::SyncWrite {
            address,
            count: u16::from(width),
            blocks,
        },
        ServoRequest::Reboot => two::Request::Reboot,
    }
}

/// The packet that switches torque off, everywhere.
pub(super) fn emergency_packet(protocol: Protocol) -> Vec<u8> {
    let Some(item) = protocol.item(TORQUE_ENABLE) else {
        return Vec::new();
    };
    let (address, data) = (item.address, &[0][..]);
    protocol.packet(one::BROADCAST, ServoRequest::Write { address, data })
}

/// Bytes of `FF`, no part of a servo's packet, for longer than any answer takes: 5 ms.
pub(super) fn outlasting_answers(baud: u32) -> Vec<u8> {
    vec![0xff; (baud / 10 / 200) as usize]
}
