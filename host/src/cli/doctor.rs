//! `handstand doctor`: what this machine has for the program.
//!
//! Serial ports and whether they may be opened, and the tools that some commands and the
//! firmware's build go on with. Nothing is opened or changed; `handstand bus doctor` looks at the
//! servos behind a port.
//!
//! Exit code 1: a port is there that may not be opened. `--json` prints `ports` (`name`,
//! `may_open`) and `tools` (`name`, `wanted_for`, `path`, null where it is missing).

use super::{Console, ExitStatus};
use handstand::Result;
use handstand::link::{PERMISSION_REMEDY, may_open, ports};
use handstand::output::table::plain_table;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Check what this machine has: ports, permissions, optional tools.
#[derive(Debug, clap::Args)]
pub struct DoctorArgs {}

/// A program, or one of several that do.
struct Tool {
    name: &'static str,
    wanted_for: &'static str,
    /// On the path, or absolute.
    files: &'static [&'static str],
}

const TOOLS: [Tool; 6] = [
    Tool {
        name: "browser",
        wanted_for: "looking at the pages of diagnose, view and paper",
        files: &["xdg-open", "chromium", "google-chrome", "firefox", "open"],
    },
    Tool {
        name: "avr-gcc",
        wanted_for: "building the CM-5's image (cargo xtask firmware)",
        files: &["avr-gcc"],
    },
    Tool {
        name: "Rust with sources",
        wanted_for: "building the CM-5's image (cargo xtask firmware)",
        files: &[
            "rustup",
            "/usr/lib/rustlib/src/rust/library/core/src/lib.rs",
        ],
    },
    Tool {
        name: "simavr",
        wanted_for: "running the image without a CM-5 (cargo xtask virtual)",
        files: &[
            "/usr/include/simavr/sim_avr.h",
            "/usr/local/include/simavr/sim_avr.h",
        ],
    },
    Tool {
        name: "Slurm",
        wanted_for: "studies as job arrays (docs/recipes)",
        files: &["sbatch"],
    },
    Tool {
        name: "GNU parallel",
        wanted_for: "studies on several processes (docs/recipes)",
        files: &["parallel"],
    },
];

/// A serial port that is there.
#[derive(Debug, Serialize)]
struct PortFound {
    name: String,
    may_open: bool,
}

/// A tool and where it lies.
#[derive(Debug, Serialize)]
struct ToolFound {
    name: &'static str,
    wanted_for: &'static str,
    path: Option<PathBuf>,
}

/// Prints ports and tools.
pub fn run(_: &DoctorArgs, console: &Console) -> Result<ExitStatus> {
    let ports: Vec<PortFound> = ports()
        .into_iter()
        .map(|name| PortFound {
            may_open: may_open(&name),
            name,
        })
        .collect();
    let tools = TOOLS.map(|tool| ToolFound {
        name: tool.name,
        wanted_for: tool.wanted_for,
        path: tool.files.iter().find_map(|file| found(file)),
    });
    let all_open = ports.iter().all(|port| port.may_open);
    if console.json {
        console.data(&serde_json::json!({ "ports": ports, "tools": tools }))?;
    } else {
        console.print(&text(&ports, &tools))?;
    }
    if !all_open {
        console.say(PERMISSION_REMEDY);
    }
    Ok(ExitStatus::answer(all_open))
}

fn text(ports: &[PortFound], tools: &[ToolFound]) -> String {
    let mut table = plain_table(["what", "where", "for"]);
    for port in ports {
        let state = if port.may_open {
            "may be opened"
        } else {
            "no permission"
        };
        table.add_row(["serial port", &port.name, state]);
    }
    if ports.is_empty() {
        let remedy = "plug an adapter or the CM-5 in; `--port sim` needs none";
        table.add_row(["serial port", "none", remedy]);
    }
    for tool in tools {
        let path = tool
            .path
            .as_deref()
            .map_or("missing".into(), Path::to_string_lossy);
        table.add_row([tool.name, &path, tool.wanted_for]);
    }
    table.to_string()
}

/// Where a program on the path lies, or a file that is named whole.
fn found(file: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let mut places = std::env::split_paths(&folders).map(|folder| folder.join(file));
    if Path::new(file).is_absolute() {
        Some(PathBuf::from(file)).filter(|file| file.is_file())
    } else {
        places.find(|place| place.is_file())
    }
}
