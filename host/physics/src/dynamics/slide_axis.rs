//! The axis of a joint that slides.

use super::lanes::Lane;

/// Along what a joint slides, and how its link stands: constants of a [`ChainLink`].
///
/// [`ChainLink`]: super::ChainLink
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlideAxis {
    /// Direction of a growing displacement from the line of the link before, rad,
    /// counter-clockwise; of the first joint from hanging.
    pub direction_rad: f64,
    /// Angle of the link from the line of the link before, rad, likewise.
    pub link_rad: f64,
}

impl SlideAxis {
    /// Unit vectors along the slide and a quarter turn left of it, where the link before stands at
    /// `before_rad` from hanging.
    #[inline(always)]
    pub(super) fn along(&self, before_rad: f64) -> ([f64; 2], [f64; 2]) {
        let (sin, cos) = Lane::sin_cos(before_rad + self.direction_rad);
        ([sin, -cos], [cos, sin])
    }
}
