//! Tables and figures as every command shows them.

use super::talk::Talk;
use comfy_table::{ContentArrangement, Table};
use handstand::fitting::{Refitted, Undetermined, in_windows};
use handstand::output::number::exact;
use handstand::report::plain_table;
use handstand::synth::{linearise, upright};
use handstand::{Model, Result};
use serde_json::{Value, json};

/// A plain table without frame.
pub fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = plain_table(header);
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
    let mut table = table(["Parameter", "Value", "95 % interval", "Unit", ""]);
    for value in &refitted.values {
        table.add_row([
            value.path.clone(),
            exact(value.value),
            format!("{} to {}", exact(value.low), exact(value.high)),
            value.unit.clone(),
            if value.on_bound { "on its bound" } else { "" }.to_string(),
        ]);
    }
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
        "refused: {refused}; nothing is written. Fit fewer values, or record motions that show them."
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
