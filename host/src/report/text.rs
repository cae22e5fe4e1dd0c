//! A diagnosis as text for the terminal.

use super::words::{
    in_mrad, measured_on, reduction, sentences, sorted, verdict_word, window, with_interval,
};
use crate::diagnose::words::{SHOWN as RIVALS, headline as sentence, joined};
use crate::diagnose::{Alternative, Diagnosis, FittedEffect};
use crate::fitting::FittedValue;
use crate::number::unit;
use crate::number::{NONE, interval, mrad, percent, short};
use comfy_table::{CellAlignment, ContentArrangement, Table, TableComponent, presets};

/// Columns of a table.
const WIDTH: u16 = 90;
/// Rows shown of what was ruled out.
const SHOWN: usize = 8;

/// Everything a diagnosis says that fits a terminal.
pub fn diagnosis_text(diagnosis: &Diagnosis) -> String {
    let sections = [
        Some(headline(diagnosis)),
        effects(&diagnosis.effects),
        error(diagnosis),
        alternatives(&diagnosis.alternatives),
        ruled_out(diagnosis),
        residual_structure(diagnosis),
        list("Next", &diagnosis.next),
        list("Warnings", &diagnosis.warnings),
    ];
    let sections: Vec<String> = sections.into_iter().flatten().collect();
    sections.join("\n\n") + "\n"
}

fn headline(diagnosis: &Diagnosis) -> String {
    let verdict = verdict_word(diagnosis.verdict);
    let mut lines = vec![format!("Verdict: {verdict}. {}", sentence(diagnosis))];
    lines.extend(sentences(diagnosis).cloned());
    lines.join("\n")
}

fn effects(effects: &[FittedEffect]) -> Option<String> {
    let mut table = table([
        "Effect",
        "Joint",
        "Parameter",
        "Value",
        "95 % interval",
        "Unit",
        "",
    ]);
    for effect in effects {
        for fitted in &effect.parameters {
            table.add_row(row(effect, fitted));
        }
    }
    right(&mut table, &[1, 3, 4]);
    (!table.is_empty()).then(|| format!("Missing effects\n{}", trimmed(&table)))
}

fn row(effect: &FittedEffect, fitted: &FittedValue) -> [String; 7] {
    let [value, low, high] = interval(fitted.value, fitted.low, fitted.high);
    let note = if fitted.on_bound { "on its bound" } else { "" };
    [
        effect.title.clone(),
        effect.joint.map_or("rig".into(), |joint| joint.to_string()),
        fitted.key.clone(),
        value,
        format!("{low} to {high}"),
        unit(&fitted.unit).to_string(),
        note.to_string(),
    ]
}

fn error(diagnosis: &Diagnosis) -> Option<String> {
    let error = &diagnosis.error;
    let nothing_added = diagnosis.effects.is_empty();
    let floor = format!("floor {} mrad", mrad(error.floor_rad));
    let figures = match nothing_added {
        true => format!("Error: {} mrad, {floor}.", mrad(error.before_rad)),
        false => format!(
            "Error: {} mrad, refitted as it is -> {} mrad; {floor}.",
            mrad(error.before_rad),
            mrad(error.after_rad)
        ),
    };
    let on = format!(
        "RMS {}, on {}.",
        window(diagnosis.horizon_s),
        measured_on(error)
    );
    let reduction = reduction(error).filter(|_| !nothing_added);
    let reduction = reduction.map(|reduction| format!("So {reduction}."));
    let lines: Vec<String> = [figures, on].into_iter().chain(reduction).collect();
    error.before_rad.is_finite().then(|| lines.join("\n"))
}

fn alternatives(alternatives: &[Alternative]) -> Option<String> {
    let line = |alternative: &Alternative| {
        let values: Vec<String> = alternative
            .effects
            .iter()
            .flat_map(|effect| &effect.parameters)
            .map(|fitted| format!("{} = {}", fitted.key, with_interval(fitted)))
            .collect();
        let effects = joined(&alternative.effects);
        format!(
            "{effects}: {}; {}",
            in_mrad(alternative.error_rad),
            values.join(", ")
        )
    };
    let mut lines: Vec<String> = alternatives.iter().take(RIVALS).map(line).collect();
    let more = alternatives.len().saturating_sub(RIVALS);
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    list("As good", &lines)
}

fn ruled_out(diagnosis: &Diagnosis) -> Option<String> {
    let mut table = table(["Ruled out", "Fitted, mrad", "Held out, mrad", "BIC", "Why"]);
    for tried in sorted(&diagnosis.ruled_out).into_iter().take(SHOWN) {
        table.add_row([
            tried.set.join(" + "),
            mrad(tried.training_error_rad),
            tried.held_out_error_rad.map_or(NONE.into(), mrad),
            short(tried.bic_change),
            tried.why.clone(),
        ]);
    }
    right(&mut table, &[1, 2, 3]);
    let more = diagnosis.ruled_out.len().saturating_sub(SHOWN);
    let more = if more > 0 {
        format!("\nand {more} more")
    } else {
        String::new()
    };
    (!table.is_empty()).then(|| format!("{}{more}", trimmed(&table)))
}

fn residual_structure(diagnosis: &Diagnosis) -> Option<String> {
    let structure = diagnosis.residual_structure.as_ref()?;
    Some(format!(
        "ResidualStructure: a free form could still gain {} (at least {}) of the squared error above the floor; it leans on {}.",
        percent(structure.explainable_share.clamp(0.0, 1.0)),
        percent(structure.explainable_low.clamp(0.0, 1.0)),
        structure.shape
    ))
}

fn list(title: &str, items: &[String]) -> Option<String> {
    let lines: Vec<String> = items.iter().map(|item| format!("  - {item}")).collect();
    (!items.is_empty()).then(|| format!("{title}\n{}", lines.join("\n")))
}

fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH)
        .set_header(header)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections);
    table
}

/// Numbers stand under each other.
fn right(table: &mut Table, columns: &[usize]) {
    for index in columns {
        if let Some(column) = table.column_mut(*index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
}

fn trimmed(table: &Table) -> String {
    let lines: Vec<String> = table
        .lines()
        .map(|line| line.trim_end().to_string())
        .collect();
    lines.join("\n")
}
