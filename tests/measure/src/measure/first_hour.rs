//! `cargo xtask first-hour`: does the README's path lead from a log to the effect that is hidden?
//!
//! Drawn rigs of one and two links, free or driven by torque, duty, goal angle or goal speed, whose
//! logs are named as public logs are. Each is walked by the program's own commands: `init`,
//! `log check`, `diagnose`, `add`. Fails when a log is refused, or fewer than nine in ten end at
//! the hidden effect.

use super::page::Page;
use super::program;
use comfy_table::Table;
use handstand_measure::first_hour::{DrawnRig, End, Walk, walk};
use handstand_measure::measured::Measured;
use serde_json::json;
use std::path::PathBuf;

/// Share of the walks that must end at what is hidden.
const TARGET: f64 = 0.9;

/// Walk the README's path on drawn rigs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Rigs to draw
    #[arg(long, default_value_t = 30)]
    seeds: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed0: u64,
    /// Longest time of a diagnosis
    #[arg(long, default_value = "60s")]
    within: String,
    /// Program to walk with; it is built in release without
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Keep each rig's logs and models in a folder of its number here
    #[arg(long, value_name = "FOLDER")]
    keep: Option<PathBuf>,
    /// Print every walk as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether the target is met.
pub fn run(args: &Args) -> bool {
    let Some(program) = args
        .program
        .as_ref()
        .map_or_else(program::built, |own| own.canonicalize().ok())
    else {
        return false;
    };
    let (mut walks, mut failed) = (Vec::new(), 0);
    for seed in args.seed0..args.seed0 + args.seeds {
        let rig = DrawnRig::draw(seed);
        let Ok(temporary) = tempfile::tempdir() else {
            return false;
        };
        let kept = args.keep.as_ref().map(|keep| keep.join(seed.to_string()));
        let folder = kept.unwrap_or_else(|| temporary.path().to_path_buf());
        if let Err(why) = std::fs::create_dir_all(&folder) {
            eprintln!("{}: {why}", folder.display());
            return false;
        }
        match walk(&program, &rig, &folder, &args.within) {
            Ok(walk) => {
                eprintln!(
                    "{seed}: {:?}, {:?}: {:?} ({})",
                    rig.drive, rig.hidden, walk.end, walk.verdict
                );
                walks.push((rig, walk));
            }
            Err(why) => {
                eprintln!("{seed}: {why}");
                failed += 1;
            }
        }
    }
    let well = |walk: &Walk| matches!(walk.end, End::Found | End::InFirstModel);
    let (count, refused) = (
        walks.iter().filter(|(_, walk)| well(walk)).count(),
        walks
            .iter()
            .filter(|(_, walk)| matches!(walk.end, End::Refused(_)))
            .count(),
    );
    let measured = Measured::default().table(table(&walks)).line(format!(
        "{count} of {} walks end at what is hidden; {refused} were refused.",
        walks.len()
    ));
    let rows = walks.iter().map(|(rig, walk)| row(rig, walk));
    let data = args.json.then(|| rows.map(|row| json!(row)).collect());
    let shown = args.page.show(
        data,
        &measured,
        "first-hour",
        "The README's path on drawn rigs",
    );
    shown && failed + refused == 0 && count as f64 >= TARGET * walks.len() as f64
}

fn table(walks: &[(DrawnRig, Walk)]) -> Table {
    let mut table = Table::new();
    table.set_header([
        "Rig",
        "Links",
        "Drive",
        "Hidden",
        "Verdict",
        "End",
        "First model, mrad",
        "After add, mrad",
    ]);
    for (rig, walk) in walks {
        table.add_row(row(rig, walk));
    }
    table
}

fn row(rig: &DrawnRig, walk: &Walk) -> [String; 8] {
    let mrad = |value: Option<f64>| value.map_or(String::new(), |mrad| format!("{mrad:.2}"));
    let end = match &walk.end {
        End::Found => "found",
        End::InFirstModel => "in the first model",
        End::Other(_) => "another",
        End::Refused(_) => "refused",
    };
    [
        rig.seed.to_string(),
        rig.links.len().to_string(),
        format!("{:?}", rig.drive).to_lowercase(),
        rig.hidden.ids()[0].to_string(),
        walk.verdict.clone(),
        end.to_string(),
        mrad(walk.error_mrad[0]),
        mrad(walk.error_mrad[1]),
    ]
}
