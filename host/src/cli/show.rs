//! Tables and figures as every command shows them.

use super::Console;
use comfy_table::{ContentArrangement, Table};
use handstand::fitting::Undetermined;
use handstand::output::number::exact;
use handstand::output::table::{plain_table, within_width};
use handstand::report::remedy_of;
use handstand::report::table::{self, Columns};
use handstand::synth::{linearise, upright};
use handstand::sysid::IntervalEstimate;
use handstand::{Model, Result};

/// A plain table without frame.
pub fn table<const N: usize>(header: [&str; N]) -> Table {
    within_width(plain_table(header), 100)
}

/// A plain table, a line for each of `rows`.
pub fn table_of<'r, T: 'r>(rows: impl IntoIterator<Item = &'r T>, columns: &Columns<T>) -> Table {
    within_width(table::table_of(rows, columns), 100)
}

/// A table of many narrow columns, as wide as it needs.
pub fn wide_table() -> Table {
    let mut table = table([""]);
    table.set_content_arrangement(ContentArrangement::Disabled);
    table
}

/// Values that cannot be had, for people.
pub fn undetermined(refused: &Undetermined) -> String {
    let remedy = remedy_of(refused);
    format!("refused: {refused}; nothing is written. What to do: {remedy}.")
}

/// Says which effects of the model a linear design leaves out.
pub fn omitted(model: &Model, console: &Console) -> Result<()> {
    model.planar_only("these designs are of planar chains (`gains` takes both)")?;
    let model = handstand::sim::bare_motors(model);
    let omitted = linearise(&model, &upright(&model))?.omitted;
    if !omitted.is_empty() {
        let each = omitted.iter().map(|omitted| {
            let title = omitted.effect.info().title;
            match omitted.joint {
                Some(joint) => format!("{title} at joint {}", joint + 1),
                None => title.to_string(),
            }
        });
        console.say(&format!(
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

/// That friction held so many runs, if it did.
pub fn held(runs: usize) -> Option<String> {
    (runs > 0).then(|| {
        format!(
            "{runs} runs stay without any command, held by friction: they do not count as \
             stabilised."
        )
    })
}
