//! The robot behind servos as they are, from many starts, in process.

use super::{Args, Row};
use handstand_measure::bench::{Rig, corners, random_starts};
use handstand_measure::firmware::Built;
use rayon::prelude::*;
use serde_json::json;

pub(super) fn servos(args: &Args, _: Option<&Built>) -> Vec<Row> {
    let one = 1f64.to_radians();
    let starts = random_starts(args.reduced(200, 20), one, args.seed);
    let seconds = if args.quick { 5.0 } else { 10.0 };
    let gyro = |degrees: f64, off| Rig {
        gyro_step_rad_s: Some(degrees.to_radians()),
        gyro_off: off,
        ..Rig::IDEAL
    };
    let blind = Rig {
        lag_s: 0.0,
        ..Rig::REAL
    }
    .plan();
    let long = if args.quick { 5.0 } else { 60.0 };
    vec![
        row(
            "real servos (lag 34 ms, back-EMF, friction, backlash, dead zone 8 %, sag)",
            "95 % of starts within 1 deg",
            Some(0.95),
            stood(&Rig::REAL, &Rig::REAL.plan(), &starts, seconds),
        ),
        row(
            "the same under a plan that believes the torque to come at once",
            "-",
            None,
            stood(&Rig::REAL, &blind, &starts, seconds),
        ),
        row(
            "ideal servos from the corners of 2 deg",
            "8 of 8",
            Some(1.0),
            stood(&Rig::IDEAL, &Rig::IDEAL.plan(), &corners(2.0 * one), long),
        ),
        row(
            "ideal servos, a gyro of 10 deg/s per code alone, its zero off by a code",
            "95 % of starts within 1 deg",
            Some(0.95),
            stood(&gyro(10.0, 1.0), &gyro(10.0, 0.0).plan(), &starts, seconds),
        ),
        row(
            "ideal servos, a gyro of 1 deg/s per code alone, its zero off by 3.4 codes",
            "95 % of starts within 1 deg",
            Some(0.95),
            stood(&gyro(1.0, 3.4), &gyro(1.0, 0.0).plan(), &starts, seconds),
        ),
    ]
}

/// How many of these starts stood for how long, s.
struct Stood {
    count: usize,
    of: usize,
    seconds: f64,
    shortest_s: f64,
}

fn stood(
    rig: &Rig,
    plan: &handstand_shared::plan::Plan,
    starts: &[[f64; 3]],
    seconds: f64,
) -> Stood {
    let times = starts
        .par_iter()
        .map(|start| rig.stands_s(plan, *start, seconds));
    let times: Vec<f64> = times.collect();
    Stood {
        count: times.iter().filter(|time| **time >= seconds).count(),
        of: times.len(),
        seconds,
        shortest_s: times.iter().copied().fold(seconds, f64::min),
    }
}

fn row(name: &'static str, limit: &'static str, least: Option<f64>, stood: Stood) -> Row {
    let share = stood.count as f64 / stood.of.max(1) as f64;
    Row {
        name,
        measured: format!(
            "{} of {} stood {} s, the shortest {:.1} s",
            stood.count, stood.of, stood.seconds, stood.shortest_s
        ),
        limit,
        holds: least.map(|least| share >= least),
        values: json!({
            "stood": stood.count,
            "starts": stood.of,
            "seconds": stood.seconds,
            "shortest_s": stood.shortest_s,
        }),
    }
}
