//! Unknowns of a motion's beginning in a fit: what was before the log acts on through all of its
//! windows, so that none of them may have a value of its own.
//!
//! In the arrow of the Jacobian they stand between the values, which all motions share, and the
//! start states, which each window has alone: windows are eliminated first, then these.

use super::normal::WindowJacobian;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// What one window tells of them.
#[derive(Debug, Clone)]
pub(super) struct MotionStart {
    /// Their places among the unknowns of a window's start.
    pub places: Vec<usize>,
    /// d(prediction) / d(unknown), weighted.
    pub columns: DMatrix<f64>,
    /// The window's part of their prior, and their pull towards the guess.
    pub precision: DVector<f64>,
    pub pull: DVector<f64>,
    /// Side on which each lies at the edge of what it may be; 0 inside.
    pub edge: Vec<f64>,
}

impl MotionStart {
    /// Those at these places of a start's derivatives, which are then no longer the window's own.
    pub fn parted_from(window_start: &mut DMatrix<f64>, places: &[usize]) -> MotionStart {
        let columns = window_start.select_columns(places);
        for &place in places {
            window_start.column_mut(place).fill(0.0);
        }
        MotionStart {
            places: places.to_vec(),
            columns,
            precision: DVector::zeros(places.len()),
            pull: DVector::zeros(places.len()),
            edge: vec![0.0; places.len()],
        }
    }
}

impl WindowJacobian {
    /// d(prediction) / d(start), the motion's unknowns included.
    pub fn all_starts(&self) -> DMatrix<f64> {
        let mut all = self.window_start.clone();
        for (column, &place) in self.motion_start.places.iter().enumerate() {
            all.set_column(place, &self.motion_start.columns.column(column));
        }
        all
    }

    /// Unknowns of the start, the motion's among them.
    pub fn starts(&self) -> usize {
        self.window_start.ncols()
    }

    /// Takes what is known of the start beforehand, and where it lies at an edge.
    pub fn know_start(
        &mut self,
        (mut precision, mut pull): (DVector<f64>, DVector<f64>),
        mut edge: Vec<f64>,
    ) {
        let motion = &mut self.motion_start;
        for (k, &place) in motion.places.iter().enumerate() {
            motion.precision[k] = precision[place];
            motion.pull[k] = pull[place];
            motion.edge[k] = edge[place];
            (precision[place], pull[place], edge[place]) = (1.0, 0.0, 0.0);
        }
        self.start_precision = precision;
        self.start_pull = pull;
        self.start_edge = edge;
        self.hold_edges();
    }
}

/// Normal equations of a motion's values and unknowns, its windows' own starts eliminated.
pub(super) struct MotionNormal {
    /// The values' part, then reduced.
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
}

/// What recovers the step of a motion's unknowns from that of the values.
#[derive(Debug, Clone)]
pub(super) struct MotionBlock {
    inverse: DMatrix<f64>,
    gradient: DVector<f64>,
    /// Unknowns of the motion by values.
    coupling: DMatrix<f64>,
}

impl MotionNormal {
    /// For so many values and the unknowns of the motion.
    pub fn zeros(size: usize) -> MotionNormal {
        MotionNormal {
            matrix: DMatrix::zeros(size, size),
            gradient: DVector::zeros(size),
        }
    }

    /// Eliminates the unknowns of the motion of these windows behind the first `values`.
    pub fn eliminate(
        &mut self,
        values: usize,
        windows: &[WindowJacobian],
        damping: f64,
    ) -> MotionBlock {
        let unknowns = self.gradient.len() - values;
        let mut own = self
            .matrix
            .view((values, values), (unknowns, unknowns))
            .into_owned();
        let mut gradient = self.gradient.rows(values, unknowns).into_owned();
        let mut coupling = self
            .matrix
            .view((values, 0), (unknowns, values))
            .into_owned();
        for start in windows.iter().map(|window| &window.motion_start) {
            own += DMatrix::from_diagonal(&start.precision);
            gradient += start.precision.component_mul(&start.pull);
        }
        let edge = windows
            .first()
            .map(|window| window.motion_start.edge.as_slice());
        for k in 0..unknowns {
            own[(k, k)] *= 1.0 + damping;
            own[(k, k)] += 1e-12;
            // It would leave by the edge on which it lies.
            if edge.is_some_and(|edge| edge[k] * gradient[k] > 0.0) {
                own.row_mut(k).fill(0.0);
                own.column_mut(k).fill(0.0);
                own[(k, k)] = 1.0;
                gradient[k] = 0.0;
                coupling.row_mut(k).fill(0.0);
            }
        }
        let inverse = own
            .try_inverse()
            .unwrap_or_else(|| DMatrix::zeros(unknowns, unknowns));
        let spent = coupling.tr_mul(&inverse);
        self.matrix = self.matrix.view((0, 0), (values, values)) - &spent * &coupling;
        self.gradient = self.gradient.rows(0, values) - &spent * &gradient;
        MotionBlock {
            inverse,
            gradient,
            coupling,
        }
    }
}

impl MotionBlock {
    /// Step of the unknowns that goes with this step of the values.
    pub fn step(&self, values: &DVector<f64>) -> DVector<f64> {
        &self.inverse * (&self.gradient - &self.coupling * values)
    }
}

/// What the unknowns of motions' beginnings can imitate of residuals from which each window's own
/// start is taken out.
#[derive(Debug)]
pub(super) struct MotionStarts(Vec<Imitation>);

/// Of one motion.
#[derive(Debug)]
struct Imitation {
    windows: Range<usize>,
    columns: Vec<DMatrix<f64>>,
    inverse: DMatrix<f64>,
    pull: DVector<f64>,
    /// What the prior adds to the squared error as it stands.
    cost: f64,
}

impl MotionStarts {
    /// Of a fit's windows.
    pub fn of(windows: &[WindowJacobian]) -> MotionStarts {
        let mut begin = 0;
        let mut all = Vec::new();
        for windows in windows.chunk_by(|a, b| a.motion == b.motion) {
            let range = begin..begin + windows.len();
            begin = range.end;
            if windows[0].motion_start.places.is_empty() {
                continue;
            }
            let reduced = |window: &WindowJacobian| window.reduced(&window.motion_start.columns);
            let columns: Vec<DMatrix<f64>> = windows.iter().map(reduced).collect();
            let size = windows[0].motion_start.places.len();
            let mut own = DMatrix::from_diagonal_element(size, size, 1e-12);
            let (mut pull, mut cost) = (DVector::zeros(size), 0.0);
            for (columns, window) in columns.iter().zip(windows) {
                let start = &window.motion_start;
                own += columns.tr_mul(columns) + DMatrix::from_diagonal(&start.precision);
                let pulled = start.precision.component_mul(&start.pull);
                cost += pulled.dot(&start.pull);
                pull += pulled;
            }
            all.push(Imitation {
                windows: range,
                columns,
                inverse: own
                    .try_inverse()
                    .unwrap_or_else(|| DMatrix::zeros(size, size)),
                pull,
                cost,
            });
        }
        MotionStarts(all)
    }

    /// Takes it out of these columns, window by window.
    pub fn take_out(&self, of: &mut [DMatrix<f64>]) {
        for own in &self.0 {
            let of = &mut of[own.windows.clone()];
            let parts = own.columns.iter().zip(&*of);
            let along = parts
                .map(|(columns, of)| columns.tr_mul(of))
                .reduce(|a, b| a + b);
            let Some(along) = along else { continue };
            let made = &own.inverse * along;
            for (of, columns) in of.iter_mut().zip(&own.columns) {
                *of -= columns * &made;
            }
        }
    }

    /// By how much less the squared error would be.
    pub fn removable(&self, windows: &[WindowJacobian]) -> f64 {
        let of = |own: &Imitation| {
            let windows = own.columns.iter().zip(&windows[own.windows.clone()]);
            let along = windows.map(|(columns, window)| {
                let start = window.start_step_alone();
                columns.tr_mul(&(&window.residual - &window.window_start * start))
            });
            let gradient = along.fold(own.pull.clone(), |sum, along| sum + along);
            gradient.dot(&(&own.inverse * &gradient)) - own.cost
        };
        self.0.iter().map(of).sum()
    }
}

/// Columns of the values of these windows without what start states, and what was before the log,
/// could explain.
pub(super) fn reduced_parameters(windows: &[WindowJacobian]) -> Vec<DMatrix<f64>> {
    let reduced = windows
        .iter()
        .map(|window| window.reduced(&window.parameters));
    let mut reduced: Vec<DMatrix<f64>> = reduced.collect();
    MotionStarts::of(windows).take_out(&mut reduced);
    reduced
}
