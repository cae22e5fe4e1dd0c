//! A moving link in axes that do not turn: what both recursions along the chain start from.

use super::chain::ChainLink;
use super::lanes::Lane;

/// Positions and velocity terms of a link, relative to its own joint.
///
/// The link's end lies at length (sin, -cos), so a quarter turn to the left of it is length (cos,
/// sin).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LinkMotion {
    /// Joint to next joint, wherever that has slid, turned left: velocity of its end per rad/s, m.
    pub lever: [f64; 2],
    /// Acceleration of the link's end at constant speeds, m/s^2: centripetal, and Coriolis of a
    /// slide.
    pub centripetal: [f64; 2],
    /// First moment about the joint, turned left, kg m.
    pub moment: [f64; 2],
    /// Square of the angular velocity, rad^2/s^2.
    pub speed_squared: f64,
}

impl LinkMotion {
    /// At an absolute angle, rad, and angular velocity, rad/s.
    #[inline(always)]
    pub fn new(link: &ChainLink, angle_rad: f64, speed_rad_s: f64) -> LinkMotion {
        let (sin, cos) = Lane::sin_cos(angle_rad);
        let (com_sin, com_cos) = if link.com_angle_rad == 0.0 {
            (sin, cos)
        } else {
            Lane::sin_cos(angle_rad + link.com_angle_rad)
        };
        let first_moment = link.mass_kg * link.com_m;
        let speed_squared = speed_rad_s * speed_rad_s;
        let lever = [link.length_m * cos, link.length_m * sin];
        LinkMotion {
            lever,
            centripetal: [-speed_squared * lever[1], speed_squared * lever[0]],
            moment: [first_moment * com_cos, first_moment * com_sin],
            speed_squared,
        }
    }

    /// Moves the link's end on to where the next joint has slid: by `q`, m, at `rate`, m/s, along a
    /// direction that the link carries with it, given turned left; `speed_rad_s` is the link's.
    #[inline]
    pub fn extend(&mut self, left: [f64; 2], q: f64, rate: f64, speed_rad_s: f64) {
        let coriolis = 2.0 * rate * speed_rad_s;
        let ahead = q * self.speed_squared;
        self.lever[0] += q * left[0];
        self.lever[1] += q * left[1];
        self.centripetal[0] += coriolis * left[0] - ahead * left[1];
        self.centripetal[1] += coriolis * left[1] + ahead * left[0];
    }

    /// Acceleration of the link's end, m/s^2, from that of its joint and the link's angular
    /// acceleration.
    #[inline(always)]
    pub fn end_m_s2(&self, joint_m_s2: [f64; 2], angular_rad_s2: f64) -> [f64; 2] {
        [
            joint_m_s2[0] + self.centripetal[0] + angular_rad_s2 * self.lever[0],
            joint_m_s2[1] + self.centripetal[1] + angular_rad_s2 * self.lever[1],
        ]
    }
}
