//! Tables and figures as every command shows them.

use super::talk::Talk;
use comfy_table::{ContentArrangement, Table, TableComponent, presets};
use handstand::diagnose::FittedValue;
use handstand::fitting::Horizon;
use handstand::fitting::{Extension, Fall, Undetermined};
use handstand::number::exact;
use handstand::synth::{linearise, upright};
use handstand::{Model, Result};
use serde_json::{Value, json};

/// A plain table without frame.
pub fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_header(header)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections);
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

/// An extension for people: its values, then its errors; `before` says which model left the error before.
pub fn extension(extension: &Extension, before: &str) -> String {
    let mut table = table(["Parameter", "Value", "95 % interval", "Unit", ""]);
    for value in &extension.values {
        table.add_row([
            value.path.clone(),
            exact(value.value),
            format!("{} to {}", exact(value.low), exact(value.high)),
            value.unit.clone(),
            if value.on_bound { "on its bound" } else { "" }.to_string(),
        ]);
    }
    let mut lines = vec![
        table.to_string(),
        String::new(),
        fall(&extension.error, before),
    ];
    if let Horizon::Seconds(seconds) = extension.horizon {
        lines.push(format!("The model ran {} s at a time.", exact(seconds)));
    }
    lines.extend(
        warnings(extension)
            .iter()
            .map(|line| format!("warning: {line}")),
    );
    lines.join("\n")
}

fn fall(error: &Fall, before: &str) -> String {
    let whose = if error.held_out {
        "on the motions held out"
    } else {
        "on the motions fitted"
    };
    format!(
        "Error {whose}: {} mrad {before} -> {} mrad for the new one; noise alone leaves {} mrad.",
        exact(1e3 * error.before_rad),
        exact(1e3 * error.after_rad),
        exact(1e3 * error.floor_rad)
    )
}

/// What to be wary of in an extension.
fn warnings(extension: &Extension) -> Vec<String> {
    let stuck = |value: &&FittedValue| value.on_bound;
    let mut warnings: Vec<String> = extension
        .values
        .iter()
        .filter(stuck)
        .map(|value| format!("`{}` lies on its bound: no measurement of it", value.path))
        .collect();
    if !extension.converged {
        warnings.push("the fit had not come to rest when its iterations ran out".to_string());
    }
    warnings
}

/// An extension for programs.
pub fn extension_json(extension: &Extension) -> Value {
    let error = &extension.error;
    json!({
        "values": extension.values,
        "error": {
            "unit": "rad",
            "before": error.before_rad,
            "after": error.after_rad,
            "floor": error.floor_rad,
            "held_out": error.held_out,
        },
        "horizon_s": match extension.horizon {
            Horizon::Whole => None,
            Horizon::Seconds(seconds) => Some(seconds),
        },
        "converged": extension.converged,
        "warnings": warnings(extension),
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
