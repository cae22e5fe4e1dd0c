//! The benchmark's figures for people.

use super::tally::{Figure, Row, Tally};
use super::trial::Outcome;
use crate::measured::Measured;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand::diagnose::Verdict;

/// The confusion and the figures beside their targets.
pub fn tables(tally: &Tally) -> Measured {
    let mut confusion = Table::new();
    confusion.load_preset(UTF8_HORIZONTAL_ONLY);
    confusion.set_header([
        "hidden",
        "right",
        "ambiguous",
        "unexplained",
        "nominal",
        "wrongly named",
    ]);
    for row in &tally.rows {
        confusion.add_row(cells(row));
    }
    let mut figures = Table::new();
    figures.load_preset(UTF8_HORIZONTAL_ONLY);
    figures.set_header(["figure", "cases", "share", "target", ""]);
    for figure in &tally.figures {
        figures.add_row(figure_cells(figure));
    }
    let mut measured = Measured::default().table(confusion).table(figures);
    if let (Some(median), Some(largest)) = (tally.median_ratio, tally.largest_ratio) {
        measured = measured.line(format!(
            "Held-out error against the true model's: median {median:.2}, largest {largest:.2}."
        ));
    }
    if let Some(seconds) = tally.median_seconds {
        measured = measured.line(format!("Seconds per diagnosis: median {seconds:.2}."));
    }
    measured
}

fn cells(row: &Row) -> Vec<String> {
    let some = |count: usize| match count {
        0 => String::new(),
        count => count.to_string(),
    };
    let mut ambiguous = some(row.ambiguous);
    if row.ambiguous_with_truth > 0 {
        ambiguous += &format!(" ({} with it)", row.ambiguous_with_truth);
    }
    let wrong = row
        .wrong
        .iter()
        .map(|(set, count)| format!("{set} {count}"));
    let mut wrong: Vec<String> = wrong.collect();
    if row.unfit > 0 {
        wrong.push(format!("(unfit) {}", row.unfit));
    }
    vec![
        row.hidden.clone().unwrap_or_else(|| "nothing".to_owned()),
        format!("{} of {}", row.right, row.count),
        ambiguous,
        some(row.unexplained),
        some(row.nominal),
        wrong.join(", "),
    ]
}

fn figure_cells(figure: &Figure) -> Vec<String> {
    let sign = if figure.at_most { "<=" } else { ">=" };
    let share = figure.share();
    vec![
        figure.name.to_owned(),
        format!("{} of {}", figure.met, figure.of),
        share.map_or_else(String::new, |share| format!("{:.1} %", 100.0 * share)),
        format!("{sign} {:.0} %", 100.0 * figure.target),
        match (share, figure.is_met()) {
            (None, _) => "not measured",
            (_, true) => "met",
            (_, false) => "MISSED",
        }
        .to_owned(),
    ]
}

/// One outcome on a line: what was hidden, what was said, and how near the truth it came.
pub fn line(outcome: &Outcome) -> String {
    let hidden = outcome.hidden.as_deref().unwrap_or("nothing");
    let library = if outcome.left_out { "left out" } else { "" };
    let mut line = format!(
        "{hidden:20} seed {:<4} {library:8}  {}; held out {:.2} -> {:.2} mrad, {:.2} x the truth's",
        outcome.seed,
        said(outcome),
        1e3 * outcome.before_rad,
        1e3 * outcome.after_rad,
        outcome.ratio(),
    );
    if !outcome.values.is_empty() {
        let held = outcome.values.iter().filter(|value| value.covered).count();
        line += &format!("; intervals {held} of {}", outcome.values.len());
    }
    line += &format!("; {:.1} s", outcome.seconds);
    if miss(outcome).is_some() {
        line += "  <- short";
    }
    line
}

/// The verdict with its effects.
fn said(outcome: &Outcome) -> String {
    let set = |kinds: &[String]| match kinds {
        [] => "no effect".to_owned(),
        kinds => kinds.join("+"),
    };
    match outcome.verdict {
        Verdict::Nominal => "nominal".to_owned(),
        Verdict::Adequate => "adequate".to_owned(),
        Verdict::WrongValue => "wrong values".to_owned(),
        Verdict::Named => format!("named {}", set(&outcome.effects)),
        Verdict::Unexplained => format!("unexplained, with {}", set(&outcome.effects)),
        Verdict::Unfit => "unfit".to_owned(),
        Verdict::Ambiguous => {
            let sets = [&outcome.effects].into_iter().chain(&outcome.alternatives);
            let sets: Vec<String> = sets.map(|kinds| set(kinds)).collect();
            format!("ambiguous: {}", sets.join(" | "))
        }
    }
}

/// A line for every outcome that falls short.
pub fn misses(outcomes: &[Outcome]) -> Vec<String> {
    outcomes.iter().filter_map(miss).collect()
}

fn miss(outcome: &Outcome) -> Option<String> {
    let said = said(outcome);
    let errors = format!(
        "error {:.2} -> {:.2}, truth {:.2} mrad",
        1e3 * outcome.before_rad,
        1e3 * outcome.after_rad,
        1e3 * outcome.true_rad
    );
    let seed = outcome.seed;
    let Some(hidden) = &outcome.hidden else {
        let alarm = outcome.names_effects();
        return alarm.then(|| format!("nothing hidden, seed {seed}: {said}; {errors}"));
    };
    if outcome.left_out {
        let sure = matches!(
            outcome.verdict,
            Verdict::Named | Verdict::Nominal | Verdict::WrongValue | Verdict::Unfit
        );
        return sure.then(|| format!("{hidden} left out, seed {seed}: {said}; {errors}"));
    }
    if !outcome.is_right() {
        return Some(format!("{hidden}, seed {seed}: {said}; {errors}"));
    }
    let mut notes = Vec::new();
    if outcome.ratio() > super::tally::MOST_RATIO {
        notes.push(errors);
    }
    for value in outcome.values.iter().filter(|value| !value.covered) {
        let interval = value.interval.map_or_else(
            || "no interval".to_owned(),
            |(low, high)| format!("{low:.5} to {high:.5}"),
        );
        notes.push(format!(
            "{} is {}, not {interval}",
            value.key, value.true_value
        ));
    }
    (!notes.is_empty()).then(|| format!("{hidden}, seed {seed}: named, but {}", notes.join("; ")))
}
