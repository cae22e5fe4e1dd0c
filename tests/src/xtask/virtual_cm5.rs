//! `cargo xtask virtual`: a serial port with a CM-5 and simulated servos behind it, in real time.
//!
//! The chip's very program in simavr where both are there, else the same logic in process. It is a chore of the tests, for
//! simavr is under the GPL and nothing that is shipped contains it; `handstand virtual --pty --cm5` is what is shipped.

use handstand::link::{Pty, SimWords};
use handstand_tests::bench::{Bench, PcRig};
use std::time::{Duration, Instant};

/// Offer the firmware as a serial port
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Servos, faults, robot: ids=1-18,delay=0,dead=3,robot=MODEL.toml,.. as docs/bus.md lists them
    #[arg(default_value = "")]
    words: String,
    /// End after so long; at Ctrl-C without
    #[arg(long)]
    seconds: Option<f64>,
    /// The logic in process, even if the ELF could run
    #[arg(long)]
    in_process: bool,
}

/// Serves; whether nothing failed.
pub fn run(args: &Args) -> bool {
    match served(args) {
        Ok(()) => true,
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn served(args: &Args) -> Result<(), String> {
    let words: SimWords = args.words.parse()?;
    let bus = words.set_up().map_err(|error| error.to_string())?;
    #[cfg(simavr)]
    if !args.in_process {
        match handstand_tests::firmware::find_built() {
            Some(built) => {
                let mut rig = handstand_simavr::Rig::new(&built.elf)?;
                rig.bus = bus;
                eprintln!(
                    "{} in simavr, at 57600 baud; Ctrl-C ends it",
                    built.elf.display()
                );
                return serve(&mut rig, args.seconds);
            }
            None => eprintln!("There is no ELF: `cargo xtask firmware` builds it."),
        }
    }
    let mut rig = PcRig::new();
    rig.board.bus = bus;
    eprintln!("The firmware's logic in process, at 57600 baud; Ctrl-C ends it");
    serve(&mut rig, args.seconds)
}

/// Further behind than this, simulated time stands still for a moment: a program at the port waits some 30 ms for an
/// answer.
const LATE_MS: f64 = 10.0;
/// How often slowness is said, s.
const SAY_EVERY_S: f64 = 5.0;

fn serve(bench: &mut impl Bench, seconds: Option<f64>) -> Result<(), String> {
    let failed = |error: handstand::Error| error.to_string();
    let pty = Pty::open().map_err(failed)?;
    println!("{}", pty.name());
    let began = Instant::now();
    let mut offset_ms = bench.now_ms();
    let mut bytes = [0; 512];
    let (mut skipped_ms, mut said_s) = (0.0, 0.0);
    while seconds.is_none_or(|seconds| began.elapsed().as_secs_f64() < seconds) {
        let behind_ms = began.elapsed().as_secs_f64() * 1e3 + offset_ms - bench.now_ms();
        if behind_ms > LATE_MS {
            offset_ms -= behind_ms - LATE_MS;
            skipped_ms += behind_ms - LATE_MS;
        }
        let now_s = began.elapsed().as_secs_f64();
        if now_s - said_s > SAY_EVERY_S {
            let share = skipped_ms * 1e-3 / (now_s - said_s);
            if share > 0.01 {
                eprintln!(
                    "this machine is too slow: simulated time runs at {:.0} %",
                    100.0 * (1.0 - share)
                );
            }
            (skipped_ms, said_s) = (0.0, now_s);
        }
        let wait = match behind_ms < 1.0 {
            true => Duration::from_millis(1),
            false => Duration::ZERO,
        };
        let count = pty.receive(&mut bytes, wait).map_err(failed)?;
        // A program at another speed understands nothing, nor is it understood.
        let is_heard = (56_000..59_000).contains(&pty.baud());
        if is_heard {
            bench.type_bytes(&bytes[..count]);
        }
        bench.run_ms(behind_ms.clamp(0.1, 5.0));
        if is_heard && !bench.raw().is_empty() {
            pty.send(bench.raw()).map_err(failed)?;
        }
        bench.forget();
    }
    Ok(())
}
