//! The laws of the chain and its joints.

use super::{Joints, LINKS};
use crate::history::History;
use crate::moving_base::{Base, BaseState, LinksOnBase};
use crate::physics::{DriveCommand, GRAVITY_M_S2, Physics};

/// The robot's laws: what each joint and its link is, how far the next joint is, and how it hangs.
#[derive(Debug, Clone)]
pub struct Laws {
    /// Joint and link, from the bar outwards; a passive joint has a stall torque of 0.
    pub joints: [Physics; LINKS],
    /// Joint to next joint, m.
    pub length_m: Joints,
    /// Whether the rig is turned by 180 degrees about the vertical.
    pub turned: bool,
}

/// Forces on the chain at one state.
pub(super) struct ChainForces {
    pub mass: [Joints; LINKS],
    /// What the links ask of the base.
    pub on_base: LinksOnBase<LINKS>,
    /// Torques that gravity and velocities ask of the joints at rest of acceleration, N m.
    pub needed: Joints,
}

impl Laws {
    /// Links with a gyro, counted from 0.
    pub fn gyros(&self) -> Vec<usize> {
        (0..LINKS)
            .filter(|k| self.joints[*k].gyro.is_some())
            .collect()
    }

    /// Angle from the vertical by which gravity is turned, rad.
    pub(super) fn tilt(&self) -> f64 {
        let tilt: f64 = self.joints.iter().map(|joint| joint.tilt).sum();
        if self.turned { -tilt } else { tilt }
    }

    /// What the rig stands on, where it gives way.
    pub(super) fn base(&self) -> Option<Base> {
        self.joints.iter().find_map(|joint| joint.base)
    }

    /// The base under the robot at rest.
    pub(super) fn sagged(&self) -> BaseState {
        let mass = self.joints.iter().map(|link| link.mass_kg).sum();
        BaseState::sagged(self.base(), mass, self.tilt())
    }

    /// Mass matrix, kg m^2, and needed torques in relative angles.
    pub(super) fn forces(&self, angle: &Joints, speed: &Joints) -> ChainForces {
        let (theta, omega) = (summed(angle), summed(speed));
        let tilt = self.tilt();
        let mut mass = [[0.0; LINKS]; LINKS];
        let mut needed = [0.0; LINKS];
        let mut on_base = LinksOnBase::of_mass(self.joints.iter().map(|link| link.mass_kg).sum());
        for (i, link) in self.joints.iter().enumerate() {
            // The way from the bar to this link's centre of mass: its parts' lengths and angles.
            let part = |k: usize| {
                if k == i {
                    (link.com_m, theta[i] + link.com_angle)
                } else {
                    (self.length_m[k], theta[k])
                }
            };
            for k in 0..=i {
                let (long_k, at_k) = part(k);
                let weight = link.mass_kg * GRAVITY_M_S2;
                needed[k] += weight * long_k * (at_k - tilt).sin();
                on_base.add(k, [link.mass_kg, long_k, at_k, omega[k]]);
                for l in 0..=i {
                    let (long_l, at_l) = part(l);
                    let share = link.mass_kg * long_k * long_l;
                    mass[k][l] += share * (at_k - at_l).cos();
                    needed[k] += share * (at_k - at_l).sin() * omega[l] * omega[l];
                }
            }
            mass[i][i] += link.inertia_kg_m2;
        }
        // A joint turns all links from its own on: torques and inertias add up from the end.
        for k in (0..LINKS - 1).rev() {
            needed[k] += needed[k + 1];
            let outer = mass[k + 1];
            for (sum, part) in mass[k].iter_mut().zip(outer) {
                *sum += part;
            }
            let outer = on_base.moment[k + 1];
            for (sum, part) in on_base.moment[k].iter_mut().zip(outer) {
                *sum += part;
            }
        }
        for row in &mut mass {
            for l in (0..LINKS - 1).rev() {
                row[l] += row[l + 1];
            }
        }
        for (k, joint) in self.joints.iter().enumerate() {
            mass[k][k] += joint.armature;
        }
        ChainForces {
            mass,
            on_base,
            needed,
        }
    }

    /// Torques of the drives at the joints, N m, at these speeds.
    pub(super) fn drives(
        &self,
        push: &[DriveCommand; LINKS],
        speed: &Joints,
        histories: &[History; LINKS],
    ) -> Joints {
        std::array::from_fn(|k| {
            if self.joints[k].stall_nm > 0.0 {
                let drive = |speed| self.joints[k].drive(push[k], speed);
                histories[k].passed_on(&self.joints[k], drive, speed[k])
            } else {
                0.0
            }
        })
    }

    /// Torques that hold the robot still at a pose by the joints' springs and gravity, N m.
    pub fn holding(&self, angle: &Joints) -> Joints {
        let needed = self.forces(angle, &[0.0; LINKS]).needed;
        std::array::from_fn(|k| needed[k] - self.joints[k].smooth(angle[k], 0.0))
    }
}

/// Running sums: absolute from relative angles.
pub(super) fn summed(relative: &Joints) -> Joints {
    let mut sum = 0.0;
    relative.map(|angle| {
        sum += angle;
        sum
    })
}
