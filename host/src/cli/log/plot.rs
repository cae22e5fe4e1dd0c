//! `handstand log plot LOG [--column NAME]... [--report PAGE.html]`: a log as it stands in its
//! file, before any model reads it.
//!
//! Each column with its range and its course, as text or as a page. `--json` prints `columns`
//! (`name`, `rows`, `gaps`, `low`, `high`) and `time`, the column taken for it. Exit code 0.

use crate::cli::page::PageFile;
use crate::cli::{Console, ExitStatus, input};
use handstand::log::{LogRequest, RawLog};
use handstand::output::readable;
use handstand::report::{raw_html, raw_text};
use handstand::{Error, Result};
use serde_json::{Value, json};

/// Draw a log's columns as they stand in its file.
#[derive(Debug, clap::Args)]
pub struct LogPlotArgs {
    /// Log
    #[arg(value_name = "LOG", value_parser = input::log)]
    log: LogRequest,
    /// Column to draw, instead of all but the time
    #[arg(long = "column", value_name = "NAME")]
    columns: Vec<String>,
    #[command(flatten)]
    page: PageFile,
}

/// Draws.
pub fn run(args: &LogPlotArgs, console: &Console) -> Result<ExitStatus> {
    args.page.vacant()?;
    let log = RawLog::read_request(&args.log)?;
    for (what, remedy) in log.remarks() {
        console.say(&format!("{}: {what} ({remedy})", args.log));
    }
    for column in &args.columns {
        if !log.names.contains(column) {
            return Err(Error::usage(
                format!("{} has no column `{column}`", args.log),
                format!("it has {}", readable(log.names.join(", "))),
            ));
        }
    }
    let columns: Vec<Value> = log.names.iter().zip(&log.columns).map(column).collect();
    let data = json!({ "time": log.time().map(|time| &log.names[time]), "columns": columns });
    // Who asks for a page does not want it in dots too.
    console.result(&data, || {
        if args.page.is_wanted() {
            format!("{}: {} columns", args.log, log.names.len())
        } else {
            raw_text(&log, &args.columns)
        }
    })?;
    let title = args.log.name();
    args.page
        .write(|| Ok(raw_html(&title, &log, &args.columns)), console)?;
    Ok(ExitStatus::Done)
}

fn column((name, values): (&String, &Vec<f64>)) -> Value {
    let known = values.iter().copied().filter(|value| value.is_finite());
    json!({
        "name": name,
        "rows": values.len(),
        "gaps": values.len() - known.clone().count(),
        "low": known.clone().reduce(f64::min),
        "high": known.reduce(f64::max),
    })
}
