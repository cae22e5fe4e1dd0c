//! What a plan takes of a model, and what the torque limit allows, as tables.

use crate::cli::show::table_of;
use handstand::deploy::{EffectUse, ModeLimit};
use handstand::output::table::TableColumn;

/// A line for each unstable mode.
pub fn limits_table(limits: &[ModeLimit]) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let columns: &[TableColumn<ModeLimit>] = &[
        ("Unstable mode", &|l| format!("{:.1} /s", l.pole_per_s)),
        ("Grows until an answer acts", &|l| {
            format!("x {:.2} in {:.1} ms", l.growth, 1e3 * l.answer_s)
        }),
        ("1 deg, of what is recoverable", &|l| {
            percent(l.degree_share)
        }),
        ("Half a sensor step, when answered", &|l| {
            percent(l.half_step_share)
        }),
    ];
    table_of(limits, columns).to_string()
}

/// A line for each effect of a model: where its plan has it.
pub fn uses_table(uses: &[EffectUse]) -> String {
    let columns: &[TableColumn<EffectUse>] = &[
        ("Of the model", &|used| used.effect.clone()),
        ("In the plan", &|used| used.place.name().to_string()),
        ("How", &|used| used.how.clone()),
    ];
    table_of(uses, columns).to_string()
}
