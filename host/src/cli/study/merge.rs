//! `handstand study merge JOURNAL|FOLDER... -o FOLDER`: shards put together, as if one run had done
//! them all.
//!
//! Verifies that all belong to one study and that no run came out twice differently. If runs are
//! missing it lists them, writes nothing and exits with 1.
//!
//! `--json` prints `complete`, and `summary` or `missing` (`first_run`, `last_run`) with `torn`
//! (`file`, `bytes`).

use super::super::{Outcome, talk::Talk};
use handstand::Result;
use handstand::study::{Missing, merge};
use serde_json::json;
use std::path::PathBuf;

/// Merge a study's shards.
#[derive(Debug, clap::Args)]
pub struct Args {
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
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    match merge(&args.journals)? {
        Ok(merged) => {
            super::write::finished(&merged, &args.output, args.force, talk)?;
            Ok(Outcome::Done)
        }
        Err(missing) => {
            lacking(&missing, talk)?;
            Ok(Outcome::Refused)
        }
    }
}

/// Says what is missing.
pub fn lacking(missing: &Missing, talk: &Talk) -> Result<()> {
    if talk.json {
        let runs = missing.runs.iter();
        let runs: Vec<_> = runs
            .map(|(first, last)| json!({ "first_run": first, "last_run": last }))
            .collect();
        let torn = missing.torn.iter();
        let torn: Vec<_> = torn
            .map(|(file, bytes)| json!({ "file": file.display().to_string(), "bytes": bytes }))
            .collect();
        return talk.data(&json!({ "complete": false, "missing": runs, "torn": torn }));
    }
    let mut text = format!("{} chunks are missing:\n", missing.chunks.len());
    for (first, last) in &missing.runs {
        text += &format!("  runs {first} to {last}\n");
    }
    for (file, bytes) in &missing.torn {
        text += &format!(
            "{}: {bytes} bytes at its end are torn and not used\n",
            file.display()
        );
    }
    text += "Start the shards again that hold them: they go on where they were.";
    talk.print(&text)
}
