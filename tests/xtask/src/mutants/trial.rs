//! A listed mutant in a copy of the tree, and whether the tests notice it.

use super::listed::{Bench, ListedMutant};
use handstand_xtask::{cargo, root};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A test run that takes longer hangs.
const LONGEST: Duration = Duration::from_secs(1800);

/// What became of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// A test failed.
    Caught,
    /// No test failed.
    Missed,
    /// The tests did not come to an end.
    Timeout,
    /// It does not compile.
    Unviable,
}

impl Verdict {
    /// For people and programs.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Caught => "caught",
            Verdict::Missed => "missed",
            Verdict::Timeout => "timeout",
            Verdict::Unviable => "unviable",
        }
    }
}

/// A copy of the tree that mutants are tried in.
pub struct Copy {
    folder: PathBuf,
}

impl Copy {
    /// All files that git knows, as they are now.
    ///
    /// # Errors
    /// git or the system refuses.
    pub fn of_tree() -> Result<Copy, String> {
        let list = Command::new("git")
            .args([
                "ls-files",
                "-z",
                "--cached",
                "--others",
                "--exclude-standard",
            ])
            .current_dir(root())
            .output()
            .map_err(|error| format!("git cannot be run: {error}"))?;
        let copy = Copy {
            folder: root().join("target/mutants/tree"),
        };
        let names = String::from_utf8_lossy(&list.stdout).into_owned();
        for name in names.split('\0').filter(|name| !name.is_empty()) {
            copy.restore(name)?;
        }
        Ok(copy)
    }

    /// A file as it is in the tree; unchanged ones keep their time.
    fn restore(&self, name: &str) -> Result<(), String> {
        let (from, to) = (root().join(name), self.folder.join(name));
        // A file that is deleted and not committed.
        let Ok(content) = std::fs::read(&from) else {
            return Ok(());
        };
        match std::fs::read(&to) {
            Ok(there) if there == content => Ok(()),
            _ => write(&to, &content),
        }
    }

    /// Changes the one place, runs the tests, and changes it back.
    ///
    /// # Errors
    /// The place is not there, or the tests cannot be run.
    pub fn try_out(&self, mutant: &ListedMutant) -> Result<Verdict, String> {
        let file = self.folder.join(mutant.file);
        let text = std::fs::read_to_string(&file)
            .map_err(|error| format!("{}: {error}", file.display()))?;
        if text.matches(mutant.old).count() != 1 {
            return Err(format!("{}: its place is not there once", mutant.name));
        }
        write(&file, text.replace(mutant.old, mutant.new).as_bytes())?;
        let verdict = self.verdict(mutant.bench);
        self.restore(mutant.file)?;
        verdict
    }

    fn verdict(&self, bench: Bench) -> Result<Verdict, String> {
        let runs: &[&[&str]] = match bench {
            Bench::Logic => &[
                &["check", "-p", "handstand-cm5-sim", "--tests"],
                &[
                    "test",
                    "-p",
                    "handstand-shared",
                    "-p",
                    "handstand-firmware",
                    "-p",
                    "handstand-cm5-sim",
                    "--tests",
                    "--",
                    "--skip",
                    "invariant",
                ],
            ],
            Bench::Elf => &[
                &["xtask", "firmware"],
                &[
                    "test",
                    "-p",
                    "handstand-tests",
                    "--test",
                    "it",
                    "firmware::",
                ],
            ],
        };
        for (place, words) in runs.iter().enumerate() {
            match self.succeeds(words)? {
                Some(true) => {}
                Some(false) if place == 0 => return Ok(Verdict::Unviable),
                Some(false) => return Ok(Verdict::Caught),
                None => return Ok(Verdict::Timeout),
            }
        }
        Ok(Verdict::Missed)
    }

    /// Whether cargo succeeds with these words; none if it takes too long.
    fn succeeds(&self, words: &[&str]) -> Result<Option<bool>, String> {
        let target = root().join("target/mutants/target");
        let mut command = cargo(words);
        command
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", target);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command
            .spawn()
            .map_err(|error| format!("cargo cannot be run: {error}"))?;
        let begun = Instant::now();
        loop {
            match child.try_wait() {
                Ok(Some(status)) => return Ok(Some(status.success())),
                Ok(None) if begun.elapsed() > LONGEST => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return Ok(None);
                }
                Ok(None) => std::thread::sleep(Duration::from_millis(200)),
                Err(error) => return Err(format!("cargo cannot be waited for: {error}")),
            }
        }
    }
}

fn write(file: &Path, content: &[u8]) -> Result<(), String> {
    let refused = |error| format!("{}: {error}", file.display());
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(refused)?;
    }
    std::fs::write(file, content).map_err(refused)
}
