//! Long logs, written and read again: how long it takes, and how much memory.

use handstand::Model;
use handstand::log::{LogRequest, read};
use parquet::data_type::DoubleType;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

/// Samples per second.
const RATE_HZ: f64 = 100.0;
/// Of each joint, before its number.
const QUANTITIES: [&str; 3] = ["q", "dq", "goal"];
/// Rows of a group in Parquet.
const GROUP: usize = 100_000;

/// A log of a robot that swings all its joints.
#[derive(Debug, Clone, Copy)]
pub struct HourLog {
    /// Joints.
    pub joints: usize,
    /// Samples.
    pub samples: usize,
}

impl HourLog {
    /// Its numbers as doubles, bytes.
    pub fn bytes(&self) -> usize {
        8 * self.samples * (1 + QUANTITIES.len() * self.joints)
    }

    fn names(&self) -> Vec<String> {
        let joint = |joint| QUANTITIES.map(|quantity| format!("{quantity}{joint}"));
        let joints = (0..self.joints).flat_map(joint);
        std::iter::once("time_s".to_string())
            .chain(joints)
            .collect()
    }

    /// Numbers with all their digits, as a sensor's are after scaling.
    fn value(column: usize, sample: usize) -> f64 {
        let time_s = sample as f64 / RATE_HZ;
        match column {
            0 => time_s,
            _ => (0.7 * time_s + column as f64).sin() / 3.0,
        }
    }

    /// Writes it, as the file's ending says.
    ///
    /// # Errors
    /// What the system or the library refuses.
    pub fn write(&self, file: &Path) -> Result<(), String> {
        let written = if file.extension().is_some_and(|ending| ending == "parquet") {
            self.write_parquet(file).map_err(|error| error.to_string())
        } else {
            self.write_csv(file).map_err(|error| error.to_string())
        };
        written.map_err(|why| format!("{}: {why}", file.display()))
    }

    fn write_csv(&self, file: &Path) -> std::io::Result<()> {
        let mut out = BufWriter::new(std::fs::File::create(file)?);
        let names = self.names();
        writeln!(out, "{}", names.join(","))?;
        for sample in 0..self.samples {
            write!(out, "{}", Self::value(0, sample))?;
            for column in 1..names.len() {
                write!(out, ",{}", Self::value(column, sample))?;
            }
            writeln!(out)?;
        }
        out.flush()
    }

    fn write_parquet(&self, file: &Path) -> parquet::errors::Result<()> {
        let names = self.names();
        let fields = names.iter().fold(String::new(), |fields, name| {
            fields + &format!("required double {name}; ")
        });
        let schema = Arc::new(parse_message_type(&format!("message log {{ {fields} }}"))?);
        let out = std::fs::File::create(file)?;
        let mut writer = SerializedFileWriter::new(out, schema, Arc::default())?;
        for first in (0..self.samples).step_by(GROUP) {
            let mut group = writer.next_row_group()?;
            let samples = first..self.samples.min(first + GROUP);
            let mut index = 0;
            while let Some(mut column) = group.next_column()? {
                let values: Vec<f64> = samples.clone().map(|k| Self::value(index, k)).collect();
                column
                    .typed::<DoubleType>()
                    .write_batch(&values, None, None)?;
                column.close()?;
                index += 1;
            }
            group.close()?;
        }
        writer.close().map(drop)
    }

    /// The model that says what its columns are.
    fn model(&self) -> Result<Model, String> {
        let mut text = "[rig]\nname = \"robot\"\nangle_zero = \"hanging\"\n".to_string();
        for _ in 0..self.joints {
            text += "\n[[link]]\nlength_m = 0.1\ncom_m = 0.05\nmass_kg = 0.1\n\
                     inertia_kg_m2 = 1e-4\n\n[[joint]]\ndrive = \"torque\"\n";
        }
        text += "\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n";
        for joint in 0..self.joints {
            let _ = write!(
                text,
                "\n[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}\n\
                 velocity = {{ column = \"dq{joint}\", unit = \"rad/s\" }}\n\
                 input = {{ column = \"goal{joint}\", unit = \"N m\" }}\n"
            );
        }
        Model::parse(&text, Path::new("robot.toml")).map_err(|error| error.to_string())
    }
}

/// What reading a file took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Time, s.
    pub read_s: f64,
    /// Most memory that the process ever had, bytes.
    pub peak_bytes: u64,
}

impl Reading {
    /// Reads a file in a process of its own, this program's `bench-read --file`.
    ///
    /// # Errors
    /// What that process says.
    pub fn of_child(log: &HourLog, file: &Path) -> Result<Reading, String> {
        let own = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut child = Command::new(own);
        child.arg("bench-read").arg("--file").arg(file);
        child.args(["--joints", &log.joints.to_string()]);
        child.args(["--samples", &log.samples.to_string()]);
        let output = child.output().map_err(|error| error.to_string())?;
        let told: Option<Value> = serde_json::from_slice(&output.stdout).ok();
        let told = told.and_then(|told| {
            Some(Reading {
                read_s: told["read_s"].as_f64()?,
                peak_bytes: told["peak_bytes"].as_u64()?,
            })
        });
        told.ok_or_else(|| String::from_utf8_lossy(&output.stderr).into_owned())
    }

    /// As a line that [`Reading::of_child`] reads.
    pub fn json(&self) -> Value {
        json!({ "read_s": self.read_s, "peak_bytes": self.peak_bytes })
    }
}

/// Reads a file once; its last sample must be the log's.
///
/// # Errors
/// What cannot be read, or is not that log; a system that does not tell a process's peak memory.
pub fn read_once(log: &HourLog, file: &Path) -> Result<Reading, String> {
    let model = log.model()?;
    let begun = Instant::now();
    let motions = read(&[LogRequest::whole(file)], &model.log);
    let read_s = begun.elapsed().as_secs_f64();
    let motions = motions.map_err(|error| error.to_string())?;
    let last = log.samples - 1;
    let read: Vec<f64> = motions
        .iter()
        .filter_map(|motion| motion.position_rad.last()?.get(last).copied())
        .collect();
    let column = 1 + QUANTITIES.len() * (log.joints - 1);
    if read != [HourLog::value(column, last)] {
        return Err(format!(
            "{}: {read:?} is not what was written",
            file.display()
        ));
    }
    Ok(Reading {
        read_s,
        peak_bytes: peak_bytes()?,
    })
}

fn peak_bytes() -> Result<u64, String> {
    let status = std::fs::read_to_string("/proc/self/status").map_err(|error| error.to_string())?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    kib.map(|kib| kib * 1024)
        .ok_or_else(|| "no VmHWM in /proc/self/status".to_string())
}
