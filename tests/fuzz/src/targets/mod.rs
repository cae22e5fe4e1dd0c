//! The targets, by what they read.

pub(crate) mod arguments;
pub(crate) mod files;
pub(crate) mod model;
pub(crate) mod wire;

use std::path::Path;
use std::str::from_utf8;

/// The bytes as text; what is no UTF-8 is refused before any parser sees it.
fn text(bytes: &[u8]) -> Option<&str> {
    from_utf8(bytes).ok()
}

/// Runs `read` on a file of this name that holds the bytes, in a folder of its own for each thread.
fn with_file(name: &str, bytes: &[u8], read: impl FnOnce(&Path)) {
    thread_local! {
        static FOLDER: tempfile::TempDir = tempfile::tempdir().expect("a temporary folder");
    }
    FOLDER.with(|folder| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("a temporary file");
        read(&path);
    });
}
