//! A finished Monte Carlo study, printed and written.

use super::super::show::table;
use super::super::talk::Talk;
use handstand::output::number::exact;
use handstand::study::{Merged, Summary, monte_carlo_svg};
use handstand::{Error, Result, output};
use serde_json::json;
use std::path::Path;

/// Makes the folder if it is not there.
pub fn folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| Error::file(folder, "write", error))
}

/// Writes `runs.csv`, `summary.json`, `stabilised.svg`, prints the summary. What is there already
/// with the same content stays.
pub fn finished(merged: &Merged, into: &Path, force: bool, talk: &Talk) -> Result<()> {
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
    if talk.json {
        return talk.data(&json!({ "complete": true, "summary": summary }));
    }
    talk.print(&shown(&summary))?;
    talk.say(&format!(
        "{}: runs.csv, summary.json, stabilised.svg",
        into.display()
    ));
    Ok(())
}

fn shown(summary: &Summary) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let mut text = format!(
        "{} of {} runs are stabilised: {} (95 % interval {} to {}), {} fall\n{} of the robots are unstable in the small\n\n",
        summary.stabilised,
        summary.runs,
        percent(summary.stabilised_share),
        percent(summary.stabilised_low),
        percent(summary.stabilised_high),
        percent(summary.fallen_share),
        percent(summary.unstable),
    );
    let mut figures = table(["Of the stabilised", "5 %", "median", "95 %"]);
    for figure in &summary.figures {
        let quantile = |place: usize| match figure.quantiles.map(|q| q[place]) {
            Some(value) if value.is_finite() => exact(value),
            Some(_) => "never".to_string(),
            None => "–".to_string(),
        };
        figures.add_row([figure.figure.clone(), quantile(0), quantile(1), quantile(2)]);
    }
    text += &format!("{figures}\n");
    if !summary.influence.is_empty() {
        let mut influence = table([
            "Uncertain",
            "correlation with being stabilised",
            "of its size",
        ]);
        for value in &summary.influence {
            influence.add_row([
                value.value.clone(),
                format!("{:+.2}", value.correlation),
                format!("{:+.2}", value.correlation_of_size),
            ]);
        }
        text += &format!("\n{influence}\n");
    }
    text
}
