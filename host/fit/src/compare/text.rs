//! A comparison as text: models side by side, then where the last of them fails.

use super::closed_loop::closed_loop_text;
use super::result::{Comparison, SignalError};
use crate::fitting::in_windows;
use crate::model::JointNames;
use crate::output::number::{NONE, mrad_in_column};
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use std::fmt::Write as _;

/// Width of the longest bar of a waterfall.
const BAR: usize = 40;

/// Models side by side, one column each; the last one's failures and failed tests in full. Joints
/// are called as `names` has them.
pub fn text(comparisons: &[Comparison], names: &JointNames) -> String {
    let Some((last, others)) = comparisons.split_last() else {
        return String::new();
    };
    let mut rows = comparison_rows(comparisons);
    let cells = rows.iter_mut().skip(1).flatten();
    cells.for_each(|cell| *cell = names.in_text(cell));
    let mut text = format!("{}\n{LEGEND}\n", aligned(&rows));
    if !others.is_empty() {
        let _ = write!(
            text,
            "\nFrom model to model, each as it is\n{}",
            waterfall(comparisons)
        );
    }
    let loops: Vec<_> = comparisons
        .iter()
        .filter_map(Comparison::named_loop)
        .collect();
    text += &closed_loop_text(&loops);
    for other in others {
        let worst = other.failures.first();
        let where_ = worst.map_or(NOWHERE, |failure| failure.sentence.as_str());
        let _ = write!(text, "\nWhere {} fails most\n  {where_}\n", other.model);
    }
    let _ = write!(text, "\nWhere {} fails\n", last.model);
    for sentence in &last.unobserved {
        let _ = writeln!(text, "  {sentence}");
    }
    if last.failures.is_empty() {
        let _ = writeln!(text, "  {NOWHERE}");
    }
    for failure in &last.failures {
        let _ = writeln!(text, "  {}", failure.sentence);
    }
    for signal in &last.signals {
        for test in signal.tests.iter().filter(|test| !test.passed) {
            let joint = of_joint(last, signal);
            let _ = writeln!(text, "  Not passed{joint}: {}; {}", test.name, test.meaning);
        }
    }
    names.in_text(&text)
}

/// What a comparison's table tells, below it.
pub const LEGEND: &str = "rms: typical error; floor: what noise and resolution alone leave; \
    fit: 100 % is a perfect model";
const NOWHERE: &str = "no condition holds more than its share of the error";

/// One bar per model, the floor last: what each step gained, and what there is left to gain.
pub fn waterfall(comparisons: &[Comparison]) -> String {
    let mut steps: Vec<(&str, f64)> = comparisons
        .iter()
        .map(|c| (c.model.as_str(), c.pooled_rms(|s| s.rms)))
        .collect();
    if let Some(last) = comparisons.last() {
        steps.push(("floor", last.pooled_rms(|s| s.floor)));
    }
    let most = steps.iter().map(|step| step.1).fold(0.0, f64::max);
    let width = steps.iter().map(|s| s.0.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for (name, rad) in steps {
        let length = if most > 0.0 { rad / most } else { 0.0 };
        let bar = "#".repeat((length * BAR as f64).round() as usize);
        let milli = comparisons
            .last()
            .map_or("mrad", |last| last.quantity().milli());
        let line = format!("  {name:width$}  {:>8} {milli}  {bar}", mrad_in_column(rad));
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

fn of_joint(comparison: &Comparison, signal: &SignalError) -> String {
    if comparison.signals.len() > 1 || !comparison.unobserved.is_empty() {
        format!(", joint {}", signal.label())
    } else {
        String::new()
    }
}

/// A table of rows whose first are the headings; its columns but the first hold numbers.
pub(super) fn aligned(rows: &[Vec<String>]) -> Table {
    let mut rows = rows.iter();
    let mut table = Table::new();
    table
        .load_preset(presets::ASCII_MARKDOWN)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(rows.next().into_iter().flatten())
        .add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Models side by side: a header (nothing, the models' names), then a row per figure that begins
/// with its name and unit.
pub fn comparison_rows(comparisons: &[Comparison]) -> Vec<Vec<String>> {
    let mut table = Vec::new();
    row(&mut table, comparisons, "", |c| c.model.clone());
    row(&mut table, comparisons, "runs uncorrected", |c| {
        in_windows(&c.windows)
    });
    let signals = comparisons.iter().flat_map(|c| &c.signals);
    let mut signals: Vec<(usize, bool)> = signals.map(|s| (s.joint, s.beside_angle)).collect();
    signals.sort_unstable();
    signals.dedup();
    for signal in signals {
        signal_rows(&mut table, comparisons, signal);
    }
    let mut rungs: Vec<f64> = comparisons
        .iter()
        .flat_map(|c| c.horizons.iter().filter_map(|h| h.horizon_s))
        .collect();
    rungs.sort_by(f64::total_cmp);
    rungs.dedup();
    let whole = comparisons
        .iter()
        .flat_map(|c| &c.horizons)
        .any(|h| h.horizon_s.is_none());
    let milli = comparisons
        .last()
        .map_or("mrad", |last| last.quantity().milli());
    for rung in rungs.into_iter().map(Some).chain(whole.then_some(None)) {
        let label = match rung {
            Some(seconds) => format!("rms of runs of {} s, {milli}", short(seconds)),
            None => format!("rms of whole motions, {milli}"),
        };
        row(&mut table, comparisons, &label, |c| {
            let found = c.horizons.iter().find(|h| h.horizon_s == rung);
            found.map_or("-".to_string(), |h| mrad_in_column(h.rms))
        });
    }
    table
}

/// What a table tells of a signal.
type Cell = fn(&SignalError) -> String;

/// The rows of a joint, or of the rate that it has beside its angle.
fn signal_rows(table: &mut Vec<Vec<String>>, comparisons: &[Comparison], wanted: (usize, bool)) {
    fn own(comparison: &Comparison, wanted: (usize, bool)) -> Option<&SignalError> {
        let mut signals = comparison.signals.iter();
        signals.find(|s| (s.joint, s.beside_angle) == wanted)
    }
    let Some(signal) = comparisons.iter().find_map(|c| own(c, wanted)) else {
        return;
    };
    let named = |c: &Comparison| c.signals.len() > 1 || !c.unobserved.is_empty();
    let prefix = if comparisons.iter().any(named) {
        format!("joint {}: ", signal.label())
    } else {
        String::new()
    };
    let milli = signal.quantity.milli();
    let lines: [(&str, Cell); 6] = [
        ("rms, mrad", |s| mrad_in_column(s.rms)),
        ("largest, mrad", |s| mrad_in_column(s.largest)),
        ("fit, %", |s| {
            if s.fit_percent.is_nan() {
                NONE.to_string()
            } else {
                format!("{:.1}", s.fit_percent)
            }
        }),
        ("floor, mrad", |s| mrad_in_column(s.floor)),
        ("squared error above floor, %", |s| {
            format!("{:.0}", 100.0 * s.share_above_floor)
        }),
        ("tests passed", |s| {
            let passed = s.tests.iter().filter(|t| t.passed).count();
            format!("{passed} of {}", s.tests.len())
        }),
    ];
    for (label, cell) in lines {
        let label = label.replace("mrad", milli);
        row(table, comparisons, &format!("{prefix}{label}"), |c| {
            own(c, wanted).map_or("-".to_string(), cell)
        });
    }
}

fn row(
    table: &mut Vec<Vec<String>>,
    comparisons: &[Comparison],
    label: &str,
    cell: impl Fn(&Comparison) -> String,
) {
    let cells = comparisons.iter().map(cell);
    table.push(std::iter::once(label.to_string()).chain(cells).collect());
}

fn short(seconds: f64) -> String {
    let text = format!("{seconds:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}
