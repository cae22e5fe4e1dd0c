//! `handstand init LOG -o MODEL.toml`: starts a model from a log.
//!
//! Columns and units are guessed from the header's names and the values' ranges, the angles' zero
//! from where a free joint rests or how torques follow angles, a free link's length from how often
//! it swings. Each guess is said with its reason, and stands in the file as a comment. On a
//! terminal what nothing tells is asked, unless an option answers it; elsewhere nothing is asked.
//!
//! ```console
//! $ handstand init swing.csv -o arm.toml
//! $ handstand log check arm.toml swing.csv
//! $ handstand fit arm.toml swing.csv -o fitted.toml
//! ```
//!
//! With `--robot` the model is the robot in space of a URDF or MJCF file, and the log's columns are
//! matched with its joints by their names: of a data set of LeRobot by those in its
//! `meta/info.json`, of joint states by `NAME.position`.
//!
//! ```console
//! $ handstand init my_dataset --robot so101.urdf --lock gripper=0.3 -o arm.toml
//! $ handstand compare arm.toml my_dataset
//! ```
//!
//! Without `-o` the file's text goes to stdout. `--json` prints `file` (or null), `text` (null
//! where a file was written), `guesses` (`what`, `guess`, `why`) and `values` (`path`, `value`,
//! `low` and `high` of an estimate's 95 % interval, `origin`: `given`, `estimated` or `guess`);
//! with `--robot` also `joints`, and `not_carried` and `notes` (`part`, `name`, `line`, `why`).

mod robot;

use super::{Console, ExitStatus, input};
use handstand::first_model::estimate;
use handstand::fitting::StopSwitch;
use handstand::log::init::{Draft, Guess};
use handstand::log::{LogRequest, RawLog};
use handstand::output::vacant;
use handstand::{Error, Result};
use serde_json::json;
use std::io::{BufRead as _, IsTerminal as _, Write as _};
use std::path::PathBuf;

/// Start a model from a log.
#[derive(Debug, clap::Args)]
pub struct InitArgs {
    /// Log
    #[arg(value_name = "LOG", value_parser = input::log)]
    log: LogRequest,
    /// Model file to write; stdout without it
    #[arg(long, short, value_name = "MODEL.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    /// Name for reports
    #[arg(long)]
    name: Option<String>,
    /// What drives the joints that have an input
    #[arg(long, value_parser = ["passive", "torque", "duty", "position", "speed"])]
    drive: Option<String>,
    /// Where the log's angles are zero
    #[arg(long, value_parser = ["hanging", "upright", "horizontal"])]
    angle_zero: Option<String>,
    /// What the log's angles are measured from: the link before, or the world
    #[arg(long, value_parser = ["relative", "absolute"])]
    angles: Option<String>,
    /// Length of each link from joint to joint, m, from the base outwards
    #[arg(long, value_name = "M", num_args = 1.., value_parser = input::positive)]
    length: Vec<f64>,
    /// Mass of each link, kg, from the base outwards
    #[arg(long, value_name = "KG", num_args = 1.., value_parser = input::positive)]
    mass: Vec<f64>,
    #[command(flatten)]
    robot: robot::RobotArgs,
}

/// Guesses, asks, writes.
pub fn run(args: &InitArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(file) = &args.output {
        vacant(file, args.force)?;
    }
    let log = RawLog::read_request(&args.log)?;
    if let Some(robot) = &args.robot.robot {
        return robot::run(args, robot, &log, console);
    }
    let mut draft = Draft::of(&log, &args.log.name(), args.drive.as_deref())?;
    if let Some(drive) = args
        .drive
        .as_deref()
        .filter(|drive| !draft.has_input_of(drive))
    {
        return Err(no_input(args, drive, &log));
    }
    tell(&draft.guesses, console);
    answer(args, &mut draft)?;
    if std::io::stdin().is_terminal() && std::io::stderr().is_terminal() {
        ask(args, &mut draft)?;
    }
    let said = draft.guesses.len();
    let progress = console.progress();
    estimate(&mut draft, &args.log, &StopSwitch::default(), &progress)?;
    // Nothing is printed beside the bar.
    drop(progress);
    tell(&draft.guesses[said..], console);
    let text = draft.toml()?;
    if let Some(file) = &args.output {
        console.write(file, &text, args.force)?;
        let (model, log) = (file.display(), &args.log);
        console.say(&format!("next: handstand log check {model} {log}"));
    }
    let data = json!({ "guesses": draft.guesses, "values": draft.values()? });
    console.made(args.output.as_deref(), &text, data)?;
    Ok(ExitStatus::Done)
}

/// Says what was guessed, and why.
fn tell(guesses: &[Guess], console: &Console) {
    for guess in guesses {
        console.say(&format!("{}: {} ({})", guess.what, guess.guess, guess.why));
    }
}

/// Why `--drive` cannot be followed.
fn no_input(args: &InitArgs, drive: &str, log: &RawLog) -> Error {
    let (means, name) = match drive {
        "torque" => ("a torque", "tau_nm"),
        "duty" => ("a duty", "duty"),
        "position" => ("a goal angle", "goal_rad"),
        _ => ("a goal speed", "goal_speed_rad_s"),
    };
    let names = log.names.join(", ");
    Error::usage(
        format!(
            "--drive {drive}: no column of {} that changes is named as {means}: {names}",
            args.log
        ),
        format!("name the input's column {name}, or leave --drive out"),
    )
}

/// Takes the options in place of guesses.
fn answer(args: &InitArgs, draft: &mut Draft) -> Result<()> {
    let options = [
        ("name", &args.name),
        ("angle zero", &args.angle_zero),
        ("angles", &args.angles),
    ];
    for (what, option) in options {
        if let Some(value) = option {
            draft.set(what, value)?;
        }
    }
    for (what, values) in [("length", &args.length), ("mass", &args.mass)] {
        if !values.is_empty() {
            draft.set_links(what, values)?;
        }
    }
    Ok(())
}

/// Asks what no option answers; an empty line keeps the guess.
fn ask(args: &InitArgs, draft: &mut Draft) -> Result<()> {
    let plan = &draft.plan;
    let of_links = |value: fn(&handstand::model::new_model::LinkPlan) -> f64| {
        let values = plan.links.iter().map(|link| value(link).to_string());
        values.collect::<Vec<_>>().join(" ")
    };
    let mut questions = vec![
        (
            "name",
            "name of the rig",
            plan.name.clone(),
            args.name.is_some(),
        ),
        (
            "angle zero",
            "angles are zero where it is hanging, upright or horizontal",
            plan.angle_zero.clone(),
            args.angle_zero.is_some(),
        ),
        (
            "length",
            "length of each link, m",
            of_links(|link| link.length_m),
            !args.length.is_empty(),
        ),
        (
            "mass",
            "mass of each link, kg",
            of_links(|link| link.mass_kg),
            !args.mass.is_empty(),
        ),
    ];
    if plan.links.len() > 1 {
        let what = "angles are relative (from the link before) or absolute (from the world)";
        questions.push(("angles", what, plan.angles.clone(), args.angles.is_some()));
    }
    let open = questions.into_iter().filter(|(.., answered)| !answered);
    for (what, question, guess, _) in open {
        while let Some(line) = asked(question, &guess)? {
            let numbers: std::result::Result<Vec<f64>, _> =
                line.split_whitespace().map(str::parse).collect();
            let taken = match (what, numbers) {
                ("length" | "mass", Ok(values)) => draft.set_links(what, &values),
                ("length" | "mass", Err(_)) => {
                    Err(Error::usage("these are no numbers", "such as 0.3 0.2"))
                }
                _ => draft.set(what, &line),
            };
            match taken {
                Ok(()) => break,
                Err(error) => {
                    let _ = writeln!(std::io::stderr(), "{}", input::said(error));
                }
            }
        }
    }
    Ok(())
}

/// One answer; none for an empty line or the end.
fn asked(question: &str, guess: &str) -> Result<Option<String>> {
    // A closed stderr is no error.
    let _ = write!(std::io::stderr(), "{question} [{guess}]: ");
    let mut line = String::new();
    let read = std::io::stdin().lock().read_line(&mut line);
    read.map_err(|error| Error::file("stdin", "read", error))?;
    let line = line.trim();
    Ok((!line.is_empty()).then(|| line.to_string()))
}
