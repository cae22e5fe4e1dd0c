//! Every law of the library against the truth of the challenges, which states it a second time with
//! another integrator: the true model must predict the logs to their noise.

use crate::common::Bench;
use handstand::Model;
use handstand::challenge::{KINDS, Motions, bench};
use handstand::compare::compare;
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, read};
use rayon::prelude::*;

/// How long the model runs freely. A joint that sticks and slips forgets where it began: over a
/// whole motion noise decides when it lets go.
fn horizon(kind: &str) -> Horizon {
    match kind {
        "stribeck" => Horizon::Seconds(1.0),
        _ => Horizon::Whole,
    }
}

/// Worst error of the true model over a rig's motions, in shares of the readings' noise.
fn error_over_floor(rig: Motions, kind: &'static str, horizon: Horizon) -> f64 {
    let files = Bench::new();
    let bench = bench(rig, 2, &[kind]).unwrap();
    files.put("true.toml", &bench.true_model_toml);
    let model = Model::load(&files.path("true.toml")).unwrap();
    let error = |log: &handstand::challenge::BenchLog| {
        files.put(&log.name, &log.csv);
        let motions = read(&[LogRequest::whole(files.path(&log.name))], &model.log).unwrap();
        let compared = compare(&model, "true.toml", &motions, Some(horizon));
        let of_floor = compared
            .signals
            .iter()
            .map(|signal| signal.rms / signal.floor);
        of_floor.fold(0.0, f64::max)
    };
    bench.logs.iter().map(error).fold(0.0, f64::max)
}

#[test]
fn the_true_model_predicts_the_truth_of_every_kind() {
    let off: Vec<(&str, f64)> = KINDS
        .par_iter()
        .map(|kind| (*kind, error_over_floor(Motions::Arm, kind, horizon(kind))))
        .filter(|(_, error)| *error > 1.3)
        .collect();
    assert!(off.is_empty(), "{off:?}");
}

/// Kinds, each with what the true model may leave, in shares of the readings' noise.
type Bounds<'a> = &'a [(&'static str, f64)];

fn assert_within(rig: Motions, horizon: Horizon, bounds: Bounds) {
    let over_floor = bounds
        .par_iter()
        .map(|&(kind, most)| (kind, error_over_floor(rig, kind, horizon), most));
    let off: Vec<_> = over_floor.filter(|(_, error, most)| error > most).collect();
    assert!(off.is_empty(), "{off:?}");
}

/// What is remembered must follow the motion from the last sample of a window to the first of the
/// next: a motor that stands still for that sample is degrees off. Nor may a window begin at a
/// knock, where no speed can be read off.
#[test]
fn windows_begin_with_what_was_remembered() {
    let bounds: Bounds = &[
        ("backlash", 1.3),
        ("slew_limit", 1.3),
        ("pre_sliding", 1.3),
        ("gear_compliance", 1.3),
        ("gear_backlash", 1.3),
        ("base_compliance", 1.3),
        ("grip_slip", 2.0),
        ("time_offset", 1.3),
    ];
    assert_within(Motions::Arm, Horizon::Seconds(0.5), bounds);
}

/// What moves beside the links, or reads them, at three links on a bar, whose motion forgets where
/// it began.
#[test]
fn the_true_model_predicts_the_robot() {
    let bounds: Bounds = &[
        ("gear_compliance", 1.5),
        ("gear_backlash", 2.6),
        ("base_compliance", 1.5),
        ("grip_slip", 6.0),
        ("time_offset", 1.5),
    ];
    assert_within(Motions::Hanging, Horizon::Seconds(1.0), bounds);
}
