//! The equations of motion of a tree in space.
//!
//! Featherstone, Rigid Body Dynamics Algorithms (2008): articulated bodies (section 7.3) forwards,
//! recursive Newton-Euler (section 5.3) backwards. Every link's vectors are in a frame of its own
//! whose third axis is its joint's: what a joint moves is then a column, and its turn mixes two. A
//! held joint passes the inertia of what it carries on whole, as in a planar chain
//! ([`Chain::forward`](crate::dynamics::Chain::forward)).

use super::SpatialTree;
use super::carried::{Carried, Spatial};
use super::small::{Matrix, Symmetric, Vector, cross, dot, plus, scaled, times, times_transposed};
use crate::dynamics::lanes::Lane;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// A [`SpatialTree`] made ready for computing.
#[derive(Debug, Clone)]
pub struct SpatialEquations {
    links: Vec<Link>,
    /// Acceleration of the base that stands for gravity.
    base_m_s2: Vector,
}

#[derive(Debug, Clone)]
struct Link {
    parent: Option<usize>,
    /// The frame at 0 in the parent's: its axes, and its origin.
    place: Matrix,
    origin: Vector,
    slides: bool,
    mass_kg: f64,
    /// Mass times centre of mass.
    moment: Vector,
    /// Moments of inertia about the frame's origin.
    inertia: Symmetric,
    armature: f64,
}

/// Scratch memory of [`SpatialEquations`], reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct SpatialWorkspace {
    links: Vec<Scratch>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Scratch {
    /// The frame's axes and origin in the parent's.
    axes: Matrix,
    origin: Vector,
    speed: Spatial,
    /// Acceleration that speeds alone give.
    bias: Spatial,
    acceleration: Spatial,
    inertia: Carried,
    /// Moment and force at no acceleration.
    force: Spatial,
    /// Moment and force per acceleration of the joint.
    pull: Spatial,
    /// One over the inertia that the joint's own torque meets.
    inverse: f64,
    /// Torque that is left to it.
    left: f64,
}

impl Scratch {
    /// A speed or an acceleration of the parent's frame, as this link's frame has it.
    #[inline(always)]
    fn carried_on(&self, parent: &Spatial) -> Spatial {
        let moved = plus(parent.shifting, cross(&parent.turning, &self.origin));
        Spatial {
            turning: times_transposed(&self.axes, &parent.turning),
            shifting: times_transposed(&self.axes, &moved),
        }
    }

    /// A moment and a force on this link, as they act on the parent's frame.
    #[inline(always)]
    fn handed_down(&self, force: &Spatial) -> Spatial {
        let shifting = times(&self.axes, &force.shifting);
        let turning = times(&self.axes, &force.turning);
        Spatial {
            turning: plus(turning, cross(&self.origin, &shifting)),
            shifting,
        }
    }
}

impl Link {
    fn rigid(&self) -> Carried {
        let [x, y, z] = self.moment;
        Carried {
            turning: self.inertia,
            mixed: [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]],
            shifting: Symmetric::diagonal(self.mass_kg),
        }
    }

    /// Moment and force of the rigid link at this acceleration.
    #[inline(always)]
    fn inertial(&self, a: &Spatial) -> Spatial {
        Spatial {
            turning: plus(
                self.inertia.times(&a.turning),
                cross(&self.moment, &a.shifting),
            ),
            shifting: plus(
                scaled(&a.shifting, self.mass_kg),
                cross(&a.turning, &self.moment),
            ),
        }
    }

    /// Moment and force that keep the link moving at this speed.
    #[inline(always)]
    fn gyroscopic(&self, speed: &Spatial) -> Spatial {
        let momentum = self.inertial(speed);
        Spatial {
            turning: plus(
                cross(&speed.turning, &momentum.turning),
                cross(&speed.shifting, &momentum.shifting),
            ),
            shifting: cross(&speed.turning, &momentum.shifting),
        }
    }
}

impl SpatialEquations {
    /// Of a tree as it is now.
    pub fn new(tree: &SpatialTree) -> Self {
        // From a link's frame to the one whose third axis is the joint's.
        let aligned: Vec<Matrix3<f64>> = (tree.links.iter())
            .map(|link| {
                let onto = UnitQuaternion::rotation_between(&Vector3::z(), &link.axis);
                let flipped =
                    UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
                onto.unwrap_or(flipped).to_rotation_matrix().into_inner()
            })
            .collect();
        let links = tree.links.iter().enumerate().map(|(i, link)| {
            let before = link.parent.map_or_else(Matrix3::identity, |p| aligned[p]);
            let place = link.place.rotation.to_rotation_matrix().into_inner();
            let com = aligned[i].tr_mul(&link.com_m);
            let arm = com.cross_matrix();
            let inertia =
                aligned[i].tr_mul(&link.inertia_kg_m2) * aligned[i] - arm * arm * link.mass_kg;
            Link {
                parent: link.parent,
                place: rows(&(before.tr_mul(&place) * aligned[i])),
                origin: before.tr_mul(&link.place.translation.vector).into(),
                slides: link.slides,
                mass_kg: link.mass_kg,
                moment: (com * link.mass_kg).into(),
                inertia: Symmetric::of(&rows(&inertia)),
                armature: link.armature_kg_m2,
            }
        });
        SpatialEquations {
            links: links.collect(),
            base_m_s2: (-tree.gravity_m_s2).into(),
        }
    }

    /// Number of links.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Whether there is no link.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Acceleration of what carries a link.
    #[inline(always)]
    fn before(&self, work: &SpatialWorkspace, link: &Link) -> Spatial {
        match link.parent {
            Some(parent) => work.links[parent].acceleration,
            None => Spatial {
                turning: [0.0; 3],
                shifting: self.base_m_s2,
            },
        }
    }

    /// From the base outwards: how every link lies and moves.
    #[inline(always)]
    fn find_motions(&self, work: &mut SpatialWorkspace, angle_rad: &[f64], speed_rad_s: &[f64]) {
        if work.links.len() != self.links.len() {
            work.links.resize(self.links.len(), Scratch::default());
        }
        for (i, link) in self.links.iter().enumerate() {
            let parent = link
                .parent
                .map_or(Spatial::default(), |p| work.links[p].speed);
            let (at, speed) = (&mut work.links[i], speed_rad_s[i]);
            let [x, y, z] = &link.place;
            if link.slides {
                let moved = scaled(&[x[2], y[2], z[2]], angle_rad[i]);
                (at.axes, at.origin) = (link.place, plus(link.origin, moved));
            } else {
                let (sin, cos) = Lane::sin_cos(angle_rad[i]);
                at.axes = [
                    [cos * x[0] + sin * x[1], cos * x[1] - sin * x[0], x[2]],
                    [cos * y[0] + sin * y[1], cos * y[1] - sin * y[0], y[2]],
                    [cos * z[0] + sin * z[1], cos * z[1] - sin * z[0], z[2]],
                ];
                at.origin = link.origin;
            }
            at.speed = at.carried_on(&parent);
            *at.speed.along(link.slides) += speed;
            let ([x, y, _], [u, v, _]) = (at.speed.turning, at.speed.shifting);
            at.bias = if link.slides {
                Spatial {
                    turning: [0.0; 3],
                    shifting: [y * speed, -x * speed, 0.0],
                }
            } else {
                Spatial {
                    turning: [y * speed, -x * speed, 0.0],
                    shifting: [v * speed, -u * speed, 0.0],
                }
            };
        }
    }

    /// Accelerations of the joints, rad/s^2, into `out`; of a slide in m/s^2.
    ///
    /// Where `held[i]`, the joint does not move (its speed must be 0) and `out[i]` is instead the
    /// torque, N m, that must be added to `torque_nm[i]` to keep it so. All slices have the tree's
    /// length.
    pub fn forward(
        &self,
        work: &mut SpatialWorkspace,
        [angle_rad, speed_rad_s, torque_nm]: [&[f64]; 3],
        held: &[bool],
        out: &mut [f64],
    ) {
        let n = self.links.len();
        let (angle_rad, speed_rad_s) = (&angle_rad[..n], &speed_rad_s[..n]);
        let (torque_nm, held, out) = (&torque_nm[..n], &held[..n], &mut out[..n]);
        self.find_motions(work, angle_rad, speed_rad_s);
        self.gather(work, torque_nm, held);
        for (i, link) in self.links.iter().enumerate() {
            let parent = self.before(work, link);
            let at = &mut work.links[i];
            let mut acceleration = at.carried_on(&parent);
            acceleration.add(&at.bias, 1.0);
            let pulled = at.pull.dot(&acceleration) - at.left;
            out[i] = if held[i] {
                pulled
            } else {
                -pulled * at.inverse
            };
            if !held[i] {
                *acceleration.along(link.slides) += out[i];
            }
            at.acceleration = acceleration;
        }
    }

    /// From the tips inwards: what everything behind a joint asks of it.
    #[inline(always)]
    fn gather(&self, work: &mut SpatialWorkspace, torque_nm: &[f64], held: &[bool]) {
        for (at, link) in work.links.iter_mut().zip(&self.links) {
            at.inertia = link.rigid();
            at.force = link.gyroscopic(&at.speed);
        }
        for (i, link) in self.links.iter().enumerate().rev() {
            let (carrying, carried) = work.links.split_at_mut(i);
            let at = &mut carried[0];
            let inertia = &mut at.inertia;
            let mixed = inertia.mixed;
            at.pull = if link.slides {
                Spatial {
                    turning: [mixed[0][2], mixed[1][2], mixed[2][2]],
                    shifting: inertia.shifting.column_2(),
                }
            } else {
                Spatial {
                    turning: inertia.turning.column_2(),
                    shifting: mixed[2],
                }
            };
            let (mut pull, mut force) = (at.pull, at.force);
            at.inverse = 1.0 / (*pull.along(link.slides) + link.armature);
            at.left = torque_nm[i] - *force.along(link.slides);
            let Some(parent) = link.parent else { continue };
            if !held[i] {
                inertia.give_way(&at.pull, at.inverse);
                force.add(&at.pull, at.left * at.inverse);
            }
            force.add(&inertia.times(&at.bias), 1.0);
            let parent = &mut carrying[parent];
            parent.inertia.add_seen(&at.inertia, &at.axes, &at.origin);
            parent.force.add(&at.handed_down(&force), 1.0);
        }
    }

    /// The inertia, kg m^2, that each joint's own torque meets at these angles while the others are
    /// free; of a slide in kg.
    pub fn joint_inertias(&self, angle_rad: &[f64]) -> Vec<f64> {
        let n = self.len();
        let mut work = SpatialWorkspace::default();
        let still = vec![0.0; n];
        self.find_motions(&mut work, angle_rad, &still);
        self.gather(&mut work, &still, &vec![false; n]);
        work.links.iter().map(|at| 1.0 / at.inverse).collect()
    }

    /// Joint torques, N m, into `out`, that give the tree these accelerations; `bearing_n` is told
    /// each joint's number and the force in its bearing, N.
    ///
    /// All slices have the tree's length.
    pub fn inverse(
        &self,
        work: &mut SpatialWorkspace,
        [angle_rad, speed_rad_s, acceleration_rad_s2]: [&[f64]; 3],
        out: &mut [f64],
        mut bearing_n: impl FnMut(usize, f64),
    ) {
        self.find_motions(work, angle_rad, speed_rad_s);
        for (i, link) in self.links.iter().enumerate() {
            let parent = self.before(work, link);
            let at = &mut work.links[i];
            at.acceleration = at.carried_on(&parent);
            at.acceleration.add(&at.bias, 1.0);
            *at.acceleration.along(link.slides) += acceleration_rad_s2[i];
            at.force = link.inertial(&at.acceleration);
            at.force.add(&link.gyroscopic(&at.speed), 1.0);
        }
        for (i, link) in self.links.iter().enumerate().rev() {
            let at = work.links[i];
            let mut force = at.force;
            out[i] = *force.along(link.slides) + link.armature * acceleration_rad_s2[i];
            bearing_n(i, dot(&force.shifting, &force.shifting).sqrt());
            if let Some(parent) = link.parent {
                work.links[parent].force.add(&at.handed_down(&force), 1.0);
            }
        }
    }
}

fn rows(matrix: &Matrix3<f64>) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|k| matrix[(i, k)]))
}
