//! The sampled regulator with the delay in its model, in floating or fixed point.

use super::{ControllerDesign, ControllerInfo, DesignModel, FixedPointFeedback, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::{Controller, StateFeedback};
use crate::synth::{Format, Ranges, dlqr, quantise, rows, zoh};
use nalgebra::DMatrix;

/// DLQR on angles, speeds and past torques.
#[derive(Debug)]
pub struct Regulator;

static INFO: ControllerInfo = ControllerInfo {
    id: "dlqr-delay",
    title: "DLQR with delay states",
    law: "u = -K [x, past u]",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., section 3.2",
};

/// Angles and speeds that words of the fixed-point law hold, rad and rad/s.
const ANGLE_RANGE_RAD: f64 = 45.0 * std::f64::consts::PI / 180.0;
const SPEED_RANGE_RAD_S: f64 = 20.0;

/// Torque that they hold where the drives have no limit, N m.
const TORQUE_RANGE_NM: f64 = 8.0;

impl ControllerDesign for Regulator {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, model: &DesignModel) -> Result<Box<dyn Controller>> {
        let (q, r) = model.weights()?;
        let k = dlqr(&zoh(&model.plant, model.period_s, model.delay_s)?, &q, &r)?.k;
        if model.word_bits == 0 {
            let law = StateFeedback::new(model.joints(), rows(&k));
            return Ok(Box::new(law));
        }
        Ok(Box::new(fixed_point(model, &k)?))
    }
}

/// What the board computes, bit for bit, if its words have 16 bits.
fn fixed_point(model: &DesignModel, k: &DMatrix<f64>) -> Result<FixedPointFeedback> {
    let joints = model.joints();
    let torque_nm = if model.limit_nm.is_finite() {
        model.limit_nm
    } else {
        TORQUE_RANGE_NM
    };
    let range = |state: usize| match state {
        _ if state < joints => ANGLE_RANGE_RAD,
        _ if state < 2 * joints => SPEED_RANGE_RAD_S,
        _ => torque_nm,
    };
    let ranges = Ranges {
        state: (0..k.ncols()).map(range).collect(),
        input: vec![torque_nm; k.nrows()],
    };
    let format = Format {
        bits: model.word_bits,
        ..Format::default()
    };
    let (x0, u0) = (vec![0.0; k.ncols()], vec![0.0; k.nrows()]);
    let law = quantise(k, &x0, &u0, &ranges, &format)?;
    Ok(FixedPointFeedback::new(law, None, &x0, joints))
}
