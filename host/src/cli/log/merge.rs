//! `handstand log merge FIRST SECOND -o MERGED.csv`: two logs of one motion, by recorders with
//! clocks of their own, as one.
//!
//! The second's clock is moved until a signal that both hold agrees best; `--align` says which
//! columns hold it, `--offset` gives the offset. The columns of the second are then read at the
//! times of the first, by straight lines; outside it, and in its gaps, cells stay empty.
//!
//! ```console
//! $ handstand log merge robot.csv camera.csv -o both.csv --align position_rad=angle_deg
//! ```
//!
//! `--json` prints `offset_s`, `alignment` (`first`, `second`, `correlation`), `rows`,
//! `rows_of_both`, `columns`.

use crate::cli::{Console, ExitStatus, input};
use handstand::Result;
use handstand::log::{LogRequest, MergePlan, MergedLog, RawLog, merge};
use handstand::output::number::{exact, percent};
use handstand::output::{vacant, write_new};
use serde_json::json;
use std::path::PathBuf;

/// Put two logs of one motion together, their clocks aligned by what both hold.
#[derive(Debug, clap::Args)]
pub struct LogMergeArgs {
    /// Log whose times are kept
    #[arg(value_name = "FIRST", value_parser = input::log)]
    first: LogRequest,
    /// Log whose clock is moved
    #[arg(value_name = "SECOND", value_parser = input::log)]
    second: LogRequest,
    /// Columns that hold the same signal; found by themselves without it
    #[arg(long, value_name = "FIRST=SECOND", value_parser = pair, conflicts_with = "offset")]
    align: Option<(String, String)>,
    /// What to add to the second log's time, s; estimated without it
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    offset: Option<f64>,
    /// New log
    #[arg(long, short, value_name = "MERGED.csv")]
    output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .filter(|(a, b)| !a.is_empty() && !b.is_empty());
    let (a, b) = pair.ok_or("write the columns as FIRST=SECOND")?;
    Ok((a.to_string(), b.to_string()))
}

/// Merges, writes, prints.
pub fn run(args: &LogMergeArgs, console: &Console) -> Result<ExitStatus> {
    vacant(&args.output, args.force)?;
    let first = RawLog::read_request(&args.first)?;
    let second = RawLog::read_request(&args.second)?;
    let plan = MergePlan {
        align: args.align.clone(),
        offset_s: args.offset,
    };
    let merged = merge(&first, &second, &plan)?;
    write_new(&args.output, &merged.log.to_csv(), args.force)?;
    let rows = merged.log.columns.first().map_or(0, Vec::len);
    let data = json!({
        "offset_s": merged.offset_s,
        "alignment": merged.alignment,
        "rows": rows,
        "rows_of_both": merged.rows_of_both,
        "columns": merged.log.names,
    });
    console.result(&data, || said(&merged, rows))?;
    console.say(&format!("wrote {}", args.output.display()));
    Ok(ExitStatus::Done)
}

fn said(merged: &MergedLog, rows: usize) -> String {
    let offset = exact(merged.offset_s);
    let how = match &merged.alignment {
        Some(found) => format!(
            "offset {offset} s: there `{}` and `{}` correlate by {}",
            found.first,
            found.second,
            percent(found.correlation)
        ),
        None => format!("offset {offset} s, as given"),
    };
    format!(
        "{how}\n{} of {rows} rows hold values of both",
        merged.rows_of_both
    )
}
