//! What the torque limit allows, computed: how far each unstable mode grows before an answer to
//! what is read can act, and which share of what the torques can bring back a sensor step uses up.
//!
//! A mode with pole p > 0 and left eigenvector w (w'A = p w') of x' = A x + B u under |u| <= u_max
//! is brought back from states with |w'x| < u_max |w'B|_1 / p, and from no others, whatever the law
//! (Hu, Lin, Control Systems with Actuator Saturation (2001), section 2.2). Torques that follow
//! their inputs with a lag T leave 1 / (1 + p T) of it. A state that is off by d is off by d e^{p
//! t} when the first input that knows of it acts.

use super::observer_known;
use crate::deploy::Board;
use crate::error::Result;
use crate::model::Model;
use crate::synth::controllers::BoardTiming;
use crate::synth::poles;
use handstand_shared::message::Attitude;
use handstand_shared::observer::JOINTS;
use handstand_shared::raw::Position;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Poles slower than this are not unstable but neutral, 1/s.
const LEAST_POLE: f64 = 1e-3;

/// Limits of an unstable mode.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModeLimit {
    /// Its pole, 1/s.
    pub pole_per_s: f64,
    /// From a measurement until the first torque that knows of it has its effect: age, a period,
    /// the way to the servo; the servo's lag is in `recoverable`.
    pub answer_s: f64,
    /// By how much it grows meanwhile.
    pub growth: f64,
    /// Share of the recoverable states that a start of 1 deg in the worst corner is.
    pub degree_share: f64,
    /// Share of them that half a step of every sensor is, when the answer to it acts. Above 1 no
    /// law recovers from it.
    pub half_step_share: f64,
}

/// Limits of all unstable modes of the robot upright, the fastest first.
///
/// # Errors
/// As [`observer_design`](super::observer_design).
pub fn mode_limits(model: &Model, board: &Board, timing: &BoardTiming) -> Result<Vec<ModeLimit>> {
    let known = observer_known(model, board)?;
    let (a, b) = (&known.plant.a, &known.plant.b);
    let mut limits = Vec::new();
    for pole in poles(a)? {
        if pole.im.abs() > LEAST_POLE || pole.re < LEAST_POLE {
            continue;
        }
        let p = pole.re;
        let Some(w) = left_eigenvector(a, p) else {
            continue;
        };
        let pulls = b.transpose() * &w;
        let pulls = pulls.iter().zip(board.most_nm);
        let reach_nm: f64 = pulls.map(|(part, most_nm)| part.abs() * most_nm).sum();
        let recoverable = reach_nm / (p * (1.0 + p * timing.lag_s));
        let off = |steps: &[f64]| -> f64 {
            let parts = w.iter().zip(steps).map(|(w, step)| (w * step).abs());
            parts.sum()
        };
        let degree = [1f64.to_radians(); JOINTS];
        let oldest_s = (timing.age_s.iter().zip(&timing.deviation))
            .filter(|(_, deviation)| deviation.is_finite())
            .fold(0.0, |oldest: f64, (age, _)| oldest.max(*age));
        let answer_s = oldest_s + board.period_s + timing.latest_effect_s();
        let growth = (p * answer_s).exp();
        limits.push(ModeLimit {
            pole_per_s: p,
            answer_s,
            growth,
            degree_share: off(&degree) / recoverable,
            half_step_share: growth * off(&half_steps(board, timing)) / recoverable,
        });
    }
    limits.sort_by(|one, other| other.pole_per_s.total_cmp(&one.pole_per_s));
    Ok(limits)
}

/// Half a step of each sensor: the joints' angles, then the first link's rate.
fn half_steps(board: &Board, timing: &BoardTiming) -> [f64; JOINTS + 1] {
    let first_rad = if timing.deviation[0].is_finite() {
        Attitude::ANGLE_LSB_RAD / 2.0
    } else {
        0.0
    };
    let rate = if board.gyro.from_host {
        Attitude::RATE_LSB_RAD_S
    } else {
        f64::from(board.gyro.scale.unsigned_abs()) / 16.0 * Attitude::RATE_LSB_RAD_S
    };
    let joint_rad = Position::LSB_RAD / 2.0;
    [first_rad, joint_rad, joint_rad, rate / 2.0]
}

/// w with w'A = p w', of length 1.
fn left_eigenvector(a: &DMatrix<f64>, p: f64) -> Option<DVector<f64>> {
    let n = a.nrows();
    let shifted = a.transpose() - DMatrix::identity(n, n) * p;
    let svd = shifted.svd(false, true);
    let rows = svd.v_t?;
    let least = svd.singular_values.imin();
    Some(rows.row(least).transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(timing: &BoardTiming, board: &Board) -> Vec<ModeLimit> {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/handstand.toml");
        mode_limits(&Model::load(file.as_ref()).unwrap(), board, timing).unwrap()
    }

    /// docs/controllers.md: poles 21.2, .., 5.7; the worst corner of 2 deg comes to 21 % of what
    /// the slowest mode allows.
    #[test]
    fn the_paper_s_robot_has_three_modes() {
        let all = limits(&BoardTiming::HOST_ATTITUDE, &Board::BIOLOID);
        assert_eq!(all.len(), 3, "{all:?}");
        let slowest = all[2];
        assert!((slowest.pole_per_s - 5.7).abs() < 0.1, "{slowest:?}");
        assert!(
            (2.0 * slowest.degree_share - 0.21).abs() < 0.02,
            "{slowest:?}"
        );
        assert!(all.iter().all(|mode| mode.half_step_share < 0.1), "{all:?}");
    }

    #[test]
    fn later_answers_and_coarser_steps_leave_less() {
        let at_once = limits(&BoardTiming::HOST_ATTITUDE, &Board::BIOLOID);
        let lagging = BoardTiming::HOST_ATTITUDE.with_lag(0.034);
        let weaker = Board {
            most_nm: [1.0; 2],
            ..Board::BIOLOID
        };
        for (mode, late) in at_once.iter().zip(limits(&lagging, &Board::BIOLOID)) {
            let left = 1.0 + 0.034 * mode.pole_per_s;
            assert!((late.degree_share / mode.degree_share - left).abs() < 1e-6);
        }
        for (mode, weak) in at_once
            .iter()
            .zip(limits(&BoardTiming::HOST_ATTITUDE, &weaker))
        {
            assert!((weak.half_step_share / mode.half_step_share - 2.0).abs() < 1e-9);
        }
        let slower = BoardTiming {
            effect_s: 20e-3,
            ..BoardTiming::HOST_ATTITUDE
        };
        for (mode, late) in at_once.iter().zip(limits(&slower, &Board::BIOLOID)) {
            let grown =
                (mode.pole_per_s * (slower.effect_s - BoardTiming::HOST_ATTITUDE.effect_s)).exp();
            assert!((late.growth / mode.growth - grown).abs() < 1e-9);
        }
    }
}
