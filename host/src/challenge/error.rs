//! What can be wrong with a challenge's files.

use crate::error::{Error, Place};
use std::path::PathBuf;

/// What is wrong with a challenge's files.
#[derive(Debug, thiserror::Error)]
pub enum ChallengeError {
    /// Nothing is written into a folder that holds files.
    #[error("{} is not empty", .0.display())]
    NotEmpty(PathBuf),
    /// The answer is refused.
    #[error("{}: {what}", .file.display())]
    Sealed {
        /// The file.
        file: PathBuf,
        /// Why.
        what: SealError,
    },
    /// The system refused a file, or the model or a log in it is refused.
    #[error(transparent)]
    File(#[from] Error),
}

/// Why a sealed answer is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SealError {
    /// It has not the keys of one.
    #[error("not a sealed answer")]
    NotSealed,
    /// What is sealed is no hexadecimal text.
    #[error("the sealed answer is not hexadecimal")]
    NotHexadecimal,
    /// What is sealed is not what was sealed.
    #[error("the sealed answer was changed: its SHA-256 does not match")]
    Changed,
    /// What is sealed lacks keys, or has others.
    #[error("the sealed answer is of another version")]
    OtherVersion,
}

impl From<ChallengeError> for Error {
    fn from(error: ChallengeError) -> Error {
        match error {
            ChallengeError::NotEmpty(_) => Error::usage(
                error.to_string(),
                "name a new directory: nothing is overwritten",
            ),
            ChallengeError::Sealed { file, what } => Error::data(
                Place::file(file),
                what.to_string(),
                "take the file as `challenge` wrote it, or generate the challenge again",
            ),
            ChallengeError::File(error) => error,
        }
    }
}
