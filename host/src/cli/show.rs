//! Tables and figures as every command shows them.

use super::Talk;
use comfy_table::{ContentArrangement, Table};
use handstand::fitting::{FittedValue, Refitted, Undetermined, in_windows};
use handstand::output::number::exact;
use handstand::output::table::{self, TableColumn, plain_table};
use handstand::synth::{linearise, upright};
use handstand::sysid::IntervalEstimate;
use handstand::{Model, Result};
use serde_json::{Value, json};

/// A plain table without frame.
pub fn table<const N: usize>(header: [&str; N]) -> Table {
    within_width(plain_table(header))
}

/// A plain table, a line for each of `rows`.
pub fn table_of<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &[TableColumn<T>],
) -> Table {
    within_width(table::table_of(rows, columns))
}

fn within_width(mut table: Table) -> Table {
    if table.width().is_none() {
        table.set_width(100);
    }
    table
}

/// A table of many narrow columns, as wide as it needs.
pub fn wide_table() -> Table {
    let mut table = table([""]);
    table.set_content_arrangement(ContentArrangement::Disabled);
    table
}

/// A refitted model for people: its values, then its errors; `before` says which model left the
/// error before.
pub fn refitted(refitted: &Refitted, before: &str) -> String {
    let on_bound = |on_bound: bool| if on_bound { "on its bound" } else { "" };
    let columns: &[TableColumn<FittedValue>] = &[
        ("Parameter", &|v| v.path.clone()),
        ("Value", &|v| exact(v.value)),
        ("95 % interval", &|v| {
            format!("{} to {}", exact(v.low), exact(v.high))
        }),
        ("Unit", &|v| v.unit.clone()),
        ("", &|v| on_bound(v.on_bound).to_string()),
    ];
    let table = table_of(&refitted.values, columns);
    let error = &refitted.error;
    let motions = if error.held_out { "held out" } else { "fitted" };
    let [old, new, floor] =
        [error.before_rad, error.after_rad, error.floor_rad].map(|rad| exact(1e3 * rad));
    let mut lines = vec![
        table.to_string(),
        String::new(),
        format!(
            "Error on the motions {motions}: {old} mrad {before} -> {new} mrad for the new one; \
             noise alone leaves {floor} mrad."
        ),
    ];
    lines.push(format!("The model ran {}.", in_windows(&refitted.windows)));
    let warnings = warnings(refitted).into_iter();
    lines.extend(warnings.map(|line| format!("warning: {line}")));
    lines.join("\n")
}

/// What to be wary of in a refitted model.
fn warnings(refitted: &Refitted) -> Vec<String> {
    let on_bound = refitted.values.iter().filter(|value| value.on_bound);
    let mut warnings: Vec<String> = on_bound
        .map(|value| format!("`{}` lies on its bound: no measurement of it", value.path))
        .collect();
    if !refitted.converged {
        warnings.push("the fit had not come to rest when its iterations ran out".to_string());
    }
    warnings.extend(refitted.unobserved.iter().cloned());
    warnings
}

/// A refitted model for programs.
pub fn refitted_json(refitted: &Refitted) -> Value {
    json!({
        "values": refitted.values,
        "error": refitted.error,
        "horizon_s": refitted.horizon.seconds(),
        "windows": refitted.windows,
        "converged": refitted.converged,
        "warnings": warnings(refitted),
    })
}

/// Values that cannot be had, for people.
pub fn undetermined(refused: &Undetermined) -> String {
    format!(
        "refused: {refused}; nothing is written. Fit fewer values, or record motions that show \
         them."
    )
}

/// Says which effects of the model a linear design leaves out.
pub fn omitted(model: &Model, talk: &Talk) -> Result<()> {
    let model = handstand::sim::bare_motors(model);
    let omitted = linearise(&model, &upright(&model))?.omitted;
    if !omitted.is_empty() {
        let each = omitted.iter().map(|omitted| {
            let joint = omitted.joint + 1;
            format!("{} at joint {joint}", omitted.effect.info().title)
        });
        talk.say(&format!(
            "the designs leave out {}; the simulation has them",
            each.collect::<Vec<_>>().join(", ")
        ));
    }
    Ok(())
}

/// The ends of an interval.
pub fn ends(known: &IntervalEstimate) -> String {
    format!("{} to {}", exact(known.low), exact(known.high))
}

/// A value with its interval.
pub fn known(known: &IntervalEstimate) -> String {
    format!("{} ({})", exact(known.value), ends(known))
}

/// A value as `text` shows it, or a dash where there is none.
pub fn or_dash<V>(value: Option<V>, text: impl Fn(V) -> String) -> String {
    value.map_or("–".to_string(), text)
}
