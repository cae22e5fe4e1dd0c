use super::{DesignMargins, LoopMargin, Margins, OpenLoop, design_margins};
use crate::model::Model;
use crate::synth::{CostWeights, Design, Request, Sensors, Time, Weight};
use nalgebra::DMatrix;
use serde_json::Value;
use std::path::Path;

/// What python-control finds, by `tests/peers/margins.py`.
const REFERENCE: &str = include_str!("../../../../tests/data/margins.json");

fn matrix(value: &Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = serde_json::from_value(value.clone()).unwrap();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// Each loop with its margins and the reference.
fn all() -> Vec<(Margins, Value)> {
    let reference: Value = serde_json::from_str(REFERENCE).unwrap();
    let of = |value: &Value| {
        let open = OpenLoop {
            a: matrix(&value["a"]),
            b: matrix(&value["b"]),
            c: matrix(&value["k"]),
            ts_s: reference["ts_s"].as_f64(),
        };
        (open.margins().unwrap().unwrap(), value.clone())
    };
    reference["loops"]
        .as_array()
        .unwrap()
        .iter()
        .map(of)
        .collect()
}

/// A number, or none where the reference has null.
fn agrees(found: Option<f64>, reference: &Value, what: &str) {
    match (found.filter(|found| found.is_finite()), reference.as_f64()) {
        (None, None) => {}
        (Some(found), Some(reference)) => assert!(
            (found - reference).abs() <= 1e-6 * reference.abs(),
            "{what}: {found} {reference}"
        ),
        (found, _) => panic!("{what}: {found:?} {reference}"),
    }
}

fn agree(found: &LoopMargin, reference: &Value, what: &str) {
    agrees(Some(found.gain[0]), &reference["gain"][0], what);
    agrees(Some(found.gain[1]), &reference["gain"][1], what);
    agrees(found.phase_rad, &reference["phase_rad"], what);
    agrees(found.delay_s, &reference["delay_s"], what);
}

#[test]
fn they_are_those_of_python_control() {
    let all = all();
    assert_eq!(all.len(), 20);
    for (at, (found, reference)) in all.iter().enumerate() {
        agree(
            &found.common,
            &reference["common"],
            &format!("{at}, common"),
        );
        for (i, single) in found.single.iter().enumerate() {
            agree(single, &reference["single"][i], &format!("{at}, {i}"));
        }
        let peak = |name: &str| reference[name].as_f64().unwrap();
        for (found, reference, most) in [
            (found.disk.alpha, peak("disk"), 1e-4),
            (found.sensitivity.value, peak("sensitivity"), 1e-6),
            (found.complementary.value, peak("complementary"), 1e-6),
        ] {
            assert!(
                (found / reference - 1.0).abs() < most,
                "{at}: {found} {reference}"
            );
        }
    }
}

/// K/(s(s + 1)) with K = 1: crosses |L| = 1 at w^2 = (sqrt(5) - 1)/2.
#[test]
fn in_continuous_time_they_are_those_of_a_formula() {
    let open = OpenLoop {
        a: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, -1.0]),
        b: DMatrix::from_row_slice(2, 1, &[0.0, 1.0]),
        c: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
        ts_s: None,
    };
    let found = open.margins().unwrap().unwrap();
    let crossing = ((5f64.sqrt() - 1.0) / 2.0).sqrt();
    let phase = (1.0 / crossing).atan();
    let common = found.common;
    assert!(
        (common.phase_rad.unwrap() - phase).abs() < 1e-9,
        "{common:?}"
    );
    assert!((common.delay_s.unwrap() - phase / crossing).abs() < 1e-9);
    assert_eq!(common.gain[1], f64::INFINITY);
    assert!(common.gain[0] < 1e-6, "{common:?}");
}

/// The corners of the gains that the disk margin allows all channels at once.
#[test]
fn no_change_within_the_disk_loses_the_loop() {
    for (at, (found, reference)) in all().iter().enumerate() {
        let (a, b, k) = (
            matrix(&reference["a"]),
            matrix(&reference["b"]),
            matrix(&reference["k"]),
        );
        let channels = b.ncols();
        let gain = found.disk.gain();
        for corner in 0..1 << channels {
            let factor = |i: usize| {
                let share: f64 = if corner >> i & 1 == 1 { 1.0 } else { -1.0 };
                (0.999 * share * gain.ln()).exp()
            };
            let changed = DMatrix::from_fn(channels, k.ncols(), |i, j| factor(i) * k[(i, j)]);
            let open = OpenLoop {
                a: a.clone(),
                b: b.clone(),
                c: changed,
                ts_s: Some(0.01),
            };
            assert!(open.is_stable(1.0).unwrap(), "loop {at}, corner {corner}");
        }
    }
}

#[test]
fn a_loop_that_is_not_stable_has_none() {
    let open = OpenLoop {
        a: DMatrix::from_element(1, 1, 1.2),
        b: DMatrix::from_element(1, 1, 1.0),
        c: DMatrix::from_element(1, 1, 0.1),
        ts_s: Some(0.01),
    };
    assert_eq!(open.margins().unwrap(), None);
}

fn of_the_paper_s_robot(change: impl Fn(&mut Request)) -> DesignMargins {
    let text = include_str!("../../../../models/handstand.toml");
    let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
    let mut request = Request {
        weights: CostWeights::PAPER,
        ..Request::standard(&model)
    };
    change(&mut request);
    let design = Design::of(&model, &request).unwrap();
    design_margins(&model, &design).unwrap().unwrap()
}

fn near(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} {expected}");
}

/// Figures of an independent computation; `handstand study sweep supply` flips at 7.75 to 7.78 V.
#[test]
fn the_paper_s_weights_are_fragile_and_others_are_not() {
    let paper = of_the_paper_s_robot(|_| {});
    near(paper.inputs.common.gain[0], 0.7938829160, 1e-9);
    near(paper.inputs.common.gain[1], 1.8845609175, 1e-9);
    near(paper.supply.unwrap().lowest_v, 7.78, 0.005);
    // The plant sampled with the later input, by matrix exponentials and bisection.
    near(paper.inputs.common.delay_s.unwrap(), 0.008790450805, 1e-9);
    near(paper.inputs.disk.alpha, 0.22981, 1e-4);
    near(paper.inputs.disk.gain_db(), 2.005, 1e-3);
    near(paper.inputs.disk.phase_rad().to_degrees(), 13.11, 0.01);

    let spared = of_the_paper_s_robot(|request| {
        let q = Weight::Diagonal(vec![1.0, 1.0, 1.0, 0.01, 0.01, 0.01]);
        let r = Weight::Scalar(1.0);
        request.weights = CostWeights::Given { q, r };
    });
    near(spared.inputs.common.gain[0], 0.496, 5e-4);
    near(spared.inputs.common.gain[1], 2.67, 5e-3);
    near(spared.inputs.disk.alpha, 0.67, 5e-3);
    near(spared.inputs.disk.phase_rad().to_degrees(), 37.0, 0.5);
}

/// The past inputs of the law are those that it asked for, whatever became of them.
#[test]
fn a_compensated_delay_narrows_the_gains() {
    let late = of_the_paper_s_robot(|request| {
        request.time = Time::Sampled {
            ts_s: 0.01,
            delay_s: Some(0.01),
        };
    });
    near(late.inputs.common.gain[0], 0.8874153869, 1e-9);
    near(late.inputs.common.gain[1], 1.3113741753, 1e-9);
    let supply = late.supply.unwrap();
    near(supply.lowest_v, 8.70, 0.01);
    near(supply.highest_v, 12.85, 0.01);
    let common = late.inputs.common.delay_s.unwrap();
    assert!(common > 1e-4 && common < 0.01, "{common}");
}

#[test]
fn a_filter_costs_margin() {
    let filtered = of_the_paper_s_robot(|request| {
        request.sensors = Some(Sensors {
            position_step_rad: 300f64.to_radians() / 1024.0,
            gyro_step_rad_s: 10f64.to_radians(),
            process: None,
            recovery: 0.0,
        });
    });
    near(filtered.inputs.common.gain[0], 0.865, 5e-4);
    near(filtered.inputs.common.gain[1], 1.20, 5e-3);
    // A loop broken in all channels is lost at the same common gain wherever it is broken.
    let sensors = filtered.sensors.unwrap();
    near(sensors.common.gain[0], filtered.inputs.common.gain[0], 1e-6);
    near(sensors.common.gain[1], filtered.inputs.common.gain[1], 1e-6);
    assert_eq!(sensors.single.len(), 4);
}
