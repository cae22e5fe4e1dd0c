//! `cargo xtask bench-read`: how long logs of an hour take to read, and how much memory; neither
//! may be more than was promised.

use super::page::Page;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand_measure::measured::Measured;
use handstand_measure::reading::{HourLog, Reading, read_once};
use std::path::PathBuf;

/// Measure how soon an hour's logs are read, and in how much memory
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Joints of the robot
    #[arg(long, default_value_t = 18, value_parser = clap::value_parser!(u64).range(1..=100))]
    joints: u64,
    /// Samples
    #[arg(
        long,
        default_value_t = 360_000,
        value_parser = clap::value_parser!(u64).range(100..=10_000_000)
    )]
    samples: u64,
    /// Read this file of as many joints once, and print what it took as JSON
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    page: Page,
}

/// Times that each file is read; the quickest counts, for other programs run as well.
const ROUNDS: usize = 5;
/// Most that reading may take, s: Parquet, CSV.
const LIMITS_S: [(&str, f64); 2] = [("parquet", 1.0), ("csv", 5.0)];
/// Most memory, as a multiple of the numbers that are read.
const MEMORY: f64 = 4.0;

/// Whether every file was read in time and memory.
pub fn run(args: &Args) -> bool {
    let log = HourLog {
        joints: args.joints as usize,
        samples: args.samples as usize,
    };
    let done = match &args.file {
        Some(file) => read_once(&log, file).map(|reading| {
            println!("{}", reading.json());
            true
        }),
        None => measure(args, &log),
    };
    done.unwrap_or_else(|why| {
        eprintln!("{why}");
        false
    })
}

fn measure(args: &Args, log: &HourLog) -> Result<bool, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY);
    table.set_header([
        "File",
        "MB",
        "Read, s",
        "Limit, s",
        "Peak memory / data",
        "Limit",
    ]);
    let mut well = true;
    for (ending, limit_s) in LIMITS_S {
        let file = folder.path().join(format!("hour.{ending}"));
        log.write(&file)?;
        let readings = (0..ROUNDS).map(|_| Reading::of_child(log, &file));
        let readings = readings.collect::<Result<Vec<_>, _>>()?;
        let read_s = readings.iter().map(|reading| reading.read_s);
        let read_s = read_s.fold(f64::INFINITY, f64::min);
        let peak = readings.iter().map(|reading| reading.peak_bytes);
        let share = peak.max().unwrap_or(0) as f64 / log.bytes() as f64;
        well &= read_s <= limit_s && share <= MEMORY;
        let length = std::fs::metadata(&file).map_err(|error| error.to_string())?;
        table.add_row([
            ending.to_string(),
            format!("{:.0}", length.len() as f64 / 1e6),
            format!("{read_s:.2}"),
            limit_s.to_string(),
            format!("{share:.2}"),
            MEMORY.to_string(),
        ]);
    }
    let measured = Measured::default().table(table).line(format!(
        "{} samples of {} joints: time, and of each joint angle, speed and goal; {:.0} MB as \
         doubles. Read into motions, by a process of its own each time; the quickest of {ROUNDS}, \
         its peak memory with the program itself.",
        log.samples,
        log.joints,
        log.bytes() as f64 / 1e6
    ));
    let title = "How soon an hour's logs are read";
    Ok(args.page.show(None, &measured, "bench-read", title) && well)
}
