//! What the tests need beside cargo: said, and installed where it can be.

use handstand_xtask::cargo;
use handstand_xtask::firmware::Toolchain;
use handstand_xtask::program::{self, found, is_root};
use std::process::Command;

/// Programs or files that some tests need, and the Debian packages that bring them.
#[derive(Debug)]
pub struct Need {
    /// What it is called.
    pub name: &'static str,
    /// Which tests need it, as in "for the test that renders a report".
    pub wanted_for: &'static str,
    /// How it is known to be here.
    pub sign: Sign,
    /// Debian's packages.
    pub packages: &'static [&'static str],
    /// Whether it must be here before anything is built; else before the tests run.
    pub for_builds: bool,
}

/// How a need is known to be met.
#[derive(Debug)]
pub enum Sign {
    /// One of these is a program on the path, or a file that exists.
    Files(&'static [&'static str]),
    /// Who needs it finds it.
    Asked(fn() -> bool),
}

/// Every need, those of builds first; a new one is one entry.
pub const NEEDS: &[Need] = &[
    Need {
        name: "simavr",
        wanted_for: "the tests of the firmware's ELF",
        sign: Sign::Files(&["/usr/include/simavr/sim_avr.h"]),
        packages: &["libsimavr-dev", "simavr"],
        for_builds: true,
    },
    Need {
        name: "The AVR's linker",
        wanted_for: "the build and the tests of the firmware's ELF",
        sign: Sign::Files(&["avr-gcc"]),
        packages: &["gcc-avr", "binutils-avr", "avr-libc"],
        for_builds: true,
    },
    Need {
        name: "A Rust compiler with its sources",
        wanted_for: "the build and the tests of the firmware's ELF",
        sign: Sign::Asked(Toolchain::is_there),
        packages: &["rustc-web", "rust-web-src", "cargo-web"],
        for_builds: true,
    },
    Need {
        name: "Chromium",
        wanted_for: "the tests that render pages and use the lab",
        sign: Sign::Files(&["chromium", "chromium-browser", "google-chrome"]),
        packages: &["chromium"],
        for_builds: false,
    },
    Need {
        name: "Slurm",
        wanted_for: "the test of the recipe for job arrays",
        sign: Sign::Files(&["slurmctld", "/usr/sbin/slurmctld"]),
        packages: &["slurm-wlm"],
        for_builds: false,
    },
    Need {
        name: "GNU parallel",
        wanted_for: "the test of the recipe for several processes",
        sign: Sign::Files(&["parallel"]),
        packages: &["parallel"],
        for_builds: false,
    },
    Need {
        name: "Python 3",
        wanted_for: "the test that drives simulated servos by ROBOTIS's own SDK",
        sign: Sign::Files(&["python3"]),
        packages: &["python3", "python3-venv"],
        for_builds: false,
    },
];

impl Need {
    /// Whether it is here.
    pub fn is_met(&self) -> bool {
        match self.sign {
            Sign::Files(files) => found(files),
            Sign::Asked(is_there) => is_there(),
        }
    }
}

/// Install what the builds and the tests need.
#[derive(Debug, Default, clap::Args)]
pub struct Args {
    /// Only what must be here before anything is built
    #[arg(long, conflicts_with = "only_tests")]
    only_builds: bool,
    /// Only what must be here before the tests run
    #[arg(long)]
    only_tests: bool,
}

/// Says what is needed and installs what is not here; what cannot be installed is said, and its
/// tests skipped.
pub fn run(args: &Args) {
    if !args.only_tests {
        crates();
        each(|need| need.for_builds);
    }
    if !args.only_builds {
        each(|need| !need.for_builds);
        super::python::all();
        super::python_package::install();
        super::npm::all();
    }
}

/// What the builds need alone.
pub fn for_builds() {
    run(&Args {
        only_builds: true,
        only_tests: false,
    });
}

fn crates() {
    println!("Needed: the crates in Cargo.lock. Fetching them where they are not here yet.");
    program::run(&mut cargo(&["fetch", "--locked"]));
}

fn each(wanted: impl Fn(&Need) -> bool) {
    for need in NEEDS.iter().filter(|need| wanted(need)) {
        let Need {
            name, wanted_for, ..
        } = need;
        match obstacle(need) {
            None if need.is_met() => println!("{name}, for {wanted_for}: here already."),
            None => bring(need),
            Some(why) => println!("{name}, for {wanted_for}: {why}; they are skipped."),
        }
    }
}

fn obstacle(need: &Need) -> Option<&'static str> {
    if need.is_met() {
        None
    } else if !found(&["apt-get"]) {
        Some("no apt-get here")
    } else if !is_root() {
        Some("only root may install it")
    } else {
        None
    }
}

fn bring(need: &Need) {
    println!(
        "{}, for {}: installing {} by apt-get.",
        need.name,
        need.wanted_for,
        need.packages.join(" ")
    );
    // The lists of packages may be missing or stale, and then bring too old a version; they are
    // renewed only when they did not serve.
    let well = |need: &Need| install(need) && need.is_met();
    if !(well(need) || (apt(&["update"]) && well(need))) {
        println!(
            "{} could not be installed; {} are skipped.",
            need.name, need.wanted_for
        );
    }
}

fn install(need: &Need) -> bool {
    let words = ["install", "--yes", "--no-install-recommends"];
    apt(&[&words, need.packages].concat())
}

fn apt(words: &[&str]) -> bool {
    let mut apt = Command::new("apt-get");
    program::run(apt.args(words).env("DEBIAN_FRONTEND", "noninteractive"))
}
