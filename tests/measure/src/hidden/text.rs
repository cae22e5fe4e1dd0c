//! The benchmark's figures for people.

use super::outcome::{Answer, Outcome};
use super::tally::{COVERAGE, EffectRow, FamilyRow, MOST_RATIO, Share, Tally};
use crate::measured::Measured;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};

/// Families beside their targets, what was said of each effect, values whose intervals miss.
pub fn tables(tally: &Tally) -> Measured {
    let mut families = table([
        "family",
        "right",
        "equivalent",
        "wrong",
        "unexplained",
        "nominal",
        "unfit",
        "reached (95 %)",
        "target",
        "error / truth's: median, 90 %",
        "coverage (95 %)",
        "s: median, 90 %",
        "version",
        "",
    ]);
    for row in &tally.families {
        families.add_row(family_cells(row));
    }
    let mut effects = table([
        "hidden",
        "in",
        "right",
        "equivalent",
        "unexplained",
        "nominal",
        "wrong",
    ]);
    for row in &tally.effects {
        effects.add_row(effect_cells(row));
    }
    let mut values = table(["value", "intervals that hold the truth (95 %)"]);
    for row in &tally.values {
        let Share { met, of, .. } = row.coverage;
        values.add_row([
            row.value.clone(),
            format!("{met} of {of}: {}", share(&row.coverage)),
        ]);
    }
    let notes = [
        "Reached: named exactly, joint and all, or in a set of explanations that cannot be told \
         apart; nothing said to be missing where nothing is; unexplained where the library lacks \
         the effect."
            .to_string(),
        format!(
            "Targets also ask that nine of ten held-out errors are at most {MOST_RATIO} times the \
             true model's, and that {:.0} to {:.0} % of the 95 % intervals hold the truth.",
            100.0 * COVERAGE.0,
            100.0 * COVERAGE.1
        ),
        "Values of which every interval holds the truth are not in the list.".to_string(),
    ];
    Measured::default()
        .table(families)
        .table(effects)
        .table(values)
        .lines(notes)
}

/// An empty table of the benchmark's style.
pub(super) fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY);
    table.set_header(header);
    table
}

fn some(count: usize) -> String {
    match count {
        0 => String::new(),
        count => count.to_string(),
    }
}

/// A share in per cent with its interval.
fn share(share: &Share) -> String {
    share.share().map_or_else(String::new, |mean| {
        let [mean, low, high] = [mean, share.low, share.high].map(|share| 100.0 * share);
        format!("{mean:.1} % ({low:.0}-{high:.0})")
    })
}

fn family_cells(row: &FamilyRow) -> Vec<String> {
    let mut cells = vec![row.family.name().to_string()];
    cells.push(format!("{} of {}", row.answered(Answer::Right), row.count));
    for answer in [
        Answer::Equivalent,
        Answer::Wrong,
        Answer::Unexplained,
        Answer::Nominal,
        Answer::Unfit,
    ] {
        cells.push(some(row.answered(answer)));
    }
    cells.push(share(&row.reached));
    cells.push(format!(">= {:.0} %", 100.0 * row.target));
    cells.push(row.ratio.map_or_else(String::new, |ratio| {
        format!("{:.2}, {:.2}", ratio.median, ratio.most_90)
    }));
    cells.push(share(&row.coverage));
    cells.push(row.seconds.map_or_else(String::new, |seconds| {
        format!("{:.1}, {:.1}", seconds.median, seconds.most_90)
    }));
    let versions: Vec<&str> = row.versions.iter().map(String::as_str).collect();
    cells.push(versions.join("\n"));
    let mut missed = Vec::new();
    for (is_met, what) in [
        (row.is_reached(), "rate"),
        (row.is_near(), "error"),
        (row.is_covered(), "coverage"),
    ] {
        if !is_met {
            missed.push(what);
        }
    }
    cells.push(if missed.is_empty() {
        "met".to_string()
    } else {
        format!("MISSED: {}", missed.join(", "))
    });
    cells
}

fn effect_cells(row: &EffectRow) -> Vec<String> {
    let count = |answer| row.answers.get(&answer).copied().unwrap_or(0);
    let mut wrong: Vec<String> = row
        .instead
        .iter()
        .map(|(said, times)| format!("{said} ({times})"))
        .collect();
    if count(Answer::Unfit) > 0 {
        wrong.push(format!("unfit ({})", count(Answer::Unfit)));
    }
    vec![
        row.kind.clone(),
        row.family.name().to_string(),
        format!("{} of {}", count(Answer::Right), row.count),
        some(count(Answer::Equivalent)),
        some(count(Answer::Unexplained)),
        some(count(Answer::Nominal)),
        wrong.join("\n"),
    ]
}

/// One outcome on a line: what was hidden, what was said, and how near the truth it came.
pub fn line(outcome: &Outcome) -> String {
    let mut line = format!(
        "{:17} seed {:<4} {}: {}; held out {}; {:.1} s",
        outcome.family.name(),
        outcome.seed,
        hidden(outcome),
        said(outcome),
        errors(outcome),
        outcome.seconds
    );
    let fitted = outcome.fitted().count();
    if fitted > 0 {
        let held = outcome.fitted().filter(|value| value.covered).count();
        line += &format!("; intervals {held} of {fitted}");
    }
    if miss(outcome).is_some() {
        line += "  <- short";
    }
    line
}

fn hidden(outcome: &Outcome) -> String {
    match outcome.hidden.as_slice() {
        [] => "nothing".to_string(),
        hidden => hidden.join(" + "),
    }
}

/// The verdict with its effects.
fn said(outcome: &Outcome) -> String {
    let sets = outcome.sets.iter().filter(|set| !set.is_empty());
    let sets: Vec<String> = sets.map(|set| set.join(" + ")).collect();
    if sets.is_empty() {
        outcome.verdict.clone()
    } else {
        format!("{} {}", outcome.verdict, sets.join(" | "))
    }
}

fn errors(outcome: &Outcome) -> String {
    let mrad = |error: Option<f64>| {
        error.map_or_else(|| "?".to_string(), |error| format!("{:.2}", 1e3 * error))
    };
    format!(
        "{} -> {}, truth {} mrad",
        mrad(outcome.before_rad),
        mrad(outcome.after_rad),
        mrad(outcome.true_rad)
    )
}

/// A line for every outcome that falls short.
pub fn misses(outcomes: &[Outcome]) -> Vec<String> {
    outcomes.iter().filter_map(miss).collect()
}

fn miss(outcome: &Outcome) -> Option<String> {
    let head = format!(
        "{}, seed {}, {}",
        outcome.family.name(),
        outcome.seed,
        hidden(outcome)
    );
    if !outcome.is_right() {
        let note = match outcome.answer {
            Answer::Equivalent => "equivalent: ",
            _ => "",
        };
        return Some(format!(
            "{head}: {note}{}; {}",
            said(outcome),
            errors(outcome)
        ));
    }
    let mut notes = Vec::new();
    if outcome.ratio().is_some_and(|ratio| ratio > MOST_RATIO) {
        notes.push(errors(outcome));
    }
    for value in outcome.fitted().filter(|value| !value.covered) {
        let (low, high) = value.interval.unwrap_or_default();
        let interval = format!("{low:.5} to {high:.5}");
        notes.push(format!(
            "{} is {}, not {interval}",
            value.path, value.true_value
        ));
    }
    (!notes.is_empty()).then(|| format!("{head}: right, but {}", notes.join("; ")))
}
