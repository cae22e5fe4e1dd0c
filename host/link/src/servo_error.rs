//! Errors of communicating with a servo.

use super::status_error::StatusError;
use crate::error::Error;

/// Result of a request to a servo.
pub type ServoResult<T> = std::result::Result<T, ServoError>;

/// A request to a servo that failed after all tries.
#[derive(Debug, thiserror::Error)]
pub enum ServoError {
    /// No byte came.
    #[error("servo {id}: no status packet")]
    NoResponse {
        /// Id of the servo, as in all variants.
        id: u8,
    },
    /// Bytes came, but no valid packet.
    #[error("servo {id}: {bytes} bytes came, but no sound status packet")]
    Garbled {
        /// Id of the servo.
        id: u8,
        /// How many bytes.
        bytes: usize,
    },
    /// The servo received the request with a wrong checksum.
    #[error("servo {id} receives wrong checksums")]
    CorruptedRequest {
        /// Id of the servo.
        id: u8,
    },
    /// Another servo replied.
    #[error("servo {id} was asked, servo {from} answered")]
    UnexpectedId {
        /// Id of the servo asked.
        id: u8,
        /// Id in the reply.
        from: u8,
    },
    /// The servo refused the request.
    #[error("servo {id} refuses: {}", error.names().join(", "))]
    Refused {
        /// Id of the servo.
        id: u8,
        /// What it complains of.
        error: StatusError,
    },
    /// A register in EEPROM while torque is on.
    #[error("servo {id} does not take `{name}` while its torque is on")]
    Locked {
        /// Id of the servo.
        id: u8,
        /// The register.
        name: &'static str,
    },
    /// The servo's control table has no such register.
    #[error("servo {id} has no register `{name}`")]
    NoRegister {
        /// Id of the servo.
        id: u8,
        /// The register.
        name: &'static str,
    },
    /// A request in Protocol 1.0 to a servo of 2.0, whose registers are others.
    #[error("servo {id} speaks Protocol 2.0, and was asked in 1.0")]
    OtherProtocol {
        /// Id of the servo.
        id: u8,
    },
    /// A model whose control table is not known.
    #[error("servo {id} is of model {number}, whose control table is not known")]
    UnknownModel {
        /// Id of the servo.
        id: u8,
        /// Its model number.
        number: u16,
    },
    /// A model whose codes of position are not the AX-12's, where a CM-5 reads or moves it.
    #[error("servo {id} is of model {number} ({name}); a CM-5 knows the codes of AX and RX only")]
    NotAxCodes {
        /// Id of the servo.
        id: u8,
        /// Its model number.
        number: u16,
        /// Its model.
        name: &'static str,
    },
    /// The port failed.
    #[error(transparent)]
    Port(#[from] Error),
}

impl ServoError {
    /// Whether another try may succeed.
    pub fn is_transient(&self) -> bool {
        !matches!(
            self,
            ServoError::Refused { .. }
                | ServoError::Locked { .. }
                | ServoError::NoRegister { .. }
                | ServoError::UnknownModel { .. }
                | ServoError::OtherProtocol { .. }
                | ServoError::NotAxCodes { .. }
                | ServoError::Port(_)
        )
    }

    /// The port's error, if that is what failed; everything else is about the servo.
    ///
    /// # Errors
    /// The port's error.
    pub fn port(self) -> crate::error::Result<ServoError> {
        match self {
            ServoError::Port(error) => Err(error),
            other => Ok(other),
        }
    }
}

impl From<ServoError> for Error {
    fn from(error: ServoError) -> Self {
        let remedy = match error {
            ServoError::Port(error) => return error,
            ServoError::Refused { .. } => "see the error bits in docs/bus.md",
            ServoError::Locked { .. } => "torque off first: handstand bus write ID torque-enable 0",
            ServoError::NoRegister { .. } => "`handstand bus read ID` lists its registers",
            ServoError::UnknownModel { .. } => {
                "docs/servos.md lists the models that are known; leave it out with --ids"
            }
            ServoError::NotAxCodes { .. } => {
                "reach it through an adapter on the servos' bus, without --stream"
            }
            ServoError::OtherProtocol { .. } => "pass --protocol 2",
            _ => "`handstand bus doctor` finds the cause",
        };
        Error::device(error.to_string(), remedy)
    }
}
