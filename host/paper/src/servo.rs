//! The servo's figures: 4, 5, 7 from a simulated servo's own logs, 9 and 10 from data made with eq.
//! (2).

use super::figure::{Holds, PaperFigure};
use super::identification::identification;
use crate::error::Result;
use crate::model::Model;
use crate::motion::{Motion, MotionSource};
use crate::output::number::interval;
use crate::plot::{Chart, Curve, Tone};
use crate::sim::{Plant, PlantMemory, StartState, predict};
use crate::sysid::generate::{PAPER_TS_S, noise};
use crate::sysid::{
    BlockMean, DeadZoneMap, IntervalEstimate, OutputQuantity, Side, SupplyLine, blocks,
    supply_errors,
};
use handstand_shared::raw::Position;
use std::ops::Range;
use std::path::Path;

/// Speed of the full command, rad/s.
const FULL_RAD_S: f64 = 11.9;
/// Length of the blocks that are averaged, s.
const BLOCK_S: f64 = 0.2;
/// Mass that is lifted, kg: more than it can turn over.
const LIFTED_KG: f64 = 1.6;

/// Figures 4, 5, 7, 9, 10.
pub(super) fn figures() -> Result<Vec<PaperFigure>> {
    let model = model()?;
    let dead_zone = PaperFigure {
        title: "Dead zone",
        claim: "stiction is a dead zone of 7-10 % of the full range, without load",
        ..fitted("4", dead_zone(&model))
    };
    let supply = PaperFigure {
        title: "Supply voltage",
        claim: "the speed error is proportional to the supply, and none near 9.8 V",
        ..fitted("5", supply(&model))
    };
    let torque = PaperFigure {
        title: "Torque against commanded speed",
        claim: "torque is linear in the commanded speed outside the dead zone, and stops at 2 N m",
        ..fitted("7", torque(&model))
    };
    let mut all = vec![dead_zone, supply, torque];
    all.extend(identification());
    Ok(all)
}

/// A chart, and what follows from it.
pub(super) type FittedFigure = (Chart, Holds, String);

/// A figure that shows a fit, or that none was found.
pub(super) fn fitted(number: &'static str, drawn: Result<FittedFigure, String>) -> PaperFigure {
    let (charts, holds, sentence) = match drawn {
        Ok((chart, holds, sentence)) => (vec![chart], holds, sentence),
        Err(why) => {
            let sentence = format!("The simulated log gives no fit: {why}.");
            (Vec::new(), Holds::No, sentence)
        }
    };
    PaperFigure {
        number,
        title: "",
        claim: "",
        charts,
        holds,
        sentence,
    }
}

/// The servo on the bench.
pub(super) fn model() -> Result<Model> {
    let text = include_str!("servo.toml");
    Model::parse(text, Path::new("servo.toml"))
}

/// A motion at 100 Hz that is told `command` and has not been run.
pub(super) fn empty_motion(command: Vec<f64>) -> Motion {
    let samples = command.len();
    Motion {
        name: "simulated".to_string(),
        source: MotionSource {
            path: "simulated".into(),
            sha256: String::new(),
            lines: (1, samples),
        },
        time_s: (0..samples).map(|k| k as f64 * PAPER_TS_S).collect(),
        position_rad: vec![vec![0.0; samples]],
        velocity_rad_s: vec![None],
        rate_rad_s: Vec::new(),
        input: vec![Some(command)],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
    }
}

/// What the servo does under `command`, read by its encoder, with a little noise before the
/// rounding.
fn simulated(
    model: &Model,
    command: Vec<f64>,
    supply_v: Option<Vec<f64>>,
    payload_kg: f64,
    seed: u64,
) -> Motion {
    let samples = command.len();
    let mut motion = Motion {
        supply_v,
        payload_kg,
        ..empty_motion(command)
    };
    let rest = StartState {
        angle_rad: vec![0.0],
        speed_rad_s: vec![0.0],
        ..StartState::default()
    };
    let (mut readings, _) = predicted(model, &motion, 0..samples, &rest);
    let jitter = noise(samples, 0.1 * Position::LSB_RAD, seed);
    for (reading, jitter) in readings.iter_mut().zip(jitter) {
        *reading = ((*reading + jitter) / Position::LSB_RAD).round() * Position::LSB_RAD;
    }
    motion.position_rad = vec![readings];
    motion
}

/// What the model's encoder reads over a stretch of a motion, rad, and where it ends.
pub(super) fn predicted(
    model: &Model,
    motion: &Motion,
    stretch: Range<usize>,
    start: &StartState,
) -> (Vec<f64>, StartState) {
    let plant = Plant::new(model, motion);
    let mut readings = vec![0.0; stretch.len()];
    let memory = &mut PlantMemory::default();
    let end = predict(&plant, motion, stretch, start, memory, &mut readings);
    (readings, end)
}

/// From one end of the range to the other and back, slowly.
fn ramp(samples: usize, most: f64) -> Vec<f64> {
    let phase = |k: usize| 4.0 * k as f64 / samples as f64;
    (0..samples)
        .map(|k| match phase(k) {
            p if p < 1.0 => most * p,
            p if p < 3.0 => most * (2.0 - p),
            p => most * (p - 4.0),
        })
        .collect()
}

fn points(blocks: &[BlockMean]) -> Vec<(f64, f64)> {
    blocks.iter().map(|b| (100.0 * b.input, b.output)).collect()
}

/// The fitted map over the blocks' range, in percent of the range.
fn line(map: &DeadZoneMap, most: f64) -> Vec<(f64, f64)> {
    let place = |k: i32| most * f64::from(k) / 200.0;
    (-200..=200)
        .map(|k| (100.0 * place(k), map.output(place(k))))
        .collect()
}

fn sides(map: &DeadZoneMap, of: impl Fn(&Side) -> Option<IntervalEstimate>, scale: f64) -> String {
    let text = |side: &Side| match of(side) {
        Some(known) => within(&known, scale),
        None => "none".to_string(),
    };
    format!("{} and {}", text(&map.up), text(&map.down))
}

/// "8.50 (8.47 to 8.53)", to the decimals that the interval deserves.
fn within(known: &IntervalEstimate, scale: f64) -> String {
    let [value, low, high] = interval(scale * known.value, scale * known.low, scale * known.high);
    format!("{value} ({low} to {high})")
}

fn dead_zone(model: &Model) -> Result<FittedFigure, String> {
    let motion = simulated(model, ramp(8000, 0.4), None, 0.0, 4);
    let blocks = blocks(&[motion], 0, OutputQuantity::Velocity, BLOCK_S);
    let map = DeadZoneMap::fit(&blocks).map_err(|why| why.to_string())?;
    let chart = Chart::new(
        "speed against command, unloaded",
        "command, % of full range",
        "speed, rad/s",
        vec![
            Curve::dots("means over 0.2 s", Tone::Ink, points(&blocks)),
            Curve::line("fitted dead zone", Tone::Orange, line(&map, 0.4)),
        ],
    );
    let sentence = format!(
        "Put into a simulated servo as 8.5 %, the dead zone comes back from its 10-bit position \
         log as {} % (up and down).",
        sides(&map, |side| Some(side.edge), 100.0)
    );
    let is_found = map.up.edge.holds(0.085) && map.down.edge.holds(0.085);
    Ok((chart, Holds::at_least_in_part(is_found), sentence))
}

fn supply(model: &Model) -> Result<FittedFigure, String> {
    let mut means = Vec::new();
    for (seed, volts) in (50..).zip([8.0, 8.8, 9.6, 10.4, 11.2]) {
        // What the servo would have to be told to move at the speed, past its dead zone.
        let command = |k: usize| [0.5, -0.4][k / 300 % 2];
        let command = (0..1200).map(command).collect();
        let motion = simulated(model, command, Some(vec![volts; 1200]), 0.0, seed);
        means.extend(blocks(&[motion], 0, OutputQuantity::Velocity, BLOCK_S));
    }
    // Command as the speed it stands for: that of the same command at the nominal supply.
    for mean in &mut means {
        let beyond = mean.input.abs() - 0.085;
        mean.input = (beyond * FULL_RAD_S).copysign(mean.input);
    }
    let fitted = SupplyLine::fit(&means).map_err(|why| why.to_string())?;
    let percent = |points: &[(f64, f64)]| points.iter().map(|(v, e)| (*v, 100.0 * e)).collect();
    let (right, slope) = (fitted.right_at_v, fitted.error_per_v);
    let ends = [7.8, 11.4].map(|v| (v, slope.value * (v - right.value)));
    let chart = Chart::new(
        "speed error against supply",
        "supply, V",
        "speed error, % of the command",
        vec![
            Curve::dots(
                "means over 0.2 s",
                Tone::Ink,
                percent(&supply_errors(&means)),
            ),
            Curve::line("fitted line", Tone::Orange, percent(&ends)),
        ],
    );
    let sentence = format!(
        "The simulated servo's speed error in % of the command grows per volt by {}, and is none \
         at {} V.",
        within(&slope, 100.0),
        within(&right, 1.0)
    );
    let is_found = right.holds(9.8) && slope.low > 0.0;
    Ok((chart, Holds::at_least_in_part(is_found), sentence))
}

/// A known mass is lifted until it hangs in balance: its weight's moment is the torque.
fn torque(model: &Model) -> Result<FittedFigure, String> {
    let mut motion = simulated(model, ramp(24_000, 1.0), None, LIFTED_KG, 7);
    let (own, at) = (&model.links[0], model.log.payload_at_m);
    let moment = model.gravity_m_s2 * (own.mass_kg * own.com_m + LIFTED_KG * at);
    for angle in &mut motion.position_rad[0] {
        *angle = moment * angle.sin();
    }
    let blocks = blocks(&[motion], 0, OutputQuantity::AsMeasured, BLOCK_S);
    let map = DeadZoneMap::fit(&blocks).map_err(|why| why.to_string())?;
    let chart = Chart::new(
        format!("lifting {LIFTED_KG} kg at {:.0} mm", 1e3 * at),
        "command, % of full range",
        "torque, N m",
        vec![
            Curve::dots("means over 0.2 s", Tone::Ink, points(&blocks)),
            Curve::line("fitted map", Tone::Orange, line(&map, 1.0)),
        ],
    );
    let sentence = format!(
        "In simulation the torque stops at {} N m and rises by {} N m per full command; turned \
         round, 1 N m needs a command of {:.1} %.",
        sides(&map, |side| side.limit, 1.0),
        sides(&map, |side| Some(side.slope), 1.0),
        100.0 * map.inverse().input(1.0)
    );
    let near =
        |limit: Option<IntervalEstimate>| limit.is_some_and(|l| (l.value - 2.0).abs() < 0.02);
    let is_found = near(map.up.limit) && near(map.down.limit);
    Ok((chart, Holds::at_least_in_part(is_found), sentence))
}
