//! What a plan takes of a model, and what the torque limit allows, as tables.

use crate::cli::show::table_of;
use handstand::deploy::{EffectUse, ModeLimit, ObserverLoop};
use handstand::report::input_margins_text;
use handstand::report::table::columns_of;

/// Lasting torque whose lean is said, N m.
const TORQUE_NM: f64 = 0.01;

/// A line for each unstable mode.
pub fn limits_table(limits: &[ModeLimit]) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let columns = columns_of::<ModeLimit>()
        .text("Unstable mode", |l| format!("{:.1} /s", l.pole_per_s))
        .text("Grows until an answer acts", |l| {
            format!("x {:.2} in {:.1} ms", l.growth, 1e3 * l.answer_s)
        })
        .text("1 deg, of what is recoverable", |l| percent(l.degree_share))
        .text("Half a sensor step, when answered", |l| {
            percent(l.half_step_share)
        });
    table_of(limits, &columns).to_string()
}

/// Margins of the observer's loop, and where a lasting torque on the bar leaves the robot.
pub fn observer_text(of: &ObserverLoop) -> String {
    let margins = input_margins_text(of.margins.as_ref(), &["shoulder", "hip"]);
    let lean = of.lean_per_torque.as_ref().map_or(String::new(), |lean| {
        let deg: Vec<String> = lean
            .column(0)
            .iter()
            .map(|per_nm| format!("{:+.2}", (TORQUE_NM * per_nm).to_degrees()))
            .collect();
        format!(
            "\nIts offsets act as integrals: under a lasting {TORQUE_NM} N m on the bar it rests where \
             gravity balances it, bar, shoulder and hip at {} deg",
            deg.join(", ")
        )
    });
    margins + &lean
}

/// A line for each effect of a model: where its plan has it.
pub fn uses_table(uses: &[EffectUse]) -> String {
    let columns = columns_of::<EffectUse>()
        .text("Of the model", |used| used.effect.clone())
        .text("In the plan", |used| used.place.name().to_string())
        .text("How", |used| used.how.clone());
    table_of(uses, &columns).to_string()
}
