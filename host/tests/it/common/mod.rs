//! A folder with a model and logs, and the built program in it.

#[cfg(unix)]
pub mod boot_loader;

use assert_cmd::Command;
use std::fmt::Write as _;
use std::path::PathBuf;
use tempfile::TempDir;

/// A pendulum without friction.
pub const MODEL: &str = r#"# A pendulum.
[rig]
name = "pendulum"
angle_zero = "hanging"
step_s = 0.005

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4

[[joint]]
drive = "passive"

[log]
time = { column = "time_s", unit = "s" }

[[log.joint]]
position = { column = "angle_rad", unit = "rad", resolution_rad = 0.001 }
"#;

/// A folder for one test.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    /// With `model.toml`, and `a.csv` and `b.csv` of a pendulum that viscous friction calms.
    pub fn new() -> Self {
        let bench = Bench {
            folder: tempfile::tempdir().unwrap(),
        };
        bench.put("model.toml", MODEL);
        bench.put("a.csv", swing(1.2).as_bytes());
        bench.put("b.csv", swing(-0.6).as_bytes());
        bench
    }

    /// Writes a file.
    pub fn put(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Reads a file.
    pub fn get(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// A file's place.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the program here with the words of `line`.
    pub fn run(&self, line: &str) -> Ran {
        self.run_with(line, &[])
    }

    /// The same in another environment.
    pub fn run_with(&self, line: &str, environment: &[(&str, String)]) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_handstand"))
            .args(line.split_whitespace())
            .current_dir(self.folder.path())
            .env("NO_COLOR", "1")
            .envs(environment.iter().map(|(name, value)| (name, value)))
            // Ends what hangs: the longest run computes for a minute, which other tests stretch.
            .timeout(std::time::Duration::from_secs(600))
            .output()
            .unwrap();
        Ran {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// How a run ended and what it said.
#[derive(Debug)]
pub struct Ran {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Ran {
    /// stdout as JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

/// Four seconds of the pendulum let go at `angle`, with viscous friction of 0.001 N m s/rad.
pub fn swing(mut angle: f64) -> String {
    let inertia = 1e-4 + 0.2 * 0.1 * 0.1;
    let (mut speed, step) = (0.0, 1e-4);
    let mut log = String::from("time_s,angle_rad\n");
    for sample in 0..400 {
        let _ = writeln!(log, "{:.2},{:.3}", f64::from(sample) * 0.01, angle);
        for _ in 0..100 {
            speed += step / inertia * (-0.2 * 9.81 * 0.1 * f64::sin(angle) - 0.001 * speed);
            angle += step * speed;
        }
    }
    log
}
