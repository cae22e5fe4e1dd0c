//! The design for other programs: JSON, CSV, and a script for MATLAB and Octave.

use super::Provenance;
use super::values::names;
use crate::synth::{Design, Discrete, Estimation, FixedDesign, OmittedEffect, Signal, rows};
use nalgebra::{Complex, DMatrix};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// K with a line per input, a column per state, every digit.
pub fn csv(design: &Design) -> String {
    let mut text = format!("input,{}\n", names(&design.states).join(","));
    for (input, row) in design.inputs.iter().zip(rows(&design.gains.k)) {
        let row: Vec<String> = row.iter().map(|k| format!("{k:?}")).collect();
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
        "joint_names": joint_names(design),
        "states": signals(&design.states),
        "inputs": signals(&design.inputs),
        "x0": design.x0,
        "u0": design.u0,
        "omitted_effects": design.omitted.iter().map(omitted).collect::<Vec<Value>>(),
        "integral": design.integral.as_ref().map(|integral| json!({
            "joints": one_based(&integral.joints),
            "weights": integral.weights,
        })),
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
        "continuous": plant(&design.plant.a, &design.plant.b, &design.plant.c),
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

/// What a robot in space calls its joints, which are numbered elsewhere; null of a planar chain.
fn joint_names(design: &Design) -> Option<Vec<&str>> {
    let joints = 1..=design.plant.a.nrows() / 2;
    joints.map(|joint| design.names.joint(joint)).collect()
}

fn omitted(omitted: &OmittedEffect) -> Value {
    json!({
        "effect": omitted.effect.info().id,
        "joint": omitted.joint.map(|joint| joint + 1),
        "why": omitted.why.to_string(),
    })
}

/// A plant without feedthrough.
fn plant(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>) -> Value {
    let d = DMatrix::zeros(c.nrows(), b.ncols());
    json!({ "a": rows(a), "b": rows(b), "c": rows(c), "d": rows::<f64>(&d) })
}

fn sampled(sampled: &Discrete, delay_s: f64) -> Value {
    let mut value = plant(&sampled.a, &sampled.b, &sampled.c);
    value["ts_s"] = json!(sampled.ts_s);
    value["delay_s"] = json!(delay_s);
    value["delayed_inputs"] = json!(sampled.delayed_inputs);
    value
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
        "recovery": estimation.recovery,
        "stationary": estimation.stationary.as_ref().map(|stationary| json!({
            "state_rms": stationary.state_rms,
            "input_rms": stationary.input_rms,
        })),
    })
}

fn fixed(fixed: &FixedDesign) -> Value {
    let (law, loss) = (&fixed.law, &fixed.loss);
    json!({
        "bits": law.bits,
        "k": rows(&law.k),
        "bias": law.bias,
        "shift": law.shift,
        "limits": law.limits,
        "x0": law.x0,
        "state_step": law.state_step,
        "input_step": law.input_step,
        "state_range": fixed.ranges.state,
        "input_range": fixed.ranges.input,
        "sums": fixed.sums.as_ref().map(|sums| json!({
            "first_state": sums.first + 1,
            "joints": one_based(&sums.joints),
            "shift": sums.shift,
        })),
        "fingerprint": law.fingerprint(),
        "gain_error": loss.gain_error,
        "state_error": loss.state_error,
        "input_error": loss.input_error,
        "margin_bits": loss.margin_bits,
        "spectral_radius": loss.radius,
        "spectral_radius_fixed": loss.radius_fixed,
    })
}

fn one_based(joints: &[usize]) -> Vec<usize> {
    joints.iter().map(|joint| joint + 1).collect()
}

fn signals(signals: &[Signal]) -> Vec<Value> {
    let value = |s: &Signal| json!({ "name": s.name, "unit": s.unit });
    signals.iter().map(value).collect()
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
    for (name, values) in [("x0", &design.x0), ("u0", &design.u0)] {
        put(name, &DMatrix::from_row_slice(1, values.len(), values));
    }
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
