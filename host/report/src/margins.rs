//! Margins and stiffness of a linear loop, in words and as JSON.

use crate::synth::{Design, LoopFigures, LoopMargin, Margins, Peak, Signal, Stiffness, rows};
use serde::Serialize;
use serde_json::{Value, json};

/// Less than this is warned of, dB and degrees.
const LOW: (f64, f64) = (6.0, 30.0);

/// Lasting torque and share of dead zone whose leans are said, N m and 1.
const TORQUE_NM: f64 = 0.01;
const DEAD_ZONE: f64 = 0.01;

const UNSTABLE: &str = "The linear loop is not stable: it has no margins.";

/// Whether a loop is robust to less than 6 dB or 30 degrees in all channels at once.
pub fn is_low(margins: &Margins) -> bool {
    margins.disk.gain_db() < LOW.0 || margins.disk.phase_rad().to_degrees() < LOW.1
}

/// What is said of margins: a table whose first row has the headings, or a line.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum MarginsPart {
    /// Cells of a table, row by row.
    Rows(Vec<[String; 4]>),
    /// A line of its own; an empty one keeps tables apart.
    Line(String),
}

/// Lines for people.
pub fn margins_text(figures: Option<&LoopFigures>, design: &Design) -> String {
    in_lines(&margins_parts(figures, design))
}

/// Margins at the inputs of a loop in lines for people; `channels` are the inputs' names.
pub fn input_margins_text(margins: Option<&Margins>, channels: &[&str]) -> String {
    match margins {
        Some(margins) => in_lines(&parts_of("Margins at the inputs", margins, channels)),
        None => UNSTABLE.to_string(),
    }
}

fn in_lines(parts: &[MarginsPart]) -> String {
    let lines = parts.iter().map(|part| match part {
        MarginsPart::Rows(rows) => aligned(rows),
        MarginsPart::Line(line) => line.clone(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A table's rows, those below the headings indented.
fn aligned(rows: &[[String; 4]]) -> String {
    let longest = rows.iter().skip(1).map(|row| row[0].chars().count() + 3);
    let width = longest.fold(24, usize::max);
    let lines = rows.iter().enumerate();
    let lines = lines.map(|(index, [name, gain, phase, delay])| {
        let indent = if index > 0 { "  " } else { "" };
        let name = format!("{indent}{name}");
        format!("{name:<width$}{gain:<18}{phase:<12}{delay}")
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Margins and stiffness for every writer.
pub fn margins_parts(figures: Option<&LoopFigures>, design: &Design) -> Vec<MarginsPart> {
    let Some(LoopFigures { margins, stiffness }) = figures else {
        return vec![MarginsPart::Line(UNSTABLE.to_string())];
    };
    let of = |title: &str, margins: &Margins, channels: &[Signal]| {
        let names: Vec<&str> = channels.iter().map(|it| it.name.as_str()).collect();
        parts_of(title, margins, &names)
    };
    let mut parts = of("Margins at the inputs", &margins.inputs, &design.inputs);
    if let (Some(sensors), Some(estimation)) = (&margins.sensors, &design.estimator) {
        parts.push(MarginsPart::Line(String::new()));
        parts.extend(of("Margins at the sensors", sensors, &estimation.outputs));
    }
    let mut lines = Vec::new();
    if let Some(supply) = &margins.supply {
        let above = if supply.highest_v.is_finite() {
            format!("to {:.2} V", supply.highest_v)
        } else {
            "V upwards".to_string()
        };
        lines.push(format!(
            "As supply, about {} V: stable from {:.2} {above}",
            supply.nominal_v, supply.lowest_v
        ));
    }
    if let Some(stiffness) = stiffness {
        lines.extend(lean_lines(stiffness, design));
    }
    if is_low(&margins.inputs) || margins.sensors.as_ref().is_some_and(is_low) {
        let filter = design.estimator.as_ref();
        let remedy = if filter.is_some_and(|filter| filter.recovery == 0.0) {
            "a filter takes margin, and --recovery 1 gives it back; or weigh the speeds less or \
             the inputs more (--q, --r)"
        } else {
            "weigh the speeds less or the inputs more (--q, --r), or try --tune"
        };
        lines.push(format!(
            "LOW MARGINS: below {} dB or {} deg in all channels at once; {remedy}",
            LOW.0, LOW.1
        ));
    }
    parts.extend(lines.into_iter().map(MarginsPart::Line));
    parts
}

/// Margins of one place of a loop; `null` of a loop that is not stable.
pub fn place_margins_json(margins: Option<&Margins>) -> Value {
    margins.map_or(Value::Null, of_place)
}

/// Gain, phase and delay of all alike and of each alone, the disk, the peaks.
fn parts_of(title: &str, margins: &Margins, channels: &[&str]) -> Vec<MarginsPart> {
    let or_any = |said: Option<String>| said.unwrap_or_else(|| "any".to_string());
    let row = |name: String, of: &LoopMargin| {
        let above = Some(of.gain[1]).filter(|above| above.is_finite());
        let above = or_any(above.map(|above| format!("{above:.3}")));
        let degrees = of.phase_rad.map(f64::to_degrees);
        [
            name,
            format!("{:.3} to {above}", of.gain[0]),
            or_any(degrees.map(|degrees| format!("{degrees:.1} deg"))),
            or_any(of.delay_s.map(|s| format!("{:.1} ms", 1e3 * s))),
        ]
    };
    let mut rows = vec![
        [title, "gain", "phase", "delay"].map(str::to_string),
        row("all alike".to_string(), &margins.common),
    ];
    if channels.len() > 1 {
        let single = channels.iter().zip(&margins.single);
        rows.extend(single.map(|(channel, single)| row(format!("{channel} alone"), single)));
    }
    let disk = &margins.disk;
    let gain = Some(disk.gain_db()).filter(|_| disk.gain().is_finite());
    rows.push([
        "each in its own way".to_string(),
        or_any(gain.map(|gain_db| format!("±{gain_db:.1} dB"))),
        format!("±{:.1} deg", disk.phase_rad().to_degrees()),
        format!(
            "disk margin {:.3} at {:.3} rad/s",
            disk.alpha, disk.frequency_rad_s
        ),
    ]);
    let peaks = format!(
        "  Peaks: |S| {:.2} at {:.3} rad/s, |T| {:.2} at {:.3} rad/s",
        margins.sensitivity.value,
        margins.sensitivity.frequency_rad_s,
        margins.complementary.value,
        margins.complementary.frequency_rad_s,
    );
    vec![MarginsPart::Rows(rows), MarginsPart::Line(peaks)]
}

/// Rounded to two places; a zero has no sign for people.
fn hundredths(value: f64) -> f64 {
    (100.0 * value).round() / 100.0 + 0.0
}

fn lean_lines(stiffness: &Stiffness, design: &Design) -> Vec<String> {
    let joints = stiffness.lean_per_torque.nrows();
    let said = |lean: Vec<f64>| {
        let each = lean.iter().zip(&design.states[..joints]);
        let each = each.map(|(lean, state)| match state.unit {
            "rad" => format!("{} {:+.2} deg", state.name, hundredths(lean.to_degrees())),
            _ => format!("{} {:+.2} mm", state.name, hundredths(1e3 * lean)),
        });
        each.collect::<Vec<String>>().join(", ")
    };
    // Where the robot gives most.
    let torque = &stiffness.lean_per_torque;
    let softest = (0..joints).max_by(|a, b| {
        let most = |joint: &usize| torque.column(*joint).amax();
        most(a).total_cmp(&most(b))
    });
    let mut lines = Vec::new();
    if let Some(joint) = softest {
        let lean = (0..joints).map(|row| TORQUE_NM * torque[(row, joint)]);
        let unit = match design.states[joint].unit {
            "rad" => "N m",
            _ => "N",
        };
        lines.push(format!(
            "Lean under a lasting {TORQUE_NM} {unit} at joint {}: {}",
            design.names.label(joint),
            said(lean.collect())
        ));
    }
    if let Some(lean) = &stiffness.lean_per_dead_zone {
        let lean = lean.iter().map(|lean| DEAD_ZONE * lean);
        lines.push(format!(
            "Lean by each {} % of the inputs' limits that a dead zone takes: {}",
            100.0 * DEAD_ZONE,
            said(lean.collect())
        ));
    }
    lines
}

/// `margins` and `stiffness` as keys of an object; `null` of a loop that is not stable.
pub fn margins_json(figures: Option<&LoopFigures>) -> Value {
    let Some(LoopFigures { margins, stiffness }) = figures else {
        return json!({ "margins": null, "stiffness": null });
    };
    // JSON has no infinity: what nothing bounds is null.
    let supply = margins.supply.map(|supply| {
        json!({
            "nominal_v": supply.nominal_v,
            "lowest_v": supply.lowest_v,
            "highest_v": supply.highest_v,
        })
    });
    let stiffness = stiffness.as_ref().map(|stiffness| {
        let zone = stiffness.lean_per_dead_zone.as_ref();
        json!({
            "lean_per_torque": rows(&stiffness.lean_per_torque),
            "lean_per_dead_zone": zone.map(|lean| lean.iter().copied().collect::<Vec<f64>>()),
        })
    });
    json!({
        "margins": {
            "inputs": of_place(&margins.inputs),
            "sensors": margins.sensors.as_ref().map(of_place),
            "supply": supply,
        },
        "stiffness": stiffness,
    })
}

fn of_place(margins: &Margins) -> Value {
    let of = |margin: &LoopMargin| {
        json!({
            "gain": margin.gain,
            "phase_rad": margin.phase_rad,
            "delay_s": margin.delay_s,
        })
    };
    let peak = |peak: &Peak| json!({ "peak": peak.value, "frequency_rad_s": peak.frequency_rad_s });
    json!({
        "common": of(&margins.common),
        "single": margins.single.iter().map(of).collect::<Vec<Value>>(),
        "disk": {
            "alpha": margins.disk.alpha,
            "gain": margins.disk.gain(),
            "gain_db": margins.disk.gain_db(),
            "phase_rad": margins.disk.phase_rad(),
            "frequency_rad_s": margins.disk.frequency_rad_s,
        },
        "sensitivity": peak(&margins.sensitivity),
        "complementary": peak(&margins.complementary),
        "low": is_low(margins),
    })
}

/// Adds `margins` and `stiffness` to a design's JSON.
pub fn with_margins(mut data: Value, figures: Option<&LoopFigures>) -> Value {
    if let (Value::Object(data), Value::Object(added)) = (&mut data, margins_json(figures)) {
        data.extend(added);
    }
    data
}
