//! What the host asks of servos.

use super::packet::emit;

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
    FactoryReset = 0x06,
    /// Restart.
    Reboot = 0x08,
    /// Clear the turn count.
    Clear = 0x10,
    /// Store the control table, or restore it.
    Backup = 0x20,
    /// Send the same registers of several servos.
    SyncRead = 0x82,
    /// Set the same registers of several servos.
    SyncWrite = 0x83,
    /// As [`Instruction::SyncRead`], with one joint status.
    FastSyncRead = 0x8a,
    /// Send registers of several servos, others of each.
    BulkRead = 0x92,
    /// Set registers of several servos, others of each.
    BulkWrite = 0x93,
    /// As [`Instruction::BulkRead`], with one joint status.
    FastBulkRead = 0x9a,
}

/// A request's content; whom it is for stands beside it. The requests to several servos go to the
/// broadcast id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request<'a> {
    /// Answered with model number (2 bytes) and firmware version.
    Ping,
    /// Answered with `count` bytes from `address` on.
    Read {
        /// First register.
        address: u16,
        /// Bytes.
        count: u16,
    },
    /// Sets registers at once.
    Write {
        /// First register.
        address: u16,
        /// Bytes, at least one.
        data: &'a [u8],
    },
    /// Sets registers at the next [`Request::Action`].
    RegWrite {
        /// First register.
        address: u16,
        /// Bytes, at least one.
        data: &'a [u8],
    },
    /// Carries out what was registered.
    Action,
    /// Factory settings: `FF` all, `01` all but the id, `02` all but id and baud rate.
    FactoryReset(u8),
    /// Restart; the only way to torque again after a hardware error.
    Reboot,
    /// Sets the turn count to 0: present position within 0 to 4095.
    Clear,
    /// Stores the control table (true) or restores it (false).
    Backup {
        /// Whether it is stored.
        store: bool,
    },
    /// Each of `ids` answers with `count` bytes from `address` on; `fast` in one joint status.
    SyncRead {
        /// Whether one joint status is wanted.
        fast: bool,
        /// First register.
        address: u16,
        /// Bytes of each.
        count: u16,
        /// Servos, in the order of their answers.
        ids: &'a [u8],
    },
    /// Sets the same registers of several servos; not answered.
    SyncWrite {
        /// First register.
        address: u16,
        /// Bytes of each.
        count: u16,
        /// Per servo its id and `count` bytes.
        blocks: &'a [u8],
    },
    /// As [`Request::SyncRead`], with other registers of each servo.
    BulkRead {
        /// Whether one joint status is wanted.
        fast: bool,
        /// Per servo id, address (2 bytes) and number of bytes (2 bytes).
        items: &'a [u8],
    },
    /// Per servo id, address (2 bytes), number of bytes (2 bytes) and the bytes; not answered.
    BulkWrite {
        /// All of them, one behind the other.
        items: &'a [u8],
    },
}

/// Why a sound packet is no request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RequestError {
    /// Not an instruction of the protocol.
    Instruction(u8),
    /// Parameters do not fit the instruction.
    Parameters,
}

/// What protects the instruction CLEAR.
const CLEAR: [u8; 5] = [0x01, 0x44, 0x58, 0x4c, 0x22];
/// What protects the instruction of the backup.
const BACKUP: [u8; 4] = [0x43, 0x54, 0x52, 0x4c];

impl<'a> Request<'a> {
    /// Reads an instruction with its parameters, without stuffing.
    pub fn parse(instruction: u8, parameters: &'a [u8]) -> Result<Self, RequestError> {
        let word = |low: u8, high: u8| u16::from_le_bytes([low, high]);
        Ok(match (instruction, parameters) {
            (0x01, []) => Request::Ping,
            (0x02, &[a, b, c, d]) => Request::Read {
                address: word(a, b),
                count: word(c, d),
            },
            (0x03, &[a, b, ref data @ ..]) if !data.is_empty() => Request::Write {
                address: word(a, b),
                data,
            },
            (0x04, &[a, b, ref data @ ..]) if !data.is_empty() => Request::RegWrite {
                address: word(a, b),
                data,
            },
            (0x05, []) => Request::Action,
            (0x06, &[kept @ (0xff | 0x01 | 0x02)]) => Request::FactoryReset(kept),
            (0x08, []) => Request::Reboot,
            (0x10, key) if key == CLEAR => Request::Clear,
            (0x20, &[what @ (0x01 | 0x02), ref key @ ..]) if key == BACKUP => Request::Backup {
                store: what == 0x01,
            },
            (0x82 | 0x8a, &[a, b, c, d, ref ids @ ..]) => Request::SyncRead {
                fast: instruction == 0x8a,
                address: word(a, b),
                count: word(c, d),
                ids,
            },
            (0x83, &[a, b, c, d, ref blocks @ ..])
                if word(c, d) > 0 && blocks.len() % (usize::from(word(c, d)) + 1) == 0 =>
            {
                Request::SyncWrite {
                    address: word(a, b),
                    count: word(c, d),
                    blocks,
                }
            }
            (0x92 | 0x9a, items) if items.len() % 5 == 0 => Request::BulkRead {
                fast: instruction == 0x9a,
                items,
            },
            (0x93, items) => Request::BulkWrite { items },
            (0x01..=0x06 | 0x08 | 0x10 | 0x20 | 0x82 | 0x83 | 0x8a | 0x92 | 0x9a, _) => {
                return Err(RequestError::Parameters);
            }
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
            Request::FactoryReset(_) => Instruction::FactoryReset,
            Request::Reboot => Instruction::Reboot,
            Request::Clear => Instruction::Clear,
            Request::Backup { .. } => Instruction::Backup,
            Request::SyncRead { fast: false, .. } => Instruction::SyncRead,
            Request::SyncRead { fast: true, .. } => Instruction::FastSyncRead,
            Request::SyncWrite { .. } => Instruction::SyncWrite,
            Request::BulkRead { fast: false, .. } => Instruction::BulkRead,
            Request::BulkRead { fast: true, .. } => Instruction::FastBulkRead,
            Request::BulkWrite { .. } => Instruction::BulkWrite,
        }
    }

    /// Writes it as a packet for servo `id` into `out`; the packet's length, or nothing if it does
    /// not fit.
    pub fn emit(&self, id: u8, out: &mut [u8]) -> Option<usize> {
        let code = self.instruction() as u8;
        match *self {
            Request::Ping | Request::Action | Request::Reboot => emit(out, id, code, &[]),
            Request::Read { address, count } => emit(
                out,
                id,
                code,
                &[&address.to_le_bytes(), &count.to_le_bytes()],
            ),
            Request::Write { address, data } | Request::RegWrite { address, data } => {
                emit(out, id, code, &[&address.to_le_bytes(), data])
            }
            Request::FactoryReset(kept) => emit(out, id, code, &[&[kept]]),
            Request::Clear => emit(out, id, code, &[&CLEAR]),
            Request::Backup { store } => {
                let what = if store { 0x01 } else { 0x02 };
                emit(out, id, code, &[&[what], &BACKUP])
            }
            Request::SyncRead {
                address,
                count,
                ids: rest,
                ..
            }
            | Request::SyncWrite {
                address,
                count,
                blocks: rest,
            } => {
                let (address, count) = (address.to_le_bytes(), count.to_le_bytes());
                emit(out, id, code, &[&address, &count, rest])
            }
            Request::BulkRead { items, .. } | Request::BulkWrite { items } => {
                emit(out, id, code, &[items])
            }
        }
    }
}
