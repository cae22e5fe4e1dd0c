//! A tree of rigid links in space: hinges and slides about any axis, on a fixed base.
//!
//! Featherstone, Rigid Body Dynamics Algorithms (2008): articulated bodies (section 7.3) forwards,
//! recursive Newton-Euler (section 5.3) backwards. Every link's vectors are in its own frame, whose
//! origin lies on its joint's axis. A held joint passes the inertia of what it carries on whole, as
//! in a planar chain ([`Chain::forward`](super::Chain::forward)).

use nalgebra::{Isometry3, Matrix3, Rotation3, Unit, Vector3};

/// A tree on a fixed base. A joint's number is that of the link it carries.
///
/// Where a joint slides, its place among the angles, rad, is a displacement, m, that among the
/// speeds, rad/s, one in m/s, and that among the torques, N m, a force, N.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialTree {
    /// Links, each behind the one that carries it.
    pub links: Vec<SpatialLink>,
    /// Acceleration of free fall, m/s^2, in the base's frame.
    pub gravity_m_s2: Vector3<f64>,
}

/// One link and the joint that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialLink {
    /// The link that carries it, a smaller number than its own; none of the base.
    pub parent: Option<usize>,
    /// Where its frame stands in the parent's while the joint is at 0.
    pub place: Isometry3<f64>,
    /// About what the joint turns, or along what it slides, in the link's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Whether it slides.
    pub slides: bool,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass in the link's frame, m.
    pub com_m: Vector3<f64>,
    /// Moments of inertia about the centre of mass along the link's axes, kg m^2.
    pub inertia_kg_m2: Matrix3<f64>,
    /// Rotor's inertia reflected through the gear, kg m^2: counts in the joint's own acceleration
    /// only. Of a slide in kg.
    pub armature_kg_m2: f64,
}

/// Scratch memory of a [`SpatialTree`]'s equations, reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct SpatialWorkspace {
    links: Vec<Scratch>,
}

/// What turns and what shifts: a speed, an acceleration, or a moment and a force.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spatial {
    angular: Vector3<f64>,
    linear: Vector3<f64>,
}

/// Inertia of what a joint carries: moment = turning * angular + mixed * linear, force = mixed' *
/// angular + shifting * linear.
#[derive(Debug, Clone, Copy)]
struct Carried {
    turning: Matrix3<f64>,
    mixed: Matrix3<f64>,
    shifting: Matrix3<f64>,
}

#[derive(Debug, Clone, Copy)]
struct Scratch {
    /// From the link's frame to the parent's.
    turn: Matrix3<f64>,
    /// The frame's origin in the parent's frame, m.
    origin: Vector3<f64>,
    speed: Spatial,
    /// Acceleration that speeds alone give.
    bias: Spatial,
    acceleration: Spatial,
    inertia: Carried,
    /// Moment and force at no acceleration.
    force: Spatial,
    /// Moment and force per acceleration of the joint.
    pull: Spatial,
    /// Inertia the joint's own torque meets.
    own: f64,
    /// Torque that is left to it.
    left: f64,
}

impl Spatial {
    const ZERO: Spatial = Spatial {
        angular: Vector3::new(0.0, 0.0, 0.0),
        linear: Vector3::new(0.0, 0.0, 0.0),
    };

    fn dot(&self, other: &Spatial) -> f64 {
        self.angular.dot(&other.angular) + self.linear.dot(&other.linear)
    }

    fn plus(&self, other: &Spatial, share: f64) -> Spatial {
        Spatial {
            angular: self.angular + other.angular * share,
            linear: self.linear + other.linear * share,
        }
    }
}

impl Carried {
    const ZERO: Carried = Carried {
        turning: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        mixed: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        shifting: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    fn times(&self, a: &Spatial) -> Spatial {
        Spatial {
            angular: self.turning * a.angular + self.mixed * a.linear,
            linear: self.mixed.tr_mul(&a.angular) + self.shifting * a.linear,
        }
    }

    fn add(&mut self, other: &Carried) {
        self.turning += other.turning;
        self.mixed += other.mixed;
        self.shifting += other.shifting;
    }

    /// Without what the joint gives way to.
    fn yielding(&self, pull: &Spatial, own: f64) -> Carried {
        let share = pull.linear.transpose() / own;
        Carried {
            turning: self.turning - pull.angular * (pull.angular.transpose() / own),
            mixed: self.mixed - pull.angular * share,
            shifting: self.shifting - pull.linear * share,
        }
    }

    /// In the parent's frame.
    fn seen_from_parent(&self, turn: &Matrix3<f64>, origin: &Vector3<f64>) -> Carried {
        let turned = |part: &Matrix3<f64>| turn * part * turn.transpose();
        let (turning, mixed, shifting) = (
            turned(&self.turning),
            turned(&self.mixed),
            turned(&self.shifting),
        );
        let arm = origin.cross_matrix();
        let reach = arm * shifting;
        Carried {
            turning: turning - mixed * arm + arm * mixed.transpose() - reach * arm,
            mixed: mixed + reach,
            shifting,
        }
    }
}

impl Scratch {
    const ZERO: Scratch = Scratch {
        turn: Carried::ZERO.turning,
        origin: Spatial::ZERO.linear,
        speed: Spatial::ZERO,
        bias: Spatial::ZERO,
        acceleration: Spatial::ZERO,
        inertia: Carried::ZERO,
        force: Spatial::ZERO,
        pull: Spatial::ZERO,
        own: 0.0,
        left: 0.0,
    };

    /// A speed or an acceleration of the parent's frame, as this link's frame has it.
    fn carried_on(&self, parent: &Spatial) -> Spatial {
        let moved = parent.linear + parent.angular.cross(&self.origin);
        Spatial {
            angular: self.turn.tr_mul(&parent.angular),
            linear: self.turn.tr_mul(&moved),
        }
    }

    /// A moment and a force on this link, as they act on the parent's frame.
    fn handed_down(&self, force: &Spatial) -> Spatial {
        let linear = self.turn * force.linear;
        Spatial {
            angular: self.turn * force.angular + self.origin.cross(&linear),
            linear,
        }
    }
}

impl SpatialLink {
    /// The joint's motion per unit of its speed.
    fn motion(&self) -> Spatial {
        let axis = self.axis.into_inner();
        if self.slides {
            Spatial {
                linear: axis,
                ..Spatial::ZERO
            }
        } else {
            Spatial {
                angular: axis,
                ..Spatial::ZERO
            }
        }
    }

    /// Where the link's frame stands in the parent's.
    fn stands(&self, coordinate: f64) -> (Matrix3<f64>, Vector3<f64>) {
        let place = self.place.rotation.to_rotation_matrix();
        let origin = self.place.translation.vector;
        if self.slides {
            let along = place * (self.axis.into_inner() * coordinate);
            return (place.into_inner(), origin + along);
        }
        let turn = Rotation3::from_axis_angle(&self.axis, coordinate);
        ((place * turn).into_inner(), origin)
    }

    fn inertia(&self) -> Carried {
        let moment = self.com_m * self.mass_kg;
        let arm = self.com_m.cross_matrix();
        Carried {
            turning: self.inertia_kg_m2 - arm * arm * self.mass_kg,
            mixed: moment.cross_matrix(),
            shifting: Matrix3::identity() * self.mass_kg,
        }
    }

    /// Moment and force that keep the link moving at this speed.
    fn gyroscopic(&self, inertia: &Carried, speed: &Spatial) -> Spatial {
        let momentum = inertia.times(speed);
        Spatial {
            angular: speed.angular.cross(&momentum.angular) + speed.linear.cross(&momentum.linear),
            linear: speed.angular.cross(&momentum.linear),
        }
    }
}

impl SpatialTree {
    /// Number of links.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Whether there is no link.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Acceleration of the base that stands for gravity.
    fn base(&self) -> Spatial {
        Spatial {
            linear: -self.gravity_m_s2,
            ..Spatial::ZERO
        }
    }

    /// From the base outwards: how every link lies and moves.
    fn find_motions(&self, work: &mut SpatialWorkspace, angle_rad: &[f64], speed_rad_s: &[f64]) {
        work.links.resize(self.links.len(), Scratch::ZERO);
        for (i, link) in self.links.iter().enumerate() {
            let (turn, origin) = link.stands(angle_rad[i]);
            let parent = link.parent.map_or(Spatial::ZERO, |p| work.links[p].speed);
            let at = &mut work.links[i];
            (at.turn, at.origin) = (turn, origin);
            let own = link.motion();
            at.speed = at.carried_on(&parent).plus(&own, speed_rad_s[i]);
            let (turning, along) = (own.angular * speed_rad_s[i], own.linear * speed_rad_s[i]);
            at.bias = Spatial {
                angular: at.speed.angular.cross(&turning),
                linear: at.speed.linear.cross(&turning) + at.speed.angular.cross(&along),
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
        self.find_motions(work, angle_rad, speed_rad_s);
        self.gather(work, torque_nm, held);
        for (i, link) in self.links.iter().enumerate() {
            let base = || self.base();
            let parent = (link.parent).map_or_else(base, |p| work.links[p].acceleration);
            let at = &mut work.links[i];
            let before = at.carried_on(&parent).plus(&at.bias, 1.0);
            let pulled = at.pull.dot(&before) - at.left;
            if held[i] {
                (out[i], at.acceleration) = (pulled, before);
            } else {
                out[i] = -pulled / at.own;
                at.acceleration = before.plus(&link.motion(), out[i]);
            }
        }
    }

    /// From the tips inwards: what everything behind a joint asks of it.
    fn gather(&self, work: &mut SpatialWorkspace, torque_nm: &[f64], held: &[bool]) {
        for (at, link) in work.links.iter_mut().zip(&self.links) {
            at.inertia = link.inertia();
            at.force = link.gyroscopic(&at.inertia, &at.speed);
        }
        for (i, link) in self.links.iter().enumerate().rev() {
            let motion = link.motion();
            let at = &mut work.links[i];
            at.pull = at.inertia.times(&motion);
            at.own = motion.dot(&at.pull) + link.armature_kg_m2;
            at.left = torque_nm[i] - motion.dot(&at.force);
            let Some(parent) = link.parent else { continue };
            let (mut inertia, mut force) = (at.inertia, at.force);
            if !held[i] {
                inertia = inertia.yielding(&at.pull, at.own);
                force = force.plus(&at.pull, at.left / at.own);
            }
            force = force.plus(&inertia.times(&at.bias), 1.0);
            let (inertia, force) = (
                inertia.seen_from_parent(&at.turn, &at.origin),
                at.handed_down(&force),
            );
            let parent = &mut work.links[parent];
            parent.inertia.add(&inertia);
            parent.force = parent.force.plus(&force, 1.0);
        }
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
            let base = || self.base();
            let parent = (link.parent).map_or_else(base, |p| work.links[p].acceleration);
            let at = &mut work.links[i];
            let before = at.carried_on(&parent).plus(&at.bias, 1.0);
            at.acceleration = before.plus(&link.motion(), acceleration_rad_s2[i]);
            let inertia = link.inertia();
            let force = inertia.times(&at.acceleration);
            at.force = force.plus(&link.gyroscopic(&inertia, &at.speed), 1.0);
        }
        for (i, link) in self.links.iter().enumerate().rev() {
            let at = work.links[i];
            out[i] = link.motion().dot(&at.force) + link.armature_kg_m2 * acceleration_rad_s2[i];
            bearing_n(i, at.force.linear.norm());
            if let Some(parent) = link.parent {
                let parent = &mut work.links[parent];
                parent.force = parent.force.plus(&at.handed_down(&at.force), 1.0);
            }
        }
    }

    /// Poses of the links' frames in the base's.
    pub fn poses(&self, angle_rad: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses: Vec<Isometry3<f64>> = Vec::with_capacity(self.links.len());
        for (link, coordinate) in self.links.iter().zip(angle_rad) {
            let (turn, origin) = link.stands(*coordinate);
            let turn = Rotation3::from_matrix_unchecked(turn);
            let own = Isometry3::from_parts(origin.into(), turn.into());
            let parent = link.parent.map_or_else(Isometry3::identity, |p| poses[p]);
            poses.push(parent * own);
        }
        poses
    }

    /// Kinetic and potential energy, J; the potential is zero with all masses at the base.
    pub fn energy_j(&self, angle_rad: &[f64], speed_rad_s: &[f64]) -> (f64, f64) {
        let mut work = SpatialWorkspace::default();
        self.find_motions(&mut work, angle_rad, speed_rad_s);
        let poses = self.poses(angle_rad);
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (i, (link, at)) in self.links.iter().zip(&work.links).enumerate() {
            let momentum = link.inertia().times(&at.speed);
            kinetic += 0.5 * at.speed.dot(&momentum)
                + 0.5 * link.armature_kg_m2 * speed_rad_s[i] * speed_rad_s[i];
            let com = poses[i] * nalgebra::Point3::from(link.com_m);
            potential -= link.mass_kg * self.gravity_m_s2.dot(&com.coords);
        }
        (kinetic, potential)
    }
}

#[cfg(test)]
mod tests;
