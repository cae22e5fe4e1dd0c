//! The response of a designed loop from a start at rest, with every effect of the model.

use super::verified_loop::{closed_loop, law};
use crate::error::Result;
use crate::model::Model;
use crate::sim::closed_loop::{ClosedLoop, InitialState, stream};
use crate::synth::{Design, Request};

/// Angles and commands over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoopResponse {
    /// Times of the samples, s.
    pub time_s: Vec<f64>,
    /// Per joint: departure from the pose, rad.
    pub angle_rad: Vec<Vec<f64>>,
    /// Per input: the command, in its own SI unit.
    pub command: Vec<Vec<f64>>,
}

/// Simulates the loop of a design under the law that is exported for `seconds` from these
/// departures from its pose, rad, at rest; it ends early where the robot falls.
///
/// # Errors
/// Models that cannot be simulated.
pub fn response(
    model: &Model,
    design: &Design,
    request: &Request,
    start_rad: &[f64],
    seconds: f64,
) -> Result<LoopResponse> {
    let closed = closed_loop(model.clone(), design, request)?;
    Ok(watched(&closed, design, start_rad, seconds))
}

/// The same from the pose, under a torque on the first joint that comes on with the run and stays,
/// N m.
///
/// # Errors
/// As [`response`].
pub fn step_response(
    model: &Model,
    design: &Design,
    request: &Request,
    torque_nm: f64,
    seconds: f64,
) -> Result<LoopResponse> {
    let mut closed = closed_loop(model.clone(), design, request)?;
    closed.plant.disturbance_nm[0] = torque_nm;
    let still = vec![0.0; model.link_count()];
    Ok(watched(&closed, design, &still, seconds))
}

fn watched(closed: &ClosedLoop, design: &Design, start_rad: &[f64], seconds: f64) -> LoopResponse {
    let joints = closed.plant.joints();
    let controller = law(design);
    let start = InitialState {
        command: design.u0.clone(),
        ..InitialState::at(start_rad)
    };
    let mut response = LoopResponse {
        angle_rad: vec![Vec::new(); joints],
        command: vec![Vec::new(); design.u0.len()],
        ..LoopResponse::default()
    };
    closed.watch(&*controller, &start, seconds, stream(1, 0), |sample| {
        response.time_s.push(sample.time_s);
        for (all, angle) in response.angle_rad.iter_mut().zip(sample.angle_rad) {
            all.push(*angle);
        }
        for (all, command) in response.command.iter_mut().zip(sample.command) {
            all.push(*command);
        }
    });
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::{CostWeights, Weight};
    use std::path::Path;

    #[test]
    fn the_handstand_comes_back_from_a_lean() {
        let text = include_str!("../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request::standard(&model);
        let design = Design::of(&model, &request).unwrap();
        let lean = [0.02, 0.0, 0.0];
        let response = response(&model, &design, &request, &lean, 6.0).unwrap();
        assert_eq!(response.angle_rad.len(), 3);
        assert_eq!(response.command.len(), 2);
        assert!((response.angle_rad[0][0] - 0.02).abs() < 1e-12);
        let last = response
            .angle_rad
            .iter()
            .map(|angles| angles.last().unwrap().abs());
        // The steps of the table leave it a small limit cycle.
        assert!(last.fold(0.0, f64::max) < 2e-3);
        assert!((response.time_s.last().unwrap() - 6.0).abs() < 0.02);
    }

    /// With integral action the driven joints come back to the pose, and the bar's joint alone
    /// leans.
    #[test]
    fn integral_action_brings_the_driven_joints_back() {
        let text = include_str!("../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let leans = |integral| {
            let request = Request {
                weights: CostWeights::Given {
                    q: Weight::Diagonal(vec![1.0, 1.0, 1.0, 0.01, 0.01, 0.01]),
                    r: Weight::Scalar(1.0),
                },
                integral,
                ..Request::standard(&model)
            };
            let design = Design::of(&model, &request).unwrap();
            let stepped = step_response(&model, &design, &request, 1e-3, 20.0).unwrap();
            let last = stepped.angle_rad.iter();
            let last: Vec<f64> = last.map(|a| a.last().unwrap().to_degrees()).collect();
            last[1].abs().max(last[2].abs())
        };
        let (without, with) = (leans(None), leans(Some(Weight::Scalar(1.0))));
        assert!(without > 0.3 && with < 0.05, "{without} {with}");
    }

    /// A lasting torque ends in the lean that the closed form says.
    #[test]
    fn a_lasting_torque_leans_it_as_the_closed_form_says() {
        let text = include_str!("../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            weights: CostWeights::PAPER,
            ..Request::standard(&model)
        };
        let design = Design::of(&model, &request).unwrap();
        let stepped = step_response(&model, &design, &request, 1e-3, 12.0).unwrap();
        // -9.04, 16.09 and 12.74 deg for 0.01 N m. The table's rounding alone changes that by a
        // tenth.
        for (angles, deg) in stepped.angle_rad.iter().zip([-0.904, 1.609, 1.274]) {
            let last = angles.last().unwrap().to_degrees();
            assert!((last - deg).abs() < 0.15 * deg.abs(), "{last} {deg}");
        }
    }
}
