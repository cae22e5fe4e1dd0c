//! Inverse dynamics by recursive Newton-Euler, in the plane.

use super::chain::{Chain, ChainLink};
use super::link_motion::LinkMotion;

/// Absolute angle, angular velocity and angular acceleration of a link, and the acceleration of its
/// joint.
#[derive(Clone, Copy)]
struct LinkState {
    link: [f64; 3],
    joint_m_s2: [f64; 2],
}

impl Chain {
    /// Joint torques, N m, into `out`, that give the chain these accelerations.
    ///
    /// `gravity_turn_rad` turns gravity counter-clockwise. All slices have the chain's length.
    pub fn inverse(
        &self,
        gravity_turn_rad: f64,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        acceleration_rad_s2: &[f64],
        out: &mut [f64],
    ) {
        let joints = [angle_rad, speed_rad_s, acceleration_rad_s2];
        self.newton_euler(gravity_turn_rad, joints, |i, moment, force| {
            let own = match &self.links[i].slide {
                None => moment,
                Some(slide) => {
                    let ([x, y], _) = slide.along(self.angle_before_rad(i, angle_rad));
                    x * force[0] + y * force[1]
                }
            };
            out[i] = own + self.links[i].armature_kg_m2 * acceleration_rad_s2[i];
        });
    }

    /// Angle of the link before a joint from hanging, rad.
    fn angle_before_rad(&self, joint: usize, angle_rad: &[f64]) -> f64 {
        let links = self.links[..joint].iter().zip(angle_rad);
        let turn = |(link, angle): (&ChainLink, &f64)| link.slide.map_or(*angle, |s| s.link_rad);
        links.map(turn).sum()
    }

    /// Calls `each` with every joint's index and what its bearing passes on, moment, N m, and
    /// force, N, from the tip to the base. `joints` are angles, speeds and accelerations.
    pub fn newton_euler(
        &self,
        gravity_turn_rad: f64,
        joints: [&[f64]; 3],
        mut each: impl FnMut(usize, f64, [f64; 2]),
    ) {
        let base = LinkState {
            link: [0.0; 3],
            joint_m_s2: self.base_m_s2(gravity_turn_rad),
        };
        self.newton_euler_from(0, base, joints, &mut each);
    }

    /// Speeds and accelerations outwards, then moment and force that link `i` and all beyond it ask
    /// of its joint.
    fn newton_euler_from(
        &self,
        i: usize,
        before: LinkState,
        joints: [&[f64]; 3],
        each: &mut impl FnMut(usize, f64, [f64; 2]),
    ) -> (f64, [f64; 2]) {
        let Some(link) = self.links.get(i) else {
            return (0.0, [0.0; 2]);
        };
        let mut linear = before.joint_m_s2;
        let own = match &link.slide {
            None => std::array::from_fn(|k| before.link[k] + joints[k][i]),
            Some(slide) => {
                let (along, _) = slide.along(before.link[0]);
                linear = [0, 1].map(|k| linear[k] + joints[2][i] * along[k]);
                let [angle, speed, acceleration] = before.link;
                [angle + slide.link_rad, speed, acceleration]
            }
        };
        let [angle, speed, acceleration] = own;
        let mut at = LinkMotion::new(link, angle, speed);
        if let Some(slide) = self.links.get(i + 1).and_then(|next| next.slide) {
            let (_, left) = slide.along(angle);
            at.extend(left, joints[0][i + 1], joints[1][i + 1], speed);
        }
        let next = LinkState {
            link: own,
            joint_m_s2: at.end_m_s2(linear, acceleration),
        };
        let (beyond_moment, beyond) = self.newton_euler_from(i + 1, next, joints, each);
        let [x, y] = at.moment;
        let force = [
            beyond[0] + link.mass_kg * linear[0] + acceleration * x - at.speed_squared * y,
            beyond[1] + link.mass_kg * linear[1] + acceleration * y + at.speed_squared * x,
        ];
        let inertia = link.inertia_kg_m2 + link.mass_kg * link.com_m * link.com_m;
        let moment = beyond_moment
            + (at.lever[0] * beyond[0] + at.lever[1] * beyond[1])
            + inertia * acceleration
            + (x * linear[0] + y * linear[1]);
        each(i, moment, force);
        (moment, force)
    }
}
