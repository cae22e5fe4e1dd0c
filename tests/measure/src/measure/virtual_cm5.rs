//! `cargo xtask virtual`: a serial port with a CM-5 and simulated servos behind it, in real time.
//!
//! The chip's very program in simavr where both are there, else the same logic in process. It is a
//! chore of the tests, for simavr is under the GPL and nothing that is shipped contains it;
//! `handstand virtual --pty --cm5` is what is shipped.

use handstand::link::Pty;
use handstand::link::virtual_cm5::{set_up, spec};
use handstand_measure::bench::{SimulatedCm5, VirtualCm5, serve};
use std::time::Instant;

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
    let bus = spec(&args.words).and_then(|spec| set_up(&spec));
    let bus = bus.map_err(|error| error.to_string())?;
    #[cfg(simavr)]
    if !args.in_process {
        match handstand_measure::firmware::find_built() {
            Ok(built) => {
                let mut rig = handstand_simavr::ElfCm5::new(&built.elf)?;
                rig.bus = bus;
                eprintln!(
                    "{} in simavr, at 57600 baud; Ctrl-C ends it",
                    built.elf.display()
                );
                return offer(&mut rig, args.seconds);
            }
            Err(why) => eprintln!("{why}"),
        }
    }
    let mut rig = VirtualCm5::new();
    rig.board.bus = bus;
    eprintln!("The firmware's logic in process, at 57600 baud; Ctrl-C ends it");
    offer(&mut rig, args.seconds)
}

fn offer(bench: &mut impl SimulatedCm5, seconds: Option<f64>) -> Result<(), String> {
    let pty = Pty::open().map_err(|error| error.to_string())?;
    println!("{}", pty.name());
    let began = Instant::now();
    serve(bench, &pty, || {
        seconds.is_none_or(|seconds| began.elapsed().as_secs_f64() < seconds)
    })
}
