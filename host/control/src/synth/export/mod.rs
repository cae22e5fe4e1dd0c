//! A design written for people, for other programs, and for firmware.

mod c_header;
mod c_text;
mod format;
mod golden;
mod rust_file;
mod state_space;
mod text;
mod values;

pub use c_header::{C_NAME, c_header, is_c_name};
pub use golden::{Golden, golden};
pub use rust_file::rust_file;
pub use state_space::{csv, json, matlab};
pub use text::text;

/// Where a file of gains comes from.
#[derive(Debug, Clone)]
pub struct Provenance {
    /// The model's file name.
    pub model: String,
    /// SHA-256 of that file.
    pub sha256: String,
    /// The command that says it all again.
    pub command: String,
}
