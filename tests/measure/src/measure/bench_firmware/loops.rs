//! The robot in closed loop, the laws side by side.

use super::{Args, Row};
use handstand::deploy::mode_limits;
use handstand_measure::bench::{
    Balanced, Conditions, Fixed, Float, HostLaw, Sides, Source, VirtualCm5, balance_by_host,
    corners, model, side_by_side,
};
use handstand_measure::firmware::Built;
use rayon::prelude::*;
use serde_json::json;

/// A start with all angles this far off, with these signs.
fn corner(degrees: f64, signs: [f64; 3]) -> Conditions {
    Conditions {
        dead_zone: 0.08,
        eccentric_m: [0.0; 3],
        start_rad: signs.map(|sign| sign * degrees.to_radians()),
    }
}

pub(super) fn loops(args: &Args, built: Option<&Built>) -> Vec<Row> {
    // The corners of a cube of starts; the first and the last take the longest way back.
    let starts = [
        ("2, 2, 2 deg", corner(2.0, [1.0, 1.0, 1.0])),
        ("2, -2, 2 deg", corner(2.0, [1.0, -1.0, 1.0])),
        ("2, 2, -2 deg", corner(2.0, [1.0, 1.0, -1.0])),
        ("2, -2, -2 deg", corner(2.0, [1.0, -1.0, -1.0])),
        ("-2, 2, 2 deg", corner(2.0, [-1.0, 1.0, 1.0])),
        ("-2, -2, 2 deg", corner(2.0, [-1.0, -1.0, 1.0])),
        ("-2, 2, -2 deg", corner(2.0, [-1.0, 1.0, -1.0])),
        ("-2, -2, -2 deg", corner(2.0, [-1.0, -1.0, -1.0])),
    ];
    let seconds = if args.quick { 5.0 } else { 60.0 };
    let of_start = |(start, conditions): &(&str, Conditions)| {
        let sides = loop_sides(built, conditions, Source::Host, seconds);
        let mut rows = loop_rows(LOOP_NAMES, start, &sides, seconds);
        let (different, compared) = sides.different;
        rows.push(Row {
            name: "its commands against the fixed host law's on the same readings",
            measured: format!("{compared} ticks, {different} different"),
            limit: "0",
            holds: Some(different == 0 && compared > 0),
            values: json!({"ticks": compared, "different": different}),
        });
        rows
    };
    starts.par_iter().flat_map_iter(of_start).collect()
}

/// With nothing but a gyro of 10 deg/s per code for the first link.
pub(super) fn gyros(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let starts = [
        ("upright", corner(0.0, [1.0, 1.0, 1.0])),
        ("0.5, 0.5, 0.5 deg", corner(0.5, [1.0, 1.0, 1.0])),
        ("1, 1, 1 deg", corner(1.0, [1.0, 1.0, 1.0])),
    ];
    let seconds = if args.quick { 5.0 } else { 60.0 };
    let of_start = |(start, conditions): &(&str, Conditions)| {
        let sides = loop_sides(built, conditions, Source::Gyro, seconds);
        loop_rows(GYRO_NAMES, start, &sides, seconds)
    };
    let mut rows: Vec<Row> = starts.par_iter().flat_map_iter(of_start).collect();
    rows.push(gyro_corners(seconds));
    rows.push(gyro_limit());
    rows
}

/// From how many corners of 1 deg the host's laws stand by the gyro.
fn gyro_corners(seconds: f64) -> Row {
    let (machine, plan) = Source::Gyro.plan();
    let starts = corners(1f64.to_radians());
    let stands = |is_float: bool, start_rad: [f64; 3]| {
        let conditions = Conditions {
            start_rad,
            ..corner(1.0, [1.0; 3])
        };
        let (mut float, mut fixed) = (Float::new(&plan, &machine), Fixed::new(&plan));
        let law: &mut dyn HostLaw = if is_float { &mut float } else { &mut fixed };
        let timing = Source::Gyro.timing();
        let run = balance_by_host(law, &conditions, &timing, Source::Gyro, seconds);
        run.stood_s >= seconds - 1e-6
    };
    let count = |is_float| {
        let stood = starts.iter().filter(|start| stands(is_float, **start));
        stood.count()
    };
    let (float, fixed) = (count(true), count(false));
    let of = starts.len();
    Row {
        name: "gyro alone, host laws from the corners of 1 deg",
        measured: format!("float {float}, fixed {fixed} of {of} stood {seconds} s"),
        limit: "-",
        holds: None,
        values: json!({"float": float, "fixed": fixed, "starts": of, "seconds": seconds}),
    }
}

/// What the torque limit leaves, computed for the slowest unstable mode, which it limits most.
fn gyro_limit() -> Row {
    let limits = mode_limits(&model(), &Source::Gyro.board(), &Source::Gyro.timing());
    let limits = limits.expect("the repository's own model");
    let slowest = limits.last().expect("an upright robot is unstable");
    let (start, step) = (slowest.degree_share, slowest.half_step_share);
    Row {
        name: "gyro alone, share of the recoverable states in the slowest mode, computed",
        measured: format!(
            "pole {:.1} /s: 1 deg in the worst corner {:.1} %, half a step of every sensor, grown \
             {:.2}-fold until an answer acts, {:.1} %",
            slowest.pole_per_s,
            100.0 * start,
            slowest.growth,
            100.0 * step
        ),
        limit: "100 %: above, no law recovers",
        holds: Some(start + step < 1.0),
        values: json!({
            "pole_per_s": slowest.pole_per_s,
            "degree_share": start,
            "half_step_share": step,
            "growth": slowest.growth,
        }),
    }
}

const LOOP_NAMES: [&str; 3] = [
    "three links, float host law",
    "three links, fixed host law",
    "three links, the firmware's law",
];

const GYRO_NAMES: [&str; 3] = [
    "gyro alone, float host law",
    "gyro alone, fixed host law",
    "gyro alone, the firmware's law",
];

fn loop_sides(
    built: Option<&Built>,
    conditions: &Conditions,
    source: Source,
    seconds: f64,
) -> Sides {
    #[cfg(simavr)]
    if let Some(built) = built {
        let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        return side_by_side(&mut rig, conditions, source, seconds);
    }
    let _ = built;
    side_by_side(&mut VirtualCm5::new(), conditions, source, seconds)
}

fn loop_rows(names: [&'static str; 3], start: &str, sides: &Sides, seconds: f64) -> Vec<Row> {
    let row = |name, run: Result<&Balanced, String>| {
        let stood_s = run.as_ref().map_or(0.0, |run| run.stood_s);
        let values = run.as_ref().map_or(json!({}), |run| {
            json!({"start": start, "stood_s": run.stood_s, "rms_rad": run.rms_rad, "rms_nm": run.torque_rms_nm})
        });
        let measured = match run {
            Ok(run) => format!(
                "from {start}: stood {stood_s:.1} of {seconds} s, {:.1} mrad, {:.3} and {:.3} N m rms",
                1e3 * run.rms_rad,
                run.torque_rms_nm[0],
                run.torque_rms_nm[1]
            ),
            Err(refusal) => refusal,
        };
        Row {
            name,
            measured,
            limit: "stands",
            holds: Some(stood_s >= seconds - 1e-6),
            values,
        }
    };
    let [float, fixed, firmware] = names;
    let board = sides.board.as_ref();
    vec![
        row(float, Ok(&sides.float)),
        row(fixed, Ok(&sides.fixed)),
        row(
            firmware,
            board.map_err(|refusal| format!("refused: {refusal:?}")),
        ),
    ]
}

/// What the firmware says of itself while it balances, whatever the moment of the servos'
/// interrupts.
#[cfg(simavr)]
pub(super) fn balancing(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand_measure::bench::balance;
    let Some(built) = built else {
        return Vec::new();
    };
    let starts = args.reduced(10, 3) as u64;
    let (_, plan) = Source::Host.plan();
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        rig.bus_ahead_ns = start * 1_000_000 / starts;
        let run = balance(&mut rig, &plan, &corner(1.0, [1.0, -1.0, 1.0]), 2.0).expect("it arms");
        run.telemetry.expect("it was asked for")
    };
    let runs: Vec<_> = (0..starts).into_par_iter().map(of_start).collect();
    let ticks = runs.iter().map(|run| run.longest_tick_us);
    let (least, longest) = (ticks.clone().min(), ticks.max());
    let (least, longest) = (least.unwrap_or(0), longest.unwrap_or(0));
    let law = runs.iter().map(|run| run.longest_law_us).max().unwrap_or(0);
    let overruns: u16 = runs.iter().map(|run| run.overruns).sum();
    let share = f64::from(longest) / 10_000.0;
    let deepest = runs.iter().max_by_key(|run| run.stack_used);
    let mut rows = vec![Row {
        name: "longest tick while balancing, waiting for the bus included",
        measured: format!(
            "{least} to {longest} us in {starts} starts, {:.1} % of the period, the law {law} us, {overruns} overruns",
            100.0 * share
        ),
        limit: "6 ms, 60 % of the period",
        holds: Some(longest <= handstand_measure::bench::LONGEST_TICK_US && overruns == 0),
        values: json!({"longest_tick_us": longest, "longest_law_us": law, "overruns": overruns, "starts": starts}),
    }];
    rows.extend(
        deepest.map(|run| super::streams::stack_row("deepest stack while balancing, and RAM", run)),
    );
    rows
}

#[cfg(not(simavr))]
pub(super) fn balancing(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: ticks and stack are the ELF's, and simavr is not installed");
    Vec::new()
}
