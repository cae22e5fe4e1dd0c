//! One number per joint: in place where there is one joint, as on a servo's bench, else on the heap.
//!
//! The equations are written once; with a single joint known when they are compiled, no loop is left of them.

use std::fmt::Debug;
use std::ops::IndexMut;

/// How rows of one number per joint are kept.
pub(super) trait Rows {
    /// A row.
    type Of<T: Copy + Debug>: Clone + Debug + AsRef<[T]> + AsMut<[T]> + IndexMut<usize, Output = T>;

    /// A row of this value for each of `joints`.
    fn filled<T: Copy + Debug>(value: T, joints: usize) -> Self::Of<T>;
}

/// A single joint.
#[derive(Debug, Clone)]
pub(super) struct One;

impl Rows for One {
    type Of<T: Copy + Debug> = [T; 1];

    fn filled<T: Copy + Debug>(value: T, _: usize) -> [T; 1] {
        [value]
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
