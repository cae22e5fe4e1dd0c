//! What effects that remember do over time, or as the joint goes to and fro.

use super::{Effect, FULL_TORQUE_NM, POINTS, Points, triangle};
use crate::effects::{DriveState, JointState, MemoryCell, Site, StepState};

/// Labels of x and y.
pub(super) fn labels(site: Site) -> (&'static str, &'static str) {
    match site {
        Site::Command => ("time, s", "input that is obeyed, 1"),
        Site::Drive => ("time, s", "torque at full duty, N m"),
        _ => ("angle, to and fro, rad", "torque on the joint, N m"),
    }
}

/// The effect's curve with these values; `span_s` is how long it is looked at.
pub(super) fn curve(effect: Effect, values: &[f64], span_s: f64) -> Points {
    let step_s = span_s / (POINTS - 1) as f64;
    let times = (0..POINTS).map(|index| index as f64 * step_s);
    let mut memory = effect.recall(values, &moved(0.0, 0.0));
    match effect.info().site {
        Site::Command => {
            effect.remember(values, &mut memory, &moved(0.0, 0.0), step_s);
            let obeyed = |time_s| (time_s, stepped(effect, values, &mut memory, step_s));
            times.map(obeyed).collect()
        }
        Site::Drive => {
            let drawn = |time_s| (time_s, driven(effect, values, &mut memory, step_s));
            times.map(drawn).collect()
        }
        _ => to_and_fro(effect, values, memory),
    }
}

/// How long to look at it: three times as long as the longest of its times, or as a ramp to full
/// range takes.
pub(super) fn span_s(effect: Effect, values: &[f64]) -> f64 {
    let parameters = effect.info().parameters.iter().zip(values);
    let times = parameters.filter_map(|(parameter, value)| match parameter.unit {
        "s" => Some(*value),
        "1/s" => Some(1.0 / value),
        _ => None,
    });
    3.0 * times.fold(0.0, f64::max).max(0.01)
}

fn moved(input: f64, angle_rad: f64) -> StepState {
    StepState {
        input,
        duty: input,
        ..StepState::at_rest(angle_rad)
    }
}

/// What is obeyed in a step of an input that has gone from 0 to 1.
fn stepped(effect: Effect, values: &[f64], memory: &mut MemoryCell, step_s: f64) -> f64 {
    let obeyed = effect.obey(values, *memory, 1.0, step_s);
    effect.remember(values, memory, &moved(1.0, 0.0), step_s);
    obeyed
}

/// Torque of a step at full duty.
fn driven(effect: Effect, values: &[f64], memory: &mut MemoryCell, step_s: f64) -> f64 {
    let at = DriveState {
        speed_rad_s: 0.0,
        duty: 1.0,
        full_torque_nm: FULL_TORQUE_NM,
        supply_ratio: 1.0,
        memory: *memory,
    };
    let torque_nm = effect.drive(values, FULL_TORQUE_NM, &at);
    effect.remember(values, memory, &moved(1.0, 0.0), step_s);
    torque_nm
}

/// The second of two periods of a triangle.
fn to_and_fro(effect: Effect, values: &[f64], mut memory: MemoryCell) -> Points {
    let at = |index: usize| {
        let angle_rad = triangle(index as f64);
        let joint = JointState {
            memory,
            ..JointState::undriven(angle_rad, 0.0)
        };
        let torque_nm = effect.torque(values, &joint);
        effect.remember(values, &mut memory, &moved(0.0, angle_rad), 0.0);
        (angle_rad, torque_nm)
    };
    (0..2 * POINTS - 1).map(at).skip(POINTS - 1).collect()
}
