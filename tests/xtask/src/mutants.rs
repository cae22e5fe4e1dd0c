//! `cargo xtask mutants`: breaks the firmware's safety on purpose, one place at a time, and counts
//! how many of the breaks the tests in process notice.
//!
//! The list is kept by hand: each entry is a defect that once survived, or that would cost a robot.
//! The sources are copied to `target/mutants`, broken there, and tested there.

use handstand_xtask::{cargo, root};
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Break the firmware on purpose and count what the tests notice.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only mutants whose name holds this
    #[arg(long)]
    only: Option<String>,
    /// Runs of the state machine's test, of 1000 steps each, in each of its two tests
    #[arg(long, default_value_t = 25)]
    runs: u32,
}

/// One break: in this file this text becomes that.
struct Mutant {
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
}

/// Share of mutants that must be caught.
const TARGET: f64 = 0.95;

/// Whether enough were caught.
pub fn run(args: &Args) -> bool {
    match caught(args) {
        Ok(well) => well,
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn caught(args: &Args) -> Result<bool, String> {
    let folder = copied()?;
    if !passes(&folder, args.runs) {
        return Err("the tests fail without any mutant: mend them first".into());
    }
    let chosen = |mutant: &&Mutant| {
        let only = args.only.as_deref();
        only.is_none_or(|part| mutant.name.contains(part))
    };
    let (mut tried, mut missed) = (0, Vec::new());
    for mutant in MUTANTS.iter().filter(chosen) {
        let path = folder.join(mutant.file);
        let kept = read(&path)?;
        if kept.matches(mutant.from).count() != 1 {
            return Err(format!(
                "{}: `{}` is not there once: mend the list",
                mutant.file, mutant.name
            ));
        }
        write(&path, &kept.replace(mutant.from, mutant.to))?;
        let survives = passes(&folder, args.runs);
        write(&path, &kept)?;
        tried += 1;
        println!(
            "{}  {}",
            if survives { "MISSED" } else { "caught" },
            mutant.name
        );
        if survives {
            missed.push(mutant.name);
        }
    }
    let share = 1.0 - missed.len() as f64 / f64::from(tried.max(1));
    println!(
        "{} of {tried} caught, {:.0} %; at least {:.0} % are wanted",
        tried - missed.len() as u32,
        100.0 * share,
        100.0 * TARGET
    );
    Ok(share >= TARGET)
}

/// The sources of the tests, and a workspace of them alone.
fn copied() -> Result<PathBuf, String> {
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let folder = root().join(target).join("mutants");
    for name in ["firmware", "shared", "host/cm5-sim"] {
        let to = folder.join(name);
        if to.exists() {
            std::fs::remove_dir_all(&to).map_err(|error| format!("{}: {error}", to.display()))?;
        }
        copy(&root().join(name), &to)?;
    }
    let manifest = read(&root().join("Cargo.toml"))?;
    // Behind the members and the default ones.
    let (_, behind) = manifest
        .split_once("[workspace.package]")
        .ok_or("Cargo.toml has no [workspace.package]")?;
    let members =
        "[workspace]\nresolver = \"3\"\nmembers = [\"firmware\", \"host/cm5-sim\", \"shared\"]\n";
    write(
        &folder.join("Cargo.toml"),
        &format!("{members}[workspace.package]{behind}"),
    )?;
    let lock = folder.join("Cargo.lock");
    std::fs::copy(root().join("Cargo.lock"), &lock)
        .map_err(|error| format!("{}: {error}", lock.display()))?;
    Ok(folder)
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", from.display());
    std::fs::create_dir_all(to).map_err(failed)?;
    for entry in std::fs::read_dir(from).map_err(failed)?.flatten() {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        match path.is_dir() {
            true => copy(&path, &to)?,
            false => std::fs::copy(&path, &to).map(|_| ()).map_err(failed)?,
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Whether it compiles and all tests pass.
fn passes(folder: &Path, runs: u32) -> bool {
    let words = [
        "test",
        "--quiet",
        "--workspace",
        "--offline",
        "--lib",
        "--tests",
    ];
    let mut cargo = cargo(&words);
    cargo.current_dir(folder);
    cargo.env("CARGO_TARGET_DIR", folder.join("target"));
    cargo.env("PROPTEST_CASES", runs.to_string());
    cargo.stdout(Stdio::null()).stderr(Stdio::null());
    cargo.status().is_ok_and(|status| status.success())
}

const MUTANTS: &[Mutant] = &[
    Mutant {
        name: "a low supply lets nothing down",
        file: "firmware/src/app/soft_stop.rs",
        from: "self.low.0 >= LOW_ROUNDS",
        to: "self.low.0 > 254",
    },
    Mutant {
        name: "any supply arms",
        file: "firmware/src/app/command.rs",
        from: "Some(supply) if supply >= LOW_SUPPLY => Ok(())",
        to: "Some(_) => Ok(())",
    },
    Mutant {
        name: "a disarming keeps the token",
        file: "firmware/src/app/soft_stop.rs",
        from: "        self.token = None;\n",
        to: "",
    },
    Mutant {
        name: "a token arms again",
        file: "firmware/src/app/command.rs",
        from: "right != token || self.is_used",
        to: "right != token",
    },
    Mutant {
        name: "arming while a plan is written",
        file: "firmware/src/app/command.rs",
        from: "self.writer.is_busy()",
        to: "false",
    },
    Mutant {
        name: "a piece of a plan is taken while armed",
        file: "firmware/src/app/command.rs",
        from: "Command::PlanChunk { offset, bytes } => match self.is_armed() {",
        to: "Command::PlanChunk { offset, bytes } => match false {",
    },
    Mutant {
        name: "a plan is stored while armed",
        file: "firmware/src/app/command.rs",
        from: "Command::PlanStore { length, check } => match self.is_armed() {",
        to: "Command::PlanStore { length, check } => match false {",
    },
    Mutant {
        name: "a plan's check is ignored when it is stored",
        file: "firmware/src/plan_store.rs",
        from: "body_check(board, slot, length) != check",
        to: "false && body_check(board, slot, length) != check",
    },
    Mutant {
        name: "a slot's check is ignored",
        file: "firmware/src/plan_store.rs",
        from: "== u32::from_le_bytes(check);",
        to: "== u32::from_le_bytes(check) || true;",
    },
    Mutant {
        name: "the pose is not checked",
        file: "firmware/src/app/command.rs",
        from: "!self.balance.is_posed(&readings)",
        to: "false",
    },
    Mutant {
        name: "an old attitude is balanced with",
        file: "firmware/src/app/soft_stop.rs",
        from: "self.attitude_age.us() <= ATTITUDE_US",
        to: "true",
    },
    Mutant {
        name: "any frame is life",
        file: "firmware/src/app/command.rs",
        from: "if message.is_life() {",
        to: "if true {",
    },
    Mutant {
        name: "silence lets nothing down",
        file: "firmware/src/app/soft_stop.rs",
        from: "self.life.us() >= SILENT_US",
        to: "false",
    },
    Mutant {
        name: "a fault says torque off no more",
        file: "firmware/src/app/modes.rs",
        from: "self.ticks & 7 == 0",
        to: "false",
    },
    Mutant {
        name: "torque off is not repeated",
        file: "firmware/src/app.rs",
        from: "self.off.us() < INSIST_US && !self.is_armed()",
        to: "false",
    },
    Mutant {
        name: "nothing completes the packet before a restart",
        file: "firmware/src/app.rs",
        from: "bus::torque_off_at_start(board);",
        to: "bus::torque_off(board);",
    },
    Mutant {
        name: "the gyro turns the other way",
        file: "firmware/src/balance.rs",
        from: "wrapping_mul(i32::from(self.plan.gyro.scale)) >> 4",
        to: "wrapping_mul(-i32::from(self.plan.gyro.scale)) >> 4",
    },
    Mutant {
        name: "joints have no range",
        file: "firmware/src/balance.rs",
        from: "!joint.is_in_range(*q)",
        to: "false",
    },
    Mutant {
        name: "joints have no largest speed",
        file: "firmware/src/balance.rs",
        from: "!joint.is_slow(q.wrapping_sub(last), ago)",
        to: "false",
    },
    Mutant {
        name: "lost torque is not noticed",
        file: "firmware/src/servos/round.rs",
        from: "|| !has_torque",
        to: "",
    },
    Mutant {
        name: "overload is not noticed",
        file: "firmware/src/servos/round.rs",
        from: "error.0 & GAVE_UP != 0 ||",
        to: "",
    },
    Mutant {
        name: "a round of readings lasts for ever",
        file: "firmware/src/servos/round.rs",
        from: "is_asked = since_us(board, started) < ROUND_US;",
        to: "is_asked = true;",
    },
    Mutant {
        name: "the watchdog is fed by every turn of the main loop",
        file: "firmware/src/app.rs",
        from: "        self.pump(board);\n        if",
        to: "        self.pump(board);\n        board.feed_watchdog();\n        if",
    },
    Mutant {
        name: "a button stops nothing",
        file: "firmware/src/app.rs",
        from: "        self.panel(board);\n",
        to: "",
    },
    Mutant {
        name: "a button that is held keeps nothing from arming",
        file: "firmware/src/app/command.rs",
        from: "self.buttons.is_down()",
        to: "false",
    },
    Mutant {
        name: "arming with ticks that last too long",
        file: "firmware/src/app/command.rs",
        from: "self.calm < CALM_TICKS",
        to: "false",
    },
    Mutant {
        name: "arming sets full torque",
        file: "firmware/src/servos/commands.rs",
        from: "bus::write_all(board, TORQUE_LIMIT, limits.torque.0);",
        to: "bus::write_all(board, TORQUE_LIMIT, 1023);",
    },
    Mutant {
        name: "a wheel gets a speed when it is armed",
        file: "firmware/src/servos/commands.rs",
        from: "Some(true) | None => 0,",
        to: "Some(true) | None => limits.speed.0,",
    },
    Mutant {
        name: "goals jump",
        file: "firmware/src/servos/commands.rs",
        from: "goals.get(place).max(nearest).min(farthest)",
        to: "goals.get(place)",
    },
    Mutant {
        name: "the CRC-16 starts with zero",
        file: "shared/src/crc.rs",
        from: "pub const START_16: u16 = 0xffff;",
        to: "pub const START_16: u16 = 0;",
    },
    Mutant {
        name: "a critical message's check is ignored",
        file: "shared/src/message/mod.rs",
        from: "crc32(summed).to_le_bytes() != [a, b, c, d]",
        to: "crc32(summed).to_le_bytes() == [0; 4] && [a, b, c, d] == [1; 4]",
    },
    Mutant {
        name: "frames hold a `#`",
        file: "shared/src/message/mod.rs",
        from: "const WITHOUT: Option<u8> = Some(b'#');",
        to: "const WITHOUT: Option<u8> = None;",
    },
];
