//! Values that every file of gains names, in its own syntax.

use super::Provenance;
use super::text::omitted_lines;
use crate::synth::{Design, FixedDesign, Signal};
use std::fmt::Display;

/// Comma-separated.
pub(super) fn list<T: Display>(values: impl IntoIterator<Item = T>) -> String {
    let values: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
    values.join(", ")
}

/// Names of signals.
pub(super) fn names(signals: &[Signal]) -> Vec<String> {
    signals.iter().map(|signal| signal.name.clone()).collect()
}

/// What the head of a file says, a line each.
pub(super) fn head(design: &Design, fixed: &FixedDesign, made: &Provenance) -> Vec<String> {
    let law = &fixed.law;
    let with_units =
        |signals: &[Signal]| list(signals.iter().map(|s| format!("{} [{}]", s.name, s.unit)));
    let plain = |values: &[f64]| list(values.iter());
    let margins = fixed.loss.margin_bits.iter();
    let margins = margins.map(|bits| format!("{bits:.2}"));
    let mut lines = vec![
        format!(
            "Gains of `{}`: u = sat(u0 - K (x - x0)) in fixed point.",
            design.model
        ),
        format!(
            "Made by handstand {} from {}",
            env!("CARGO_PKG_VERSION"),
            made.model
        ),
        format!("  sha256 {}", made.sha256),
        format!("  $ {}", made.command),
        format!("States x: {}", with_units(&design.states)),
        format!("  SI value of one step: {}", plain(&law.state_step)),
        format!("  ranges about x0: {}", plain(&fixed.ranges.state)),
        format!("Inputs u: {}", with_units(&design.inputs)),
        format!("  SI value of one step: {}", plain(&law.input_step)),
        format!("  limits: {}", plain(&fixed.ranges.input)),
        format!(
            "No states whatever overflow the 32-bit sum: {} bits of margin.",
            list(margins)
        ),
        format!(
            "Spectral radius of the loop: {:.6} as designed, {:.6} with these gains.",
            fixed.loss.radius, fixed.loss.radius_fixed
        ),
    ];
    lines.extend(omitted_lines(design));
    lines
}
