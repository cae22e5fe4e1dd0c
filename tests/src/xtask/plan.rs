//! `cargo xtask plan`: the plan of the repository's robot as a file that the firmware compiles in.

use handstand::Model;
use handstand::controllers::{Fitting, Timing, board_plan, plan_file};
use std::path::{Path, PathBuf};

/// Write the plan that `cargo xtask firmware --plan` compiles in.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The model
    #[arg(long, default_value = "host/models/handstand.toml")]
    model: PathBuf,
    /// The file to write
    #[arg(long, default_value = "target/plan.rs")]
    out: PathBuf,
    /// For a gyro on the CM-5 instead of an attitude from the host
    #[arg(long)]
    gyro: bool,
}

/// Whether it was written.
pub fn run(args: &Args) -> bool {
    match made(args).and_then(|text| {
        std::fs::write(&args.out, text).map_err(|error| format!("{}: {error}", args.out.display()))
    }) {
        Ok(()) => {
            eprintln!(
                "Compile it in: cargo xtask firmware --plan {}",
                args.out.display()
            );
            true
        }
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn made(args: &Args) -> Result<String, String> {
    let say = |error: handstand::Error| error.to_string();
    let model = Model::load(Path::new(&args.model)).map_err(say)?;
    let (mut fitting, timing) = (
        Fitting::BIOLOID,
        if args.gyro {
            Timing::GYRO
        } else {
            Timing::HOST_ATTITUDE
        },
    );
    fitting.gyro.from_host = !args.gyro;
    let (_, plan) = board_plan(&model, &fitting, &timing).map_err(say)?;
    let gyro = if args.gyro { " --gyro" } else { "" };
    Ok(plan_file(
        &plan,
        &format!("cargo xtask plan --model {}{gyro}", args.model.display()),
    ))
}
