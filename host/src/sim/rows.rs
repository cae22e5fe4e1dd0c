//! One number per joint: in place for a few joints, else on the heap.
//!
//! The equations are written once; where the number of joints is known when they are compiled,
//! their loops are unrolled.

use std::fmt::Debug;
use std::ops::IndexMut;

/// How rows of one number per joint are kept.
pub(super) trait Rows {
    /// A row.
    type Of<T: Copy + Debug>: Clone + Debug + AsRef<[T]> + AsMut<[T]> + IndexMut<usize, Output = T>;

    /// A row of this value for each of `joints`.
    fn filled<T: Copy + Debug>(value: T, joints: usize) -> Self::Of<T>;
}

/// `N` joints.
#[derive(Debug, Clone)]
pub(super) struct Few<const N: usize>;

impl<const N: usize> Rows for Few<N> {
    type Of<T: Copy + Debug> = [T; N];

    fn filled<T: Copy + Debug>(value: T, _: usize) -> [T; N] {
        [value; N]
    }
}

/// Any number of joints.
#[derive(Debug, Clone)]
pub(super) struct Many;

impl Rows for Many {
    type Of<T: Copy + Debug> = Vec<T>;

    fn filled<T: Copy + Debug>(value: T, joints: usize) -> Vec<T> {
        vec![value; joints]
    }
}
