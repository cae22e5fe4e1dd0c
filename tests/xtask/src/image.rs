//! `cargo xtask firmware`: builds the CM-5's program, says what it takes, and refuses what must not
//! be in it.

use handstand_xtask::firmware::{self, Budget, Built, FLASH_LIMIT, Image, RAM_SIZE, Toolchain};
use serde_json::json;
use std::path::PathBuf;

/// Build the CM-5's program: ELF, HEX and BIN.
#[derive(Debug, Default, clap::Args)]
pub struct Args {
    /// A plan to compile in, as `handstand gains deploy --header` writes it; one in EEPROM wins
    #[arg(long)]
    plan: Option<PathBuf>,
    /// Take this image's flash and RAM as what later ones may not exceed: firmware/budget.json
    #[arg(long, conflicts_with = "plan")]
    accept_size: bool,
    /// Print sizes and files as JSON
    #[arg(long)]
    json: bool,
}

/// Whether it was built and may be flashed.
pub fn run(args: &Args) -> bool {
    match made(args) {
        Ok((toolchain, built, image)) => {
            show(args, toolchain.name, &built, &image);
            is_fit(&image) && keeps_budget(args, &image)
        }
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn made(args: &Args) -> Result<(Toolchain, Built, Image), String> {
    let toolchain = Toolchain::find()?;
    eprintln!(
        "Building with {}; the first time takes minutes.",
        toolchain.name
    );
    let built = firmware::build(&toolchain, args.plan.as_deref())?;
    let image = Image::of(&built)?;
    Ok((toolchain, built, image))
}

fn show(args: &Args, toolchain: &str, built: &Built, image: &Image) {
    let Image {
        flash,
        ram,
        stack,
        forbidden,
    } = image;
    if args.json {
        println!(
            "{}",
            json!({
                "toolchain": toolchain, "elf": built.elf, "hex": built.hex, "bin": built.bin,
                "flash_bytes": flash, "flash_limit_bytes": FLASH_LIMIT, "ram_bytes": ram, "ram_size_bytes": RAM_SIZE,
                "stack_bytes": stack,
                "forbidden_symbols": forbidden,
            })
        );
        return;
    }
    let share = |part: usize, whole: usize| 100.0 * part as f64 / whole as f64;
    println!(
        "Flash  {flash:6} of {FLASH_LIMIT} bytes, {:.1} %",
        share(*flash, FLASH_LIMIT)
    );
    println!(
        "RAM    {ram:6} of   {RAM_SIZE} bytes static, {:.1} %; {} are left for the stack",
        share(*ram, RAM_SIZE),
        RAM_SIZE - ram
    );
    println!(
        "Stack  {stack:6} bytes at most; with static data {:.1} % of RAM",
        share(ram + stack, RAM_SIZE)
    );
    println!("ELF    {}", built.elf.display());
    println!("HEX    {}", built.hex.display());
    println!("BIN    {}", built.bin.display());
}

/// Whether flash and RAM are about what they were last; a plan adds to them.
fn keeps_budget(args: &Args, image: &Image) -> bool {
    if args.plan.is_some() {
        return true;
    }
    let checked = if args.accept_size {
        Budget::accept(image).map(|()| Vec::new())
    } else {
        Budget::last().map(|last| last.exceeded(image))
    };
    let said = checked.unwrap_or_else(|why| vec![why]);
    said.iter().for_each(|line| eprintln!("{line}"));
    said.is_empty()
}

fn is_fit(image: &Image) -> bool {
    for symbol in &image.forbidden {
        eprintln!("Not fit to be flashed: it links {symbol}");
    }
    if image.flash >= FLASH_LIMIT {
        eprintln!("Not fit to be flashed: it would overwrite the boot loader");
    }
    let has_room = (image.ram + image.stack) * 10 <= RAM_SIZE * 8;
    if !has_room {
        eprintln!("Not fit to be flashed: static data and stack take more than 80 % of RAM");
    }
    image.forbidden.is_empty() && image.flash < FLASH_LIMIT && has_room
}
