//! Weights that suit a robot: a few ratios, tried under every effect of its model.
//!
//! Bryson's rule is the middle of them: around it the weight of all states against the inputs, and
//! that of the speeds against the angles, go through decades. The paper's weights are tried, too.

use super::judge::STABILISED_SHARE;
use super::verify::{figures_near, stabilised_from};
use crate::error::Result;
use crate::model::Model;
use crate::synth::{CostWeights, Design, Request, Weight, design_margins};
use serde::Serialize;

/// Weights of the states against the inputs, times Bryson's.
const STATES: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];

/// Weights of the speeds against the angles, times Bryson's.
const SPEEDS: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// A disk margin of 6 dB: margins beyond it are enough.
const ENOUGH: f64 = 2.0 / 3.0;

/// How many weights [`tune`] tries.
pub const TUNING_STEPS: usize = STATES.len() * SPEEDS.len() + 1;

/// Of what was tried, Bryson's rule and the paper's weights.
const PLAIN: usize = 2;

/// Weights, and what came of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WeightTrial {
    /// Weights of the states.
    pub q: Vec<f64>,
    /// Weights of the inputs.
    pub r: Vec<f64>,
    /// Disk margin at the inputs; 0 of a loop that is not stable, and of weights that no gains
    /// follow from.
    pub disk_margin: f64,
    /// Share stabilised of the starts near the pose.
    pub stabilised_share: f64,
    /// Largest cube of starts of which 95 % are stabilised, rad.
    pub region_rad: f64,
    /// Whether it may be larger still.
    pub region_open: bool,
}

/// What was tried and chosen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tuned {
    /// All that was tried: Bryson's rule first, then the paper's weights.
    pub tried: Vec<WeightTrial>,
    /// The chosen one: its place among them. Region and disk margin are not smaller than those of
    /// the better of the first two: the one with the larger region, then with the larger margin. Of
    /// those one with a margin of 6 dB is taken if there is any, then the largest region, then the
    /// largest margin.
    pub chosen: usize,
}

impl Tuned {
    /// The request with the chosen weights.
    pub fn request(&self, request: &Request) -> Request {
        let chosen = &self.tried[self.chosen];
        Request {
            weights: CostWeights::Given {
                q: Weight::Diagonal(chosen.q.clone()),
                r: Weight::Diagonal(chosen.r.clone()),
            },
            ..request.clone()
        }
    }

    /// Of plain weights, the place of the better ones.
    pub fn plain(&self) -> usize {
        best(&self.tried[..PLAIN], |one| {
            [one.region_rad, one.disk_margin, 0.0, 0.0]
        })
    }

    fn of(tried: Vec<WeightTrial>) -> Tuned {
        let mut tuned = Tuned { tried, chosen: 0 };
        let bar = tuned.tried[tuned.plain()].clone();
        let not_worse = |one: &WeightTrial| {
            one.region_rad >= bar.region_rad
                && (bar.region_rad == 0.0 || one.disk_margin >= bar.disk_margin)
        };
        tuned.chosen = best(&tuned.tried, |one| {
            if !not_worse(one) {
                return [f64::NEG_INFINITY; 4];
            }
            let enough = one.region_rad > 0.0 && one.disk_margin >= ENOUGH;
            [
                f64::from(u8::from(enough)),
                one.region_rad,
                one.stabilised_share,
                one.disk_margin,
            ]
        });
        tuned
    }
}

/// The place of the largest by rank; the first of equals.
fn best(tried: &[WeightTrial], rank: impl Fn(&WeightTrial) -> [f64; 4]) -> usize {
    let order = |a: [f64; 4], b: [f64; 4]| {
        let mut orders = a.into_iter().zip(b).map(|(a, b)| a.total_cmp(&b));
        let first = orders.find(|order| order.is_ne());
        first.unwrap_or(std::cmp::Ordering::Equal)
    };
    let places = (0..tried.len()).rev();
    let place = places.max_by(|a, b| order(rank(&tried[*a]), rank(&tried[*b])));
    place.unwrap_or(0)
}

/// Tries weights for `request`, its own apart. Designs are made for `designed_for`, the model or a
/// part of it; the loop is simulated with all effects of `model`. `done` is called after each of
/// [`TUNING_STEPS`].
///
/// # Errors
/// Models that have no design by Bryson's rule, or cannot be simulated.
pub fn tune(
    model: &Model,
    designed_for: &Model,
    request: &Request,
    done: &dyn Fn(),
) -> Result<Tuned> {
    let around = STATES.into_iter().flat_map(|states| {
        let of = move |speeds| CostWeights::ByRange { states, speeds };
        SPEEDS.map(of)
    });
    let around = around.filter(|weights| *weights != CostWeights::BRYSON);
    let mut tried = Vec::with_capacity(TUNING_STEPS);
    for weights in [CostWeights::BRYSON, CostWeights::PAPER]
        .into_iter()
        .chain(around)
    {
        let request = Request {
            weights,
            ..request.clone()
        };
        match Design::of(designed_for, &request) {
            Ok(design) => tried.push(judged(model, designed_for, &design, &request)?),
            Err(error) if tried.is_empty() => return Err(error.into()),
            // Gains that overflow a word or lose the loop by rounding are no answer; the paper's
            // keep their place.
            Err(_) if tried.len() < PLAIN => tried.push(WeightTrial {
                disk_margin: 0.0,
                stabilised_share: 0.0,
                region_rad: 0.0,
                region_open: false,
                ..tried[0].clone()
            }),
            Err(_) => {}
        }
        done();
    }
    Ok(Tuned::of(tried))
}

fn judged(
    model: &Model,
    designed_for: &Model,
    design: &Design,
    request: &Request,
) -> Result<WeightTrial> {
    let near = figures_near(model, design, request)?;
    let holds = near.stabilised_share >= STABILISED_SHARE;
    let region = holds.then(|| stabilised_from(model, design, request));
    let region = region.transpose()?;
    let margins = design_margins(designed_for, design)?;
    let diagonal = |weight: &nalgebra::DMatrix<f64>| weight.diagonal().as_slice().to_vec();
    Ok(WeightTrial {
        q: diagonal(&design.weights[0]),
        r: diagonal(&design.weights[1]),
        disk_margin: margins.map_or(0.0, |margins| margins.inputs.disk.alpha),
        stabilised_share: near.stabilised_share,
        region_rad: region.as_ref().map_or(0.0, |(_, region)| region.spread_rad),
        region_open: region.is_some_and(|(_, region)| region.open),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(disk_margin: f64, region_rad: f64) -> WeightTrial {
        WeightTrial {
            q: vec![1.0],
            r: vec![1.0],
            disk_margin,
            stabilised_share: 1.0,
            region_rad,
            region_open: false,
        }
    }

    fn choose(plain: [WeightTrial; 2], others: &[WeightTrial]) -> usize {
        Tuned::of([&plain[..], others].concat()).chosen
    }

    #[test]
    fn nothing_worse_than_plain_weights_is_chosen() {
        let plain = || [tried(0.69, 0.03), tried(0.23, 0.04)];
        // Bryson's margin does not make up for its smaller region.
        assert_eq!(choose(plain(), &[tried(0.9, 0.039), tried(0.22, 0.2)]), 1);
        assert_eq!(choose(plain(), &[tried(0.3, 0.2), tried(0.7, 0.05)]), 3);
        assert_eq!(choose(plain(), &[tried(0.3, 0.05), tried(0.25, 0.2)]), 3);
    }

    #[test]
    fn weights_that_do_not_hold_the_robot_bind_nothing() {
        let plain = || [tried(0.5, 0.0), tried(0.4, 0.0)];
        assert_eq!(choose(plain(), &[tried(0.1, 0.02), tried(0.9, 0.0)]), 2);
        assert_eq!(choose([tried(0.8, 0.02), tried(0.9, 0.0)], &[]), 0);
    }
}
