//! `handstand man FOLDER`: manual pages, one for each command.
//!
//! ```console
//! $ handstand man ~/.local/share/man/man1
//! $ man handstand-diagnose
//! ```
//!
//! `--json` prints the names of the files, `pages`.

use super::{Cli, Console, ExitStatus};
use clap::{Command, CommandFactory as _};
use clap_mangen::Man;
use handstand::output::write_new;
use handstand::{Error, Result};
use std::path::{Path, PathBuf};

/// Write manual pages, one for each command.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// Folder for the pages, made where it is missing
    folder: PathBuf,
    /// Write over pages that are there
    #[arg(long)]
    force: bool,
}

/// Writes the pages.
pub fn run(args: &ManArgs, console: &Console) -> Result<ExitStatus> {
    let folder = &args.folder;
    std::fs::create_dir_all(folder).map_err(|e| Error::file(folder, "make", e))?;
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    write_pages(command, folder, args.force, &mut pages)?;
    if console.json {
        console.data(&serde_json::json!({ "pages": pages }))?
    } else {
        console.say(&format!("{} pages in {}", pages.len(), folder.display()))
    }
    Ok(ExitStatus::Done)
}

/// The page of a command, and of those below it.
fn write_pages(
    command: Command,
    folder: &Path,
    force: bool,
    pages: &mut Vec<PathBuf>,
) -> Result<()> {
    for below in command.get_subcommands().filter(|c| !c.is_hide_set()) {
        write_pages(below.clone(), folder, force, pages)?;
    }
    let name = command.get_display_name().unwrap_or(command.get_name());
    let file = folder.join(format!("{name}.1"));
    let mut page = Vec::new();
    Man::new(command)
        .render(&mut page)
        .map_err(|e| Error::file(&file, "write", e))?;
    write_new(&file, &String::from_utf8_lossy(&page), force)?;
    pages.push(file);
    Ok(())
}
