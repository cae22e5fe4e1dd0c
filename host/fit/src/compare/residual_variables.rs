//! What the residual of a joint can be drawn over: speed, angle, load, time, supply.

use super::sample_features::{load_nm, speed_rad_s};
use crate::model::{Drive, MeasuredSignal, Model};
use crate::motion::Motion;

/// A quantity at every sample, the motions end to end.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualVariable {
    /// What it is: `speed`, `angle` (of a slide its displacement), `load`, `time`, `supply`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Not a number where it is unknown.
    pub values: Vec<f64>,
}

/// The variables of a joint, counted from 0; supply only where it is logged. The load is the
/// torque that the joint is told, the duty in its place, else gravity's torque on the model's
/// links at the measured angles.
pub fn residual_variables(
    model: &Model,
    motions: &[Motion],
    joint: usize,
) -> Vec<ResidualVariable> {
    let variable = |name, unit, of: &dyn Fn(&Motion) -> Vec<f64>| ResidualVariable {
        name,
        unit,
        values: motions.iter().flat_map(of).collect(),
    };
    let signal = model.log.joints[joint].signal();
    let speed = |m: &Motion| match signal {
        MeasuredSignal::Rate => m.measured(joint, signal).to_vec(),
        _ => speed_rad_s(&m.time_s, &m.position_rad[joint]),
    };
    let [place_unit, speed_unit, torque_unit] = model.joints[joint].units();
    let duty = matches!(model.joints[joint].drive, Drive::Duty(_))
        && motions.iter().any(|motion| motion.input[joint].is_some());
    let mut variables = vec![
        variable("speed", speed_unit, &|m| speed(m)),
        variable("angle", place_unit, &|m| m.position_rad[joint].clone()),
        variable("load", if duty { "1" } else { torque_unit }, &|m| {
            load_nm(model, m, joint)
        }),
        variable("time", "s", &|m| {
            m.time_s.iter().map(|time| time - m.time_s[0]).collect()
        }),
    ];
    if motions.iter().any(|motion| motion.supply_v.is_some()) {
        let unknown = |m: &Motion| vec![f64::NAN; m.len()];
        variables.push(variable("supply", "V", &|m| {
            m.supply_v.clone().unwrap_or_else(|| unknown(m))
        }));
    }
    variables
}
