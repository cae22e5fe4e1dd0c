//! A running lab in a bench's folder.

use crate::common::Bench;
use std::path::Path;

pub use handstand_browser::{LabServer, PATIENCE, Response};

impl Bench {
    /// `handstand lab` with these words here; a browser has come in, and works in session 1.
    pub fn lab(&self, words: &str) -> LabServer {
        LabServer::start(program(), &self.path("."), words.split_whitespace())
    }

    /// The same before anyone came in.
    pub fn lab_alone(&self, words: &str) -> LabServer {
        LabServer::start_alone(program(), &self.path("."), words.split_whitespace())
    }
}

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_handstand"))
}
