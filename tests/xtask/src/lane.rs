//! Chores that run beside others. What one prints is kept until it is waited for, so that nothing
//! is mixed.

use std::io::Write as _;
use std::process::{Command, Output, Stdio};
use std::thread::JoinHandle;

/// A chore of `cargo xtask` in a process of its own.
#[derive(Debug)]
pub struct Lane {
    name: String,
    output: JoinHandle<std::io::Result<Output>>,
}

impl Lane {
    /// Starts `cargo xtask` with these words.
    pub fn start(words: &[&str]) -> Lane {
        let name = format!("cargo xtask {}", words.join(" "));
        println!("\n$ {name}    (beside the following; what it says comes later)");
        let program = std::env::current_exe();
        let words: Vec<String> = words.iter().map(ToString::to_string).collect();
        let output = std::thread::spawn(move || {
            let mut command = Command::new(program?);
            command.args(words).stdin(Stdio::null()).output()
        });
        Lane { name, output }
    }

    /// Waits for its end and prints what it said; whether it succeeded.
    pub fn end(self) -> bool {
        println!("\n$ {}", self.name);
        match self.output.join() {
            Ok(Ok(output)) => {
                // A terminal that is gone is no reason to fail.
                let _ = std::io::stdout().write_all(&output.stdout);
                let _ = std::io::stderr().write_all(&output.stderr);
                output.status.success()
            }
            Ok(Err(error)) => {
                println!("cannot run it: {error}");
                false
            }
            Err(_) => false,
        }
    }
}
