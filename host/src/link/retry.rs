//! Why a servo gave no usable answer.

use crate::error::Error;
use handstand_shared::dynamixel::ErrorBits;

/// The outcome of a request that failed after all tries.
#[derive(Debug)]
pub enum Failure {
    /// No byte came.
    Silent,
    /// Bytes came, but no sound packet.
    Garbled(usize),
    /// The servo heard a request with a wrong checksum.
    Misheard,
    /// Another servo answered.
    Stranger(u8),
    /// The servo refused the request.
    Refused(ErrorBits),
    /// The port failed.
    Port(Error),
}

impl Failure {
    /// Whether asking again may help.
    pub fn is_passing(&self) -> bool {
        matches!(
            self,
            Failure::Silent | Failure::Garbled(_) | Failure::Misheard | Failure::Stranger(_)
        )
    }

    /// As an error about servo `id`.
    pub fn of(self, id: u8) -> Error {
        let doctor = "`handstand bus doctor` finds the cause";
        match self {
            Failure::Port(error) => error,
            Failure::Silent => Error::device(format!("servo {id}: no status packet"), doctor),
            Failure::Garbled(bytes) => Error::device(
                format!("servo {id}: {bytes} bytes came, but no sound status packet"),
                doctor,
            ),
            Failure::Misheard => Error::device(format!("servo {id} hears wrong checksums"), doctor),
            Failure::Stranger(other) => Error::device(
                format!("servo {id} was asked, servo {other} answered"),
                doctor,
            ),
            Failure::Refused(bits) => Error::device(
                format!(
                    "servo {id} refuses: {}",
                    bits.names().collect::<Vec<_>>().join(", ")
                ),
                "see the error bits in docs/bus.md",
            ),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Port(error)
    }
}
