//! `handstand virtual --pty [WORDS]`: a serial port with simulated servos behind it, for any
//! program.
//!
//! Without `--cm5` the port is an adapter on the servos' bus, as a USB2Dynamixel is; programs open
//! it at the servos' speed, 1000000. With `--cm5` the firmware's own logic stands between: an
//! adapter at 57600 at first, and all its modes when spoken to in frames. WORDS say which servos
//! and what goes wrong: `ids=1-18,delay=0,drop=0.01,dead=3`.
//!
//! ```console
//! $ handstand virtual --pty ids=1-3 &
//! /dev/pts/5
//! $ handstand bus scan --port /dev/pts/5 --baud 1000000
//! ```
//!
//! `--robot MODEL.toml` hangs a robot on the servos: a chain of links whose driven joints are their
//! shafts. It begins hanging at rest (`start=upright` among the words: standing); two driven joints
//! hang on the servos 1 and 2, 11 and 12 (`joints=1+2/11+12`). `--log FILE.csv` writes its true
//! state a hundred times a second: `time_s`, each joint's `q1_rad`, `dq1_rad_s`, and where one is
//! driven `goal2_rad`, `duty2`, `torque_on2`; `supply_v`.
//!
//! It runs until Ctrl-C or for `--seconds`. `--json` prints `port`, `ids`, `cm5`, `robot`.

use super::{Console, ExitStatus};
#[cfg(feature = "virtual-cm5")]
use handstand::Error;
use handstand::Result;
use std::path::PathBuf;

/// Offer simulated servos to any program.
#[derive(Debug, clap::Args)]
pub struct VirtualArgs {
    /// Servos and faults: ids=1-18,delay=0,drop=0.01,dead=3,...
    #[arg(default_value = "")]
    words: String,
    /// As a pseudo terminal that opens like a serial port
    #[arg(long, required = true)]
    pty: bool,
    /// Put a CM-5 with its firmware before the servos
    #[arg(long)]
    cm5: bool,
    /// Hang this robot on the servos
    #[arg(long, value_name = "MODEL.toml")]
    robot: Option<PathBuf>,
    /// Write what the robot truly does
    #[arg(long, value_name = "FILE.csv")]
    log: Option<PathBuf>,
    /// Name the port by this link as well
    #[arg(long, value_name = "PATH")]
    link: Option<PathBuf>,
    /// End after so long
    #[arg(long)]
    seconds: Option<f64>,
}

/// Serves until told to stop.
#[cfg(not(feature = "virtual-cm5"))]
pub fn run(_: &VirtualArgs, _: &Console) -> Result<ExitStatus> {
    Err(super::simulated::absent())
}

/// Serves until told to stop.
#[cfg(all(feature = "virtual-cm5", not(unix)))]
pub fn run(_: &VirtualArgs, _: &Console) -> Result<ExitStatus> {
    Err(Error::usage(
        "this system has no pseudo terminals",
        "use --port sim with the command itself",
    ))
}

/// Serves until told to stop.
#[cfg(all(feature = "virtual-cm5", unix))]
pub fn run(args: &VirtualArgs, console: &Console) -> Result<ExitStatus> {
    use handstand::link::virtual_cm5::{StateLog, serve, set_up, spec_with_robot};

    let spec = spec_with_robot(&args.words, args.robot.as_deref())?;
    if !args.seconds.unwrap_or(1.0).is_finite() {
        return Err(Error::usage(
            "--seconds is no time",
            "give a number of seconds",
        ));
    }
    let mut bus = set_up(&spec)?;
    let mut states = StateLog::of(&mut bus, args.log.as_deref())?;
    let mut device = super::simulated::link(bus, args.cm5);
    let interrupt = super::interrupt::Interrupt::listen();
    let pty = handstand::link::Pty::open()?;
    let alias = args
        .link
        .as_deref()
        .map(|path| Alias::new(path, pty.name()))
        .transpose()?;
    let data = serde_json::json!({
        "port": pty.name(),
        "ids": spec.ids,
        "cm5": args.cm5,
        "robot": spec.robot.as_ref().map(|robot| &robot.model),
    });
    console.result(&data, || pty.name().to_string())?;
    let speed = if args.cm5 { 57_600 } else { 1_000_000 };
    console.say(&format!(
        "{} simulated servos at {speed} baud; Ctrl-C ends it",
        spec.ids.len(),
    ));
    let bar = console.bar(0);
    serve(&mut device, &pty, |elapsed| {
        if let Some(state) = states.newest()? {
            bar.set_message(state);
        }
        let is_over = args.seconds.is_some_and(|s| elapsed.as_secs_f64() > s);
        Ok(!interrupt.has_come() && !is_over)
    })?;
    drop(alias);
    Ok(ExitStatus::Done)
}

/// A symbolic link that goes with the port.
#[cfg(all(feature = "virtual-cm5", unix))]
struct Alias(PathBuf);

#[cfg(all(feature = "virtual-cm5", unix))]
impl Alias {
    fn new(path: &std::path::Path, port: &str) -> Result<Self> {
        let refused = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => {
                Error::usage(format!("{} exists", path.display()), "choose another name")
            }
            _ => Error::file(path, "link", error),
        };
        std::os::unix::fs::symlink(port, path).map_err(refused)?;
        Ok(Alias(path.to_path_buf()))
    }
}

#[cfg(all(feature = "virtual-cm5", unix))]
impl Drop for Alias {
    fn drop(&mut self) {
        // A link that somebody removed meanwhile is gone all the same.
        let _ = std::fs::remove_file(&self.0);
    }
}
