//! A packet as bytes: a checked view, and writing one.

use super::stuffing::RunFinder;
use super::{ErrorByte, HEADER, STATUS, Unstuffed, crc16};

/// Bytes known to be one whole packet with the right CRC.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a>(&'a [u8]);

/// Why bytes are no packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketError {
    /// It does not begin with `FF FF FD 00` and an id.
    Header,
    /// The bytes are fewer or more than its length says.
    Length,
    /// The CRC is wrong.
    Crc,
}

impl<'a> Packet<'a> {
    /// Checks header, length and CRC.
    pub fn new(bytes: &'a [u8]) -> Result<Self, PacketError> {
        let [0xff, 0xff, 0xfd, 0x00, id, low, high, rest @ ..] = bytes else {
            return Err(PacketError::Header);
        };
        if *id == 0xff || *id == 0xfd {
            return Err(PacketError::Header);
        }
        let length = usize::from(u16::from_le_bytes([*low, *high]));
        if length < 3 || rest.len() != length {
            return Err(PacketError::Length);
        }
        let (covered, crc) = bytes.split_at(bytes.len() - 2);
        if crc16(0, covered).to_le_bytes() == crc {
            Ok(Packet(bytes))
        } else {
            Err(PacketError::Crc)
        }
    }

    /// Servo meant, or servo answering.
    pub fn id(&self) -> u8 {
        self.0[4]
    }

    /// Instruction; [`STATUS`] on the way back.
    pub fn instruction(&self) -> u8 {
        self.0[7]
    }

    /// Parameters without stuffing; of a status the error byte comes first.
    pub fn parameters(&self) -> Unstuffed<'a> {
        // From the instruction on, for a run of stuffing may begin there.
        let mut body = Unstuffed::new(&self.0[7..self.0.len() - 2]);
        body.next();
        body
    }

    /// The error byte and data of a status packet; none of an instruction.
    pub fn status(&self) -> Option<(ErrorByte, Unstuffed<'a>)> {
        let mut parameters = self.parameters();
        match self.instruction() {
            STATUS => Some((ErrorByte(parameters.next()?), parameters)),
            _ => None,
        }
    }

    /// All of it.
    pub fn bytes(&self) -> &'a [u8] {
        self.0
    }
}

/// Writes a packet of the parameters in `parts`, one behind the other, into `out`, stuffed; its
/// length, or nothing if `out` or the length field is too small.
pub(super) fn emit(out: &mut [u8], id: u8, instruction: u8, parts: &[&[u8]]) -> Option<usize> {
    const BODY: usize = 7;
    let mut used = BODY;
    let mut run = RunFinder::default();
    let mut put = |byte: u8| {
        *out.get_mut(used)? = byte;
        used += 1;
        if run.push(byte) {
            *out.get_mut(used)? = 0xfd;
            used += 1;
            run = RunFinder::default();
        }
        Some(())
    };
    put(instruction)?;
    for byte in parts.iter().copied().flatten() {
        put(*byte)?;
    }
    let [low, high] = u16::try_from(used + 2 - BODY).ok()?.to_le_bytes();
    let [h0, h1, h2, h3] = HEADER;
    out.get_mut(..BODY)?
        .copy_from_slice(&[h0, h1, h2, h3, id, low, high]);
    let crc = crc16(0, &out[..used]);
    out.get_mut(used..used + 2)?
        .copy_from_slice(&crc.to_le_bytes());
    Some(used + 2)
}

/// Writes a servo's status packet into `out`; its length, or nothing if it does not fit.
pub fn emit_status(out: &mut [u8], id: u8, error: ErrorByte, data: &[u8]) -> Option<usize> {
    emit(out, id, STATUS, &[&[error.0], data])
}
