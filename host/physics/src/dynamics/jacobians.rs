//! Equations of motion of a chain of hinges and slides, by the Jacobians of its centres of mass.
//!
//! With r_k the centre of mass of link k, J_k = dr_k/dq, w_k the row of its angular velocity, and
//! base as [`Chain::base_m_s2`] has it,
//!
//! ```text
//! M_ij = sum_k (m_k J_ki . J_kj + I_k w_ki w_kj) + rotor_i [i = j]     G_i = sum_k m_k base . J_ki
//! C_ij = sum_k m_k J_ki . sum_l H_kjl q_l'               dG_i/dq_j = sum_k m_k base . H_kij
//! ```
//!
//! where H_k, the second derivatives of r_k, turn J_k of the later joint left if the earlier one is
//! a hinge, and vanish if it slides; C are Christoffel's symbols, for in a plane at rest the rest
//! of them cancels. (Siciliano, Sciavicco, Villani, Oriolo, Robotics (2009), section 7.1.)

use super::chain::{Chain, ChainLink};
use nalgebra::{DMatrix, DVector};

/// First derivatives of every link's centre of mass at a pose.
pub(super) struct Jacobians {
    /// Per link, per joint up to its own: m/rad, or 1 along a slide.
    of_com: Vec<Vec<[f64; 2]>>,
    /// Per joint: whether it turns what it carries.
    hinge: Vec<bool>,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn left([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

impl Jacobians {
    /// Of `chain` at relative angles, rad, and displacements, m.
    pub fn new(chain: &Chain, angle_rad: &[f64]) -> Jacobians {
        let down = |angle: f64| [angle.sin(), -angle.cos()];
        let (mut angle, mut end) = (0.0, [0.0; 2]);
        // Where each joint is, and along what it moves if it slides.
        let mut joints: Vec<([f64; 2], Option<[f64; 2]>)> = Vec::new();
        let mut of_com = Vec::new();
        for (link, &q) in chain.links.iter().zip(angle_rad) {
            let along = link.slide.map(|slide| down(angle + slide.direction_rad));
            if let Some(along) = along {
                end = [0, 1].map(|k| end[k] + q * along[k]);
            }
            angle += link.slide.map_or(q, |slide| slide.link_rad);
            joints.push((end, along));
            let arm = down(angle + link.com_angle_rad);
            let com = [0, 1].map(|k| end[k] + link.com_m * arm[k]);
            let column = |(at, along): &([f64; 2], Option<[f64; 2]>)| match along {
                Some(along) => *along,
                None => left([com[0] - at[0], com[1] - at[1]]),
            };
            of_com.push(joints.iter().map(column).collect());
            let line = down(angle);
            end = [0, 1].map(|k| end[k] + link.length_m * line[k]);
        }
        let hinge = chain.links.iter().map(|link| link.slide.is_none());
        Jacobians {
            of_com,
            hinge: hinge.collect(),
        }
    }

    /// M(q).
    pub fn mass(&self, chain: &Chain) -> DMatrix<f64> {
        let turn = |joint: usize| f64::from(u8::from(self.hinge[joint]));
        let mut m = self.sum(chain, |link, of, i, j| {
            link.mass_kg * dot(of[i], of[j]) + link.inertia_kg_m2 * turn(i) * turn(j)
        });
        for (i, link) in chain.links.iter().enumerate() {
            m[(i, i)] += link.armature_kg_m2;
        }
        m
    }

    /// C(q, q').
    pub fn coriolis(&self, chain: &Chain, speed_rad_s: &[f64]) -> DMatrix<f64> {
        self.sum(chain, |link, of, i, j| {
            let rates = speed_rad_s[..of.len()].iter().enumerate();
            let moved = rates.map(|(l, rate)| rate * dot(of[i], self.second(of, j, l)));
            link.mass_kg * moved.sum::<f64>()
        })
    }

    /// G(q).
    pub fn gravity(&self, chain: &Chain, base_m_s2: [f64; 2]) -> DVector<f64> {
        let weighed = self.sum(chain, |link, of, i, j| {
            if i == j {
                link.mass_kg * dot(base_m_s2, of[i])
            } else {
                0.0
            }
        });
        weighed.diagonal()
    }

    /// dG/dq.
    pub fn gravity_slope(&self, chain: &Chain, base_m_s2: [f64; 2]) -> DMatrix<f64> {
        self.sum(chain, |link, of, i, j| {
            link.mass_kg * dot(base_m_s2, self.second(of, i, j))
        })
    }

    /// Second derivative of the centre of mass that `of` belongs to.
    fn second(&self, of: &[[f64; 2]], i: usize, j: usize) -> [f64; 2] {
        if self.hinge[i.min(j)] {
            left(of[i.max(j)])
        } else {
            [0.0; 2]
        }
    }

    /// n x n: over the links that both joints move, the sum of `entry` of the link, its Jacobian
    /// and the joints.
    fn sum(
        &self,
        chain: &Chain,
        entry: impl Fn(&ChainLink, &[[f64; 2]], usize, usize) -> f64,
    ) -> DMatrix<f64> {
        let n = self.hinge.len();
        DMatrix::from_fn(n, n, |i, j| {
            let links = chain.links.iter().zip(&self.of_com).skip(i.max(j));
            links.map(|(link, of)| entry(link, of, i, j)).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{EquationsOfMotion, SlideAxis, Workspace};
    use super::*;
    use proptest::prelude::*;

    /// A chain whose joints slide where the bits of `mask` say so.
    fn chain(n: usize, mask: usize) -> Chain {
        let link = |i: usize| ChainLink {
            length_m: 0.1 + 0.03 * i as f64,
            com_m: 0.05 + 0.02 * i as f64,
            com_angle_rad: 0.1 * i as f64 - 0.1,
            mass_kg: 0.3 + 0.1 * i as f64,
            inertia_kg_m2: 1e-3,
            armature_kg_m2: if i == 1 { 2e-2 } else { 0.0 },
            slide: (mask >> i & 1 == 1).then_some(SlideAxis {
                direction_rad: 1.3 - 0.7 * i as f64,
                link_rad: 0.4 * i as f64 - 0.3,
            }),
        };
        Chain {
            links: (0..n).map(link).collect(),
            gravity_m_s2: 9.81,
        }
    }

    fn torque(chain: &Chain, turn: f64, [q, w, a]: [&[f64]; 3]) -> DVector<f64> {
        let equations = EquationsOfMotion::new(chain, turn);
        equations.mass(q) * DVector::from_column_slice(a)
            + equations.coriolis(q, w) * DVector::from_column_slice(w)
            + equations.gravity(q)
    }

    proptest! {
        #[test]
        fn both_recursions_agree_with_them(
            n in 1usize..6,
            mask in 0usize..32,
            turn in -3.0f64..3.0,
            values in prop::collection::vec(-2.0f64..2.0, 15),
        ) {
            let chain = chain(n, mask);
            let [q, w, a] = [0, 5, 10].map(|k| &values[k..k + n]);
            let wanted = torque(&chain, turn, [q, w, a]);
            let mut found = vec![0.0; n];
            chain.inverse(turn, q, w, a, &mut found);
            for i in 0..n {
                prop_assert!((found[i] - wanted[i]).abs() < 1e-11, "{found:?} {wanted}");
            }
            let (mut work, base) = (Workspace::new(n), chain.base_m_s2(turn));
            let mut out = vec![0.0; n];
            chain.forward(&mut work, base, q, w, &found, &vec![false; n], &mut out);
            for i in 0..n {
                prop_assert!((out[i] - a[i]).abs() < 1e-9, "{out:?} {a:?}");
            }
        }

        #[test]
        fn held_joints_report_what_holds_them(
            mask in 1usize..16,
            held in 1usize..16,
            values in prop::collection::vec(-2.0f64..2.0, 12),
        ) {
            let chain = chain(4, mask);
            let held: Vec<bool> = (0..4).map(|i| held >> i & 1 == 1).collect();
            let (q, torque) = (&values[..4], &values[8..]);
            let w: Vec<f64> = (0..4).map(|i| if held[i] { 0.0 } else { values[4 + i] }).collect();
            let (mut work, base) = (Workspace::new(4), chain.base_m_s2(0.3));
            let (mut out, mut free) = ([0.0; 4], [0.0; 4]);
            chain.forward(&mut work, base, q, &w, torque, &held, &mut out);
            let pushed: Vec<f64> =
                (0..4).map(|i| torque[i] + if held[i] { out[i] } else { 0.0 }).collect();
            chain.forward(&mut work, base, q, &w, &pushed, &[false; 4], &mut free);
            for i in 0..4 {
                let wanted = if held[i] { 0.0 } else { out[i] };
                prop_assert!((free[i] - wanted).abs() < 1e-8, "{free:?} {out:?}");
            }
        }

        /// Power into the chain is the change of its energy, which knows neither M nor C nor G.
        #[test]
        fn power_is_the_change_of_energy(
            mask in 1usize..16,
            values in prop::collection::vec(-2.0f64..2.0, 12),
        ) {
            let chain = chain(4, mask);
            let [q, w, a] = [0, 4, 8].map(|k| &values[k..k + 4]);
            let torque = torque(&chain, 0.0, [q, w, a]);
            let power: f64 = w.iter().zip(torque.iter()).map(|(w, torque)| w * torque).sum();
            let h = 1e-5;
            let energy = |by: f64| {
                let moved = |x: &[f64], v: &[f64]| -> Vec<f64> {
                    x.iter().zip(v).map(|(x, v)| x + by * v).collect()
                };
                // Along a parabola, so that angles and speeds fit each other.
                let speed = moved(w, a);
                let mean = moved(w, &a.iter().map(|a| 0.5 * a).collect::<Vec<_>>());
                let (kinetic, potential) = chain.energy_j(&moved(q, &mean), &speed);
                kinetic + potential
            };
            let rate = (energy(h) - energy(-h)) / (2.0 * h);
            prop_assert!((rate - power).abs() < 1e-5 * (1.0 + power.abs()), "{rate} {power}");
        }

        #[test]
        fn the_slope_of_gravity_is_its_difference(
            mask in 1usize..16,
            q in prop::collection::vec(-2.0f64..2.0, 4),
        ) {
            let equations = EquationsOfMotion::new(&chain(4, mask), 0.2);
            let slope = equations.gravity_slope(&q);
            for j in 0..4 {
                let at = |by: f64| {
                    let mut q = q.clone();
                    q[j] += by;
                    equations.gravity(&q)
                };
                let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
                prop_assert!((difference - slope.column(j)).amax() < 1e-6);
            }
        }
    }
}
