//! The equations of motion of a tree in space.
//!
//! Featherstone, Rigid Body Dynamics Algorithms (2008): articulated bodies (section 7.3) forwards,
//! recursive Newton-Euler (section 5.3) backwards. Every link's vectors lie along the base's axes
//! and are taken about the link's own origin, which is on its joint's axis: from link to link
//! nothing is turned. Accelerations are those of points, so that no linear speed is needed. A held
//! joint passes the inertia of what it carries on whole, as in a planar chain
//! ([`Chain::forward`](crate::dynamics::Chain::forward)).

use super::SpatialTree;
use super::carried::{Carried, Spatial};
use super::small::{Matrix, Vector, cross, dot, scaled, vector};
use crate::dynamics::lanes::{Lane, Lanes, each};
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
    /// The frame at 0 in the parent's: its axes, the third that of the joint, and its origin.
    place: Matrix,
    origin: Vector,
    slides: bool,
    mass_kg: f64,
    /// Mass times centre of mass, in the frame.
    moment: Vector,
    /// Moments of inertia about the frame's origin, along its axes.
    inertia: Matrix,
    armature: f64,
}

/// Scratch memory of [`SpatialEquations`], reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct SpatialWorkspace {
    links: Vec<Scratch>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Scratch {
    /// Sine and cosine of the joint's angle.
    turn: (f64, f64),
    /// The frame's axes.
    axes: Matrix,
    /// From the parent's origin to the frame's.
    arm: Vector,
    /// Angular speed.
    speed: Vector,
    /// Acceleration that speeds alone give.
    bias: Spatial,
    acceleration: Spatial,
    /// Mass times centre of mass.
    moment: Vector,
    /// Inertia of the rigid link; of all that it carries, once gathered.
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

/// A frame along the base's axes.
const BASE: Matrix = Matrix([
    Lanes([1.0, 0.0, 0.0, 0.0]),
    Lanes([0.0, 1.0, 0.0, 0.0]),
    Lanes([0.0, 0.0, 1.0, 0.0]),
]);

impl Scratch {
    /// The joint's axis.
    #[inline(always)]
    fn axis(&self) -> Vector {
        self.axes.0[2]
    }

    /// Acceleration of the frame while its joint has none, where that of the parent's is this.
    #[inline(always)]
    fn carried_on(&self, parent: &Spatial) -> Spatial {
        let mut acceleration = parent.carried_on(self.arm);
        acceleration.add(&self.bias, 1.0);
        acceleration
    }

    /// Moment and force of the rigid link at this acceleration.
    #[inline(always)]
    fn inertial(&self, mass_kg: f64, a: &Spatial) -> Spatial {
        let turning = self.inertia.turning.combined(a.turning);
        Spatial {
            turning: turning + cross(self.moment, a.shifting),
            shifting: scaled(a.shifting, mass_kg) + cross(a.turning, self.moment),
        }
    }
}

impl Link {
    /// The link's own inertia along the base's axes.
    #[inline(always)]
    fn lay(&self, at: &mut Scratch) {
        let columns = self.inertia.0.map(|column| at.axes.combined(column));
        let mut turning = Matrix::default();
        for (column, axis) in columns.into_iter().zip(at.axes.0) {
            turning.add_product(axis, column);
        }
        at.inertia.turning = turning;
        at.moment = at.axes.combined(self.moment);
    }

    /// The rest of its inertia, and the moment and force that keep it turning.
    #[inline(always)]
    fn settle(&self, at: &mut Scratch) {
        at.inertia.mixed = Matrix::crossing(at.moment);
        at.inertia.shifting = Matrix::diagonal(self.mass_kg);
        at.force = Spatial {
            turning: cross(at.speed, at.inertia.turning.combined(at.speed)),
            shifting: cross(at.speed, cross(at.speed, at.moment)),
        };
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
                place: columns(&(before.tr_mul(&place) * aligned[i])),
                origin: vector(before.tr_mul(&link.place.translation.vector).into()),
                slides: link.slides,
                mass_kg: link.mass_kg,
                moment: vector((com * link.mass_kg).into()),
                inertia: columns(&inertia),
                armature: link.armature_kg_m2,
            }
        });
        SpatialEquations {
            links: links.collect(),
            base_m_s2: vector((-tree.gravity_m_s2).into()),
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

    /// Inertia of a joint's rotor, kg m^2; of a slide in kg.
    pub fn armature_mut(&mut self, joint: usize) -> &mut f64 {
        &mut self.links[joint].armature
    }

    /// Acceleration of what carries a link.
    #[inline(always)]
    fn before(&self, work: &SpatialWorkspace, link: &Link) -> Spatial {
        match link.parent {
            Some(parent) => work.links[parent].acceleration,
            None => Spatial {
                turning: Vector::default(),
                shifting: self.base_m_s2,
            },
        }
    }

    /// From the base outwards: how every link lies and moves, and what that alone asks for.
    #[inline(always)]
    fn find_motions(&self, work: &mut SpatialWorkspace, angle_rad: &[f64], speed_rad_s: &[f64]) {
        if work.links.len() != self.links.len() {
            work.links.resize(self.links.len(), Scratch::default());
        }
        let turns = (work.links.chunks_mut(4)).zip(angle_rad.chunks(4));
        for (links, angles) in turns {
            let (sin, cos) = f64::sin_cos_of::<4>(each(|i| angles.get(i).copied().unwrap_or(0.0)));
            for ((at, sin), cos) in links.iter_mut().zip(sin).zip(cos) {
                at.turn = (sin, cos);
            }
        }
        for (i, link) in self.links.iter().enumerate() {
            let (axes, turning) = match link.parent {
                Some(parent) => (work.links[parent].axes, work.links[parent].speed),
                None => (BASE, Vector::default()),
            };
            let (at, speed) = (&mut work.links[i], speed_rad_s[i]);
            let [x, y, axis] = link.place.0.map(|own| axes.combined(own));
            let arm = axes.combined(link.origin);
            let along = cross(turning, scaled(axis, speed));
            if link.slides {
                at.axes = Matrix([x, y, axis]);
                at.arm = arm + scaled(axis, angle_rad[i]);
                at.speed = turning;
                at.bias.turning = Vector::default();
                at.bias.shifting = cross(turning, cross(turning, at.arm)) + along + along;
            } else {
                let (sin, cos) = at.turn;
                at.axes = Matrix([
                    scaled(x, cos) + scaled(y, sin),
                    scaled(y, cos) - scaled(x, sin),
                    axis,
                ]);
                at.arm = arm;
                at.speed = turning + scaled(axis, speed);
                at.bias.turning = along;
                at.bias.shifting = cross(turning, cross(turning, arm));
            }
            link.lay(at);
        }
        // In a loop of its own: links wait for those that carry them above, and not here.
        for (at, link) in work.links.iter_mut().zip(&self.links) {
            link.settle(at);
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
        forward(self, work, [angle_rad, speed_rad_s, torque_nm], held, out);
    }

    /// From the tips inwards: what everything behind a joint asks of it.
    #[inline(always)]
    fn gather(&self, work: &mut SpatialWorkspace, torque_nm: &[f64], held: &[bool]) {
        for (i, link) in self.links.iter().enumerate().rev() {
            let (carrying, carried) = work.links.split_at_mut(i);
            let at = &mut carried[0];
            at.pull = at.inertia.pull(at.axis(), link.slides);
            at.inverse = 1.0 / (at.pull.along(at.axis(), link.slides) + link.armature);
            at.left = torque_nm[i] - at.force.along(at.axis(), link.slides);
            let Some(parent) = link.parent else { continue };
            let parent = &mut carrying[parent];
            let mut force = at.inertia.times(&at.bias);
            force.add(&at.force, 1.0);
            // What gives way is taken from the parent's sum: the sum need not wait for it.
            parent.inertia.add_seen(&at.inertia, at.arm);
            if !held[i] {
                force.add(&at.pull, (at.left - at.pull.dot(&at.bias)) * at.inverse);
                let pull = at.pull.handed_down(at.arm);
                parent.inertia.give_way(&pull, at.inverse);
            }
            parent.force.add(&force.handed_down(at.arm), 1.0);
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
            let mut acceleration = at.carried_on(&parent);
            acceleration.add_along(at.axis(), link.slides, acceleration_rad_s2[i]);
            at.acceleration = acceleration;
            let inertial = at.inertial(link.mass_kg, &acceleration);
            at.force.add(&inertial, 1.0);
        }
        for (i, link) in self.links.iter().enumerate().rev() {
            let at = &work.links[i];
            let (force, arm) = (at.force, at.arm);
            out[i] = force.along(at.axis(), link.slides) + link.armature * acceleration_rad_s2[i];
            bearing_n(i, dot(force.shifting, force.shifting).sqrt());
            if let Some(parent) = link.parent {
                work.links[parent].force.add(&force.handed_down(arm), 1.0);
            }
        }
    }
}

/// [`SpatialEquations::forward`]. Wider registers give the same bits: no product is fused with a
/// sum.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn forward(
    equations: &SpatialEquations,
    work: &mut SpatialWorkspace,
    [angle_rad, speed_rad_s, torque_nm]: [&[f64]; 3],
    held: &[bool],
    out: &mut [f64],
) {
    let n = equations.links.len();
    let (angle_rad, speed_rad_s) = (&angle_rad[..n], &speed_rad_s[..n]);
    let (torque_nm, held, out) = (&torque_nm[..n], &held[..n], &mut out[..n]);
    equations.find_motions(work, angle_rad, speed_rad_s);
    equations.gather(work, torque_nm, held);
    for (i, link) in equations.links.iter().enumerate() {
        let parent = equations.before(work, link);
        let at = &mut work.links[i];
        let mut acceleration = at.carried_on(&parent);
        let pulled = at.pull.dot(&acceleration) - at.left;
        out[i] = if held[i] {
            pulled
        } else {
            -pulled * at.inverse
        };
        if !held[i] {
            acceleration.add_along(at.axis(), link.slides, out[i]);
        }
        at.acceleration = acceleration;
    }
}

/// The columns of a matrix, as rows.
fn columns(matrix: &Matrix3<f64>) -> Matrix {
    Matrix(std::array::from_fn(|k| {
        vector(matrix.column(k).into_owned().into())
    }))
}
