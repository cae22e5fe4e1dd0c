//! Forward dynamics by articulated bodies, reduced to the plane.
//!
//! Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 7, with spatial vectors of three entries
//! (moment, force x, force y) taken at each link's own joint in axes that do not turn. A held joint passes its
//! inertia on whole and reports the torque that holds it: that is how friction keeps a joint at rest exactly.

use super::chain::Chain;

/// Scratch memory of [`Chain::forward`], reused from call to call.
#[derive(Debug, Clone)]
pub struct Workspace {
    links: Vec<Scratch>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Scratch {
    /// Joint to next joint, turned left: velocity of its end per rad/s.
    lever: [f64; 2],
    /// Centripetal acceleration at the link's end.
    centripetal: [f64; 2],
    /// Rigid first moment, turned left.
    moment: [f64; 2],
    speed_squared: f64,
    // Articulated inertia at the joint: [[inertia, b], [b, mass]].
    inertia: f64,
    b: [f64; 2],
    mass: [f64; 3],
    /// Inverse of the inertia the joint itself sees; 0 when held.
    inverse: f64,
    /// Bias moment and force.
    bias_moment: f64,
    bias_force: [f64; 2],
    /// Joint torque not yet spent.
    torque: f64,
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
    /// Accelerations of the joints, rad/s^2, into `out`.
    ///
    /// `base_m_s2` is the acceleration of the base that stands for gravity, from [`Chain::base_m_s2`]. Where `held[i]`, the joint does not move (its speed
    /// must be 0) and `out[i]` is instead the torque, N m, that must be added to `torque_nm[i]` to keep it so.
    /// All slices have the chain's length.
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
        let scratch = &mut work.links[..n];
        let (angle_rad, speed_rad_s, torque_nm) =
            (&angle_rad[..n], &speed_rad_s[..n], &torque_nm[..n]);
        let (held, out) = (&held[..n], &mut out[..n]);

        let (mut angle, mut speed) = (0.0, 0.0);
        for i in 0..n {
            let link = &self.links[i];
            angle += angle_rad[i];
            speed += speed_rad_s[i];
            let (sin, cos) = angle.sin_cos();
            let (com_sin, com_cos) = if link.com_angle_rad == 0.0 {
                (sin, cos)
            } else {
                (angle + link.com_angle_rad).sin_cos()
            };
            let first_moment = link.mass_kg * link.com_m;
            let s = &mut scratch[i];
            s.speed_squared = speed * speed;
            s.lever = [link.length_m * cos, link.length_m * sin];
            // The link's end lies at length * (sin, -cos); centripetal points back to the joint.
            s.centripetal = [
                -s.speed_squared * link.length_m * sin,
                s.speed_squared * link.length_m * cos,
            ];
            s.moment = [first_moment * com_cos, first_moment * com_sin];
            s.inertia = link.inertia_kg_m2 + first_moment * link.com_m;
            s.b = s.moment;
            s.mass = [link.mass_kg, 0.0, link.mass_kg];
            s.bias_moment = 0.0;
            s.bias_force = [
                -s.speed_squared * first_moment * com_sin,
                s.speed_squared * first_moment * com_cos,
            ];
        }

        for i in (0..n).rev() {
            let s = &mut scratch[i];
            s.torque = torque_nm[i] - s.bias_moment;
            let (mut inertia, mut b, mut mass) = (s.inertia, s.b, s.mass);
            let (mut bias_moment, mut bias_force) = (s.bias_moment, s.bias_force);
            if held[i] {
                s.inverse = 0.0;
                // A held joint carries whatever moment comes.
            } else {
                s.inverse = 1.0 / (s.inertia + self.links[i].armature_kg_m2);
                let (ui, ux, uy) = (
                    s.inertia * s.inverse,
                    s.b[0] * s.inverse,
                    s.b[1] * s.inverse,
                );
                inertia -= s.inertia * ui;
                b = [b[0] - s.inertia * ux, b[1] - s.inertia * uy];
                mass = [
                    mass[0] - s.b[0] * ux,
                    mass[1] - s.b[0] * uy,
                    mass[2] - s.b[1] * uy,
                ];
                bias_moment += ui * s.torque;
                bias_force = [bias_force[0] + ux * s.torque, bias_force[1] + uy * s.torque];
            }
            if i > 0 {
                let parent = &mut scratch[i - 1];
                let (l, c) = (parent.lever, parent.centripetal);
                let ml = [
                    mass[0] * l[0] + mass[1] * l[1],
                    mass[1] * l[0] + mass[2] * l[1],
                ];
                let force = [
                    bias_force[0] + mass[0] * c[0] + mass[1] * c[1],
                    bias_force[1] + mass[1] * c[0] + mass[2] * c[1],
                ];
                parent.inertia +=
                    inertia + 2.0 * (b[0] * l[0] + b[1] * l[1]) + l[0] * ml[0] + l[1] * ml[1];
                parent.b = [parent.b[0] + b[0] + ml[0], parent.b[1] + b[1] + ml[1]];
                for (sum, own) in parent.mass.iter_mut().zip(mass) {
                    *sum += own;
                }
                parent.bias_moment +=
                    bias_moment + b[0] * c[0] + b[1] * c[1] + l[0] * force[0] + l[1] * force[1];
                parent.bias_force = [
                    parent.bias_force[0] + force[0],
                    parent.bias_force[1] + force[1],
                ];
            }
        }

        let mut linear = base_m_s2;
        let mut angular = 0.0;
        for i in 0..n {
            let s = &scratch[i];
            let needed = s.inertia * angular + s.b[0] * linear[0] + s.b[1] * linear[1];
            if held[i] {
                out[i] = needed - s.torque;
            } else {
                let acceleration = (s.torque - needed) * s.inverse;
                out[i] = acceleration;
                angular += acceleration;
            }
            linear = [
                linear[0] + angular * s.lever[0] + s.centripetal[0],
                linear[1] + angular * s.lever[1] + s.centripetal[1],
            ];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::ChainLink;
    use proptest::prelude::*;

    fn chain(n: usize) -> Chain {
        let links = (0..n)
            .map(|i| ChainLink {
                length_m: 0.1 + 0.03 * i as f64,
                com_m: 0.05 + 0.02 * i as f64,
                com_angle_rad: 0.1 * i as f64,
                mass_kg: 0.3 + 0.1 * i as f64,
                inertia_kg_m2: 1e-3,
                armature_kg_m2: if i == 1 { 2e-3 } else { 0.0 },
            })
            .collect();
        Chain {
            links,
            gravity_m_s2: 9.81,
        }
    }

    proptest! {
        #[test]
        fn forward_undoes_inverse(
            n in 1usize..6,
            turn in -3.0f64..3.0,
            values in prop::collection::vec(-3.0f64..3.0, 18),
        ) {
            let chain = chain(n);
            let (q, w, a) = (&values[..n], &values[6..6 + n], &values[12..12 + n]);
            let mut torque = vec![0.0; n];
            chain.inverse(turn, q, w, a, &mut torque);
            let mut out = vec![0.0; n];
            chain.forward(&mut Workspace::new(n), chain.base_m_s2(turn), q, w, &torque, &vec![false; n], &mut out);
            for i in 0..n {
                prop_assert!((out[i] - a[i]).abs() < 1e-8, "{out:?} {a:?}");
            }
        }

        #[test]
        fn a_held_joint_reports_the_torque_that_holds_it(
            values in prop::collection::vec(-3.0f64..3.0, 9),
        ) {
            let chain = chain(3);
            let q = &values[..3];
            let mut w = values[3..6].to_vec();
            w[1] = 0.0;
            let torque = &values[6..9];
            let held = [false, true, false];
            let mut out = [0.0; 3];
            let mut work = Workspace::new(3);
            chain.forward(&mut work, chain.base_m_s2(0.0), q, &w, torque, &held, &mut out);
            let pushed = [torque[0], torque[1] + out[1], torque[2]];
            let mut free = [0.0; 3];
            chain.forward(&mut work, chain.base_m_s2(0.0), q, &w, &pushed, &[false; 3], &mut free);
            prop_assert!(free[1].abs() < 1e-7);
            prop_assert!((free[0] - out[0]).abs() < 1e-7);
            prop_assert!((free[2] - out[2]).abs() < 1e-7);
        }
    }

    #[test]
    fn energy_is_kept_without_friction() {
        let chain = chain(3);
        let mut work = Workspace::new(3);
        let (mut q, mut w) = (vec![1.0, 0.5, -0.3], vec![0.0; 3]);
        let total = |q: &[f64], w: &[f64]| {
            let (kinetic, potential) = chain.energy_j(q, w);
            kinetic + potential
        };
        let before = total(&q, &w);
        let h = 1e-4;
        for _ in 0..20_000 {
            let mut accelerate = |q: &[f64], w: &[f64]| {
                let mut out = vec![0.0; 3];
                chain.forward(
                    &mut work,
                    chain.base_m_s2(0.0),
                    q,
                    w,
                    &[0.0; 3],
                    &[false; 3],
                    &mut out,
                );
                out
            };
            let add = |x: &[f64], k: f64, dx: &[f64]| -> Vec<f64> {
                x.iter().zip(dx).map(|(x, d)| x + k * d).collect()
            };
            let a1 = accelerate(&q, &w);
            let (q2, w2) = (add(&q, h / 2.0, &w), add(&w, h / 2.0, &a1));
            let a2 = accelerate(&q2, &w2);
            q = add(&q, h, &w2);
            w = add(&w, h, &a2);
        }
        assert!((total(&q, &w) - before).abs() < 1e-6);
    }
}
