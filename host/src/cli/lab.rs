//! `handstand lab [MODEL] [LOG...]`: the measuring loop in a browser.
//!
//! Serves pages to this machine alone and prints the address to open, which carries a token.
//! Compare, see where the model fails, diagnose, add an effect, watch the error fall, undo; sliders
//! for every value and effect; challenges; gains. Every number is the one that `compare`,
//! `diagnose`, `add` and `gains` print.
//!
//! ```console
//! $ handstand lab arm.toml a.csv b.csv
//! http://127.0.0.1:40123/enter?token=...
//! ```
//!
//! Files may stand in any order: what ends in `.toml`, `.urdf` or `.xml` is the model, what a log
//! ends in is a log. Without a model the lab leads to making one. No browser is opened unless
//! `--open` asks for it.
//!
//! With `--robot PORT` the Robot page records and balances the robot at that port, live: charts and
//! the robot's shape follow the samples. Torque comes on after a press and the questions that
//! `balance` asks; it goes off when stop is pressed, when that page goes away and when the lab
//! ends.
//!
//! ```console
//! $ handstand lab handstand.toml --robot sim-cm5:robot=handstand.toml,start=held,lean=1/-1/1
//! ```
//!
//! What is done is kept in `--session DIR`, whole after each step; the same folder opened again
//! goes on from there. `--json` prints `address` and `session`. Ctrl-C ends it.

use super::deploy::board::BoardArgs;
use super::port::{Ids, Port, id_list};
use super::{Console, ExitStatus, input};
use handstand::lab::{Lab, LabOptions, ProjectFiles, RobotAccess};
use handstand::log::LogRequest;
use handstand::{Error, Result};
use serde_json::json;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;

/// Measure, compare, diagnose and improve a model in a browser.
#[derive(Debug, clap::Args)]
pub struct LabArgs {
    /// Model (TOML, URDF, MJCF) and logs to begin with; without a model one is made of the logs
    #[arg(value_name = "MODEL|LOG", value_parser = input::file)]
    files: Vec<LogRequest>,
    /// Folder that keeps the sessions [default: a folder of the user's state]
    #[arg(long, value_name = "DIR")]
    session: Option<PathBuf>,
    /// Port of this machine's loopback interface [default: a free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open the address in the browser; none is opened without
    #[arg(long)]
    open: bool,
    /// What is the case anyway
    #[arg(long, hide = true, alias = "no-open", conflicts_with = "open")]
    no_browser: bool,
    #[command(flatten, next_help_heading = "Robot at a port")]
    robot: LabRobotArgs,
}

/// The robot that pages may watch, record and balance.
#[derive(Debug, clap::Args)]
struct LabRobotArgs {
    /// Its port, as --port of other commands: `/dev/ttyUSB0`, `sim-cm5:robot=MODEL.toml`
    #[arg(long, value_name = "PORT")]
    robot: Option<String>,
    /// Speed of its port [default: 57600]
    #[arg(long, value_name = "BAUD", requires = "robot")]
    baud: Option<u32>,
    /// Its servos
    #[arg(long, default_value = "1-18", value_parser = id_list)]
    ids: Ids,
    #[command(flatten)]
    board: BoardArgs,
}

impl LabRobotArgs {
    fn access(&self) -> Result<Option<RobotAccess>> {
        let Some(name) = &self.robot else {
            return Ok(None);
        };
        let port = Port::named(name, self.baud);
        Ok(Some(RobotAccess {
            port: name.clone(),
            ids: self.ids.0.clone(),
            board: self.board.board()?,
            timing: self.board.timing(),
            told: self.board.told()?,
            open: Arc::new(move || port.open_with_attitude()),
        }))
    }
}

/// Serves until it is ended.
pub fn run(args: &LabArgs, console: &Console) -> Result<ExitStatus> {
    let folder = match &args.session {
        Some(folder) => folder.clone(),
        None => state_folder()?,
    };
    if args.no_browser {
        console.say("no browser is opened unless --open is given: --no-browser can be left out");
    }
    let lab = Lab::bind(LabOptions {
        given: ProjectFiles::of(&args.files)?,
        folder,
        port: args.port,
        robot: args.robot.access()?,
    })?;
    let address = lab.address();
    let data = json!({ "address": address, "session": lab.folder().to_string_lossy() });
    console.result(&data, || address.clone())?;
    console.say(&format!(
        "sessions are kept in {}; Ctrl-C ends the lab",
        lab.folder().display()
    ));
    if args.open {
        open(&address, console);
    }
    lab.serve()?;
    Ok(ExitStatus::Done)
}

/// Where programs keep the state of a user.
fn state_folder() -> Result<PathBuf> {
    let variable = |name| std::env::var_os(name).map(PathBuf::from);
    let absolute = |path: &PathBuf| path.is_absolute();
    let state = variable("XDG_STATE_HOME")
        .filter(absolute)
        .or_else(|| Some(variable("HOME")?.join(".local/state")))
        .or_else(|| variable("LOCALAPPDATA"));
    let state = state.ok_or_else(|| {
        Error::usage(
            "there is no home folder to keep sessions in",
            "name one: --session DIR",
        )
    })?;
    Ok(state.join("handstand").join("lab"))
}

/// Asks the system to show the address. Where it cannot, the address stands on stdout.
fn open(address: &str, console: &Console) {
    let program = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let mut command = if cfg!(windows) {
        let mut command = Command::new("cmd");
        command.args(["/c", "start", ""]);
        command
    } else {
        Command::new(program)
    };
    let begun = command
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    if let Err(why) = begun {
        console.say(&format!(
            "no browser was opened ({why}): open the address yourself"
        ));
    }
}
