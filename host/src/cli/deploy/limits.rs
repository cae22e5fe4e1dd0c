//! What the torque limit allows, as a table.

use crate::cli::show::table_of;
use handstand::deploy::ModeLimit;
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
