//! Robots whose masses are not the model's.

use crate::closed_loop::stream;
use crate::error::Result;
use crate::model::Model;
use crate::synth::{Discrete, linearise, zoh};
use rand::Rng as _;

/// How a robot may differ from its model, and how it is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertain {
    /// Largest error of each link's mass as a share of it, each by itself.
    pub mass: f64,
    /// Whether a link's inertia errs with its mass, as when its density is wrong; else it stays.
    pub with_inertia: bool,
    /// Sampling time, s.
    pub period_s: f64,
    /// Delay of the inputs, s.
    pub delay_s: f64,
}

impl Uncertain {
    /// The model with the mass of link i multiplied by 1 + `share[i]`.
    pub fn model(&self, model: &Model, share: &[f64]) -> Model {
        let mut other = model.clone();
        for (link, share) in other.links.iter_mut().zip(share) {
            link.mass_kg *= 1.0 + share;
            if self.with_inertia {
                link.inertia_kg_m2 *= 1.0 + share;
            }
        }
        other
    }

    /// The sampled linear plant with such masses.
    ///
    /// # Errors
    /// A pose that is no equilibrium.
    pub fn plant(&self, model: &Model, pose_rad: &[f64], share: &[f64]) -> Result<Discrete> {
        let plant = linearise(&self.model(model, share), pose_rad)?.plant;
        Ok(zoh(&plant, self.period_s, self.delay_s)?)
    }

    /// The model itself, then every combination of lightest and heaviest links, at `part` of the errors.
    ///
    /// # Errors
    /// As [`Uncertain::plant`].
    pub fn corners(&self, model: &Model, pose_rad: &[f64], part: f64) -> Result<Vec<Discrete>> {
        let n = model.link_count();
        let mut plants = vec![self.plant(model, pose_rad, &vec![0.0; n])?];
        // All corners would be too many for long chains: links ten apart err alike.
        let corners = 1usize << n.min(10);
        for corner in 0..corners {
            let share: Vec<f64> = (0..n)
                .map(|i| match corner >> (i % 10) & 1 {
                    0 => -self.mass * part,
                    _ => self.mass * part,
                })
                .collect();
            plants.push(self.plant(model, pose_rad, &share)?);
        }
        Ok(plants)
    }

    /// `count` robots by lot, each mass evenly anywhere within its error.
    ///
    /// # Errors
    /// As [`Uncertain::plant`].
    pub fn draw(
        &self,
        model: &Model,
        pose_rad: &[f64],
        count: usize,
        seed: u64,
    ) -> Result<Vec<Discrete>> {
        (0..count)
            .map(|index| self.plant(model, pose_rad, &self.share(model, seed, index)))
            .collect()
    }

    /// The errors of the masses of robot `index`.
    pub fn share(&self, model: &Model, seed: u64, index: usize) -> Vec<f64> {
        let mut rng = stream(seed, index as u64);
        let share = |_| self.mass * rng.random_range(-1.0..=1.0);
        (0..model.link_count()).map(share).collect()
    }
}
