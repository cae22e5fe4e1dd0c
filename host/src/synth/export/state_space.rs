//! The design for other programs: JSON, CSV, and a script for MATLAB and Octave.

use super::Provenance;
use crate::synth::Discrete;
use crate::synth::{Design, Estimation, Fixed, OmittedEffect, Signal};
use nalgebra::{Complex, DMatrix};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// K with a line per input, a column per state, every digit.
pub fn csv(design: &Design) -> String {
    let names: Vec<&str> = design.states.iter().map(|s| s.name.as_str()).collect();
    let mut text = format!("input,{}\n", names.join(","));
    for (i, input) in design.inputs.iter().enumerate() {
        let row: Vec<String> = design
            .gains
            .k
            .row(i)
            .iter()
            .map(|k| format!("{k:?}"))
            .collect();
        let _ = writeln!(text, "{},{}", input.name, row.join(","));
    }
    text
}

/// Everything, matrices as lists of rows. `plant` is what python-control's `ss(a, b, c, d, ts)`
/// takes.
pub fn json(design: &Design, made: &Provenance) -> Value {
    let [q, r] = &design.weights;
    let gains = &design.gains;
    json!({
        "model": design.model,
        "states": signals(&design.states),
        "inputs": signals(&design.inputs),
        "x0": design.x0,
        "u0": design.u0,
        "omitted_effects": design.omitted.iter().map(omitted).collect::<Vec<Value>>(),
        "q": rows(q),
        "r": rows(r),
        "k": rows(&gains.k),
        "riccati": rows(&gains.riccati),
        "residual": gains.residual,
        "loop_poles": complex(&gains.poles),
        "poles_1_s": complex(&design.poles),
        "zeros_1_s": complex(&design.zeros),
        "controllability_rank": design.controllability.rank,
        "observability_rank": design.observability.rank,
        "continuous": {
            "a": rows(&design.plant.a),
            "b": rows(&design.plant.b),
            "c": rows(&design.plant.c),
            "d": rows(&DMatrix::zeros(design.plant.c.nrows(), design.plant.b.ncols())),
        },
        "sampled": design.sampled.as_ref().map(|(plant, delay_s)| sampled(plant, *delay_s)),
        "estimator": design.estimator.as_ref().map(estimator),
        "fixed": design.fixed.as_ref().map(fixed),
        "provenance": {
            "program_version": env!("CARGO_PKG_VERSION"),
            "model_file": made.model,
            "sha256": made.sha256,
            "command": made.command,
        },
    })
}

fn omitted(omitted: &OmittedEffect) -> Value {
    json!({
        "effect": omitted.effect.info().id,
        "joint": omitted.joint + 1,
        "why": omitted.why.to_string(),
    })
}

fn sampled(plant: &Discrete, delay_s: f64) -> Value {
    json!({
        "a": rows(&plant.a),
        "b": rows(&plant.b),
        "c": rows(&plant.c),
        "d": rows(&DMatrix::zeros(plant.c.nrows(), plant.b.ncols())),
        "ts_s": plant.ts_s,
        "delay_s": delay_s,
        "delayed_inputs": plant.delayed_inputs,
    })
}

fn estimator(estimation: &Estimation) -> Value {
    let controller = &estimation.compensator;
    json!({
        "outputs": signals(&estimation.outputs),
        "gain": rows(&estimation.estimator.gain),
        "covariance": rows(&estimation.estimator.covariance),
        "residual": estimation.estimator.residual,
        "poles": complex(&estimation.estimator.poles),
        "controller": {
            "a": rows(&controller.a),
            "b": rows(&controller.b),
            "c": rows(&controller.c),
            "d": rows(&controller.d),
        },
        "loop_poles": complex(&controller.loop_poles),
    })
}

fn fixed(fixed: &Fixed) -> Value {
    let (law, loss) = (&fixed.law, &fixed.loss);
    json!({
        "bits": law.bits,
        "k": (0..law.k.nrows()).map(|i| law.k.row(i).iter().copied().collect()).collect::<Vec<Vec<i64>>>(),
        "bias": law.bias,
        "shift": law.shift,
        "limits": law.limits,
        "x0": law.x0,
        "state_step": law.state_step,
        "input_step": law.input_step,
        "state_range": fixed.ranges.state,
        "input_range": fixed.ranges.input,
        "fingerprint": law.fingerprint(),
        "gain_error": loss.gain_error,
        "state_error": loss.state_error,
        "input_error": loss.input_error,
        "margin_bits": loss.margin_bits,
        "spectral_radius": loss.radius,
        "spectral_radius_fixed": loss.radius_fixed,
    })
}

fn signals(signals: &[Signal]) -> Vec<Value> {
    let value = |s: &Signal| json!({ "name": s.name, "unit": s.unit });
    signals.iter().map(value).collect()
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .row_iter()
        .map(|row| row.iter().copied().collect())
        .collect()
}

fn complex(values: &[Complex<f64>]) -> Vec<[f64; 2]> {
    values.iter().map(|z| [z.re, z.im]).collect()
}

/// A script that makes `plant`, `K` and, with an estimator, `controller`, in MATLAB's Control
/// System Toolbox or Octave's control package.
pub fn matlab(design: &Design, made: &Provenance) -> String {
    let mut text = format!(
        "% `{}` by handstand {} from {}\n% sha256 {}\n% {}\n",
        design.model,
        env!("CARGO_PKG_VERSION"),
        made.model,
        made.sha256,
        made.command
    );
    let mut put = |name: &str, matrix: &DMatrix<f64>| {
        let _ = writeln!(text, "{name} = [");
        for row in matrix.row_iter() {
            let values: Vec<String> = row.iter().map(|v| format!("{v:?}")).collect();
            let _ = writeln!(text, "  {}", values.join(" "));
        }
        text.push_str("];\n");
    };
    let (a, b, c, ts_s) = match &design.sampled {
        Some((plant, _)) => (&plant.a, &plant.b, &plant.c, Some(plant.ts_s)),
        None => (&design.plant.a, &design.plant.b, &design.plant.c, None),
    };
    put("A", a);
    put("B", b);
    put("C", c);
    put("Q", &design.weights[0]);
    put("R", &design.weights[1]);
    put("K", &design.gains.k);
    put(
        "x0",
        &DMatrix::from_row_slice(1, design.x0.len(), &design.x0),
    );
    put(
        "u0",
        &DMatrix::from_row_slice(1, design.u0.len(), &design.u0),
    );
    if let Some(estimation) = &design.estimator {
        let controller = &estimation.compensator;
        put("L", &estimation.estimator.gain);
        put("Ac", &controller.a);
        put("Bc", &controller.b);
        put("Cc", &controller.c);
        put("Dc", &controller.d);
    }
    let ts = ts_s.map_or_else(String::new, |ts_s| format!(", {ts_s:?}"));
    let _ = writeln!(
        text,
        "plant = ss(A, B, C, zeros(size(C, 1), size(B, 2)){ts});"
    );
    if design.estimator.is_some() {
        let _ = writeln!(
            text,
            "controller = ss(Ac, Bc, Cc, Dc{ts}); % from y to u, the sign of the feedback included"
        );
    }
    text
}
