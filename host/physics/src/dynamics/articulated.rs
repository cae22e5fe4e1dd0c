//! Forward dynamics by articulated bodies, reduced to the plane.
//!
//! Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 7, with spatial vectors of three
//! entries (moment, force x, force y) taken at each link's own joint in axes that do not turn. A
//! held joint passes its inertia on whole and reports the torque that holds it: that is how
//! friction keeps a joint at rest exactly.

use super::chain::{Chain, ChainLink};
use super::lanes::Lane;
use super::link_motion::LinkMotion;

pub use free_base::FreeBase;

/// Scratch memory of [`Chain::forward`], reused from call to call.
#[derive(Debug, Clone)]
pub struct Workspace {
    links: Vec<Scratch>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Scratch {
    motion: LinkMotion,
    /// Direction of a joint that slides.
    along: [f64; 2],
    /// Share of the link before's angular acceleration that the link takes on, the rest left to the
    /// joint; of a held joint, its torque per unit of that acceleration. Of a joint that slides,
    /// its own acceleration, or force, likewise: so in the two below.
    carried: f64,
    /// Angular acceleration per unit of the joint's acceleration (x, y); of a held joint, torque
    /// instead.
    pull: [f64; 2],
    /// Angular acceleration with all else at rest; of a held joint, torque instead.
    own: f64,
}

/// What a subtree asks of the joint it hangs on: inertia [[inertia, b], [b, mass]], bias moment and
/// force.
#[derive(Debug, Clone, Copy, Default)]
struct Subtree {
    inertia: f64,
    b: [f64; 2],
    mass: [f64; 3],
    moment: f64,
    force: [f64; 2],
}

impl Workspace {
    /// Memory for a chain of `links` links.
    pub fn new(links: usize) -> Self {
        Workspace {
            links: vec![Scratch::default(); links],
        }
    }
}

impl Chain {
    /// Accelerations of the joints, rad/s^2, into `out`; m/s^2 and forces, N, of those that slide.
    ///
    /// `base_m_s2` is the acceleration of the base that stands for gravity, from
    /// [`Chain::base_m_s2`]. Where `held[i]`, the joint does not move (its speed must be 0) and
    /// `out[i]` is instead the torque, N m, that must be added to `torque_nm[i]` to keep it so. All
    /// slices have the chain's length.
    #[inline]
    #[allow(clippy::too_many_arguments)]
    pub fn forward(
        &self,
        work: &mut Workspace,
        base_m_s2: [f64; 2],
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        torque_nm: &[f64],
        held: &[bool],
        out: &mut [f64],
    ) {
        let n = self.links.len();
        if n == 1 && self.links[0].slide.is_none() {
            let (angle, torque) = (angle_rad[0], torque_nm[0]);
            out[0] = self.links[0].forward(base_m_s2, angle, torque, held[0]);
            return;
        }
        let scratch = &mut work.links[..n];
        let (angle_rad, speed_rad_s, torque_nm) =
            (&angle_rad[..n], &speed_rad_s[..n], &torque_nm[..n]);
        let (held, out) = (&held[..n], &mut out[..n]);

        self.find_motions(scratch, angle_rad, speed_rad_s);
        self.gather(scratch, torque_nm, held);
        self.spread(scratch, base_m_s2, held, out);
    }

    /// From the base outwards: the accelerations, the base having this one.
    #[inline(always)]
    fn spread(&self, scratch: &[Scratch], base_m_s2: [f64; 2], held: &[bool], out: &mut [f64]) {
        let mut linear = base_m_s2;
        let mut angular = 0.0;
        for (i, (s, link)) in scratch.iter().zip(&self.links).enumerate() {
            let value =
                (s.own + s.carried * angular) + (s.pull[0] * linear[0] + s.pull[1] * linear[1]);
            if link.slide.is_some() {
                out[i] = value;
                if !held[i] {
                    linear = [0, 1].map(|k| linear[k] + value * s.along[k]);
                }
            } else if held[i] {
                out[i] = value;
            } else {
                out[i] = value - angular;
                angular = value;
            }
            linear = s.motion.end_m_s2(linear, angular);
        }
    }

    /// From the base outwards: how every link lies and moves.
    #[inline(always)]
    fn find_motions(&self, scratch: &mut [Scratch], angle_rad: &[f64], speed_rad_s: &[f64]) {
        let (mut angle, mut speed) = (0.0, 0.0);
        let mut before: Option<&mut LinkMotion> = None;
        for (i, (s, link)) in scratch.iter_mut().zip(&self.links).enumerate() {
            if let Some(slide) = &link.slide {
                let (along, left) = slide.along(angle);
                if let Some(before) = before {
                    before.extend(left, angle_rad[i], speed_rad_s[i], speed);
                }
                s.along = along;
                angle += slide.link_rad;
            } else {
                angle += angle_rad[i];
                speed += speed_rad_s[i];
            }
            s.motion = LinkMotion::new(link, angle, speed);
            before = Some(&mut s.motion);
        }
    }

    /// From the tip inwards: what every subtree asks of its joint. Returns what the chain asks of
    /// its base.
    #[inline(always)]
    fn gather(&self, scratch: &mut [Scratch], torque_nm: &[f64], held: &[bool]) -> Subtree {
        let mut tree = Subtree::default();
        for (i, (s, link)) in scratch.iter_mut().zip(&self.links).enumerate().rev() {
            tree.shift(s.motion.lever, s.motion.centripetal);
            tree.add(link, &s.motion);
            if link.slide.is_some() {
                s.slid(&mut tree, link.armature_kg_m2, torque_nm[i], held[i]);
                continue;
            }
            let torque = torque_nm[i] - tree.moment;
            if held[i] {
                // A held joint carries whatever moment comes.
                s.carried = tree.inertia;
                s.pull = tree.b;
                s.own = -torque;
            } else {
                let inverse = 1.0 / (tree.inertia + link.armature_kg_m2);
                s.carried = link.armature_kg_m2 * inverse;
                s.pull = [-tree.b[0] * inverse, -tree.b[1] * inverse];
                s.own = torque * inverse;
                tree.yield_to(inverse, s.carried, torque);
            }
        }
        tree
    }
}

impl Scratch {
    /// A joint that slides: what it needs of the link before it, and what it leaves to that link.
    fn slid(&mut self, tree: &mut Subtree, armature_kg: f64, force_n: f64, held: bool) {
        let [x, y] = self.along;
        let force = force_n - (x * tree.force[0] + y * tree.force[1]);
        let moment = x * tree.b[0] + y * tree.b[1];
        let pull = [
            tree.mass[0] * x + tree.mass[1] * y,
            tree.mass[1] * x + tree.mass[2] * y,
        ];
        if held {
            (self.carried, self.pull, self.own) = (moment, pull, -force);
            return;
        }
        let inverse = 1.0 / (x * pull[0] + y * pull[1] + armature_kg);
        self.carried = -moment * inverse;
        self.pull = pull.map(|pull| -pull * inverse);
        self.own = force * inverse;
        tree.moment += moment * self.own;
        tree.inertia += moment * self.carried;
        for k in [0, 1] {
            tree.force[k] += pull[k] * self.own;
            tree.b[k] += moment * self.pull[k];
        }
        tree.mass[0] += pull[0] * self.pull[0];
        tree.mass[1] += pull[0] * self.pull[1];
        tree.mass[2] += pull[1] * self.pull[1];
    }
}

impl ChainLink {
    /// [`Chain::forward`] of a chain of this link alone: a servo arm on its bench, which is fitted
    /// thousands of times.
    #[inline]
    fn forward(&self, base_m_s2: [f64; 2], angle_rad: f64, torque_nm: f64, held: bool) -> f64 {
        let (sin, cos) = Lane::sin_cos(angle_rad + self.com_angle_rad);
        let first_moment = self.mass_kg * self.com_m;
        let pushed = torque_nm - first_moment * (cos * base_m_s2[0] + sin * base_m_s2[1]);
        if held {
            return -pushed;
        }
        pushed / (self.inertia_kg_m2 + first_moment * self.com_m + self.armature_kg_m2)
    }
}

impl Subtree {
    /// From the link's end to its own joint.
    #[inline]
    fn shift(&mut self, l: [f64; 2], c: [f64; 2]) {
        let (b, mass) = (self.b, self.mass);
        let ml = [
            mass[0] * l[0] + mass[1] * l[1],
            mass[1] * l[0] + mass[2] * l[1],
        ];
        let force = [
            self.force[0] + mass[0] * c[0] + mass[1] * c[1],
            self.force[1] + mass[1] * c[0] + mass[2] * c[1],
        ];
        self.inertia += 2.0 * (b[0] * l[0] + b[1] * l[1]) + (l[0] * ml[0] + l[1] * ml[1]);
        self.b = [b[0] + ml[0], b[1] + ml[1]];
        self.moment += (b[0] * c[0] + b[1] * c[1]) + (l[0] * force[0] + l[1] * force[1]);
        self.force = force;
    }

    /// The link itself.
    #[inline(always)]
    fn add(&mut self, link: &ChainLink, at: &LinkMotion) {
        self.inertia += link.inertia_kg_m2 + link.mass_kg * link.com_m * link.com_m;
        self.b[0] += at.moment[0];
        self.b[1] += at.moment[1];
        self.mass[0] += link.mass_kg;
        self.mass[2] += link.mass_kg;
        self.force[0] -= at.speed_squared * at.moment[1];
        self.force[1] += at.speed_squared * at.moment[0];
    }

    /// What is left for the link before when the joint gives way: `carried` of the inertia, the
    /// armature's share.
    #[inline]
    fn yield_to(&mut self, inverse: f64, carried: f64, torque: f64) {
        let (b, given) = (self.b, inverse * torque);
        self.moment += self.inertia * given;
        self.force[0] += b[0] * given;
        self.force[1] += b[1] * given;
        self.mass[0] -= (b[0] * b[0]) * inverse;
        self.mass[1] -= (b[0] * b[1]) * inverse;
        self.mass[2] -= (b[1] * b[1]) * inverse;
        self.inertia *= carried;
        self.b = b.map(|b| b * carried);
    }
}

mod free_base;
#[cfg(test)]
mod tests;
