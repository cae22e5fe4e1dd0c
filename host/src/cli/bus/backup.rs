//! `bus backup`, `bus restore`: the servos' settings as a TOML file.
//!
//! All registers that can be written and are kept without power are saved, with model and firmware
//! to compare. Restoring leaves id and baud rate as they are, writes only what differs, and reads
//! every register back.

use super::changes::{self, RegisterChange};
use super::scan::answering;
use crate::cli::port::{Ids, Port, id_list};
use crate::cli::{Console, ExitStatus};
use handstand::link::Settings;
use handstand::{Error, Result, output};
use handstand_shared::control_table::MODEL;
use serde_json::json;
use std::path::PathBuf;

/// Save settings.
#[derive(Debug, clap::Args)]
pub struct BackupArgs {
    /// File to write
    file: PathBuf,
    #[command(flatten)]
    port: Port,
    /// Servos to save
    #[arg(long, default_value = "0-253", value_parser = id_list)]
    ids: Ids,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Write settings back.
#[derive(Debug, clap::Args)]
pub struct RestoreArgs {
    /// File that `bus backup` wrote
    file: PathBuf,
    #[command(flatten)]
    port: Port,
    /// Servos to restore; all of the file without
    #[arg(long, value_parser = id_list)]
    ids: Option<Ids>,
    /// Only show what would change
    #[arg(long)]
    dry_run: bool,
}

/// Reads all, writes the file.
pub fn backup(args: &BackupArgs, console: &Console) -> Result<ExitStatus> {
    output::vacant(&args.file, args.force)?;
    let mut servos = args.port.servos()?;
    let ids = answering(&mut servos, &args.ids.0, console)?;
    let read = ids.iter().map(|id| Settings::read(&mut servos, *id));
    let saved = read.collect::<Result<Vec<_>, _>>()?;
    output::write_new(&args.file, &Settings::to_toml(&saved), args.force)?;
    let file = args.file.display().to_string();
    if console.json {
        console.data(&json!({ "file": file, "ids": ids }))?;
    }
    console.say(&format!("wrote {file}: {} servos", ids.len()));
    Ok(ExitStatus::Done)
}

/// Compares, writes what differs, reads back.
pub fn restore(args: &RestoreArgs, console: &Console) -> Result<ExitStatus> {
    let mut saved = Settings::load(&args.file)?;
    if let Some(Ids(ids)) = &args.ids {
        let absent = |id: &&u8| saved.iter().all(|servo| servo.id != **id);
        if let Some(absent) = ids.iter().find(absent) {
            return Err(Error::usage(
                format!("{} has no servo {absent}", args.file.display()),
                "leave it out of --ids",
            ));
        }
        saved.retain(|servo| ids.contains(&servo.id));
    }
    let mut servos = args.port.servos()?;
    let mut changes: Vec<RegisterChange> = Vec::new();
    // All servos are read before any is written: a servo that is missing stops a half restored
    // robot from arising.
    for servo in &saved {
        let now = Settings::read(&mut servos, servo.id)?;
        let (id, model, wanted) = (servo.id, now.get(MODEL), servo.get(MODEL));
        if model != wanted {
            return Err(Error::device(
                format!(
                    "servo {id} is of another model than the saved one: {model:?}, saved {wanted:?}"
                ),
                "settings of one model mean other things to another: restore it with --ids from \
                 its own file",
            ));
        }
        let differing = servo
            .restorable()
            .filter(|(register, code)| now.code(register.name) != Some(*code));
        changes.extend(differing.map(|(register, code)| RegisterChange {
            id,
            register,
            before: now.code(register.name).unwrap_or(0),
            code,
        }));
    }
    let bar = console.bar(changes.len() as u64);
    for change in changes.iter().filter(|_| !args.dry_run) {
        servos.set_code(change.id, &change.register, change.code)?;
        bar.inc(1);
    }
    drop(bar);
    let data = json!({ "written": !args.dry_run, "changes": changes });
    let done = if args.dry_run {
        "would be written"
    } else {
        "were written and read back"
    };
    let said = format!("{} registers {done}", changes.len());
    changes::report(&data, &changes, "Saved", &said, console)
}
