//! The standard input as a log: read once, for a run reads its logs several times.

use crate::error::{Error, Result};
use std::io::Read as _;
use std::path::Path;
use std::sync::OnceLock;

/// More does not fit into the memory of a run, bytes.
const LARGEST: u64 = 1 << 30;

/// Whether a path stands for the standard input.
pub(super) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// All of the standard input.
///
/// # Errors
/// What the system refuses; more than 1 GiB.
pub(super) fn standard_input() -> Result<&'static [u8]> {
    static BYTES: OnceLock<Result<Vec<u8>, String>> = OnceLock::new();
    let read = || {
        let mut bytes = Vec::new();
        let read = std::io::stdin()
            .lock()
            .take(LARGEST + 1)
            .read_to_end(&mut bytes);
        match read {
            Ok(_) if bytes.len() as u64 > LARGEST => Err("more than 1 GiB".to_string()),
            Ok(_) => Ok(bytes),
            Err(error) => Err(error.to_string()),
        }
    };
    match BYTES.get_or_init(read) {
        Ok(bytes) => Ok(bytes),
        Err(why) => Err(Error::file("-", "read", std::io::Error::other(why.clone()))),
    }
}
