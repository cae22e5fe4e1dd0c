//! One gain for robots whose masses are not the model's.

use super::paper;
use super::{Card, Design, Known, Speeds, Uncertain};
use crate::closed_loop::{Controller, StateFeedback};
use crate::error::Result;
use crate::model::Model;
use crate::synth::multi_model_continuation;
use nalgebra::DMatrix;

/// Mass error the gain is designed for: a little more than the 10 % it is judged with.
pub const SHARE: f64 = 0.11;

/// Weight of every state; torques weigh 1.
pub const WEIGHTS: f64 = 1.0;

/// Steps on the way from no error to all of it.
const STAGES: usize = 6;

/// The multi-model regulator.
#[derive(Debug)]
pub struct Robust;

static CARD: Card = Card {
    id: "robust",
    title: "multi-model DLQR",
    law: "u = -K (x - x_balance), K for nine plants at once",
    speeds: Speeds::True,
    told_balance: true,
    reference: "Makila, Toivonen, IEEE Trans. Automatic Control 32 (1987) 658",
};

/// The gain of least mean cost over the model and the corners of its mass errors (`uncertain.mass` of each mass);
/// `q` weighs angles and speeds, torques weigh 1. Past inputs are states behind them.
///
/// # Errors
/// A pose that is no equilibrium; errors so large that no gain was found for all.
pub fn gain(
    model: &Model,
    pose_rad: &[f64],
    uncertain: &Uncertain,
    q: &DMatrix<f64>,
) -> Result<DMatrix<f64>> {
    let spread = |part: f64| uncertain.corners(model, pose_rad, part);
    let drives = model
        .joints
        .iter()
        .filter(|joint| joint.drive.is_driven())
        .count();
    multi_model_continuation(spread, STAGES, q, &DMatrix::identity(drives, drives))
}

impl Design for Robust {
    fn card(&self) -> &Card {
        &CARD
    }

    fn build(&self, known: &Known) -> Result<Box<dyn Controller>> {
        let n = known.plant.a.nrows();
        let uncertain = Uncertain {
            mass: SHARE,
            with_inertia: false,
            period_s: known.period_s,
            delay_s: 0.0,
        };
        let k = gain(
            &known.model,
            &known.pose_rad,
            &uncertain,
            &(DMatrix::identity(n, n) * WEIGHTS),
        )?;
        Ok(Box::new(StateFeedback::new(
            known.joints(),
            paper::rows(&k),
        )))
    }
}
