//! A log as it stands in its file, column by column: as text and as a page.

use super::page::{Section, document};
use crate::log::{RawLog, time_si};
use crate::output::number::{exact, short};
use crate::plot::{Chart, Curve, Tone};
use maud::html;

/// Width and height of a chart, px.
const CHART_PX: (f64, f64) = (760.0, 200.0);

/// A column, what it holds, and its course over time or, in a log without one, over rows.
struct RawColumn {
    name: String,
    says: String,
    chart: Chart,
}

fn columns(log: &RawLog, names: &[String]) -> Vec<RawColumn> {
    let time = log.time();
    let (across, label) = match time {
        Some(time) => (time_si(log, time), "time, s"),
        None => {
            let rows = log.columns.first().map_or(0, Vec::len);
            ((0..rows).map(|row| row as f64).collect(), "row")
        }
    };
    let wanted = |index: &usize| match names {
        [] => Some(*index) != time,
        names => names.contains(&log.names[*index]),
    };
    let column = |index: usize| {
        let values = &log.columns[index];
        let points = across.iter().copied().zip(values.iter().copied());
        let name = log.names[index].clone();
        let curve = Curve::line(name.clone(), Tone::Ink, points.collect());
        RawColumn {
            says: said(values),
            chart: Chart::new(name.clone(), label, &name, vec![curve]),
            name,
        }
    };
    (0..log.names.len()).filter(wanted).map(column).collect()
}

/// Range, rows and gaps of a column.
fn said(values: &[f64]) -> String {
    let known: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    let low = known.iter().copied().fold(f64::INFINITY, f64::min);
    let high = known.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let range = match known.is_empty() {
        true => "no number in it".to_string(),
        false if low == high => format!("always {}", exact(low)),
        false => format!("{} to {}", short(low), short(high)),
    };
    match values.len() - known.len() {
        0 => format!("{range}, {} rows", values.len()),
        gaps => format!(
            "{range}, {} rows, {gaps} of them without a number",
            values.len()
        ),
    }
}

/// Each column with its range and its course in dots; without `names` all but the time.
pub fn raw_text(log: &RawLog, names: &[String]) -> String {
    let column = |column: &RawColumn| {
        let drawn = format!("{}: {}", column.name, column.says);
        // A column that does not change has no course.
        if column.says.contains(" to ") {
            format!("{drawn}\n{}", column.chart.text())
        } else {
            drawn
        }
    };
    let parts: Vec<String> = columns(log, names).iter().map(column).collect();
    parts.join("\n")
}

/// A page of the same.
pub fn raw_html(title: &str, log: &RawLog, names: &[String]) -> String {
    let columns = columns(log, names);
    let (width, height) = CHART_PX;
    let body = html! {
        @for column in &columns {
            figure {
                (column.chart.zoomable_svg(width, height))
                figcaption { (column.says) }
            }
        }
    };
    let section = Section {
        id: "columns",
        title: "Columns",
        lead: "As they stand in the file, in its units.",
        body,
    };
    document(title, &html! { header { h1 { (title) } } }, &[section])
}
