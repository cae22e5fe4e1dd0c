//! `handstand record FILE.csv|FILE.mcap`: what the servos do, until Ctrl-C or for `--seconds`.
//!
//! ```console
//! $ handstand record swing.mcap --seconds 20 --port /dev/ttyUSB0
//! $ handstand record swing.csv --from swing.mcap
//! ```
//!
//! Nothing is written to the servos. The file is brought to the disk twice a second: a crash, `kill
//! -9` or a power cut costs at most the last second, and what was being written then is dropped
//! when it is read. `--from` takes the samples from another recording: it turns one format into the
//! other, and a torn file into a whole one. docs/record.md lists columns and topics.
//!
//! `--json` prints `file`, `samples`, `seconds`, `rate_hz`, `missing` (answers that did not come),
//! `torn` (with `--from`).

use super::interrupt::Interrupt;
use super::robot::RobotArgs;
use super::{Console, ExitStatus, show::or_dash};
use handstand::link::record::{FileFormat, RecordingTally, RobotRecorder, read, record_samples};
use handstand::{Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Record servos.
#[derive(Debug, clap::Args)]
pub struct RecordArgs {
    /// File to write, .csv or .mcap
    file: PathBuf,
    #[command(flatten)]
    robot: RobotArgs,
    /// How long; until Ctrl-C without
    #[arg(long)]
    seconds: Option<f64>,
    /// Take the samples from this recording
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Samples until told to stop.
pub fn run(args: &RecordArgs, console: &Console) -> Result<ExitStatus> {
    FileFormat::of(&args.file)?;
    output::vacant(&args.file, args.force)?;
    if let Some(from) = &args.from {
        return convert(args, from, console);
    }
    let interrupt = Interrupt::listen();
    let (mut source, ids) = args.robot.open(console)?;
    let mut recorder = RobotRecorder::create(&args.file, &ids, args.force)?;
    let period_s = args.robot.period().map_or(0.01, |p| p.as_secs_f64());
    let bar = console.bar((args.seconds.unwrap_or(0.0) / period_s) as u64);
    let recorded = record_samples(
        &mut *source,
        &mut recorder,
        args.seconds,
        |sample, tally| {
            if sample.is_some() {
                bar.inc(1);
                bar.set_message(format!("samples, {} answers missing", tally.missing));
            }
            !interrupt.has_come()
        },
    );
    drop(bar);
    recorder.finish()?;
    for remark in source.remarks() {
        console.say(&format!("warning: {remark}"));
    }
    report(args, &recorded?, None, console)
}

fn convert(args: &RecordArgs, from: &std::path::Path, console: &Console) -> Result<ExitStatus> {
    let recording = read(from)?;
    let mut recorder = RobotRecorder::create(&args.file, &recording.ids, args.force)?;
    let mut tally = RecordingTally::default();
    for sample in &recording.samples {
        recorder.write(sample)?;
        tally.count(sample);
    }
    recorder.finish()?;
    if recording.torn {
        console.say(&format!(
            "{} ends in the middle of a sample or second, which was dropped",
            from.display()
        ));
    }
    report(args, &tally, Some(recording.torn), console)
}

fn report(
    args: &RecordArgs,
    tally: &RecordingTally,
    torn: Option<bool>,
    console: &Console,
) -> Result<ExitStatus> {
    if console.json {
        console.data(&json!({
            "file": args.file.display().to_string(),
            "samples": tally.samples,
            "seconds": tally.seconds(),
            "rate_hz": tally.rate_hz(),
            "missing": tally.missing,
            "torn": torn,
        }))?;
    }
    console.say(&format!(
        "wrote {}: {} samples, {:.2} s, {} per second, {} answers missing",
        args.file.display(),
        tally.samples,
        tally.seconds(),
        or_dash(tally.rate_hz(), |rate| format!("{rate:.1}")),
        tally.missing
    ));
    Ok(ExitStatus::Done)
}
