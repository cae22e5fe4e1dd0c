//! A design for people.

use super::format::{digits, plain, several};
use super::values::{list, names};
use crate::output::number::short;
use crate::synth::eigen::largest;
use crate::synth::{Controllability, Design, Estimation, FixedDesign, Mode, OmittedEffect, Signal};
use comfy_table::{CellAlignment, Table, TableComponent, presets};
use nalgebra::DMatrix;

/// Wider matrices are left to `--csv` and `--json`.
const WIDEST: usize = 12;

/// Longer ones, where joints have names, likewise.
const LONGEST: usize = 40;

/// Pose and inputs that hold it.
fn operating_point(design: &Design) -> String {
    let joints = design.plant.a.nrows() / 2;
    // A zero has no sign for people.
    let joined = |values: &[f64]| list(values.iter().map(|v| plain(*v + 0.0)));
    if design.names.joint(1).is_none() {
        return format!(
            "`{}` at q = [{}]{}, held by u = [{}]",
            design.model,
            joined(&design.x0[..joints]),
            pose_unit(design),
            joined(&design.u0)
        );
    }
    let labels = (0..joints).map(|joint| design.names.label(joint));
    let inputs = design.inputs.iter().map(|input| input.name.clone());
    format!(
        "`{}` at {}\nheld by {}",
        design.model,
        with_units(labels, &design.x0, &design.states),
        with_units(inputs, &design.u0, &design.inputs)
    )
}

/// Names with their values, the unit once where all have the same.
fn with_units(names: impl Iterator<Item = String>, values: &[f64], signals: &[Signal]) -> String {
    let values = values.iter().zip(signals);
    let all: Vec<(String, f64, &str)> = names
        .zip(values)
        .map(|(name, (value, signal))| (name, *value, signal.unit))
        .collect();
    let unit = all[0].2;
    let same = all.iter().all(|(.., own)| *own == unit);
    let said = all.iter().map(|(name, value, own)| {
        let value = plain(*value);
        if same {
            format!("{name} {value}")
        } else {
            format!("{name} {value} {own}")
        }
    });
    let said = list(said);
    if same { format!("{said} {unit}") } else { said }
}

/// Unit of a pose: of each joint where some slide.
fn pose_unit(design: &Design) -> String {
    let joints = design.plant.a.nrows() / 2;
    let units: Vec<&str> = design.states[..joints]
        .iter()
        .map(|state| state.unit)
        .collect();
    if units.iter().all(|unit| *unit == "rad") {
        " rad".to_string()
    } else {
        format!(" {}", units.join(", "))
    }
}

/// Gains, poles, zeros, what fixed point costs.
pub fn text(design: &Design) -> String {
    let mut parts = vec![operating_point(design)];
    parts.push(match &design.sampled {
        None => "Continuous time: u = u0 - K (x - x0)".to_string(),
        Some((plant, delay_s)) => format!(
            "Sampled every {} s, inputs {} s late ({} past inputs kept): u = u0 - K (x - x0)",
            plain(plant.ts_s),
            plain(*delay_s),
            plant.delayed_inputs * design.inputs.len()
        ),
    });
    if design.integral.is_some() {
        let sums = design.states.iter().filter(|s| s.name.starts_with("int_"));
        parts.push(format!(
            "Integral action: {} are sums of angles over time, which the law's caller keeps",
            list(sums.map(|sum| sum.name.as_str()))
        ));
    }
    parts.extend(omitted_lines(design));
    parts.push(String::new());
    parts.push(gain_table(design));
    parts.push(String::new());
    parts.extend(plant_lines(design));
    parts.extend(loop_lines(design));
    if let Some(estimation) = &design.estimator {
        parts.push(String::new());
        parts.extend(estimator_lines(design, estimation));
    }
    if let Some(fixed) = &design.fixed {
        parts.push(String::new());
        parts.extend(fixed_lines(design, fixed));
    }
    parts.join("\n")
}

/// A line per effect that the design leaves out, its joints together.
pub(super) fn omitted_lines(design: &Design) -> Vec<String> {
    let omitted = &design.omitted;
    let kinds = omitted.iter().map(|o| (o.effect, o.why));
    let mut lines = Vec::new();
    for (at, (effect, why)) in kinds.enumerate() {
        let same = |o: &&OmittedEffect| (o.effect, o.why) == (effect, why);
        if omitted[..at].iter().any(|o| same(&o)) {
            continue;
        }
        let joints = omitted.iter().filter(same).filter_map(|o| o.joint);
        let joints: Vec<String> = joints.map(|joint| design.names.label(joint)).collect();
        let at = match joints.len() {
            0 => String::new(),
            1 => format!(" at joint {}", joints[0]),
            _ => format!(" at joints {}", joints.join(", ")),
        };
        let title = effect.info().title;
        lines.push(format!("The design leaves out {title}{at}: {why}"));
    }
    lines
}

fn gain_table(design: &Design) -> String {
    let (rows, columns) = (names(&design.inputs), names(&design.states));
    let k = &design.gains.k;
    let is_named = design.names.joint(1).is_some();
    // Names are wide: a row for each state, as many as are read at a glance.
    if is_named && rows.len() <= WIDEST && columns.len() <= LONGEST {
        return matrix("K'", &columns, &rows, &k.transpose());
    }
    if design.states.len() > WIDEST {
        return format!(
            "K is {} x {}: too wide for a page; --csv and --json give every digit",
            design.inputs.len(),
            design.states.len()
        );
    }
    matrix("K", &rows, &columns, k)
}

fn matrix(corner: &str, rows: &[String], columns: &[String], values: &DMatrix<f64>) -> String {
    let header = std::iter::once(corner.to_string()).chain(columns.iter().cloned());
    let mut table = frame(header);
    for (i, name) in rows.iter().enumerate() {
        let row = values.row(i);
        let cells = row.iter().map(|value| digits(*value));
        table.add_row(std::iter::once(name.clone()).chain(cells));
    }
    right(&mut table);
    table.to_string()
}

fn frame(header: impl IntoIterator<Item = String>) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_header(header.into_iter().collect::<Vec<_>>())
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections);
    table
}

fn right(table: &mut Table) {
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
}

fn plant_lines(design: &Design) -> Vec<String> {
    // Rounding scatters poles at 0, by the root of itself where two meet.
    let size = design.plant.a.norm().max(1.0);
    let marginal = design
        .poles
        .iter()
        .filter(|pole| pole.re.abs() <= 1e-7 * size);
    let marginal = match marginal.count() {
        0 => String::new(),
        count => format!(", {count} marginal"),
    };
    let unstable = design
        .poles
        .iter()
        .filter(|pole| pole.re > 1e-7 * size)
        .count();
    let minimum = design.zeros.iter().all(|zero| zero.re <= 0.0);
    let kind = match (design.zeros.is_empty(), minimum) {
        (true, _) => "none: minimum phase".to_string(),
        (false, true) => format!("{} 1/s: minimum phase", several(&design.zeros)),
        (false, false) => format!("{} 1/s: NOT minimum phase", several(&design.zeros)),
    };
    vec![
        format!(
            "Poles of the plant    {} 1/s: {unstable} unstable{marginal}",
            several(&design.poles)
        ),
        format!("Zeros to driven q     {kind}"),
        format!(
            "Controllability       {}",
            controllability(&design.controllability, design)
        ),
        format!(
            "Observability         {}",
            controllability(&design.observability, design)
        ),
    ]
}

fn controllability(of: &Controllability, design: &Design) -> String {
    let n = design.plant.a.nrows();
    // Mirrored modes are equally hard: rounded, the growing one is named, which comes first.
    let size = |mode: &Mode| (1e6 * mode.margin.max(f64::MIN_POSITIVE).ln()).round();
    let weakest = of.modes.iter().min_by(|a, b| size(a).total_cmp(&size(b)));
    let all = if of.is_full() {
        "every mode".to_string()
    } else {
        format!("NOT every mode: rank {} of {n}", of.rank)
    };
    match weakest {
        None => all,
        Some(mode) => format!(
            "{all}; weakest {} 1/s, margin {}",
            several(&[mode.pole]),
            short(mode.margin)
        ),
    }
}

fn loop_lines(design: &Design) -> Vec<String> {
    let unit = if design.sampled.is_some() { "" } else { " 1/s" };
    let mut lines = vec![format!(
        "Poles of the loop     {}{unit}",
        several(&design.gains.poles)
    )];
    if design.sampled.is_some() {
        let radius = largest(&design.gains.poles);
        lines.push(format!("Spectral radius       {radius:.6}"));
    }
    let residual = match design.gains.residual {
        // Smaller ones differ from machine to machine.
        left if left < 1e-16 => "below 1e-16".to_string(),
        left => format!("{left:.0e}"),
    };
    lines.push(format!(
        "Riccati residual      {residual} of the largest entry"
    ));
    lines
}

fn estimator_lines(design: &Design, estimation: &Estimation) -> Vec<String> {
    let own = estimation.plant.plant_states();
    let (states, outputs) = (names(&design.states[..own]), names(&estimation.outputs));
    let mut lines = Vec::new();
    if outputs.len() <= WIDEST {
        let gain = estimation.estimator.gain.rows(0, own).into_owned();
        lines.push(matrix("L", &states, &outputs, &gain));
        lines.push(String::new());
    }
    lines.push(format!(
        "Poles of the filter   {}",
        several(&estimation.estimator.poles)
    ));
    lines.extend(stationary_lines(design, estimation));
    lines.push(format!(
        "With filter and gains the loop's spectral radius is {:.6}",
        largest(&estimation.compensator.loop_poles)
    ));
    lines
}

/// How far noise moves the loop, and whether that is too far.
fn stationary_lines(design: &Design, estimation: &Estimation) -> Vec<String> {
    let Some(stationary) = &estimation.stationary else {
        return vec!["Noise moves this loop without bound".to_string()];
    };
    let said = |signal: &Signal, rms: f64| match signal.unit {
        "rad" => format!("{} {} deg", signal.name, short(rms.to_degrees())),
        unit => format!("{} {} {unit}", signal.name, short(rms)),
    };
    let joints = design.plant.a.nrows() / 2;
    let angles = design.states[..joints].iter().zip(&stationary.state_rms);
    let inputs = design.inputs.iter().zip(&stationary.input_rms);
    let all: Vec<String> = angles.chain(inputs).map(|(s, rms)| said(s, *rms)).collect();
    let mut lines = vec![format!("Noise moves it by     {} RMS", all.join(", "))];
    if let Some(beyond) = estimation.beyond(design) {
        lines.push(format!(
            "NOT linear: noise alone moves {} by {} {} RMS, beyond its range of {}; take finer \
             sensors, or gains that ask for less",
            beyond.signal.name,
            short(beyond.rms),
            beyond.signal.unit,
            plain(beyond.range)
        ));
    }
    lines
}

/// Ranges and steps of the states; where joints have names, states of the same together.
fn ranges(design: &Design, fixed: &FixedDesign) -> Vec<String> {
    let together = design.names.joint(1).is_some();
    let mut ranges: Vec<(String, String)> = Vec::new();
    for (i, state) in design.states.iter().enumerate() {
        let (range, step) = (plain(fixed.ranges.state[i]), short(fixed.law.state_step[i]));
        let said = format!("±{range} in steps of {step}");
        match ranges.iter_mut().find(|(_, own)| together && *own == said) {
            Some((names, _)) => *names = format!("{names}, {}", state.name),
            None => ranges.push((state.name.clone(), said)),
        }
    }
    let said = ranges.into_iter();
    said.map(|(names, range)| format!("{names} {range}"))
        .collect()
}

fn fixed_lines(design: &Design, fixed: &FixedDesign) -> Vec<String> {
    let (law, loss) = (&fixed.law, &fixed.loss);
    let header = [
        "Fixed point",
        "step",
        "limit",
        "shift",
        "margin, bits",
        "error: gains",
        "states",
        "input",
    ];
    let mut table = frame(header.map(str::to_string));
    for (i, input) in design.inputs.iter().enumerate() {
        table.add_row([
            format!("{} [{}]", input.name, input.unit),
            short(law.input_step[i]),
            plain(fixed.ranges.input[i]),
            law.shift[i].to_string(),
            format!("{:.2}", loss.margin_bits[i]),
            short(loss.gain_error[i]),
            short(loss.state_error[i]),
            short(loss.input_error[i]),
        ]);
    }
    right(&mut table);
    let ranges = ranges(design, fixed);
    let beyond = design.inputs.iter().enumerate().filter(|(i, _)| {
        let error = loss.gain_error[*i] + loss.state_error[*i] + loss.input_error[*i];
        error > fixed.ranges.input[*i]
    });
    let beyond: Vec<&str> = beyond.map(|(_, input)| input.name.as_str()).collect();
    let mut lines = vec![
        table.to_string(),
        String::new(),
        if ranges.len() <= WIDEST {
            format!("Ranges: {}", ranges.join("; "))
        } else {
            format!("Ranges: of {} states, see --json", ranges.len())
        },
        "No states whatever overflow the sum; errors are the most that is possible within the \
         ranges."
            .to_string(),
        format!(
            "Spectral radius with these gains {:.6}; fingerprint {:08X}",
            loss.radius_fixed,
            law.fingerprint()
        ),
    ];
    if !beyond.is_empty() {
        lines.push(format!(
            "ROUNDING CAN EXCEED THE LIMIT of {}: declare smaller ranges (--range) or steps of your \
             own (--state-step)",
            list(&beyond)
        ));
    }
    lines
}
