//! The handstand's figures: 12, 13 and 14, from our own closed loop.

use super::case::{
    ECCENTRIC_RAD, RunCurves, SECONDS, STARTS, continuous, outcomes, sampled, stepped,
    with_dead_zone, with_gyro,
};
use super::figure::{Holds, PaperFigure};
use crate::error::Result;
use crate::output::number::short;
use crate::plot::{Chart, Curve, Tone};
use crate::sim::closed_loop::{Outcome, Velocity};
use crate::study::{Case, bisect};

/// Constant torque that disturbs the arms, N m.
const DISTURBANCE_NM: f64 = 0.01;
/// Lean of the arms a run begins with, rad.
const LEAN_RAD: f64 = 1.0 * std::f64::consts::PI / 180.0;

/// Figures 12, 13, 14.
pub(super) fn figures() -> Result<Vec<PaperFigure>> {
    Ok(vec![
        eccentric_masses()?,
        resolution()?,
        gyro()?,
        dead_zone()?,
    ])
}

fn end(outcome: &Outcome) -> String {
    match (outcome.fell_s, outcome.limit_cycle_rad) {
        (Some(fell), _) => format!("falls after {fell:.2} s"),
        (None, Some(cycle)) if cycle > 1e-3 => {
            format!("stands, swinging by {} deg", short(cycle.to_degrees()))
        }
        _ => "stands still".to_string(),
    }
}

/// Angles above, torques below, of runs side by side; of one run, side by side.
fn charts(runs: &[(&str, &RunCurves)]) -> Vec<Chart> {
    let angles = |(name, seen): &(&str, &RunCurves)| {
        let title = format!("{name}: {}", end(&seen.outcome));
        Chart::new(title, "time, s", "angle, deg", joints(0, &seen.angles))
    };
    let torques = |(name, seen): &(&str, &RunCurves)| {
        let title = format!("{name}: {} N m RMS", short(seen.outcome.rms_torque_nm));
        Chart::new(title, "time, s", "torque, N m", joints(1, &seen.torques))
    };
    let angles = runs.iter().map(angles);
    angles.chain(runs.iter().map(torques)).collect()
}

/// A curve for each joint from the `first` on.
fn joints(first: usize, points: &[Vec<(f64, f64)>]) -> Vec<Curve> {
    let looks = [
        ("q1 arms", Tone::Blue),
        ("q2 shoulder", Tone::Orange),
        ("q3 hip", Tone::Green),
    ];
    let curve = |((name, tone), points): (_, &Vec<_>)| Curve::line(name, tone, points.clone());
    looks
        .into_iter()
        .skip(first)
        .zip(points)
        .map(curve)
        .collect()
}

fn eccentric_masses() -> Result<PaperFigure> {
    let run =
        |eccentric_rad: f64, known: bool| RunCurves::upright(&continuous(eccentric_rad, known)?);
    let (without, with) = (run(ECCENTRIC_RAD, false)?, run(ECCENTRIC_RAD, true)?);
    let falls = |angle: f64| Ok(run(angle, false)?.outcome.fell_s.is_some());
    let limit = edge(falls, 0.0, ECCENTRIC_RAD)?;
    let below = run(0.5 * limit, false)?.outcome;
    let holds = without.outcome.fell_s.is_some() && with.outcome.fell_s.is_none();
    Ok(PaperFigure {
        number: "12",
        title: "LQR without and with angle compensation",
        claim: "LQR does not stabilise the robot whose centres of mass are eccentric; with angle \
                compensation it does",
        holds: Holds::when(holds),
        sentence: format!(
            "Upright, with every centre of mass {:.0} deg off its link's line, the robot {} \
             without compensation and {} with it; without, it falls from {:.1} deg on, and at half \
             of that leans by up to {} deg.",
            ECCENTRIC_RAD.to_degrees(),
            end(&without.outcome),
            end(&with.outcome),
            limit.to_degrees(),
            short(below.largest_rad.to_degrees())
        ),
        charts: charts(&[("without", &without), ("with", &with)]),
    })
}

/// Where `fails` turns true between `low` (false) and `high` (true), to a thousandth of the span;
/// `high` if it never does.
pub(super) fn edge(fails: impl Fn(f64) -> Result<bool>, low: f64, high: f64) -> Result<f64> {
    if fails(high)? {
        Ok(bisect(low, high, 10, |value| Ok(!fails(value)?))?.1)
    } else {
        Ok(high)
    }
}

fn resolution() -> Result<PaperFigure> {
    let run = |case: &Case| RunCurves::leaning(case, LEAN_RAD);
    let exact = run(&sampled()?)?;
    let coarse = run(&stepped()?)?;
    let continuous = run(&continuous(0.1 * ECCENTRIC_RAD, true)?)?;
    let mut differenced = stepped()?;
    differenced.sensor.velocity = Velocity::Difference;
    let differenced = run(&differenced)?.outcome;
    let stand = exact.outcome.fell_s.is_none() && coarse.outcome.fell_s.is_none();
    let cycle_rad = coarse.outcome.limit_cycle_rad;
    let chatters = cycle_rad.is_some_and(|cycle| cycle > 1e-3);
    let holds = stand && chatters && exact.peak_nm() < continuous.peak_nm();
    Ok(PaperFigure {
        number: "13",
        title: "DLQR at 0.01 s, and with the servos' position resolution",
        claim: "sampled at 0.01 s with compensation the loop is stable and its torque smaller than \
                in continuous time; with 300 deg / 2^10 it chatters and stays up",
        holds: Holds::when(holds),
        sentence: format!(
            "From a lean of 1 deg the sampled loop {} and asks for {} N m at most (continuous: \
             {}); with the position steps it {} with {} N m RMS instead of {}. If speeds too are \
             differences of those steps, it {} with {}.",
            end(&exact.outcome),
            short(exact.peak_nm()),
            short(continuous.peak_nm()),
            end(&coarse.outcome),
            short(coarse.outcome.rms_torque_nm),
            short(exact.outcome.rms_torque_nm),
            end(&differenced),
            short(differenced.rms_torque_nm)
        ),
        charts: charts(&[("exact", &exact), ("300 deg / 2^10", &coarse)]),
    })
}

/// Runs that stood, and the median swing of those.
fn tally(outcomes: &[Outcome]) -> (usize, f64) {
    let mut swings: Vec<f64> = outcomes.iter().filter_map(|o| o.limit_cycle_rad).collect();
    swings.sort_by(f64::total_cmp);
    let median = swings.get(swings.len() / 2).copied().unwrap_or(f64::NAN);
    let stood = outcomes.iter().filter(|o| o.fell_s.is_none()).count();
    (stood, median.to_degrees())
}

fn gyro() -> Result<PaperFigure> {
    let before = RunCurves::leaning(&stepped()?, LEAN_RAD)?.outcome;
    let mut disturbed = with_gyro()?;
    disturbed.disturbance_nm[0] = DISTURBANCE_NM;
    let seen = RunCurves::leaning(&disturbed, LEAN_RAD)?;
    let larger = seen.outcome.rms_torque_nm > before.rms_torque_nm;
    Ok(PaperFigure {
        number: "14 a,c,e",
        title: "Gyro resolution and a constant perturbation",
        claim: "with the gyro's 10 deg/s and a constant perturbation the control is larger and \
                the robot stays up",
        holds: Holds::when(larger && seen.outcome.fell_s.is_none()),
        sentence: format!(
            "With the gyro's steps and {DISTURBANCE_NM} N m on the arms the robot {} with {} N m \
             RMS instead of {}.",
            end(&seen.outcome),
            short(seen.outcome.rms_torque_nm),
            short(before.rms_torque_nm)
        ),
        charts: charts(&[("gyro, perturbed", &seen)]),
    })
}

fn dead_zone() -> Result<PaperFigure> {
    let direct = with_dead_zone()?;
    let mut differenced = direct.clone();
    differenced.sensor.velocity = Velocity::Difference;
    let [seen, fallen] = [&direct, &differenced].map(|case| RunCurves::leaning(case, LEAN_RAD));
    let (seen, fallen) = (seen?, fallen?);
    let (stood, swing) = tally(&outcomes(&direct, LEAN_RAD)?);
    let (differenced_stood, _) = tally(&outcomes(&differenced, LEAN_RAD)?);
    let cycle_rad = seen.outcome.limit_cycle_rad;
    let rests = cycle_rad.is_some_and(|cycle| cycle.to_degrees() < 0.5);
    let saturates = seen.peak_nm() >= 2.0 - 1e-9;
    Ok(PaperFigure {
        number: "14 b,d,f",
        title: "Dead zone and limit of the servos",
        claim: "with a dead zone of 10 % and 2 N m the robot is not stabilised, and the torques \
                saturate",
        holds: match (rests, saturates, stood) {
            (false, true, 0) => Holds::Yes,
            (false, true, _) => Holds::InPart,
            _ => Holds::No,
        },
        sentence: format!(
            "It never comes to rest and its torques saturate, but of {STARTS} starts within 1 deg \
             {stood} stand for {SECONDS:.0} s, swinging by {swing:.1} deg (median), as long as the \
             speeds of shoulder and hip are exact; with speeds from differences of the position \
             steps, as the servos give them, {differenced_stood} of {STARTS} stand."
        ),
        charts: charts(&[("exact speeds", &seen), ("differenced", &fallen)]),
    })
}
