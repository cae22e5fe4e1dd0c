//! The answer, sealed: unreadable at a glance and tamper-evident.
//!
//! This keeps honest people from peeking, no more. The key is in the source; whoever wants to can
//! open it.

use handstand_model::error::Problem;
use handstand_model::output::number::hex;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

const NOTE: &str = "The answer, sealed. It keeps honest people from peeking, no more.";

/// What was hidden.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChallengeAnswer {
    /// Seed of the challenge.
    pub seed: u64,
    /// Id of the effect; none if nothing is hidden.
    pub kind: Option<String>,
    /// Joint it acts on, counted from 1.
    pub joint: usize,
    /// Its values, by the keys of its parameters.
    pub parameters: Vec<(String, f64)>,
    /// The model with true friction and the effect.
    pub true_model_toml: String,
}

#[derive(Serialize, Deserialize)]
struct Sealed {
    note: String,
    /// SHA-256 of the plain text.
    sha256: String,
    /// Plain text xor key stream, hexadecimal.
    sealed: String,
}

/// The content of `answer.sealed`.
pub fn seal(answer: &impl Serialize) -> String {
    let plain = serde_json::to_vec(answer).expect("an answer is plain data");
    let sealed = Sealed {
        note: NOTE.to_owned(),
        sha256: hex(Sha256::digest(&plain)),
        sealed: hex(masked(&plain)),
    };
    let mut text = serde_json::to_string_pretty(&sealed).expect("strings are plain data");
    text.push('\n');
    text
}

/// Opens the content of `answer.sealed`.
///
/// # Errors
/// It was changed, or is no sealed answer.
pub fn unseal<T: DeserializeOwned>(text: &str) -> Result<T, Problem> {
    let refused = |what: &str| {
        Problem::new(
            what,
            "take the file as `challenge` wrote it, or generate the challenge again",
        )
    };
    let sealed: Sealed = serde_json::from_str(text).map_err(|_| refused("not a sealed answer"))?;
    let bytes =
        unhex(&sealed.sealed).ok_or_else(|| refused("the sealed answer is not hexadecimal"))?;
    let plain = masked(&bytes);
    if hex(Sha256::digest(&plain)) != sealed.sha256 {
        return Err(refused(
            "the sealed answer was changed: its SHA-256 does not match",
        ));
    }
    serde_json::from_slice(&plain).map_err(|_| refused("the sealed answer is of another version"))
}

/// `bytes` xor SHA-256 of a counter; undoes itself.
fn masked(bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(bytes.len());
    for (counter, block) in bytes.chunks(32).enumerate() {
        let mut hash = Sha256::new();
        hash.update(b"handstand challenge answer");
        hash.update((counter as u64).to_le_bytes());
        let key = hash.finalize();
        out.extend(block.iter().zip(key).map(|(byte, key)| byte ^ key));
    }
    out
}

fn unhex(text: &str) -> Option<Vec<u8>> {
    if !text.is_ascii() || !text.len().is_multiple_of(2) {
        return None;
    }
    (0..text.len())
        .step_by(2)
        .map(|k| u8::from_str_radix(&text[k..k + 2], 16).ok())
        .collect()
}
