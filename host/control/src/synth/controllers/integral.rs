//! The regulator with integrals of the driven joints' angles.
//!
//! With an unknown balance the arms must be free to lean; the driven joints are brought back to the
//! pose by the sums of their angles, which stand still while a drive is at its limit. (An integral
//! of all angles, or a washout of the offset, would have nothing to tell an offset from a fall: a
//! plant with an odd number of unstable poles isn't stabilised through a stable washout.)

use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{Discrete, dlqr, rows, zoh};
use nalgebra::DMatrix;

/// Weight of a driven joint's integral, 1/(rad s)^2; the angles weigh 100.
const INTEGRAL_WEIGHT: f64 = 100.0;

/// The paper's weights, and integrals.
#[derive(Debug)]
pub struct Integral;

static INFO: ControllerInfo = ControllerInfo {
    id: "integral",
    title: "DLQR with integrals",
    law: "u = -K [x, sum of driven angles]",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., section 4.5",
};

impl ControllerDesign for Integral {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let plant = zoh(&known.plant, known.period_s, 0.0)?;
        let (n, m) = plant.b.shape();
        let mut a = plant.a.resize(n + m, n + m, 0.0);
        for (sum, &joint) in known.driven.iter().enumerate() {
            a[(n + sum, n + sum)] = 1.0;
            a[(n + sum, joint)] = known.period_s;
        }
        let wide = Discrete {
            b: plant.b.resize(n + m, m, 0.0),
            c: DMatrix::identity(n + m, n + m),
            a,
            ..plant
        };
        let (q, r) = known.weights()?;
        let mut q = q.resize(n + m, n + m, 0.0);
        for sum in n..n + m {
            q[(sum, sum)] = INTEGRAL_WEIGHT;
        }
        Ok(Box::new(Summing {
            gains: rows(&dlqr(&wide, &q, &r)?.k),
            driven: known.driven.clone(),
            period_s: known.period_s,
            limit_nm: known.limit_nm,
        }))
    }
}

/// u = -K [q, dq, w], w(k+1) = w(k) + Ts q_driven(k).
#[derive(Debug)]
struct Summing {
    gains: Vec<Vec<f64>>,
    driven: Vec<usize>,
    period_s: f64,
    limit_nm: f64,
}

impl Controller for Summing {
    fn memory_len(&self) -> usize {
        self.driven.len()
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let state = measured
            .angle_rad
            .iter()
            .chain(measured.speed_rad_s)
            .chain(&*memory);
        for (torque, row) in command_nm.iter_mut().zip(&self.gains) {
            *torque = -row
                .iter()
                .zip(state.clone())
                .map(|(k, x)| k * x)
                .sum::<f64>();
        }
        if command_nm.iter().all(|torque| torque.abs() < self.limit_nm) {
            for (sum, &joint) in memory.iter_mut().zip(&self.driven) {
                *sum += self.period_s * measured.angle_rad[joint];
            }
        }
    }
}
