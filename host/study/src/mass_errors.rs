//! Robots whose masses are not the model's, in the linear loop.

use super::case::Case;
use super::quantity::Uncertain;
use super::region::bisect;
use crate::error::Result;
use crate::synth::controllers::DesignModel;
use crate::synth::{Discrete, spectral_radius, upright, zoh};
use nalgebra::DMatrix;

/// Sampled plants drawn around a case's model, each mass uniform within its error.
#[derive(Debug, Clone)]
pub struct MassErrors<'a> {
    /// The nominal robot and its sampling time.
    pub case: &'a Case,
    /// Whether a link's inertia errs with its mass, as when its density is wrong; else it stays.
    pub with_inertia: bool,
    /// How many.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl MassErrors<'_> {
    /// The plants, each link's mass within `share` of the model's, by itself; their inputs are as
    /// late as the model's drives.
    ///
    /// # Errors
    /// Robots that cannot be linearised.
    pub fn plants(&self, share: f64) -> Result<Vec<Discrete>> {
        let id = if self.with_inertia { "density" } else { "mass" };
        let uncertain = Uncertain::uniform(id, share, self.case.robot.link_count());
        (0..self.draws as u64)
            .map(|draw| {
                let mut case = self.case.clone();
                for uncertain in &uncertain {
                    let value = uncertain.draw(self.seed, draw);
                    uncertain.apply(&mut case, value);
                }
                let period_s = case.clock.period_s;
                let model = DesignModel::new(&case.robot, &upright(&case.robot), period_s)?;
                Ok(zoh(&model.plant, period_s, model.delay_s)?)
            })
            .collect()
    }

    /// Largest error of the masses, a share, at which no more than `share` of the robots are
    /// unstable under u = -K x; to a quarter of a percent, up to 64 %.
    ///
    /// # Errors
    /// As [`MassErrors::plants`].
    pub fn largest(&self, k: &DMatrix<f64>, share: f64) -> Result<f64> {
        let stable = |percent: f64| {
            let plants = self.plants(percent / 100.0)?;
            Ok(unstable_share(&radii(&plants, k)) <= share)
        };
        Ok(bisect(0.0, 64.0, 8, stable)?.0 / 100.0)
    }
}

/// Spectral radii of the loops A - B K, in ascending order.
pub fn radii(plants: &[Discrete], k: &DMatrix<f64>) -> Vec<f64> {
    let radius = |plant: &Discrete| spectral_radius(&(&plant.a - &plant.b * k));
    let mut radii: Vec<f64> = plants.iter().map(radius).collect();
    radii.sort_by(f64::total_cmp);
    radii
}

/// Share of the loops that are unstable: spectral radius not below 1.
pub fn unstable_share(radii: &[f64]) -> f64 {
    radii.iter().filter(|radius| **radius >= 1.0).count() as f64 / radii.len().max(1) as f64
}
