//! One number per joint: in place for a few joints, else on the heap.
//!
//! The equations are written once; where the number of joints is known when they are compiled,
//! their loops are unrolled.
//!
//! Rests on it in `cargo xtask peers`: "closed-loop run of 5 s, with effects: numba".

use super::plant::Plant;
use crate::dynamics::{Chain, Dense};
use std::fmt::Debug;
use std::ops::IndexMut;

/// How rows of one number per joint are kept.
pub(super) trait Rows {
    /// A row.
    type Of<T: Copy + Debug>: Clone + Debug + AsRef<[T]> + AsMut<[T]> + IndexMut<usize, Output = T>;

    /// Equations in closed form, where they are faster than recursion along the chain.
    type Closed: Clone + Debug;

    /// A row of this value for each of `joints`.
    fn filled<T: Copy + Debug>(value: T, joints: usize) -> Self::Of<T>;

    /// The equations of this chain of a plant, of that many joints.
    fn closed(plant: &Plant, chain: &Chain) -> Self::Closed;

    /// What [`Chain::forward`](crate::dynamics::Chain::forward) gives; none where it is to do it.
    fn forward(
        closed: &Self::Closed,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        torque_nm: &Self::Of<f64>,
        held: &Self::Of<bool>,
    ) -> Option<Self::Of<f64>>;

    /// A step of `h` s under constant torques, by the equations in closed form; false where there
    /// are none. `first` are the accelerations at its beginning where they are known already.
    fn step(
        closed: &Self::Closed,
        angle_rad: &mut Self::Of<f64>,
        speed_rad_s: &mut Self::Of<f64>,
        torque_nm: &Self::Of<f64>,
        held: &Self::Of<bool>,
        h: f64,
        first: Option<&Self::Of<f64>>,
    ) -> bool;
}

/// `N` joints.
#[derive(Debug, Clone)]
pub(super) struct FixedRows<const N: usize>;

impl<const N: usize> Rows for FixedRows<N> {
    type Of<T: Copy + Debug> = [T; N];
    type Closed = Option<Dense<N>>;

    fn filled<T: Copy + Debug>(value: T, _: usize) -> [T; N] {
        [value; N]
    }

    fn closed(plant: &Plant, chain: &Chain) -> Option<Dense<N>> {
        // One link has a formula of its own, and a tree in space none.
        match N {
            1 => None,
            _ if plant.tree.is_some() => None,
            _ => Dense::new(chain, plant.rig.gravity_turn_rad),
        }
    }

    #[inline]
    fn forward(
        closed: &Option<Dense<N>>,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        torque_nm: &[f64; N],
        held: &[bool; N],
    ) -> Option<[f64; N]> {
        let (angle, speed) = (angle_rad.try_into().ok()?, speed_rad_s.try_into().ok()?);
        Some(closed.as_ref()?.forward(angle, speed, torque_nm, held))
    }

    #[inline]
    fn step(
        closed: &Option<Dense<N>>,
        angle_rad: &mut [f64; N],
        speed_rad_s: &mut [f64; N],
        torque_nm: &[f64; N],
        held: &[bool; N],
        h: f64,
        first: Option<&[f64; N]>,
    ) -> bool {
        let Some(dense) = closed else {
            return false;
        };
        dense.step(angle_rad, speed_rad_s, torque_nm, held, h, first);
        true
    }
}

/// Any number of joints.
#[derive(Debug, Clone)]
pub(super) struct DynamicRows;

impl Rows for DynamicRows {
    type Of<T: Copy + Debug> = Vec<T>;
    type Closed = ();

    fn filled<T: Copy + Debug>(value: T, joints: usize) -> Vec<T> {
        vec![value; joints]
    }

    fn closed(_: &Plant, _: &Chain) {}

    fn forward((): &(), _: &[f64], _: &[f64], _: &Vec<f64>, _: &Vec<bool>) -> Option<Vec<f64>> {
        None
    }

    fn step(
        (): &(),
        _: &mut Vec<f64>,
        _: &mut Vec<f64>,
        _: &Vec<f64>,
        _: &Vec<bool>,
        _: f64,
        _: Option<&Vec<f64>>,
    ) -> bool {
        false
    }
}
