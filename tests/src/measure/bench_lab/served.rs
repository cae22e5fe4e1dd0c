//! A lab that runs while it is measured.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A running lab.
pub struct Served {
    child: Child,
    /// The address with its token.
    pub address: String,
    /// From the start of the program until it had printed the address.
    pub started_in: Duration,
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may be over before it is ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Served {
    /// `handstand lab` with these files, its sessions in `folder`.
    ///
    /// # Errors
    /// The program cannot be run, or prints no address.
    pub fn start(program: &Path, files: &[PathBuf], folder: &Path) -> Result<Served, String> {
        let begun = Instant::now();
        let mut command = Command::new(program);
        command.arg("lab").args(files).arg("--session").arg(folder);
        let child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let child = child.map_err(|why| format!("{} cannot be run: {why}", program.display()))?;
        let mut served = Served {
            child,
            address: String::new(),
            started_in: Duration::ZERO,
        };
        let out = served.child.stdout.take().ok_or("no stdout")?;
        let read = BufReader::new(out).read_line(&mut served.address);
        read.map_err(|why| why.to_string())?;
        served.started_in = begun.elapsed();
        served.address.truncate(served.address.trim_end().len());
        match served.address.contains("/enter?token=") {
            true => Ok(served),
            false => Err("the lab printed no address".into()),
        }
    }

    /// Address of a page of its first session.
    pub fn page(&self, name: &str) -> String {
        let host = self.address.split("/enter").next().unwrap_or_default();
        format!("{host}/s/1/{name}")
    }
}
