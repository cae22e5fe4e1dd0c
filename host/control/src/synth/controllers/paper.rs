//! The paper's sampled regulator (Q = 100 I, R = I), with and without its angle compensation.

use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::{Controller, Measurement, StateFeedback};
use crate::synth::{dlqr, rows, zoh};
use nalgebra::DMatrix;

/// One of the paper's set-ups.
#[derive(Debug)]
pub struct Paper(ControllerInfo);

const INFO: ControllerInfo = ControllerInfo {
    id: "dlqr",
    title: "DLQR of the paper",
    law: "u = -K x",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "the paper, section IV, Figure 12",
};

/// Given the true speeds, not told of eccentric masses.
pub const PLAIN: Paper = Paper(INFO);

/// With the only speeds the servos tell.
pub const DIFFERENCED: Paper = Paper(ControllerInfo {
    id: "dlqr-differences",
    title: "DLQR, speeds by equation 1",
    law: "u = -K [q, (q(k) - q(k-1)) / Ts]",
    speeds: Speeds::Differenced,
    known_equilibrium: true,
    reference: "the paper, equation 1",
});

/// Told at which angles the robot balances.
pub const COMPENSATED: Paper = Paper(ControllerInfo {
    id: "dlqr-compensated",
    title: "DLQR with angle compensation",
    law: "u = -K (x - x_balance)",
    known_equilibrium: true,
    reference: "the paper, section IV, Figures 12 to 14",
    ..INFO
});

impl ControllerDesign for Paper {
    fn info(&self) -> &ControllerInfo {
        &self.0
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let inner = StateFeedback::new(known.joints(), rows(&gain(known)?));
        if self.0.speeds == Speeds::Differenced {
            return Ok(Box::new(Differencing {
                inner,
                joints: known.joints(),
                driven: known.driven.clone(),
                period_s: known.period_s,
            }));
        }
        Ok(Box::new(inner))
    }
}

/// The paper's gain for this plant.
pub(super) fn gain(known: &DesignModel) -> Result<DMatrix<f64>> {
    let (q, r) = known.weights()?;
    Ok(dlqr(&zoh(&known.plant, known.period_s, 0.0)?, &q, &r)?.k)
}

/// The driven joints' speeds as differences of angles; the arms' is the gyro's.
#[derive(Debug)]
struct Differencing {
    inner: StateFeedback,
    joints: usize,
    driven: Vec<usize>,
    period_s: f64,
}

impl Controller for Differencing {
    /// The angles before, whether there are any, and the speeds.
    fn memory_len(&self) -> usize {
        2 * self.joints + 1
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let (before, rest) = memory.split_at_mut(self.joints);
        let (speed_rad_s, started) = rest.split_at_mut(self.joints);
        speed_rad_s.copy_from_slice(measured.speed_rad_s);
        for &joint in &self.driven {
            let moved = measured.angle_rad[joint] - before[joint];
            speed_rad_s[joint] = if started[0] == 0.0 {
                0.0
            } else {
                moved / self.period_s
            };
        }
        before.copy_from_slice(measured.angle_rad);
        started[0] = 1.0;
        let measured = Measurement {
            angle_rad: measured.angle_rad,
            speed_rad_s,
        };
        self.inner.control(&mut [], measured, command_nm);
    }
}
