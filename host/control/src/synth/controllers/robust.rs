//! One gain for robots whose masses are not the model's.

use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::{Controller, StateFeedback};
use crate::synth::{Discrete, multi_model_continuation, rows, zoh};
use nalgebra::DMatrix;

/// Mass error the gain is designed for: a little more than the 10 % it is judged with.
pub const MASS_ERROR: f64 = 0.11;

/// Weight of every state; torques weigh 1.
pub const WEIGHT: f64 = 1.0;

/// Steps on the way from no error to all of it.
const STAGES: usize = 6;

/// The multi-model regulator.
#[derive(Debug)]
pub struct Robust;

static INFO: ControllerInfo = ControllerInfo {
    id: "robust",
    title: "multi-model DLQR",
    law: "u = -K (x - x_balance), K for nine plants at once",
    speeds: Speeds::True,
    known_equilibrium: true,
    reference: "Makila, Toivonen, IEEE Trans. Automatic Control 32 (1987) 658",
};

/// One gain for a model and the corners of its mass errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultiModel {
    /// Largest error of each link's mass, a share of it.
    pub mass_error: f64,
    /// Whether a link's inertia errs with its mass.
    pub with_inertia: bool,
    /// Weight of every angle and speed; torques weigh 1.
    pub weight: f64,
}

impl MultiModel {
    /// K: the gain of least mean cost over all the plants, whose inputs are `delay_s` late; columns
    /// are those of the state, and of as many past inputs as the delay takes.
    ///
    /// # Errors
    /// A pose that is no equilibrium; errors so large that no gain was found for all.
    pub fn gain(&self, model: &DesignModel, delay_s: f64) -> Result<DMatrix<f64>> {
        let (n, m) = (model.plant.a.nrows(), model.drives());
        let q = DMatrix::identity(n, n) * self.weight;
        let spread = |part: f64| self.corners(model, delay_s, part);
        multi_model_continuation(spread, STAGES, &q, &DMatrix::identity(m, m))
    }

    /// The model itself, then every combination of lightest and heaviest links, at `part` of the
    /// errors.
    fn corners(&self, model: &DesignModel, delay_s: f64, part: f64) -> Result<Vec<Discrete>> {
        let n = model.model.link_count();
        // All corners would be too many for long chains: links ten apart err alike.
        let corners = 1usize << n.min(10);
        let shares = (0..corners).map(|corner| {
            let sign = |link: usize| {
                if corner >> (link % 10) & 1 == 0 {
                    -1.0
                } else {
                    1.0
                }
            };
            (0..n)
                .map(|link| sign(link) * self.mass_error * part)
                .collect()
        });
        std::iter::once(vec![0.0; n])
            .chain(shares)
            .map(|share| self.plant(model, delay_s, &share))
            .collect()
    }

    /// The sampled linear plant with the mass of link i multiplied by 1 + `share[i]`.
    fn plant(&self, model: &DesignModel, delay_s: f64, share: &[f64]) -> Result<Discrete> {
        let mut other = model.model.clone();
        for (link, share) in other.links.iter_mut().zip(share) {
            link.mass_kg *= 1.0 + share;
            if self.with_inertia {
                link.inertia_kg_m2 *= 1.0 + share;
            }
        }
        let other = DesignModel::new(&other, &model.pose_rad, model.period_s)?;
        Ok(zoh(&other.plant, model.period_s, delay_s)?)
    }
}

impl ControllerDesign for Robust {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let design = MultiModel {
            mass_error: MASS_ERROR,
            with_inertia: false,
            weight: WEIGHT,
        };
        let k = design.gain(known, 0.0)?;
        Ok(Box::new(StateFeedback::new(known.joints(), rows(&k))))
    }
}
