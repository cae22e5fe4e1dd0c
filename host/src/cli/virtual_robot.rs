//! `handstand virtual --pty [WORDS]`: a serial port with simulated servos behind it, for any program.
//!
//! Without `--cm5` the port is an adapter on the servos' bus, as a USB2Dynamixel is; programs open it at the servos'
//! speed, 1000000. With `--cm5` the firmware's own logic stands between: an adapter at 57600 at first, and all its
//! modes when spoken to in frames. WORDS say which servos and what goes wrong: `ids=1-18,delay=0,drop=0.01,dead=3`.
//!
//! ```console
//! $ handstand virtual --pty ids=1-3 &
//! /dev/pts/5
//! $ handstand bus scan --port /dev/pts/5 --baud 1000000
//! ```
//!
//! `--robot MODEL.toml` hangs a robot on the servos: a chain of links whose driven joints are their shafts. It begins
//! hanging at rest (`start=upright` among the words: standing); two driven joints hang on the servos 1 and 2, 11 and 12
//! (`joints=1+2/11+12`). `--log FILE.csv` writes its true state a hundred times a second: `time_s`, each joint's
//! `q1_rad`, `dq1_rad_s`, and where one is driven `goal2_rad`, `duty2`, `torque_on2`; `supply_v`.
//!
//! It runs until Ctrl-C or for `--seconds`. `--json` prints `port`, `ids`, `cm5`, `robot`.

use super::cm5::Cm5;
use super::interrupt::Interrupt;
use super::port::simulated;
use super::talk::Talk;
use super::watch::Watch;
use super::{Outcome, port::AnyLink};
use handstand::link::{InProcess, SimWords};
use handstand::{Error, Result};
use std::path::PathBuf;

/// Offer simulated servos to any program.
#[derive(Debug, clap::Args)]
pub struct Args {
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
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let mut words = simulated(&args.words)?;
    if let Some(model) = &args.robot {
        words.robot.get_or_insert_default().model = model.clone();
    }
    if !args.seconds.unwrap_or(1.0).is_finite() {
        return Err(Error::usage(
            "--seconds is no time",
            "give a number of seconds",
        ));
    }
    let mut bus = words.set_up()?;
    let watch = Watch::of(&mut bus, args.log.as_deref())?;
    let device: AnyLink = match args.cm5 {
        true => Box::new(Cm5::new(bus)),
        false => Box::new(InProcess::new(bus)),
    };
    serve(args, talk, device, &words, watch)
}

#[cfg(not(unix))]
fn serve(_: &Args, _: &Talk, _: AnyLink, _: &SimWords, _: Watch) -> Result<Outcome> {
    Err(Error::usage(
        "this system has no pseudo terminals",
        "use --port sim with the command itself",
    ))
}

#[cfg(unix)]
fn serve(
    args: &Args,
    talk: &Talk,
    mut device: AnyLink,
    words: &SimWords,
    mut watch: Watch,
) -> Result<Outcome> {
    use handstand::link::Pty;
    use std::time::{Duration, Instant};

    let interrupt = Interrupt::listen();
    let pty = Pty::open()?;
    let alias = args
        .link
        .as_deref()
        .map(|path| Alias::new(path, pty.name()))
        .transpose()?;
    if talk.json {
        talk.data(&serde_json::json!({
            "port": pty.name(),
            "ids": words.ids,
            "cm5": args.cm5,
            "robot": words.robot.as_ref().map(|robot| &robot.model),
        }))?;
    } else {
        talk.print(pty.name())?;
    }
    let speed = if args.cm5 { 57_600 } else { 1_000_000 };
    talk.say(&format!(
        "{} simulated servos at {} baud; Ctrl-C ends it",
        words.ids.len(),
        speed
    ));
    let (started, offset) = (Instant::now(), device.now());
    let mut last_byte = Duration::ZERO;
    let mut bytes = [0; 512];
    let bar = talk.bar();
    loop {
        let now = started.elapsed();
        if let Some(state) = watch.newest()? {
            bar.set_message(state);
        }
        if interrupt.has_come()
            || args
                .seconds
                .is_some_and(|seconds| now.as_secs_f64() > seconds)
        {
            break;
        }
        device.pause((now + offset).saturating_sub(device.now()));
        let count = device.receive(&mut bytes, Duration::ZERO)?;
        if count > 0 {
            pty.send(&bytes[..count])?;
            last_byte = now;
        }
        // Answers are near while somebody talks; an idle port should cost nothing.
        let busy = now.saturating_sub(last_byte) < Duration::from_millis(100);
        let wait = if busy {
            Duration::from_micros(100)
        } else {
            Duration::from_millis(2)
        };
        let count = pty.receive(&mut bytes, wait)?;
        if count > 0 {
            last_byte = now;
            device.pause((started.elapsed() + offset).saturating_sub(device.now()));
            device.set_baud(pty.baud())?;
            device.send(&bytes[..count])?;
        }
    }
    bar.finish_and_clear();
    drop(alias);
    Ok(Outcome::Done)
}

/// A symbolic link that goes with the port.
#[cfg(unix)]
struct Alias(PathBuf);

#[cfg(unix)]
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

#[cfg(unix)]
impl Drop for Alias {
    fn drop(&mut self) {
        // A link that somebody removed meanwhile is gone all the same.
        let _ = std::fs::remove_file(&self.0);
    }
}
