//! A shape as a robot's file writes it.

use crate::error::Result;
use crate::model::import::Solid;
use nalgebra::{Isometry3, Vector3};

/// What a shape is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Looks {
    /// To be seen.
    Visual,
    /// To collide; seen where what is to be seen cannot be drawn.
    Collision,
}

/// A shape that a file describes, or what is wrong with it.
pub(super) type Described = (Looks, Result<Drawn>);

/// A shape of a body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drawn {
    /// In the body's frame.
    pub pose: Isometry3<f64>,
    pub shape: DrawnShape,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum DrawnShape {
    Solid(Solid),
    Mesh { name: String, scale: Vector3<f64> },
}
