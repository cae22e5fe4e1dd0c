//! `handstand gains deploy MODEL`: gains from a model onto the CM-5. `handstand deploy` is the
//! same.
//!
//! Two laws run on the board. `--law observer`, unless told otherwise, is the one that stands on
//! 10-bit positions: a Kalman filter with known delays and angles of balance, and a regulator
//! behind it; it has weights of its own. `--law state` is what `handstand gains` designs, with its
//! options, on positions and their differences.
//!
//! What the model says of its drives goes into the plan: delay and encoder lag into the observer,
//! dead zone and dry friction into what is jumped over, limits, the supply; options go before it.
//! What no plan has a place for is listed. Whether the plan holds the robot is tried out: ten
//! starts within 1 deg, on the firmware's own logic, the model with all of its effects behind
//! simulated servos. With `--dry-run` the exit code is 1 where fewer than nine stand for 10 s. A
//! law on plain states whose loop is unstable with the board's own speeds is refused.
//!
//! Step by step: designs; tries the plan out; writes the whole plan (`--header`), and of a law on
//! plain states the table (`--rust`, `--c`), as source files; uploads the plan, which the CM-5
//! keeps in EEPROM beside the one before, or with `--flash` builds the firmware with the plan
//! compiled in and writes that through the boot loader; reads it back; compares bytes and
//! fingerprint; and runs the CM-5's law, on the tables read back, over random states against wide
//! integers: not a bit may differ.
//!
//! The plan is more than its tables: which servos are in shoulder and hip (`--joints`), torque at
//! full output, dead zone, slew, where the first link's rate comes from (the PC, or with
//! `--gyro-per-code` the gyro), and when it counts as fallen. States are in the firmware's steps,
//! so `--state-step` has no place here.
//!
//! ```console
//! $ handstand gains deploy handstand.toml --port /dev/ttyUSB0
//! $ handstand gains deploy handstand.toml --law state --q 100 --r 1 --flash --port /dev/ttyUSB0
//! ```
//!
//! Torque stays off. `--json` prints `law`, `steps`, `way` (`upload`, `flash`, null),
//! `fingerprint`, `bytes`, `uploaded`, `states_replayed`, `limits` (of each unstable mode
//! `pole_per_s`, `answer_s`, `growth`, `degree_share`, `half_step_share`; empty with `--law
//! state`), `effects` (`effect`, `place`, `how`: what the plan takes of the model, and what it
//! cannot), `radius` (of a law on plain states), `margins` (at the inputs) and
//! `lean_per_torque` (of the observer's loop), `verdict` (`stood`, `holds`, `attempts`).

pub mod board;
mod build;
mod limits;
pub(super) mod verdict;

use super::flash::{Loader, write};
use super::port::Port;
use super::{Console, ExitStatus, gains};
use board::BoardArgs;
use clap::ValueEnum as _;
use handstand::deploy::{self, BoardLaw, ModeLimit, ObserverLoop, PlanBasis, plan_file};
use handstand::link::Session;
use handstand::link::boot_loader::Image;
use handstand::output::write_new;
use handstand::report::place_margins_json;
use handstand::synth::rows;
use handstand::{Error, Model, Result};
use handstand_shared::plan::Plan;
pub use limits::uses_table;
use limits::{limits_table, observer_text};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Bring gains onto the CM-5.
#[derive(Debug, clap::Args)]
#[group(id = "deploy")]
pub struct DeployArgs {
    #[command(flatten)]
    gains: gains::GainsArgs,
    #[command(flatten)]
    board: BoardArgs,
    #[command(flatten)]
    port: Port,
    /// The law
    #[arg(long, value_enum, default_value_t = LawKind::Observer)]
    law: LawKind,
    /// Compile the plan into the firmware and write that through the boot loader, instead of
    /// uploading it
    #[arg(long)]
    flash: bool,
    #[command(flatten)]
    loader: Loader,
    /// Handstand's repository, for --flash
    #[arg(long, value_name = "DIR", default_value = ".")]
    firmware: PathBuf,
    /// Write the plan as a Rust file
    #[arg(long, value_name = "FILE.rs")]
    header: Option<PathBuf>,
    /// Random states to compare the laws over
    #[arg(long, default_value_t = 1_000_000)]
    states: u64,
    /// Seed of these states
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Send nothing to the CM-5; exit code 1 where the plan does not hold the model's robot
    #[arg(long)]
    dry_run: bool,
    /// Make a plan even of gains whose loop on the board is unstable, to look at its tables
    #[arg(long)]
    unstable: bool,
}

/// What runs on the board.
#[derive(Debug, Clone, Copy, PartialEq, clap::ValueEnum)]
enum LawKind {
    /// On an estimated state
    Observer,
    /// The designed gains on positions and their differences
    State,
}

/// Gains for a model, or what is done with them.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct GainsCommand {
    #[command(subcommand)]
    then: Option<Then>,
    #[command(flatten)]
    gains: Option<gains::GainsArgs>,
}

#[derive(Debug, clap::Subcommand)]
enum Then {
    /// Deploy the gains to the CM-5, and read them back
    Deploy(Box<DeployArgs>),
}

/// Designs; deploys if told to.
pub fn gains(args: &GainsCommand, console: &Console) -> Result<ExitStatus> {
    match (&args.then, &args.gains) {
        (Some(Then::Deploy(args)), _) => run(args, console),
        (None, Some(args)) => gains::run(args, console),
        (None, None) => Err(Error::usage(
            "no model is given",
            "name a model file: handstand gains MODEL",
        )),
    }
}

/// What was done so far.
struct DeploySteps<'a> {
    done: Vec<String>,
    console: &'a Console,
}

impl DeploySteps<'_> {
    fn say(&mut self, step: String) {
        self.console
            .say(&format!("{}. {step}", self.done.len() + 1));
        self.done.push(step);
    }
}

/// A plan, what it was made with, and what it leads to.
struct Planned {
    model: Model,
    basis: PlanBasis,
    plan: Plan,
    /// Of its unstable modes, where an observer knows when its torques act.
    limits: Vec<ModeLimit>,
    /// Spectral radius of the loop of a law on plain states.
    radius: Option<f64>,
    /// Margins and stiffness of the loop with the observer.
    observer: Option<ObserverLoop>,
}

/// Designs; the files of a design are written.
fn planned(args: &DeployArgs, console: &Console) -> Result<Planned> {
    let model = Model::load(args.gains.model())?;
    let basis = args.board.basis(&model)?;
    let board = &basis.board;
    if args.law == LawKind::Observer {
        if let Some(option) = args.gains.for_plain_states() {
            let what = format!(
                "{option} is for gains on plain states, which `--law observer` does not run"
            );
            return Err(Error::usage(what, "leave it out, or say --law state"));
        }
        return Ok(Planned {
            plan: basis.plan(&model)?,
            limits: deploy::mode_limits(&model, board, &basis.timing)?,
            radius: None,
            observer: Some(deploy::observer_loop(&model, &basis)?),
            model,
            basis,
        });
    }
    if args.gains.is_integral() {
        return Err(Error::usage(
            "the CM-5's plan has no place for the sums of --integral",
            "leave --law out: the observer estimates lasting torques; or put the file of --c or \
             --rust into a firmware of your own",
        ));
    }
    let (reduced, request, made) =
        gains::requested(&args.gains, console).map_err(gains::of_options)?;
    let design = deploy::state_design(&reduced, request, board).map_err(gains::of_options)?;
    let plan = deploy::plan(&model, BoardLaw::State(&design), board)?;
    let radius = deploy::state_radius(&model, &design, &basis)?;
    if radius >= 1.0 && !args.unstable {
        return Err(Error::design(
            format!(
                "with the board's own speeds, differences smoothed over two ticks, the loop of \
                 these gains has the spectral radius {radius:.4}: it is unstable"
            ),
            "leave --law out: the observer's speeds come without that delay; or --unstable makes \
             the plan all the same",
        ));
    }
    let data = handstand::synth::export::json(&design, &made);
    gains::write(&args.gains, &design, &made, &data, console)?;
    Ok(Planned {
        model,
        basis,
        plan,
        limits: Vec::new(),
        radius: Some(radius),
        observer: None,
    })
}

/// Designs, brings over, reads back, replays.
pub fn run(args: &DeployArgs, console: &Console) -> Result<ExitStatus> {
    let mut steps = DeploySteps {
        done: Vec::new(),
        console,
    };
    let made = planned(args, console)?;
    let plan = made.plan;
    let fingerprint = plan.fingerprint();
    let mut bytes = Vec::new();
    plan.bytes(|byte| bytes.push(byte));
    steps.say(format!(
        "designed: fingerprint {fingerprint:08X}, a plan of {} bytes",
        bytes.len()
    ));
    let verdict = verdict::of(&made.model, &made.plan, &made.basis, console)?;
    if let Some(file) = &args.header {
        write_new(
            file,
            &plan_file(&plan, &console.command),
            args.gains.force(),
        )?;
        steps.say(format!("wrote {}", file.display()));
    }
    let back = if args.flash {
        flash(args, &plan, &bytes, &mut steps)?
    } else {
        upload(args, &bytes, fingerprint, &mut steps)?
    };
    replay(args, &back, &mut steps)?;
    let way = match (args.dry_run, args.flash) {
        (true, _) => None,
        (false, true) => Some("flash"),
        (false, false) => Some("upload"),
    };
    let (fingerprint, bytes) = (format!("{fingerprint:08X}"), bytes.len());
    let data = json!({
        "law": args.law.to_possible_value().map(|law| law.get_name().to_string()),
        "steps": steps.done,
        "way": way,
        "fingerprint": fingerprint,
        "bytes": bytes,
        "uploaded": way.is_some(),
        "states_replayed": args.states,
        "limits": made.limits,
        "effects": made.basis.uses,
        "radius": made.radius,
        "margins": place_margins_json(
            made.observer.as_ref().and_then(|it| it.margins.as_ref()),
        ),
        "lean_per_torque": made.observer.as_ref().map(|it| it.lean_per_torque.as_ref().map(rows)),
        "verdict": verdict.as_ref(),
    });
    console.result(&data, || {
        let mut parts = vec![uses_table(&made.basis.uses)];
        if !made.limits.is_empty() {
            parts.push(limits_table(&made.limits));
        }
        parts.extend(made.observer.as_ref().map(observer_text));
        parts.push(verdict::words(verdict.as_ref(), &plan));
        parts.push(format!("fingerprint {fingerprint}, {bytes} bytes"));
        parts.join("\n")
    })?;
    match way {
        _ if console.json => {}
        None => console.say("nothing was sent"),
        Some(_) => console.say("the CM-5 has these gains; torque is off"),
    }
    Ok(if args.dry_run {
        ExitStatus::answer(verdict::holds(verdict.as_ref()))
    } else {
        ExitStatus::Done
    })
}

/// Compares the law that came back with wide integers.
fn replay(args: &DeployArgs, back: &[u8], steps: &mut DeploySteps) -> Result<()> {
    let back = Plan::from_bytes(back).ok_or_else(|| {
        Error::device(
            "what came back is no plan",
            "flash the firmware that belongs to this program",
        )
    })?;
    let bar = steps.console.bar(args.states);
    let done = |done| bar.set_position(done);
    deploy::replay(&back.law, args.states, args.seed, done)?;
    drop(bar);
    steps.say(format!(
        "replayed: its law on its tables equals wide integers bit for bit over {} states",
        args.states
    ));
    Ok(())
}

fn upload(
    args: &DeployArgs,
    bytes: &[u8],
    fingerprint: u32,
    steps: &mut DeploySteps,
) -> Result<Vec<u8>> {
    if args.dry_run {
        return Ok(bytes.to_vec());
    }
    let mut session = Session::open(args.port.open()?)?;
    let bar = steps.console.bar(bytes.len() as u64);
    deploy::upload(&mut session, bytes, |sent| bar.set_position(sent))?;
    drop(bar);
    steps.say("uploaded: the CM-5 keeps it in EEPROM".to_string());
    verified(&mut session, bytes, fingerprint, steps)
}

fn flash(args: &DeployArgs, plan: &Plan, bytes: &[u8], steps: &mut DeploySteps) -> Result<Vec<u8>> {
    let folder = tempfile::tempdir()
        .map_err(|error| Error::file(Path::new("temporary folder"), "make", error))?;
    let file = folder.path().join("plan.rs");
    write_new(&file, &plan_file(plan, &steps.console.command), false)?;
    let bin = build::build(&args.firmware, &file)?;
    let image = Image::load(&bin)?;
    steps.say(format!(
        "built: {} with the plan compiled in, {} bytes",
        bin.display(),
        image.bytes().len()
    ));
    if args.dry_run {
        return Ok(bytes.to_vec());
    }
    write(&image, &args.port, &args.loader, true, steps.console)?;
    steps.say("flashed: size and checksum are those of the file".to_string());
    // It starts within its first second.
    std::thread::sleep(std::time::Duration::from_secs(1));
    let mut session = Session::open(args.port.open()?)?;
    let (theirs, ours) = (session.hello.plan, plan.fingerprint());
    if theirs != ours {
        return Err(Error::device(
            format!(
                "the CM-5 balances by {theirs:08X}, not by {ours:08X} that was compiled in: a plan \
                 in its EEPROM wins"
            ),
            "replace that plan: the same without --flash",
        ));
    }
    verified(&mut session, bytes, ours, steps)
}

fn verified(
    session: &mut Session<super::port::AnyLink>,
    bytes: &[u8],
    fingerprint: u32,
    steps: &mut DeploySteps,
) -> Result<Vec<u8>> {
    let back = deploy::verify(session, bytes, fingerprint)?;
    steps.say(format!(
        "read back: {} bytes and the fingerprint are the same",
        back.len()
    ));
    Ok(back)
}
