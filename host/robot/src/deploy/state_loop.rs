//! The loop that state feedback makes on the board: speeds are differences of positions, smoothed,
//! readings have their ages, torques act late.

use super::state::VELOCITY;
use super::{PlanBasis, observer_known};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::synth::controllers::board_plant;
use crate::synth::{Design, poles};
use handstand_shared::observer::{INPUTS, JOINTS};
use nalgebra::{DMatrix, stack};

/// Spectral radius of the loop of a design's rounded gains, with the board's velocity filter and
/// timing; its rounding of readings and torques left out.
///
/// # Errors
/// A design without a table, or a robot that the board does not balance.
pub fn state_radius(model: &Model, design: &Design, basis: &PlanBasis) -> Result<f64> {
    let fixed = design.fixed.as_ref().ok_or_else(|| {
        Error::usage(
            "gains for continuous time have no table",
            "leave --continuous out",
        )
    })?;
    let known = observer_known(model, &basis.board)?;
    let plant = board_plant(&known, &basis.timing)?;
    let share = f64::from(VELOCITY.share) / 256.0;
    let k = fixed.law.gain();
    // Readings are the angles and the first link's rate; the gains' columns are angles and speeds.
    let of_readings = k.columns(0, JOINTS + 1).into_owned();
    let of_speeds = k.columns(JOINTS + 1, INPUTS).into_owned();
    let joints = plant.c.rows(1, INPUTS).into_owned();
    let per_s = share / basis.board.period_s;
    // A speed is what is left of the last one, and a share of the newest difference.
    let newest = &joints * per_s;
    let by_state = &of_readings * &plant.c + &of_speeds * &newest;
    let by_before = &of_speeds * -per_s;
    let by_speed = &of_speeds * (1.0 - share);
    let (b, none) = (&plant.b, DMatrix::zeros(INPUTS, INPUTS));
    let same = DMatrix::identity(INPUTS, INPUTS);
    let (left, before) = (&same * (1.0 - share), &same * -per_s);
    let closed = stack![
        &plant.a - b * &by_state, -(b * &by_before), -(b * &by_speed);
        joints, none.clone(), none;
        newest, before, left
    ];
    let sizes = poles(&closed)?;
    Ok(sizes
        .iter()
        .fold(0.0, |most: f64, pole| most.max(pole.norm())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deploy::{Board, ToldDrives, state_design};
    use crate::synth::controllers::BoardTiming;
    use crate::synth::{CostWeights, Request};

    /// The paper's weights on differences: known to be unstable, and far from it.
    #[test]
    fn the_paper_s_weights_are_unstable_on_differences() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/handstand.toml");
        let model = Model::load(file.as_ref()).unwrap();
        let timing = BoardTiming::HOST_ATTITUDE;
        let none = ToldDrives::default();
        let basis = PlanBasis::of(&model, &Board::BIOLOID, &timing, &none).unwrap();
        let request = Request {
            weights: CostWeights::PAPER,
            ..Request::standard(&model)
        };
        let design = state_design(&model, request, &basis.board).unwrap();
        let radius = state_radius(&model, &design, &basis).unwrap();
        // 2.40, from the growth over 20 ticks of a simulation in steps of 0.1 ms written apart.
        assert!((2.3..2.6).contains(&radius), "{radius}");
    }
}
