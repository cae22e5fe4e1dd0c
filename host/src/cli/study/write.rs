//! A finished Monte Carlo study, printed and written.

use crate::cli::{Console, show::table_of};
use handstand::output::number::exact;
use handstand::report::monte_carlo_svg;
use handstand::report::table::columns_of;
use handstand::study::{FigureQuantiles, Influence, Merged, Summary};
use handstand::{Error, Result, output};
use serde_json::json;
use std::path::Path;

/// Makes the folder if it is not there.
pub fn folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| Error::file(folder, "write", error))
}

/// Writes `runs.csv`, `summary.json`, `stabilised.svg`, prints the summary. What is there already
/// with the same content stays.
pub fn finished(merged: &Merged, into: &Path, force: bool, console: &Console) -> Result<()> {
    let file = into.join("runs.csv");
    let summary = merged.summary(&file)?;
    let json = serde_json::to_string_pretty(&summary)
        .map_err(|error| Error::file(into.join("summary.json"), "write", error.into()))?;
    folder(into)?;
    for (name, text) in [
        ("runs.csv", merged.csv()),
        ("summary.json", json + "\n"),
        ("stabilised.svg", monte_carlo_svg(merged, &file)?),
    ] {
        let file = into.join(name);
        if std::fs::read(&file).is_ok_and(|there| there == text.as_bytes()) {
            continue;
        }
        output::write_new(&file, &text, force)?;
    }
    let data = json!({ "complete": true, "summary": summary });
    console.result(&data, || shown(&summary))?;
    if !console.json {
        let into = into.display();
        console.say(&format!("{into}: runs.csv, summary.json, stabilised.svg"));
    }
    Ok(())
}

fn shown(summary: &Summary) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let quantile = |figure: &FigureQuantiles, place: usize| match figure.quantiles.map(|q| q[place])
    {
        Some(value) if value.is_finite() => exact(value),
        Some(_) => "never".to_string(),
        None => "–".to_string(),
    };
    let figures = columns_of::<FigureQuantiles>()
        .text("Of the stabilised", |f| f.figure.clone())
        .text("5 %", |f| quantile(f, 0))
        .text("median", |f| quantile(f, 1))
        .text("95 %", |f| quantile(f, 2));
    let mut text = format!(
        "{} of {} runs are stabilised: {} (95 % interval {} to {}), {} fall\n\
         {} of the robots are unstable in the small\n\n{}\n",
        summary.stabilised,
        summary.runs,
        percent(summary.stabilised_share),
        percent(summary.stabilised_low),
        percent(summary.stabilised_high),
        percent(summary.fallen_share),
        percent(summary.unstable),
        table_of(&summary.figures, &figures)
    );
    let influence = columns_of::<Influence>()
        .text("Uncertain", |o| o.value.clone())
        .text("correlation with being stabilised", |o| {
            format!("{:+.2}", o.correlation)
        })
        .text("of its size", |o| format!("{:+.2}", o.correlation_of_size));
    if !summary.influence.is_empty() {
        text += &format!("\n{}\n", table_of(&summary.influence, &influence));
    }
    text
}
