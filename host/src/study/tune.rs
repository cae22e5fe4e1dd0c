//! Weights that suit a robot: a few ratios, tried under every effect of its model.
//!
//! Bryson's rule starts it: each state and input weighs one over the square of its largest
//! departure, which also makes their units agree. Around it the weight of all states against the
//! inputs, and that of the speeds against the angles, go through decades.

use super::judge::{Figures, STABILISED_SHARE};
use super::verify::{figures_near, stabilised_from};
use crate::error::Result;
use crate::model::Model;
use crate::synth::{Design, Request, Weight, design_margins};
use serde::Serialize;

/// Weights of the states against the inputs, times Bryson's.
const STATES: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];

/// Weights of the speeds against the angles, times Bryson's.
const SPEEDS: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// A disk margin of 6 dB: margins beyond it are enough.
const ENOUGH: f64 = 2.0 / 3.0;

/// Of how many weights the region is searched, beside the request's own: of those with the largest
/// margins that hold the robot near its pose.
const SEARCHED: usize = 6;

/// How many weights [`tune`] tries, and the regions that it searches.
pub const TUNING_STEPS: usize = STATES.len() * SPEEDS.len() + 1 + SEARCHED;

/// Weights, and what came of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Weights of the states; none of the request's own, which come first.
    pub q: Option<Vec<f64>>,
    /// Weights of the inputs, likewise.
    pub r: Option<Vec<f64>>,
    /// Disk margin at the inputs; 0 of a loop that is not stable.
    pub disk_margin: f64,
    /// Share stabilised of the starts near the pose.
    pub stabilised_share: f64,
    /// Largest cube of starts of which 95 % are stabilised, rad; 0 where it was not searched, since
    /// others have larger margins.
    pub region_rad: f64,
    /// Whether it may be larger still.
    pub region_open: bool,
}

/// What was tried and chosen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tuned {
    /// All that was tried and could be designed, the request's own weights first.
    pub tried: Vec<Tried>,
    /// The chosen one: its place among them. Region and disk margin are not smaller than the first
    /// one's, and its region was searched. Of those, one with a margin of 6 dB is taken if there is
    /// any, then the largest region, then the largest margin.
    pub chosen: usize,
}

impl Tuned {
    /// The request with the chosen weights.
    pub fn request(&self, request: &Request) -> Request {
        let chosen = &self.tried[self.chosen];
        let or = |values: &Option<Vec<f64>>, own: &Weight| {
            values.clone().map_or_else(|| own.clone(), Weight::Diagonal)
        };
        Request {
            q: or(&chosen.q, &request.q),
            r: or(&chosen.r, &request.r),
            ..request.clone()
        }
    }

    fn choose(tried: &[Tried]) -> usize {
        let first = &tried[0];
        let not_worse = |one: &Tried| {
            one.region_rad >= first.region_rad
                && (first.region_rad == 0.0 || one.disk_margin >= first.disk_margin)
        };
        let rank = |one: &Tried| {
            let enough = f64::from(u8::from(one.region_rad > 0.0 && one.disk_margin >= ENOUGH));
            [
                enough,
                one.region_rad,
                one.stabilised_share,
                one.disk_margin,
            ]
        };
        let better = |a: &Tried, b: &Tried| {
            let pairs = rank(a).into_iter().zip(rank(b));
            let mut orders = pairs.map(|(a, b)| a.total_cmp(&b));
            orders.find(|order| order.is_ne()) == Some(std::cmp::Ordering::Greater)
        };
        let mut chosen = 0;
        for (at, one) in tried.iter().enumerate() {
            if not_worse(one) && better(one, &tried[chosen]) {
                chosen = at;
            }
        }
        chosen
    }
}

/// Tries weights for `request`. Designs are made for `designed_for`, the model or a part of it; the
/// loop is simulated with all effects of `model`. `done` is called after each of [`TUNING_STEPS`].
///
/// # Errors
/// A request whose own weights have no design, models that cannot be simulated.
pub fn tune(
    model: &Model,
    designed_for: &Model,
    request: &Request,
    done: &dyn Fn(),
) -> Result<Tuned> {
    let own = Design::of(designed_for, request)?;
    let (figures, region) = stabilised_from(model, &own, request)?;
    let mut tried = vec![Tried {
        region_rad: region.spread_rad,
        region_open: region.open,
        ..judged(designed_for, &own, &figures)?
    }];
    let mut designs = vec![(request.clone(), own.clone())];
    done();
    let (states, inputs) = own.plant.b.shape();
    let state_range = request
        .state_range
        .diagonal("the range of states", states)?;
    let input_range = match &own.fixed {
        Some(fixed) => fixed.ranges.input.clone(),
        None => vec![1.0; inputs],
    };
    let bryson = |ranges: &[f64], factor: f64| -> Vec<f64> {
        ranges.iter().map(|range| factor / range.powi(2)).collect()
    };
    for level in STATES {
        for speeds in SPEEDS {
            let (angles, rates) = state_range.split_at(states / 2);
            let q = [bryson(angles, level), bryson(rates, level * speeds)].concat();
            let r = bryson(&input_range, 1.0);
            let request = Request {
                q: Weight::Diagonal(q.clone()),
                r: Weight::Diagonal(r.clone()),
                ..request.clone()
            };
            // Gains that overflow a word or lose the loop by rounding are no answer.
            if let Ok(design) = Design::of(designed_for, &request) {
                let figures = figures_near(model, &design, &request)?;
                tried.push(Tried {
                    q: Some(q),
                    r: Some(r),
                    ..judged(designed_for, &design, &figures)?
                });
                designs.push((request, design));
            }
            done();
        }
    }
    for place in worth_searching(&tried) {
        let (request, design) = &designs[place];
        let (_, region) = stabilised_from(model, design, request)?;
        (tried[place].region_rad, tried[place].region_open) = (region.spread_rad, region.open);
        done();
    }
    Ok(Tuned {
        chosen: Tuned::choose(&tried),
        tried,
    })
}

/// Places of those whose region may be chosen, the largest margins first: a margin beyond 6 dB
/// counts as 6 dB, and those with the most runs stabilised go first among equals.
fn worth_searching(tried: &[Tried]) -> Vec<usize> {
    let own = &tried[0];
    let may_be = |place: &usize| {
        let one = &tried[*place];
        let margin = own.region_rad == 0.0 || one.disk_margin >= own.disk_margin;
        margin && one.stabilised_share >= STABILISED_SHARE
    };
    let mut places: Vec<usize> = (1..tried.len()).filter(may_be).collect();
    let rank = |place: usize| {
        let one = &tried[place];
        (one.disk_margin.min(ENOUGH), one.stabilised_share)
    };
    places.sort_by(|a, b| {
        let ((margin_a, share_a), (margin_b, share_b)) = (rank(*a), rank(*b));
        margin_b
            .total_cmp(&margin_a)
            .then(share_b.total_cmp(&share_a))
    });
    places.truncate(SEARCHED);
    places
}

fn judged(designed_for: &Model, design: &Design, near: &Figures) -> Result<Tried> {
    let margins = design_margins(designed_for, design)?;
    Ok(Tried {
        q: None,
        r: None,
        disk_margin: margins.map_or(0.0, |margins| margins.inputs.disk.alpha),
        stabilised_share: near.stabilised_share,
        region_rad: 0.0,
        region_open: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(disk_margin: f64, region_rad: f64) -> Tried {
        Tried {
            q: None,
            r: None,
            disk_margin,
            stabilised_share: 1.0,
            region_rad,
            region_open: false,
        }
    }

    #[test]
    fn nothing_worse_than_the_own_weights_is_chosen() {
        let own = tried(0.23, 0.04);
        let choose =
            |others: &[Tried]| Tuned::choose(&[std::slice::from_ref(&own), others].concat());
        assert_eq!(choose(&[tried(0.9, 0.039), tried(0.22, 0.2)]), 0);
        assert_eq!(choose(&[tried(0.3, 0.2), tried(0.7, 0.05)]), 2);
        assert_eq!(choose(&[tried(0.3, 0.05), tried(0.25, 0.2)]), 2);
        // Own weights that do not hold the robot bind nothing.
        let fallen = Tuned::choose(&[tried(0.5, 0.0), tried(0.1, 0.02), tried(0.9, 0.0)]);
        assert_eq!(fallen, 1);
    }

    #[test]
    fn regions_are_searched_where_they_may_be_chosen() {
        let of = |disk_margin: f64, stabilised_share: f64| Tried {
            stabilised_share,
            ..tried(disk_margin, 0.0)
        };
        let own = tried(0.3, 0.04);
        let all = [own, of(0.2, 1.0), of(0.9, 1.0), of(0.5, 1.0), of(0.8, 0.5)];
        // The margin of one is below the own, another does not hold the robot.
        assert_eq!(worth_searching(&all), [2, 3]);
        let fallen = [tried(0.3, 0.0), of(0.2, 1.0)];
        assert_eq!(worth_searching(&fallen), [1]);
        let many: Vec<Tried> = (0..30).map(|_| of(0.5, 1.0)).collect();
        assert_eq!(worth_searching(&many).len(), SEARCHED);
    }
}
