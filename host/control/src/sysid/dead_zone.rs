//! A dead zone, a line on either side of it, and saturation: the shape of the paper's Figures 4 and
//! 7.

use super::blocks::BlockMean;
use super::dynamics::IntervalEstimate;
use crate::error::Problem;
use crate::fitting::quantile_975;
use curve::{DeadZoneCurve, best};
use serde::Serialize;

mod curve;

/// Fewest blocks on a side, and beyond the onset of saturation.
const LEAST: usize = 4;

/// One side of the map: `output = min(limit, slope * max(0, |input| - edge))`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Side {
    /// Where the dead zone ends, in the input's unit.
    pub edge: IntervalEstimate,
    /// Output per input outside.
    pub slope: IntervalEstimate,
    /// OutputQuantity at which it stays; none where no saturation is seen.
    pub limit: Option<IntervalEstimate>,
    /// Blocks on this side.
    pub blocks: usize,
    /// Root-mean-square of what is left, in the output's unit.
    pub rms: f64,
}

/// Both sides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DeadZoneMap {
    /// Inputs above zero.
    pub up: Side,
    /// Inputs below zero, both axes turned round.
    pub down: Side,
}

/// Which input makes which output: what a controller needs to see no dead zone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Inverse {
    /// Least input above zero that moves anything.
    pub edge_up: f64,
    /// Input per output above.
    pub per_output_up: f64,
    /// As `edge_up`, below zero; given as a size.
    pub edge_down: f64,
    /// Input per output below.
    pub per_output_down: f64,
    /// Largest output that can be asked for on both sides; none where none was seen.
    pub limit: Option<f64>,
}

impl DeadZoneMap {
    /// Fits both sides.
    ///
    /// # Errors
    /// A side with too few blocks, or one that never moves.
    pub fn fit(blocks: &[BlockMean]) -> Result<DeadZoneMap, Problem> {
        let side = |sign: f64, name: &'static str| {
            let points: Vec<(f64, f64)> = blocks
                .iter()
                .filter(|block| block.input * sign > 0.0)
                .map(|block| (block.input * sign, block.output * sign))
                .collect();
            fit_side(&points, name)
        };
        Ok(DeadZoneMap {
            up: side(1.0, "positive")?,
            down: side(-1.0, "negative")?,
        })
    }

    /// What the map says of an input.
    pub fn output(&self, input: f64) -> f64 {
        let side = if input >= 0.0 { &self.up } else { &self.down };
        let line = side.slope.value * (input.abs() - side.edge.value).max(0.0);
        let limit = side.limit.map_or(f64::INFINITY, |limit| limit.value);
        line.min(limit).copysign(input)
    }

    /// The map turned round.
    pub fn inverse(&self) -> Inverse {
        let limits = [self.up.limit, self.down.limit];
        Inverse {
            edge_up: self.up.edge.value,
            per_output_up: 1.0 / self.up.slope.value,
            edge_down: self.down.edge.value,
            per_output_down: 1.0 / self.down.slope.value,
            limit: limits
                .into_iter()
                .flatten()
                .map(|limit| limit.value)
                .min_by(f64::total_cmp),
        }
    }
}

impl Inverse {
    /// The input that makes this output, held at the limit; 0 for 0.
    pub fn input(&self, output: f64) -> f64 {
        let size = output.abs().min(self.limit.unwrap_or(f64::INFINITY));
        if size == 0.0 {
            0.0
        } else if output > 0.0 {
            self.edge_up + size * self.per_output_up
        } else {
            -(self.edge_down + size * self.per_output_down)
        }
    }
}

fn fit_side(points: &[(f64, f64)], name: &'static str) -> Result<Side, Problem> {
    if points.len() < LEAST {
        return Err(Problem::new(
            format!(
                "{} blocks of {name} inputs where {LEAST} are the least",
                points.len()
            ),
            "a block counts where the input hardly changes over it and the one before: record \
             slow ramps or steps of a second to either side, or average over less: --block 0.1",
        ));
    }
    let flat = || {
        Problem::new(
            format!("the output does not grow with {name} inputs"),
            "record inputs that move the servo, and check the columns' signs and units",
        )
    };
    let count = points.len() as f64;
    let criterion = |curve: &DeadZoneCurve, coefficients: f64| {
        count * (curve.cost(points) / count).max(f64::MIN_POSITIVE).ln() + coefficients * count.ln()
    };
    let open = best(points, false).ok_or_else(flat)?;
    // Schwarz's criterion decides whether a limit is seen.
    let curve = match best(points, true) {
        Some(limited) if criterion(&limited, 3.0) < criterion(&open, 2.0) => limited,
        _ => open,
    };
    side(&curve, points).ok_or_else(flat)
}

/// Intervals from the normal matrix of what the points do touch.
fn side(curve: &DeadZoneCurve, points: &[(f64, f64)]) -> Option<Side> {
    let (mut matrix, _) = curve.normal(points);
    let limited = curve.limit.is_finite();
    let coefficients = if limited { 3 } else { 2 };
    if !limited {
        matrix[(2, 2)] = 1.0;
    }
    let freedom = points.len().saturating_sub(coefficients).max(1) as f64;
    let (variance, reach) = (curve.cost(points) / freedom, quantile_975(freedom));
    let inverse = matrix.try_inverse()?;
    let known = |value: f64, k: usize| {
        IntervalEstimate::around(value, reach * (variance * inverse[(k, k)]).max(0.0).sqrt())
    };
    Some(Side {
        slope: known(curve.slope, 0),
        edge: known(curve.edge, 1),
        limit: limited.then(|| known(curve.limit, 2)),
        blocks: points.len(),
        rms: (curve.cost(points) / points.len() as f64).sqrt(),
    })
}

#[cfg(test)]
mod tests;
