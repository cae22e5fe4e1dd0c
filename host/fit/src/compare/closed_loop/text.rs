//! A closed-loop comparison as a table: the measured loop, then each model's.

use super::result::{ClosedLoopComparison, LoopMotion, LoopSignal};
use crate::compare::text::aligned;
use crate::output::number::{NONE, mrad_in_column, short};

/// What a closed-loop table tells, below it.
pub const LEGEND: &str = "Each loop is simulated from the first sample of each motion. \
    Phase drifts, so judge by rms, limit cycle and falls.";

/// One column of the table: the measured loop, or a model's with its name.
type LoopColumn<'a> = (&'a str, Option<&'a ClosedLoopComparison>);

/// A figure of a joint, rad.
type Figure = fn(&LoopSignal) -> Option<f64>;

/// Names of the figures, and what they are of the measured and of the simulated loop.
const FIGURES: [(&str, Figure, Figure); 3] = [
    ("rms error", |_| None, |s| Some(s.rms_error_rad)),
    (
        "rms deviation",
        |s| Some(s.measured_rms_rad),
        |s| Some(s.simulated_rms_rad),
    ),
    (
        "limit cycle",
        |s| s.measured_limit_cycle_rad,
        |s| s.simulated_limit_cycle_rad,
    ),
];

/// The models' loops beside the measured one, as a section of a text; empty without a model.
pub fn closed_loop_text(compared: &[(&str, &ClosedLoopComparison)]) -> String {
    let rows = closed_loop_rows(compared);
    if rows.is_empty() {
        return String::new();
    }
    let table = aligned(&rows);
    format!("\nClosed loop with the plan\n{table}\n{LEGEND}\n")
}

/// The table's cells: a header (nothing, `measured`, the models' names), then a row per figure that
/// begins with its name and unit.
pub fn closed_loop_rows(compared: &[(&str, &ClosedLoopComparison)]) -> Vec<Vec<String>> {
    let Some((_, last)) = compared.last() else {
        return Vec::new();
    };
    let models = compared.iter().map(|(name, c)| (*name, Some(*c)));
    let columns: Vec<LoopColumn> = std::iter::once(("measured", None)).chain(models).collect();
    let names = columns.iter().map(|(name, _)| (*name).to_string());
    let mut rows = vec![std::iter::once(String::new()).chain(names).collect()];
    for (joint, measured) in last.signals.iter().enumerate() {
        for (figure, in_measured, in_simulated) in FIGURES {
            let cells = columns.iter().map(|(_, compared)| {
                let value = match compared {
                    None => in_measured(measured),
                    Some(compared) => compared.signals.get(joint).and_then(in_simulated),
                };
                let value = value.filter(|value| value.is_finite());
                value.map_or(NONE.to_string(), mrad_in_column)
            });
            let label = format!("joint {}: {figure}, mrad", joint + 1);
            rows.push(std::iter::once(label).chain(cells).collect());
        }
    }
    let falls = columns.iter().map(|(_, compared)| match compared {
        None => falls(last, |motion| motion.measured_fell_s),
        Some(compared) => falls(compared, |motion| motion.simulated_fell_s),
    });
    rows.push(std::iter::once("falls".to_string()).chain(falls).collect());
    rows
}

/// "1 of 3, first after 0.84 s".
fn falls(compared: &ClosedLoopComparison, fell_s: fn(&LoopMotion) -> Option<f64>) -> String {
    let all: Vec<f64> = compared.motions.iter().filter_map(fell_s).collect();
    let count = format!("{} of {}", all.len(), compared.motions.len());
    let first_s = all.iter().copied().fold(f64::INFINITY, f64::min);
    match all.as_slice() {
        [] => count,
        [_] => format!("{count}, after {} s", short(first_s)),
        _ => format!("{count}, first after {} s", short(first_s)),
    }
}
