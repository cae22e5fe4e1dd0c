//! `handstand study merge JOURNAL|FOLDER... -o FOLDER`: shards put together, as if one run had done
//! them all.
//!
//! Verifies that all belong to one study and that no run came out twice differently. If runs are
//! missing it lists them, writes nothing and exits with 1.
//!
//! `--json` prints `complete`, and `summary` or `missing` (`first_run`, `last_run`) with `torn`
//! (`file`, `bytes`).

use crate::cli::{Console, ExitStatus};
use handstand::Result;
use handstand::study::{Missing, merge};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Merge a study's shards.
#[derive(Debug, clap::Args)]
pub struct MergeArgs {
    /// Journals, or folders that hold them
    #[arg(required = true, value_name = "JOURNAL|FOLDER")]
    journals: Vec<PathBuf>,
    /// Folder for table, summary and plot
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
    /// Replace files there
    #[arg(long)]
    force: bool,
}

/// Merges, or says what is missing.
pub fn run(args: &MergeArgs, console: &Console) -> Result<ExitStatus> {
    merged(&args.journals, &args.output, args.force, console)
}

/// Merges journals into a folder and prints the summary, or says what is missing.
pub fn merged(
    journals: &[PathBuf],
    into: &Path,
    force: bool,
    console: &Console,
) -> Result<ExitStatus> {
    let merged = merge(journals)?;
    match &merged {
        Ok(merged) => super::write::finished(merged, into, force, console)?,
        Err(missing) => console.result(&data(missing), || text(missing))?,
    }
    Ok(ExitStatus::answer(merged.is_ok()))
}

fn data(missing: &Missing) -> Value {
    let run = |(first, last): &(usize, usize)| json!({ "first_run": first, "last_run": last });
    let torn = |(file, bytes): &(PathBuf, u64)| {
        let file = file.display().to_string();
        json!({ "file": file, "bytes": bytes })
    };
    json!({
        "complete": false,
        "missing": missing.runs.iter().map(run).collect::<Vec<_>>(),
        "torn": missing.torn.iter().map(torn).collect::<Vec<_>>(),
    })
}

fn text(missing: &Missing) -> String {
    let mut text = format!("{} chunks are missing:\n", missing.chunks.len());
    for (first, last) in &missing.runs {
        text += &format!("  runs {first} to {last}\n");
    }
    for (file, bytes) in &missing.torn {
        let file = file.display();
        text += &format!("{file}: {bytes} bytes at its end are torn and not used\n");
    }
    text + "Start the shards again that hold them: they go on where they were."
}
