//! A diagnosis as text for the terminal.

use super::words::{
    floor_interval, in_columns, in_milli, measured_on, odd_shares, reduction, sentences, sorted,
    verdict_word, with_ends,
};
use crate::diagnose::words::{SHOWN as RIVALS, change, explained_by, headline as sentence};
use crate::diagnose::{Alternative, BudgetedPart, Diagnosis, FittedEffect, Fold, WrongValue};
use crate::effects;
use crate::fitting::{FittedValue, in_windows};
use crate::model::{JointNames, MeasuredSignal};
use crate::output::number::unit;
use crate::output::number::{NONE, given, interval, mrad, percent, short};
use crate::output::table::{TableColumn, plain_table, table_of, unbroken};
use comfy_table::{CellAlignment, Table};

/// Columns of a table.
const WIDTH: u16 = 90;
/// Rows shown of what was ruled out.
const SHOWN: usize = 8;

/// Everything a diagnosis says that fits a terminal. Links and joints are called as `names` has
/// them.
pub fn diagnosis_text(diagnosis: &Diagnosis, names: &JointNames) -> String {
    let sections = [
        Some(headline(diagnosis)),
        parameters("Missing effects", &diagnosis.effects, names),
        wrong_values(&diagnosis.wrong_values),
        error(diagnosis),
        budget(&diagnosis.budget, names, diagnosis.error.quantity),
        alternatives(&diagnosis.alternatives, diagnosis.error.quantity),
        not_chosen(diagnosis, names, true),
        not_chosen(diagnosis, names, false),
        residual_structure(diagnosis),
        list("Next", &diagnosis.next),
        list("Warnings", &diagnosis.warnings),
    ];
    let sections: Vec<String> = sections.into_iter().flatten().collect();
    names.in_text(&sections.join("\n\n")) + "\n"
}

fn headline(diagnosis: &Diagnosis) -> String {
    let verdict = verdict_word(diagnosis.verdict);
    let mut lines = vec![format!("Verdict: {verdict}. {}", sentence(diagnosis))];
    lines.extend(sentences(diagnosis).cloned());
    lines.join("\n")
}

/// The values of effects, under this title.
pub(crate) fn parameters(
    title: &str,
    effects: &[FittedEffect],
    names: &JointNames,
) -> Option<String> {
    let mut values = Vec::new();
    for effect in effects {
        values.extend(effect.parameters.iter().map(|fitted| (effect, fitted)));
    }
    let ends = |fitted: &FittedValue| interval(fitted.value, fitted.low, fitted.high);
    let note = |on_bound: bool| if on_bound { "on its bound" } else { "" };
    let columns: &[TableColumn<(&FittedEffect, &FittedValue)>] = &[
        ("Effect", &|(effect, _)| effect.title.clone()),
        ("Joint", &|(effect, _)| {
            let all = match effects::at_all(&effect.kind) {
                "@all" => "all",
                _ => "rig",
            };
            effect.joint.map_or(all.into(), |joint| {
                names.joint(joint).map_or(joint.to_string(), str::to_string)
            })
        }),
        ("Parameter", &|(_, fitted)| fitted.key.clone()),
        ("Value", &|(_, fitted)| ends(fitted)[0].clone()),
        ("95 % interval", &|(_, fitted)| {
            ends(fitted)[1..].join(" to ")
        }),
        ("Unit", &|(_, fitted)| unit(&fitted.unit).to_string()),
        ("", &|(_, fitted)| note(fitted.on_bound).to_string()),
    ];
    Some(format!(
        "{title}\n{}",
        lines(table_of(&values, columns), &[1, 3, 4])?
    ))
}

fn wrong_values(wrong: &[WrongValue]) -> Option<String> {
    let line = |wrong: &WrongValue| format!("{}: {}", wrong.fitted.path, change(wrong));
    let lines = |within: bool| -> Vec<String> {
        let own = wrong.iter().filter(|w| w.within_uncertainty == within);
        own.map(line).collect()
    };
    let lists = [
        list("Wrong values", &lines(false)),
        list("Better values, within their uncertainty", &lines(true)),
    ];
    let lists: Vec<String> = lists.into_iter().flatten().collect();
    (!lists.is_empty()).then(|| lists.join("\n\n"))
}

pub(crate) fn error(diagnosis: &Diagnosis) -> Option<String> {
    let error = &diagnosis.error;
    let unit = error.quantity.milli();
    let (before, after) = (mrad(error.before_rad), mrad(error.after_rad));
    let added = !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty();
    let refitted = error
        .refitted_rad
        .map(|rad| format!(", {} {unit} refitted", mrad(rad)));
    let refitted = refitted.unwrap_or_default();
    let change = if added {
        format!(" as given{refitted} -> {after} {unit};")
    } else {
        format!(" as given{refitted};")
    };
    let mut lines = vec![
        format!(
            "Error: {before} {unit}{change} floor {}{} {unit}.",
            mrad(error.floor_rad),
            floor_interval(error)
        ),
        format!(
            "Searched {}; RMS {}, on {}.",
            searched(diagnosis.search_horizon_s),
            in_windows(&diagnosis.windows),
            measured_on(error)
        ),
    ];
    lines.extend(
        reduction(error)
            .filter(|_| added)
            .map(|reduction| format!("So {reduction}.")),
    );
    lines.extend(folds(&diagnosis.folds, unit));
    error.before_rad.is_finite().then(|| lines.join("\n"))
}

/// "in windows of 1 s"
fn searched(horizon_s: Option<f64>) -> String {
    horizon_s.map_or("over whole motions".to_string(), |seconds| {
        format!("in windows of {} s", given(seconds))
    })
}

/// "With other motions held out: 41.0 -> 6.2, 39.5 -> 6.4 mrad."
fn folds(folds: &[Fold], unit: &str) -> Option<String> {
    let each = folds.iter();
    let each = each.map(|fold| format!("{} -> {}", mrad(fold.before_rad), mrad(fold.after_rad)));
    let each: Vec<String> = each.collect();
    (!each.is_empty()).then(|| format!("With other motions held out: {} {unit}.", each.join(", ")))
}

/// What each part of an explanation of several removes.
fn budget(parts: &[BudgetedPart], names: &JointNames, quantity: MeasuredSignal) -> Option<String> {
    let [leaves, without] = in_columns(["leaves", "without it"], quantity);
    let columns: &[TableColumn<&BudgetedPart>] = &[
        ("Error budget", &|part| names.in_text(&part.part)),
        ("Alone", &|part| with_ends(&part.alone)),
        (&leaves, &|part| mrad(part.alone.error_rad)),
        ("Beyond the others", &|part| with_ends(&part.beyond_others)),
        (&without, &|part| mrad(part.beyond_others.error_rad)),
    ];
    if parts.len() < 2 {
        return None;
    }
    let table = table_of(&parts.iter().collect::<Vec<_>>(), columns);
    let mut text = format!(
        "Share of the squared error of the model as given that each part removes\n{}",
        lines(table, &[1, 2, 3, 4])?
    );
    for sentence in odd_shares(parts) {
        text += &format!("\n{sentence}");
    }
    Some(text)
}

fn alternatives(alternatives: &[Alternative], quantity: MeasuredSignal) -> Option<String> {
    let line = |alternative: &Alternative| {
        let values = alternative
            .effects
            .iter()
            .flat_map(|effect| &effect.parameters);
        let wrong = alternative.wrong_values.iter().map(|wrong| &wrong.fitted);
        let values = values.chain(wrong);
        let values = values.map(|fitted| format!("{} = {fitted}", fitted.key));
        let effects = explained_by(&alternative.effects, &alternative.wrong_values);
        let error = in_milli(alternative.error_rad, quantity);
        format!(
            "{effects}: {error}; {}",
            values.collect::<Vec<_>>().join(", ")
        )
    };
    let mut lines: Vec<String> = alternatives.iter().take(RIVALS).map(line).collect();
    lines.extend(and_more(alternatives.len(), RIVALS));
    list("As good", &lines)
}

/// What was tried and not chosen: what does as well, then what does worse.
fn not_chosen(diagnosis: &Diagnosis, names: &JointNames, as_good: bool) -> Option<String> {
    let rows = sorted(&diagnosis.ruled_out, as_good);
    let title = if as_good {
        "As good, not needed"
    } else {
        "Ruled out"
    };
    let [fitted, held_out] = in_columns(["Fitted", "Held out"], diagnosis.error.quantity);
    let mut table = plain_table([title, &fitted, &held_out, "BIC", "Why"]);
    for tried in rows.iter().take(SHOWN) {
        table.add_row([
            names.in_text(&tried.set.join(" + ")),
            mrad(tried.training_error_rad),
            tried.held_out_error_rad.map_or(NONE.into(), mrad),
            short(tried.bic_change),
            names.in_text(&tried.why),
        ]);
    }
    let mut lines = vec![lines(table, &[1, 2, 3])?];
    lines.extend(and_more(rows.len(), SHOWN));
    Some(lines.join("\n"))
}

fn residual_structure(diagnosis: &Diagnosis) -> Option<String> {
    let structure = diagnosis.residual_structure.as_ref()?;
    Some(format!(
        "Residual structure: a free form could still gain {} (at least {}) of the squared error \
         above the floor; it leans on {}.",
        percent(structure.explainable_share.clamp(0.0, 1.0)),
        percent(structure.explainable_low.clamp(0.0, 1.0)),
        structure.shape
    ))
}

pub(crate) fn list(title: &str, items: &[String]) -> Option<String> {
    let lines: Vec<String> = items.iter().map(|item| format!("  - {item}")).collect();
    (!items.is_empty()).then(|| format!("{title}\n{}", lines.join("\n")))
}

/// The table's lines, numbers in these columns under each other; nothing without rows.
fn lines(mut table: Table, numbers: &[usize]) -> Option<String> {
    table.set_width(WIDTH);
    table = unbroken(table);
    for index in numbers {
        if let Some(column) = table.column_mut(*index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<String> = table
        .lines()
        .map(|line| line.trim_end().to_string())
        .collect();
    (!table.is_empty()).then(|| lines.join("\n"))
}

fn and_more(all: usize, shown: usize) -> Option<String> {
    (all > shown).then(|| format!("and {} more", all - shown))
}
