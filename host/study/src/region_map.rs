//! From where a verified loop is stabilised, start by start, in the plane of the first two joints.

use super::verified_loop::VerifiedLoop;
use crate::error::Result;
use crate::model::Model;
use crate::synth::{Design, Request};

/// Starts to either side of the pose, along each axis.
const STEPS: i32 = 12;

/// A start, and what came of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MappedStart {
    /// Departure of the first joint, rad.
    pub first_rad: f64,
    /// Of the second, rad; 0 of a robot of one joint.
    pub second_rad: f64,
    /// Whether it is stabilised.
    pub stabilised: bool,
}

/// Runs the loop from a grid of starts within `span_rad` of the pose in the first two joints, the
/// others at it, at rest.
///
/// # Errors
/// Models that cannot be simulated.
pub fn region_map(
    model: &Model,
    design: &Design,
    request: &Request,
    span_rad: f64,
) -> Result<Vec<MappedStart>> {
    let verified = VerifiedLoop::new(model, design, request, &|| ());
    let closed = verified.closed_loop(&[])?;
    let joints = model.link_count();
    let place = |step: i32| span_rad * f64::from(step) / f64::from(STEPS);
    let second = if joints > 1 { STEPS } else { 0 };
    let grid = (-STEPS..=STEPS).flat_map(|i| (-second..=second).map(move |j| (i, j)));
    let mut starts: Vec<MappedStart> = grid
        .map(|(i, j)| MappedStart {
            first_rad: place(i),
            second_rad: place(j),
            stabilised: false,
        })
        .collect();
    let angles = |start: &MappedStart| {
        let mut angles = vec![0.0; joints];
        angles[0] = start.first_rad;
        if let Some(angle) = angles.get_mut(1) {
            *angle = start.second_rad;
        }
        angles
    };
    let all: Vec<Vec<f64>> = starts.iter().map(angles).collect();
    let outcomes = verified.outcomes(&closed, &all);
    for (start, outcome) in starts.iter_mut().zip(outcomes) {
        start.stabilised = outcome.stabilised;
    }
    Ok(starts)
}
