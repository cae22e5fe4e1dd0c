//! Errors of the boot loader and of images for it.

use super::LARGEST;
use crate::error::Error;

/// Writing a program through the boot loader failed.
#[derive(Debug, thiserror::Error)]
pub enum BootLoaderError {
    /// It did not respond during reset.
    #[error("{port}: the boot loader does not answer")]
    NotEntered {
        /// The port.
        port: String,
    },
    /// It did not respond to a command or an image.
    #[error("{port}: the boot loader does not answer to {request}")]
    NoAnswer {
        /// The port.
        port: String,
        /// What was sent.
        request: String,
    },
    /// It received another number of bytes.
    #[error("{sent} bytes were sent, the boot loader received {received}")]
    Size {
        /// Bytes sent.
        sent: usize,
        /// Its own figure.
        received: String,
    },
    /// It received bytes with another checksum.
    #[error("the checksum is wrong: ours {ours:02X}, the boot loader's {theirs:02X?}")]
    Checksum {
        /// Sum of all bytes sent, modulo 256.
        ours: u8,
        /// Its own figures.
        theirs: Vec<u8>,
    },
    /// It reported no success.
    #[error("the boot loader says: {reply}")]
    Failed {
        /// Its reply.
        reply: String,
    },
    /// Flash differs from what it received.
    #[error("verify failed: the boot loader says `{reply}`")]
    Verify {
        /// Its reply.
        reply: String,
    },
    /// The port failed.
    #[error(transparent)]
    Port(#[from] Error),
}

impl From<BootLoaderError> for Error {
    fn from(error: BootLoaderError) -> Self {
        let remedy = match error {
            BootLoaderError::Port(error) => return error,
            BootLoaderError::NotEntered { .. } => {
                "press the MODE button (reset) while this program knocks; is the cable in the CM-5, the battery on?"
            }
            BootLoaderError::NoAnswer { .. } => {
                "press MODE (reset) and try again; if it stays so, slow down: --pace-us 200"
            }
            _ => {
                "the CM-5 holds no whole program, the boot loader is unharmed: try again, slower if it stays so: --pace-us 200"
            }
        };
        Error::device(error.to_string(), remedy)
    }
}

/// A file that is no program for the boot loader.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// No bytes.
    #[error("the file is empty")]
    Empty,
    /// An ELF file.
    #[error("this is an ELF, not a raw binary")]
    Elf,
    /// An Intel HEX file.
    #[error("this is Intel HEX, not a raw binary")]
    IntelHex,
    /// More bytes than there is room for.
    #[error("{0} bytes are too many: the boot loader begins at {LARGEST}")]
    TooLong(usize),
    /// The first word is no jump.
    #[error("this is no program for the AVR: it does not begin with a jump")]
    NoJump,
    /// The mark that `cargo xtask firmware` puts behind a program is missing.
    #[error("this is not Handstand's firmware, or its end is missing: there is no mark at its end")]
    NoMark,
    /// The program is not the one that the mark is of.
    #[error("this program is damaged: it is not the one that the mark at its end is of")]
    Damaged,
}

impl ImageError {
    /// What to do.
    pub fn remedy(&self) -> &'static str {
        match self {
            ImageError::TooLong(_) => "make the program smaller",
            ImageError::NoMark => {
                "give the `.bin` that `cargo xtask firmware` writes, or pass --any-program if you mean another one"
            }
            ImageError::Damaged => "build or copy it again",
            _ => "give the raw binary, the `.bin` that `cargo xtask firmware` writes",
        }
    }
}
