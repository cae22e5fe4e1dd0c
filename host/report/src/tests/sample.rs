//! A report made by hand, for tests and for looking at.

use crate::compare::{
    ClosedLoopComparison, Comparison, Failure, HorizonError, LoopMotion, LoopSignal, ResidualTest,
    SignalError, Trace,
};
use crate::diagnose::{
    Alternative, BudgetShare, BudgetedPart, Diagnosis, FittedEffect, MotionError,
    ResidualStructure, RuledOut, SearchEnded, Verdict, WrongValue,
};
use crate::fitting::{ErrorReduction, FittedValue};
use crate::model::{JointNames, MeasuredSignal};
use crate::{HashedModel, LogFile, Report, ReportProvenance};

pub(crate) fn report() -> Report {
    let log = |name: &str, held_out| LogFile {
        name: name.into(),
        motions: vec![name.trim_end_matches(".csv").into()],
        sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".into(),
        samples: 6000,
        held_out,
    };
    let model = |name: &str| HashedModel {
        name: name.into(),
        sha256: "2c26b46b68ffc68ff99b453c1d30413413422d706483bfa0f98a5e886266e7ae".into(),
    };
    Report {
        title: "Bench arm, one servo".into(),
        comparisons: vec![
            comparison("ideal.toml", 41.2),
            comparison("refitted.toml", 30.5),
            comparison("named.toml", 6.31),
        ],
        diagnosis: Some(diagnosis()),
        provenance: ReportProvenance {
            program_version: "0.1.0".into(),
            model_files: vec![model("ideal.toml"), model("named.toml")],
            logs: vec![log("swing.csv", false), log("sines.csv", true)],
            command: "handstand diagnose ideal.toml swing.csv sines.csv --html report.html".into(),
        },
        names: JointNames::default(),
    }
}

pub(crate) fn comparison(model: &str, error_mrad: f64) -> Comparison {
    Comparison {
        model: model.into(),
        horizon_s: None,
        windows: Vec::new(),
        unobserved: Vec::new(),
        signals: vec![signal(error_mrad)],
        horizons: [(Some(0.1), 0.3), (Some(0.5), 0.6), (None, 1.0)]
            .map(|(horizon_s, share)| HorizonError {
                horizon_s,
                quantity: MeasuredSignal::Angle,
                rms: share * 1e-3 * error_mrad,
            })
            .into(),
        failures: failures(error_mrad),
        traces: vec![trace("swing", error_mrad), trace("sines", error_mrad)],
        closed_loop: None,
    }
}

/// A loop of a model that falls.
pub(crate) fn closed_loop(error_mrad: f64) -> ClosedLoopComparison {
    let signals = vec![LoopSignal {
        joint: 1,
        rms_error_rad: 1e-3 * error_mrad,
        measured_rms_rad: 12e-3,
        simulated_rms_rad: 8e-3,
        measured_limit_cycle_rad: Some(40e-3),
        simulated_limit_cycle_rad: None,
    }];
    ClosedLoopComparison {
        motions: vec![LoopMotion {
            motion: "swing".into(),
            duration_s: 5.0,
            measured_fell_s: None,
            simulated_fell_s: Some(1.5),
            signals: signals.clone(),
        }],
        signals,
    }
}

fn signal(error_mrad: f64) -> SignalError {
    SignalError {
        joint: 1,
        quantity: MeasuredSignal::Angle,
        beside_angle: false,
        rms: 1e-3 * error_mrad,
        largest: 3e-3 * error_mrad,
        fit_percent: 100.0 - error_mrad / 3.0,
        floor: 5.1e-3,
        share_above_floor: 0.9,
        tests: vec![
            ResidualTest {
                name: "whiteness (Ljung-Box)",
                statistic: 41.0 * error_mrad,
                threshold: 37.6,
                passed: false,
                meaning: "neighbouring residuals resemble each other: something regular is left"
                    .into(),
            },
            ResidualTest {
                name: "independence of the input",
                statistic: 1.9,
                threshold: 2.58,
                passed: true,
                meaning: "no trace of the input is left in the residual".into(),
            },
        ],
    }
}

fn failures(error_mrad: f64) -> Vec<Failure> {
    let failure = |condition: &str, error_share, sample_share, sentence: &str| Failure {
        joint: 1,
        condition: condition.into(),
        error_share,
        sample_share,
        sentence: sentence.into(),
    };
    if error_mrad < 10.0 {
        return Vec::new();
    }
    vec![
        failure(
            "within 80 ms after a reversal",
            0.62,
            0.11,
            "62 % of the squared error lies within 80 ms after a reversal, which covers 11 % of the \
             samples.",
        ),
        failure(
            "slower than 0.2 rad/s",
            0.48,
            0.16,
            "48 % of the squared error lies where the joint is slower than 0.2 rad/s, 16 % of the \
             samples.",
        ),
    ]
}

fn trace(motion: &str, error_mrad: f64) -> Trace {
    let time_s: Vec<f64> = (0..6000).map(|index| f64::from(index) * 2e-3).collect();
    let pitch = if motion == "swing" { 1.0 } else { 2.3 };
    let truth = |t: f64| 0.7 * (3.0 * pitch * t).sin() * (-0.12 * t).exp() + 0.1 * (1.1 * t).cos();
    // A sensor of 5 mrad with a jitter that looks random enough.
    let jitter = |t: f64| 2e-3 * (9177.0 * t * t).sin();
    let reading = |t: f64| ((truth(t) + jitter(t)) / 5.1e-3).round() * 5.1e-3;
    let wrong = |t: f64| {
        truth(t) + 1.4e-3 * error_mrad * (3.0 * pitch * t).cos().signum() * (0.2 * t).sin()
    };
    Trace {
        motion: motion.into(),
        joint: 1,
        quantity: MeasuredSignal::Angle,
        rms: 1e-3 * error_mrad,
        restarts_s: Vec::new(),
        measured: time_s.iter().map(|t| reading(*t)).collect(),
        predicted: time_s.iter().map(|t| wrong(*t)).collect(),
        time_s,
    }
}

fn fitted(path: &str, unit: &str, [value, low, high]: [f64; 3]) -> FittedValue {
    FittedValue {
        path: path.into(),
        key: path.rsplit('.').next().unwrap_or(path).into(),
        unit: unit.into(),
        value,
        low,
        high,
        on_bound: false,
    }
}

fn effect(kind: &str, title: &str, parameters: Vec<FittedValue>) -> FittedEffect {
    FittedEffect {
        kind: kind.into(),
        title: title.into(),
        joint: Some(1),
        parameters,
    }
}

pub(crate) fn diagnosis() -> Diagnosis {
    let coulomb = fitted("coulomb@1.torque_nm", "N m", [0.0821, 0.0794, 0.0851]);
    let mut dead_zone = fitted("dead_zone@1.width", "1", [0.031, 0.02, 0.05]);
    dead_zone.on_bound = true;
    let delay = fitted("delay@1.delay_s", "s", [0.0081, -0.0012, 0.0174]);
    Diagnosis {
        verdict: Verdict::Named,
        effects: vec![
            effect("coulomb", "Coulomb friction", vec![coulomb]),
            effect(
                "backlash",
                "Backlash",
                vec![FittedValue {
                    on_bound: true,
                    ..fitted("backlash@1.gap_rad", "rad", [0.012, 0.009, 0.0152])
                }],
            ),
        ],
        wrong_values: vec![WrongValue {
            given: 1.2,
            free: false,
            within_uncertainty: false,
            fitted: fitted("motor.torque_nm", "N m", [1.47, 1.44, 1.5]),
        }],
        error: ErrorReduction {
            quantity: MeasuredSignal::Angle,
            before_rad: 41.2e-3,
            refitted_rad: Some(30.7e-3),
            after_rad: 6.31e-3,
            floor_rad: 5.1e-3,
            floor_interval_rad: Some([5.0e-3, 5.2e-3]),
            held_out: true,
            reduction: Some([0.81, 0.88]),
        },
        budget: vec![BudgetedPart {
            part: "coulomb@1".to_owned(),
            alone: share(0.9, 5e-3),
            beyond_others: share(0.85, 36e-3),
        }],
        alternatives: vec![Alternative {
            effects: vec![effect("dead_zone", "Dead zone", vec![dead_zone])],
            wrong_values: Vec::new(),
            error_rad: 6.5e-3,
            same_law: false,
        }],
        base: vec![fitted("motor.torque_nm", "N m", [1.47, 1.44, 1.5]), delay],
        ruled_out: ruled_out(),
        residual_structure: Some(ResidualStructure {
            explainable_share: 0.07,
            explainable_low: 0.0,
            shape: "speed of joint 1".into(),
        }),
        motions: [("swing", false, 38.0, 6.0), ("sines", true, 41.2, 6.31)]
            .map(|(motion, held_out, before, after)| MotionError {
                motion: motion.into(),
                held_out,
                before_rad: 1e-3 * before,
                after_rad: 1e-3 * after,
            })
            .into(),
        folds: Vec::new(),
        collinear: vec![("coulomb@1.torque_nm".into(), "motor.torque_nm".into(), 0.97)],
        summary: vec![
            "Joint 1 resists with about 0.082 N m at every speed, which the model leaves out."
                .into(),
            "With it the error on held-out motions falls from 41.2 to 6.31 mrad; the floor is 5.1 \
             mrad."
                .into(),
        ],
        next: vec!["Add the effect: handstand add coulomb@1 --torque_nm 0.0821.".into()],
        warnings: vec!["backlash@1.gap_rad lies on its bound.".into()],
        search_horizon_s: Some(1.0),
        horizon_s: None,
        shorter_step_s: None,
        windows: Vec::new(),
        search_ended: SearchEnded::Complete,
        left_out: Vec::new(),
        shows_alone: Vec::new(),
    }
}

fn ruled_out() -> Vec<RuledOut> {
    let tried = |set: &[&str], training, held_out: Option<f64>, bic_change, why: &str| RuledOut {
        set: set.iter().map(ToString::to_string).collect(),
        training_error_rad: 1e-3 * training,
        held_out_error_rad: held_out.map(|error| 1e-3 * error),
        bic_change,
        as_good: why.starts_with("gains nothing over"),
        why: why.into(),
    };
    vec![
        tried(
            &["viscous@1"],
            17.2,
            Some(19.8),
            -2140.0,
            "leaves the jump at reversals",
        ),
        tried(
            &["coulomb@1", "stribeck@1"],
            5.9,
            Some(6.33),
            -9870.0,
            "gains nothing over Coulomb friction alone",
        ),
        tried(
            &["cable_spring@1"],
            33.0,
            None,
            -310.0,
            "gains little on the motions of the fit",
        ),
        tried(
            &["base_tilt"],
            37.9,
            None,
            4.2,
            "gains no more than chance would",
        ),
    ]
}

fn share(share: f64, error_rad: f64) -> BudgetShare {
    BudgetShare {
        error_rad,
        share,
        low: share - 0.05,
        high: share + 0.05,
    }
}
