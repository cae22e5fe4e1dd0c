//! From where a loop is stabilised, as an ellipsoid: the Riccati equation says in which direction
//! the robot is weak, the simulation how far it goes.
//!
//! Of starts at rest the cost to come is e'Pe, P the block of the angles. The ellipsoid e'Pe <= c
//! has its half-axes along the eigenvectors of P. Where one would be longer than the search goes,
//! it ends there, which makes the ellipsoid smaller.

use super::judge::STABILISED_SHARE;
use super::region::{LARGEST_REGION_RAD, bisect};
use crate::error::Result;
use crate::model::{Angles, Model};
use crate::sim::closed_loop::{InitialState, Outcome, normal, stream};
use crate::synth::Design;
use nalgebra::{DMatrix, DVector};
use rand::Rng as _;
use serde::Serialize;

/// Runs from random starts behind each judgement.
const RUNS: u64 = 60;

/// Halvings of the interval in which the shortest half-axis ends.
const HALVINGS: usize = 7;

/// Judgements of [`ellipsoid`] at most.
pub(super) const ELLIPSOID_JUDGEMENTS: usize = HALVINGS + 2;

/// Seed of the starts, apart from those of the cube.
const SEED: u64 = 2;

/// An ellipsoid of starts at rest of which 95 % are stabilised. Angles are those between links.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ellipsoid {
    /// Half-axes, rad, the shortest first; of slides m.
    pub half_axes_rad: Vec<f64>,
    /// Their directions, a unit vector of the joints each.
    pub directions: Vec<Vec<f64>>,
    /// Whether the shortest half-axis may be longer still: the search ends at 16 deg.
    pub open: bool,
    /// Runs from random starts within it.
    pub runs: usize,
    /// How many of them were stabilised.
    pub stabilised: usize,
}

/// Half-axes per length of the shortest one, and directions: columns.
struct Shape {
    ratios: Vec<f64>,
    directions: DMatrix<f64>,
}

impl Shape {
    fn of(model: &Model, design: &Design) -> Shape {
        let n = model.link_count();
        let block = design.gains.riccati.view((0, 0), (n, n)).into_owned();
        // What the model calls an angle, of the angles between links.
        let convention = match model.angles {
            Angles::Relative => DMatrix::identity(n, n),
            Angles::Absolute => DMatrix::from_element(n, n, 1.0).lower_triangle(),
        };
        let eigen = (convention.transpose() * block * convention).symmetric_eigen();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let largest = eigen.eigenvalues[order[0]].max(f64::MIN_POSITIVE);
        let ratio = |i: &usize| {
            let share = eigen.eigenvalues[*i] / largest;
            1.0 / share.max(f64::EPSILON).sqrt()
        };
        Shape {
            ratios: order.iter().map(ratio).collect(),
            directions: eigen.eigenvectors.select_columns(&order),
        }
    }

    fn half_axes(&self, shortest_rad: f64) -> Vec<f64> {
        let axis = |ratio: &f64| (shortest_rad * ratio).min(LARGEST_REGION_RAD);
        self.ratios.iter().map(axis).collect()
    }

    /// Start `run`, evenly anywhere within the ellipsoid.
    fn start(&self, shortest_rad: f64, run: u64) -> InitialState {
        let half_axes = self.half_axes(shortest_rad);
        let mut rng = stream(SEED, run);
        let towards = DVector::from_fn(half_axes.len(), |_, _| normal(&mut rng));
        let share = rng.random::<f64>().powf(1.0 / half_axes.len() as f64);
        let at = towards.normalize() * share;
        let along = DVector::from_fn(half_axes.len(), |i, _| half_axes[i] * at[i]);
        InitialState::at((&self.directions * along).as_slice())
    }
}

/// The largest ellipsoid of a design's shape from which `outcomes` says that 95 % are stabilised;
/// none if there is none.
///
/// # Errors
/// Those of `outcomes`.
pub(super) fn ellipsoid(
    model: &Model,
    design: &Design,
    mut outcomes: impl FnMut(&[InitialState]) -> Result<Vec<Outcome>>,
) -> Result<Option<Ellipsoid>> {
    let shape = Shape::of(model, design);
    let mut stabilised = |shortest_rad: f64| -> Result<usize> {
        let starts: Vec<InitialState> = (0..RUNS)
            .map(|run| shape.start(shortest_rad, run))
            .collect();
        let outcomes = outcomes(&starts)?;
        Ok(outcomes.iter().filter(|one| one.stabilised).count())
    };
    let enough = |count: usize| count as f64 >= STABILISED_SHARE * RUNS as f64;
    let open = enough(stabilised(LARGEST_REGION_RAD)?);
    let shortest_rad = if open {
        LARGEST_REGION_RAD
    } else {
        let holds = |shortest_rad| Ok(enough(stabilised(shortest_rad)?));
        bisect(0.0, LARGEST_REGION_RAD, HALVINGS, holds)?.0
    };
    if shortest_rad == 0.0 {
        return Ok(None);
    }
    let directions = shape.directions.column_iter();
    Ok(Some(Ellipsoid {
        half_axes_rad: shape.half_axes(shortest_rad),
        directions: directions
            .map(|axis| axis.iter().copied().collect())
            .collect(),
        open,
        runs: RUNS as usize,
        stabilised: stabilised(shortest_rad)?,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::{CostWeights, Request};
    use crate::{left_out, verify};
    use std::path::Path;

    /// The weak direction is that of an independent computation; across it the region is wide.
    #[test]
    fn the_paper_s_robot_is_weak_in_one_direction() {
        let text = include_str!("../../models/handstand.toml").to_string()
            + "\n[[effect]]\nkind = \"torque_saturation\"\njoint = \"all\"\nlimit_nm = 2.0\n";
        let model = Model::parse(&text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            weights: CostWeights::PAPER,
            ..Request::standard(&model)
        };
        let design = Design::of(&model, &request).unwrap();
        let left_out = left_out(&model, &model, &design);
        let verified = verify(&model, &design, &request, &left_out, &|| ()).unwrap();
        let found = verified.ellipsoid.unwrap();
        let sign = -found.directions[0][0].signum();
        for (share, expected) in found.directions[0].iter().zip([-0.90, -0.40, -0.14]) {
            assert!((sign * share - expected).abs() < 0.01, "{found:?}");
        }
        let [weak, middle, strong] = found.half_axes_rad[..] else {
            panic!("{found:?}");
        };
        assert!((1.5..4.0).contains(&weak.to_degrees()), "{found:?}");
        assert!(middle.to_degrees() > 10.0 && strong.to_degrees() > 10.0);
        assert!(found.stabilised as f64 >= STABILISED_SHARE * found.runs as f64);
        // Its starts are where it says.
        let shape = Shape::of(&model, &design);
        for run in 0..50 {
            let start = DVector::from_vec(shape.start(weak, run).angle_rad);
            let along = shape.directions.transpose() * start;
            let share = along.iter().zip(&found.half_axes_rad);
            let share: f64 = share.map(|(along, axis)| (along / axis).powi(2)).sum();
            assert!(share <= 1.0 + 1e-9, "{share}");
        }
    }
}
