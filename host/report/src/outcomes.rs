//! Many logs and what each says of one model: as text, CSV and page.

use super::page::{Section, document};
use super::table::{Columns, columns_of, csv_of, page_table, table_of};
use crate::diagnose::{LogOutcome, OutcomeValue};
use crate::output::number::{exact, mrad, short};
use crate::output::table::{or_empty, within_width};
use crate::plot::{Chart, Curve, Tone};
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Width and height of a chart, px.
const CHART_PX: (f64, f64) = (760.0, 240.0);

/// A row per log, for people.
pub fn outcomes_text(outcomes: &[LogOutcome]) -> String {
    let table = within_width(table_of(outcomes, &columns()), 120);
    let mut lines = vec![table.to_string(), String::new()];
    lines.extend(counted(outcomes));
    lines.join("\n")
}

/// A row per log and value, for programs; a log without values has one row.
pub fn outcomes_csv(outcomes: &[LogOutcome]) -> String {
    let rows: Vec<(&LogOutcome, Option<&OutcomeValue>)> = outcomes
        .iter()
        .flat_map(|outcome| match outcome.values.as_slice() {
            [] => vec![(outcome, None)],
            values => values.iter().map(|value| (outcome, Some(value))).collect(),
        })
        .collect();
    type OutcomeRow<'a> = (&'a LogOutcome, Option<&'a OutcomeValue>);
    let columns = columns_of::<OutcomeRow>()
        .text("log", |(outcome, _)| outcome.key.log.replace(',', "_"))
        .text("verdict", |(outcome, _)| outcome.verdict.clone())
        .text("effects", |(outcome, _)| outcome.effects.join("+"))
        .text("before_rad", |(outcome, _)| or_empty(outcome.before_rad))
        .text("after_rad", |(outcome, _)| or_empty(outcome.after_rad))
        .text("floor_rad", |(outcome, _)| or_empty(outcome.floor_rad))
        .text("path", |(_, value)| or_empty(value.map(|v| &v.path)))
        .text("unit", |(_, value)| or_empty(value.map(|v| &v.unit)))
        .text("value", |(_, value)| or_empty(value.map(|v| v.value)))
        .text("low", |(_, value)| or_empty(value.and_then(|v| v.low)))
        .text("high", |(_, value)| or_empty(value.and_then(|v| v.high)));
    csv_of(&rows, &columns)
}

/// A page: the table, then how each value goes from log to log.
pub fn outcomes_html(model: &str, outcomes: &[LogOutcome]) -> String {
    let title = format!("What {model} lacks, log by log");
    let header = html! {
        header {
            h1 { (title) }
            @for line in counted(outcomes) { p { (line) } }
        }
    };
    let mut sections = vec![Section {
        id: "logs",
        title: "Log by log",
        lead: "Each log diagnosed by itself, in the order of their names; of its motions the last \
               third judges.",
        body: all(outcomes),
    }];
    let paths = paths(outcomes);
    if !paths.is_empty() {
        sections.push(Section {
            id: "values",
            title: "How the values go",
            lead: "A value that leaves its neighbours' intervals tells which servo differs, or \
                   since when. `handstand drift` tests whether it does by more than chance.",
            body: html! { @for path in &paths { (course(path, outcomes)) } },
        });
    }
    document(&title, &header, &sections)
}

/// How many logs end in which verdict, in a sentence each.
fn counted(outcomes: &[LogOutcome]) -> Vec<String> {
    let verdicts: BTreeSet<&str> = outcomes.iter().map(|o| o.verdict.as_str()).collect();
    let count = |verdict: &str| outcomes.iter().filter(|o| o.verdict == verdict).count();
    let mut counts: Vec<(usize, &str)> = verdicts.iter().map(|v| (count(v), *v)).collect();
    counts.sort_by(|a, b| b.cmp(a));
    let counts: Vec<String> = counts
        .iter()
        .map(|(n, verdict)| format!("{n} {verdict}"))
        .collect();
    let logs = match outcomes.len() {
        1 => "1 log".to_string(),
        logs => format!("{logs} logs"),
    };
    vec![format!("{logs}: {}.", counts.join(", "))]
}

fn columns<'a>() -> Columns<'a, LogOutcome> {
    columns_of::<LogOutcome>()
        .text("Log", |o| o.key.log.clone())
        .text("Verdict", |o| o.verdict.clone())
        .text("Effects", |o| o.effects.join(", "))
        .text("Values", |o| {
            let values: Vec<String> = o.values.iter().map(in_words).collect();
            values.join("\n")
        })
        .number("Before, mrad", |o| o.before_rad.map_or(String::new(), mrad))
        .number("After, mrad", |o| o.after_rad.map_or(String::new(), mrad))
}

fn in_words(value: &OutcomeValue) -> String {
    let ends = match (value.low, value.high) {
        (Some(low), Some(high)) => format!(" ({} to {})", exact(low), exact(high)),
        _ => String::new(),
    };
    format!(
        "{} = {}{ends} {}",
        value.path,
        short(value.value),
        value.unit
    )
}

fn all(outcomes: &[LogOutcome]) -> Markup {
    html! {
        (page_table(outcomes, &columns()))
        @for outcome in outcomes.iter().filter(|o| !o.is_usable()) {
            p { strong { (outcome.key.log) } ": " (outcome.said) }
        }
    }
}

/// Addresses of all values, each once.
fn paths(outcomes: &[LogOutcome]) -> BTreeSet<&str> {
    let values = outcomes.iter().flat_map(|outcome| &outcome.values);
    values.map(|value| value.path.as_str()).collect()
}

/// One value over the logs.
fn course(path: &str, outcomes: &[LogOutcome]) -> Markup {
    let found = |outcome: &LogOutcome| outcome.values.iter().find(|v| v.path == path).cloned();
    let values: Vec<Option<OutcomeValue>> = outcomes.iter().map(found).collect();
    let unit = values
        .iter()
        .flatten()
        .next()
        .map_or("", |value| &value.unit);
    let mut curve = Curve::by_category(
        path,
        Tone::Blue,
        values.iter().map(|value| value.as_ref().map(|v| v.value)),
    );
    curve.dots = true;
    curve.intervals = values
        .iter()
        .map(|value| {
            let ends = value.as_ref().and_then(|v| Some([v.low?, v.high?]));
            ends.unwrap_or([f64::NAN; 2])
        })
        .collect();
    let label = match unit {
        "" => path.to_string(),
        unit => format!("{path}, {unit}"),
    };
    let chart = Chart {
        categories: outcomes
            .iter()
            .map(|outcome| outcome.key.log.clone())
            .collect(),
        ..Chart::new(path, "", &label, vec![curve])
    };
    let (width, height) = CHART_PX;
    html! { figure { (chart.svg(width, height)) } }
}
