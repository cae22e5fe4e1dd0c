//! `handstand flash IMAGE.bin`: a program into the CM-5, through its boot loader.
//!
//! ```console
//! $ cargo xtask firmware
//! $ handstand flash handstand-firmware.bin --port /dev/ttyUSB0
//! ```
//!
//! Press the CM-5's MODE button (reset) when asked. Size and checksum are compared with the boot
//! loader's, what it says to `verify` is shown, and the application starts at every power-on from
//! then on (`--no-app` leaves that out). The boot loader itself is never written. `--pace-us` slows
//! the line down, `--dry-run` only checks the file.
//!
//! `--isp PROGRAMMER` goes through avrdude and the board's ISP pads instead. That erases the whole
//! chip, the boot loader included: afterwards only a programmer can write it. It asks before,
//! unless `--yes`.
//!
//! `--json` prints `bytes`, `checksum`, `written`, `verify_said`, `starts_at_power_on`; with
//! `--dry-run` or `--isp` `command` or less.

use super::{Console, ExitStatus, interrupt::Interrupt, port::Port};
use handstand::link::boot_loader::{BootLoader, Image};
use handstand::{Error, Result};
use serde_json::json;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Flash firmware into the CM-5.
#[derive(Debug, clap::Args)]
pub struct FlashArgs {
    /// Raw binary; for --isp also HEX or ELF
    image: PathBuf,
    #[command(flatten)]
    port: Port,
    #[command(flatten)]
    loader: Loader,
    /// Start the application when all is well
    #[arg(long)]
    go: bool,
    /// Only check the file
    #[arg(long)]
    dry_run: bool,
    /// Go through avrdude and this programmer; erases the boot loader
    #[arg(long, value_name = "PROGRAMMER")]
    isp: Option<String>,
    /// Do not ask
    #[arg(long)]
    yes: bool,
}

/// How the boot loader is spoken with.
#[derive(Debug, Clone, clap::Args)]
pub struct Loader {
    /// Pause after every byte, for a line that loses some
    #[arg(long, value_name = "MICROSECONDS", default_value_t = 0)]
    #[arg(value_parser = clap::value_parser!(u64).range(0..=100_000))]
    pace_us: u64,
    /// Seconds to wait for the reset
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u64).range(1..=600))]
    wait: u64,
    /// Do not start the application at power-on
    #[arg(long)]
    no_app: bool,
    /// Take any program for the AVR, not only Handstand's
    #[arg(long)]
    pub any_program: bool,
}

/// Checks the image, then writes it.
pub fn run(args: &FlashArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(programmer) = &args.isp {
        return isp(args, programmer, console);
    }
    let image = if args.loader.any_program {
        Image::load_any(&args.image)?
    } else {
        Image::load(&args.image)?
    };
    let facts = format!(
        "{}: {} bytes, checksum {:02X}",
        args.image.display(),
        image.bytes().len(),
        image.checksum()
    );
    if args.dry_run {
        console.say(&format!("{facts}; nothing was sent"));
        return report(&image, None, false, console);
    }
    console.say(&facts);
    let said = write(&image, &args.port, &args.loader, args.go, console)?;
    report(&image, Some(&said), !args.loader.no_app, console)
}

/// Writes an image through the boot loader, and starts it now if `go`; what the loader says to
/// `verify`.
///
/// # Errors
/// It does not answer, or received something else.
pub fn write(
    image: &Image,
    port: &Port,
    how: &Loader,
    go: bool,
    console: &Console,
) -> Result<String> {
    let interrupt = Interrupt::listen();
    let link = port.open()?;
    console.say("Press the MODE button (reset) of the CM-5 now.");
    let patience = Duration::from_secs(how.wait);
    let pace = Duration::from_micros(how.pace_us);
    let mut loader = BootLoader::enter(link, pace, patience, || !interrupt.has_come())?;
    // A write that is interrupted leaves half a program: it must not start.
    loader.stay_at_power_on()?;
    let bar = console.bar(image.bytes().len() as u64);
    bar.set_message("bytes; do not switch off");
    loader.load(image, |sent| bar.set_position(sent as u64))?;
    drop(bar);
    let said = loader.verify()?;
    console.say(&format!("verify: the boot loader says `{said}`"));
    if !how.no_app {
        loader.start_at_power_on()?;
    }
    if go {
        loader.go()?;
    }
    console.say("Written: size and checksum are those of the file.");
    Ok(said)
}

fn report(
    image: &Image,
    said: Option<&str>,
    starts: bool,
    console: &Console,
) -> Result<ExitStatus> {
    if console.json {
        console.data(&json!({
            "bytes": image.bytes().len(),
            "checksum": image.checksum(),
            "written": said.is_some(),
            "verify_said": said,
            "starts_at_power_on": starts,
        }))?;
    }
    Ok(ExitStatus::Done)
}

/// avrdude's letter for a kind of file.
fn format_of(path: &Path) -> Result<&'static str> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("bin") => Ok("r"),
        Some("hex") => Ok("i"),
        Some("elf") => Ok("e"),
        _ => Err(Error::usage(
            format!("{}: what kind of file is this?", path.display()),
            "give a .hex, .elf or .bin",
        )),
    }
}

fn isp(args: &FlashArgs, programmer: &str, console: &Console) -> Result<ExitStatus> {
    let kind = format_of(&args.image)?;
    if let Err(error) = std::fs::metadata(&args.image) {
        return Err(Error::file(&args.image, "read", error));
    }
    let target = format!("flash:w:{}:{kind}", args.image.display());
    // Fuses and lock bits are never written.
    let words = ["-p", "m128", "-c", programmer, "-U", &target];
    let line = format!("avrdude {}", words.join(" "));
    console.say(
        "This erases the whole chip, the CM-5's boot loader included: afterwards only a \
         programmer can write it.",
    );
    if args.dry_run {
        console.say(&format!("{line}; not run"));
    } else {
        agreed(args.yes, "Erase the boot loader?")?;
        let status = Command::new("avrdude")
            .args(words)
            .status()
            .map_err(|error| {
                Error::device(
                    format!("avrdude cannot be run: {error}"),
                    "install it: apt-get install avrdude",
                )
            })?;
        if !status.success() {
            return Err(Error::device(
                format!("avrdude failed: {status}"),
                "is the programmer on J5, the board powered?",
            ));
        }
    }
    if console.json {
        console.data(&json!({ "command": line, "run": !args.dry_run }))?;
    }
    Ok(ExitStatus::Done)
}

/// Asks on the terminal, unless it was answered beforehand.
///
/// # Errors
/// [`Error::Usage`] if the answer is not yes, or there is no terminal to ask on.
pub fn agreed(yes: bool, question: &str) -> Result<()> {
    if yes {
        return Ok(());
    }
    if !std::io::stdin().is_terminal() {
        return Err(Error::usage(
            "nobody is here to be asked",
            "pass --yes if you mean it",
        ));
    }
    eprint!("{question} Type yes: ");
    let mut answer = String::new();
    let read = std::io::stdin().read_line(&mut answer);
    if read.is_ok() && answer.trim() == "yes" {
        Ok(())
    } else {
        Err(Error::usage("not agreed to", "nothing was done"))
    }
}
