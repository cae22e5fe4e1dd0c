//! Tests on residuals made by hand and on a pendulum integrated here, not by the library.

mod residual_tests;

use super::conditions::{CONDITIONS, ConditionSamples, met};
use super::failure::{failing, ranked};
use super::run::fit_percent;
use super::sample_features::{features, speed_rad_s};
use super::*;
use crate::fitting::{FitProblem, Horizon};
use crate::model::Model;
use crate::motion::{Motion, MotionSource};
use crate::output::number::mrad_in_column;
use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;

const PENDULUM: &str = r#"
[rig]
name = "pendulum"
angle_zero = "hanging"
[[link]]
com_m = 0.2
mass_kg = 0.5
inertia_kg_m2 = 1e-3
[[joint]]
drive = "passive"
[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.01
[log]
time = { column = "t", unit = "s" }
[[log.joint]]
position = { column = "q", unit = "rad", resolution_rad = 1e-4 }
"#;

fn pendulum() -> Model {
    Model::parse(PENDULUM, Path::new("pendulum.toml")).unwrap()
}

fn motion(time_s: Vec<f64>, position_rad: Vec<f64>) -> Motion {
    Motion {
        name: "hand-made".into(),
        source: MotionSource {
            path: "hand-made".into(),
            sha256: String::new(),
            lines: (2, time_s.len() + 1),
        },
        time_s,
        position_rad: vec![position_rad],
        velocity_rad_s: vec![None],
        rate_rad_s: Vec::new(),
        input: vec![None],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
    }
}

/// The pendulum of the model file with this Coulomb friction, released at rest; semi-implicit Euler
/// at 20 us.
fn swing(release_rad: f64, coulomb_nm: f64, samples: usize) -> Motion {
    let (mut angle, mut speed): (f64, f64) = (release_rad, 0.0);
    let inertia = 1e-3 + 0.5 * 0.2 * 0.2;
    let (mut time, mut angles) = (Vec::new(), Vec::new());
    for k in 0..samples {
        time.push(k as f64 * 0.01);
        angles.push((angle / 1e-4).round() * 1e-4);
        for _ in 0..500 {
            let friction = 0.01 * speed + coulomb_nm * (speed / 1e-3).tanh();
            let torque = -0.5 * 9.81 * 0.2 * angle.sin() - friction;
            speed += torque / inertia * 2e-5;
            angle += speed * 2e-5;
        }
    }
    motion(time, angles)
}

/// Noise whose neighbours correlate by `memory`.
fn noise(seed: u64, count: usize, memory: f64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut last = 0.0;
    (0..count)
        .map(|_| {
            let fresh: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
            last = memory * last + fresh;
            last
        })
        .collect()
}

#[test]
fn fit_percent_is_exact() {
    // y = 0 1 2 3 about 1.5: sum of squares 5; errors 0.5 0 0 1: 1.25; 100 (1 - sqrt(0.25)) = 50.
    let fit = |error: &[f64]| fit_percent(&[&[0.0, 1.0], &[2.0, 3.0]], &[error.to_vec()]);
    assert_eq!(fit(&[0.5, 0.0, 0.0, 1.0]), 50.0);
    assert_eq!(fit(&[0.0; 4]), 100.0);
    // Of what does not move there is no share to explain.
    for still in [0.0, 0.1] {
        assert!(fit_percent(&[&[2.0, 2.0]], &[vec![still; 2]]).is_nan());
    }
}

#[test]
fn speed_of_a_parabola_at_uneven_times_is_its_slope() {
    let time: Vec<f64> = (0..100)
        .map(|k| f64::from(k) * 0.005 + f64::from(k % 3) * 1e-3)
        .collect();
    let angle: Vec<f64> = time.iter().map(|t| 3.0 * t).collect();
    for speed in speed_rad_s(&time, &angle) {
        assert!((speed - 3.0).abs() < 1e-9);
    }
}

#[test]
fn an_error_after_reversals_is_named_so() {
    let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 0.005).collect();
    let swing = motion(
        time.clone(),
        time.iter().map(|t| 0.6 * (4.0 * t).sin()).collect(),
    );
    let motions = [swing];
    let model = pendulum();
    // Reversals of sin 4t: at (n + 1/2) pi / 4.
    let since = |t: f64| (t - std::f64::consts::FRAC_PI_8).rem_euclid(std::f64::consts::FRAC_PI_4);
    let error: Vec<f64> = time
        .iter()
        .zip(noise(5, 2000, 0.0))
        .map(|(t, e)| {
            1e-4 * e
                + if since(*t) < 0.07 && *t > 0.3 {
                    5e-3
                } else {
                    0.0
                }
        })
        .collect();
    let all = ranked(
        &error,
        1e-4,
        met(&features(&model, &motions, 0), ("rad", 1.0)),
    );
    assert_eq!(all[0].words, "within 80 ms after a reversal");
    assert!(all[0].error_share > 0.95 && all[0].sample_share < 0.12);
}

#[test]
fn the_same_samples_are_named_once() {
    let error: Vec<f64> = (0..100).map(|k| if k < 20 { 1.0 } else { 0.1 }).collect();
    let first = |words: &str, count: usize| ConditionSamples {
        words: words.into(),
        holds: (0..100).map(|k| k < count).collect(),
    };
    let all = ranked(
        &error,
        0.0,
        vec![
            first("wider", 22),
            first("exact", 20),
            first("half", 10),
            first("few", 4),
            first("all", 100),
        ],
    );
    let words: Vec<&str> = all.iter().map(|r| r.words.as_str()).collect();
    assert_eq!(words, ["exact", "half"]);
}

#[test]
fn a_joint_at_its_floor_has_no_failures() {
    let motions = [swing(0.8, 0.0, 300)];
    let comparison = compare(&pendulum(), "right", &motions, None);
    assert_eq!(comparison.horizon_s, None);
    let signal = &comparison.signals[0];
    assert!(signal.rms < 1e-4, "{}", signal.rms);
    assert!(signal.fit_percent > 99.9);
    assert!(signal.share_above_floor <= 0.1 || signal.rms < 2.0 * signal.floor);
    let signals = [SignalError {
        share_above_floor: 0.05,
        ..signal.clone()
    }];
    let error = vec![vec![noise(1, 300, 0.0)]];
    let data = FitProblem::new(&pendulum(), motions.to_vec(), Horizon::Whole);
    assert!(failing(&pendulum(), &data, &error, &signals).is_empty());
}

#[test]
fn missing_friction_shows_and_grows_with_the_run() {
    let motions = [swing(0.8, 0.02, 500), swing(-0.5, 0.02, 300)];
    let comparison = compare(&pendulum(), "no Coulomb", &motions, Some(Horizon::Whole));
    let signal = &comparison.signals[0];
    assert!(signal.rms > 20.0 * signal.floor, "{}", signal.rms);
    assert!(!signal.tests[0].passed);
    let rungs: Vec<Option<f64>> = comparison.horizons.iter().map(|h| h.horizon_s).collect();
    assert_eq!(rungs, [Some(0.1), Some(0.3), Some(1.0), Some(3.0), None]);
    let errors: Vec<f64> = comparison.horizons.iter().map(|h| h.rms).collect();
    assert!(errors.is_sorted(), "{errors:?}");
    assert_eq!(*errors.last().unwrap(), signal.rms);
    assert_eq!(comparison.traces.len(), 2);
    assert_eq!(comparison.traces[0].time_s.len(), 500);
}

#[test]
fn a_trace_tells_where_the_model_restarts() {
    let motions = [swing(0.8, 0.02, 500), swing(-0.5, 0.02, 300)];
    let horizon = Horizon::Seconds(1.0);
    let data = FitProblem::new(&pendulum(), motions.to_vec(), horizon);
    let cut = compare(&pendulum(), "in windows", &motions, Some(horizon));
    for (motion, trace) in cut.traces.iter().enumerate() {
        let starts = data
            .windows_of(motion)
            .map(|(_, window)| window.samples.start);
        let times: Vec<f64> = starts.map(|start| motions[motion].time_s[start]).collect();
        assert_eq!(trace.restarts_s, times[1..]);
    }
    let counts: Vec<usize> = cut.traces.iter().map(|t| t.restarts_s.len()).collect();
    assert_eq!(counts, [4, 2]);
    let whole = compare(&pendulum(), "whole", &motions, Some(Horizon::Whole));
    assert!(whole.traces.iter().all(|trace| trace.restarts_s.is_empty()));
}

#[test]
fn text_sets_models_side_by_side_and_tells_the_last_in_full() {
    let motions = [swing(0.8, 0.02, 300)];
    let base = compare(&pendulum(), "base", &motions, None);
    let mut better = pendulum();
    better.links[0].inertia_kg_m2 = 1.1e-3;
    let other = compare(&better, "other", &motions, None);
    let all = [base, other];
    let text = text(&all, &crate::model::JointNames::default());
    for part in [
        " base ",
        "rms, mrad",
        "Where other fails",
        "From model to model",
        "\nWhere base fails most\n",
        "whiteness",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let waterfall = waterfall(&all);
    assert_eq!(waterfall.lines().count(), 3);
    assert!(
        waterfall.lines().last().unwrap().starts_with("  floor"),
        "{waterfall}"
    );
    assert!(waterfall.contains(&"#".repeat(40)));
}

#[test]
fn milliradians_bear_three_digits() {
    let shown: Vec<String> = [0.41123, 0.0123456, 0.0016, 0.000443, 0.0]
        .into_iter()
        .map(mrad_in_column)
        .collect();
    assert_eq!(shown, ["411", "12.3", "1.60", "0.443", "0.000"]);
}

#[test]
fn conditions_are_worded_to_end_a_sentence() {
    let mut words: Vec<&str> = CONDITIONS.iter().map(|(words, _)| *words).collect();
    assert!(
        words
            .iter()
            .all(|w| w.starts_with(char::is_lowercase) && !w.ends_with('.'))
    );
    words.sort_unstable();
    words.dedup();
    assert_eq!(words.len(), CONDITIONS.len());
}

#[test]
fn ranges_of_angle_are_told_in_the_unit_of_the_log() {
    let times = (0..41).map(|k| 0.01 * f64::from(k)).collect();
    let angles = (0..41).map(|k| -1.0 + 0.05 * f64::from(k)).collect();
    let features = features(&pendulum(), &[motion(times, angles)], 0);
    let last = |shown| met(&features, shown).pop().unwrap().words;
    assert_eq!(last(("rad", 1.0)), "between 0.67 and 1.00 rad");
    assert_eq!(last(("deg", 1f64.to_degrees())), "between 38 and 57 deg");
}

#[test]
fn no_motion_at_all_is_no_panic() {
    let nothing = compare(&pendulum(), "nothing", &[], None);
    assert_eq!(nothing.signals[0].rms, 0.0);
    assert!(
        text(
            std::slice::from_ref(&nothing),
            &crate::model::JointNames::default()
        )
        .contains("nothing")
    );
    assert_eq!(waterfall(&[nothing]).lines().count(), 2);
    assert!(
        text(&[], &crate::model::JointNames::default()).is_empty() && waterfall(&[]).is_empty()
    );
}

proptest! {
    #[test]
    fn moments_and_conditions_bear_any_short_motion(
        rows in prop::collection::vec((1e-4..0.2f64, -4.0..4.0f64, -1.0..1.0f64, 9.0..12.0f64, any::<bool>()), 1..12),
        gap in any::<bool>(),
    ) {
        let mut time = 0.0;
        let times = rows.iter().map(|row| { time += row.0; time }).collect();
        let mut short = motion(times, rows.iter().map(|row| row.1).collect());
        short.input = vec![Some(rows.iter().map(|row| row.2).collect())];
        short.supply_v = Some(rows.iter().map(|row| row.3).collect());
        short.torque_on = Some(rows.iter().map(|row| row.4).collect());
        if gap {
            short.position_rad[0][0] = f64::NAN;
        }
        let motions = [short.clone(), short];
        let features = features(&pendulum(), &motions, 0);
        prop_assert_eq!(features.len(), 2 * rows.len());
        let error: Vec<f64> = features.iter().map(|m| m.angle_rad).collect();
        for ranked in ranked(&error, 0.0, met(&features, ("rad", 1.0))) {
            prop_assert!((0.0..=1.0 + 1e-12).contains(&ranked.error_share));
            prop_assert!((0.0..=1.0).contains(&ranked.sample_share));
        }
    }
}
