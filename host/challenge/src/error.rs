//! Why a challenge is refused.

use handstand_model::error::Reason;
use std::borrow::Cow;
use std::path::PathBuf;

/// What is wrong with a challenge's directory or its sealed answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ChallengeError {
    /// The directory to write to has something in it.
    #[error("{} is not empty", .0.display())]
    NotEmpty(PathBuf),
    /// No JSON of the right shape.
    #[error("not a sealed answer")]
    NotSealed,
    /// Not pairs of hexadecimal digits.
    #[error("the sealed answer is not hexadecimal")]
    NotHexadecimal,
    /// The hash does not match.
    #[error("the sealed answer was changed: its SHA-256 does not match")]
    Changed,
    /// Well sealed, but not an answer that this program knows.
    #[error("the sealed answer is of another version")]
    OtherVersion,
}

impl Reason for ChallengeError {
    fn remedy(&self) -> Cow<'_, str> {
        match self {
            ChallengeError::NotEmpty(_) => "name a new directory: nothing is overwritten".into(),
            _ => "take the file as `challenge` wrote it, or generate the challenge again".into(),
        }
    }
}
