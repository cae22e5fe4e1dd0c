//! The chain's equations of motion in closed form: M(q) q'' + C(q, q') q' + G(q) = torque, for any n.
//!
//! With absolute angles t, the centre of mass of link j lies at the sum of the lengths before it and its own lever.
//! As complex numbers the kinetic energy is (1/2) sum_ij M_ij t_i' t_j' with
//!
//! ```text
//! M_ii = I_i + m_i c_i^2 + l_i^2 (m_{i+1} + ..)      M_ij = l_i Re(p_j e^{i (t_j - t_i)}),  i < j
//! p_j  = m_j c_j e^{i d_j} + l_j (m_{j+1} + ..)      V    = -g sum_j Re(p_j e^{i (t_j - turn)})
//! ```
//!
//! where d is the angle of the centre of mass off the link's line. M depends on differences of angles only, so
//! Lagrange's equations leave C_ij = (dM_ij / dt_j) t_j', for which dM/dt - 2 C is skew. Relative angles q follow
//! from t = L q with L the lower triangle of ones: M becomes L^T M L, and so on.

use crate::effects::Rig;
use nalgebra::{DMatrix, DVector};

/// Closed-form equations of a planar chain, angles relative, the first from hanging.
///
/// [`Chain::forward`](crate::dynamics::Chain::forward) computes the same motion in O(n); these matrices are for
/// analysis.
#[derive(Debug, Clone)]
pub struct Equations {
    length_m: Vec<f64>,
    /// p_j above, kg m: along and across the link.
    moment: Vec<[f64; 2]>,
    /// M_ii above, kg m^2.
    own: Vec<f64>,
    armature_kg_m2: Vec<f64>,
    gravity_m_s2: f64,
    turn_rad: f64,
}

impl Equations {
    /// The equations of a rig.
    pub fn of(rig: &Rig) -> Equations {
        let links = &rig.chain.links;
        let mut beyond_kg = 0.0;
        let (mut moment, mut own) = (Vec::new(), Vec::new());
        for link in links.iter().rev() {
            let (sin, cos) = link.com_angle_rad.sin_cos();
            let first = link.mass_kg * link.com_m;
            moment.push([first * cos + link.length_m * beyond_kg, first * sin]);
            own.push(
                link.inertia_kg_m2
                    + link.mass_kg * link.com_m.powi(2)
                    + beyond_kg * link.length_m.powi(2),
            );
            beyond_kg += link.mass_kg;
        }
        moment.reverse();
        own.reverse();
        Equations {
            length_m: links.iter().map(|link| link.length_m).collect(),
            moment,
            own,
            armature_kg_m2: links.iter().map(|link| link.armature_kg_m2).collect(),
            gravity_m_s2: rig.chain.gravity_m_s2,
            turn_rad: rig.gravity_turn_rad,
        }
    }

    /// Moment of each link with all that hangs on its end, p_j above: along the link and across it, kg m.
    pub fn moments_kg_m(&self) -> &[[f64; 2]] {
        &self.moment
    }

    /// Number of links.
    pub fn len(&self) -> usize {
        self.own.len()
    }

    /// Whether there is no link.
    pub fn is_empty(&self) -> bool {
        self.own.is_empty()
    }

    /// M(q), n x n, kg m^2: symmetric, positive definite.
    pub fn mass(&self, angle_rad: &[f64]) -> DMatrix<f64> {
        let t = absolute(angle_rad);
        let absolute = DMatrix::from_fn(self.len(), self.len(), |i, j| match i == j {
            true => self.own[i],
            false => self.coupling(i.min(j), i.max(j), &t)[0],
        });
        let mut mass = relative(absolute);
        for (i, armature) in self.armature_kg_m2.iter().enumerate() {
            mass[(i, i)] += armature;
        }
        mass
    }

    /// C(q, q'), n x n, kg m^2/s: C q' are the Coriolis and centrifugal torques, and dM/dt - 2 C is skew.
    pub fn coriolis(&self, angle_rad: &[f64], speed_rad_s: &[f64]) -> DMatrix<f64> {
        let (t, w) = (absolute(angle_rad), absolute(speed_rad_s));
        relative(DMatrix::from_fn(self.len(), self.len(), |i, j| {
            let slope = self.coupling(i.min(j), i.max(j), &t)[1];
            match i.cmp(&j) {
                std::cmp::Ordering::Less => -slope * w[j],
                std::cmp::Ordering::Equal => 0.0,
                std::cmp::Ordering::Greater => slope * w[j],
            }
        }))
    }

    /// G(q), n, N m: the torques that hold the chain at rest.
    pub fn gravity(&self, angle_rad: &[f64]) -> DVector<f64> {
        let mut torque = self.weight(angle_rad, |(re, im), (sin, cos)| re * sin + im * cos);
        for i in (1..torque.len()).rev() {
            torque[i - 1] += torque[i];
        }
        torque
    }

    /// dG/dq, n x n, N m/rad.
    pub fn gravity_slope(&self, angle_rad: &[f64]) -> DMatrix<f64> {
        let slope = self.weight(angle_rad, |(re, im), (sin, cos)| re * cos - im * sin);
        relative(DMatrix::from_diagonal(&slope))
    }

    /// Per absolute angle: g times `of` the moment and the angle from gravity's pull.
    fn weight(
        &self,
        angle_rad: &[f64],
        of: impl Fn((f64, f64), (f64, f64)) -> f64,
    ) -> DVector<f64> {
        let t = absolute(angle_rad);
        let each = t
            .iter()
            .zip(&self.moment)
            .map(|(t, p)| self.gravity_m_s2 * of((p[0], p[1]), (t - self.turn_rad).sin_cos()));
        DVector::from_iterator(self.len(), each)
    }

    /// l_i p_j e^{i (t_j - t_i)}, real and imaginary part, for i < j.
    fn coupling(&self, i: usize, j: usize, t: &[f64]) -> [f64; 2] {
        let (sin, cos) = (t[j] - t[i]).sin_cos();
        let [re, im] = self.moment[j];
        [
            self.length_m[i] * (re * cos - im * sin),
            self.length_m[i] * (re * sin + im * cos),
        ]
    }
}

/// Running sums.
fn absolute(relative: &[f64]) -> Vec<f64> {
    let sum = |sum: &mut f64, value: &f64| {
        *sum += value;
        Some(*sum)
    };
    relative.iter().scan(0.0, sum).collect()
}

/// L^T M L: sums of all entries to the right and below.
fn relative(mut m: DMatrix<f64>) -> DMatrix<f64> {
    for i in (1..m.nrows()).rev() {
        for j in 0..m.ncols() {
            m[(i - 1, j)] += m[(i, j)];
        }
    }
    for j in (1..m.ncols()).rev() {
        for i in 0..m.nrows() {
            m[(i, j - 1)] += m[(i, j)];
        }
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Chain, ChainLink};
    use proptest::prelude::*;

    fn rig(n: usize) -> Rig {
        let link = |i: usize| ChainLink {
            length_m: 0.1 + 0.03 * i as f64,
            com_m: 0.05 + 0.02 * i as f64,
            com_angle_rad: 0.1 * i as f64 - 0.1,
            mass_kg: 0.3 + 0.1 * i as f64,
            inertia_kg_m2: 1e-3,
            armature_kg_m2: if i == 1 { 2e-3 } else { 0.0 },
        };
        Rig {
            chain: Chain {
                links: (0..n).map(link).collect(),
                gravity_m_s2: 9.81,
            },
            gravity_turn_rad: 0.2,
            turned: false,
        }
    }

    proptest! {
        #[test]
        fn they_are_the_torques_newton_and_euler_ask_for(
            n in 1usize..7,
            values in prop::collection::vec(-3.0f64..3.0, 21),
        ) {
            let rig = rig(n);
            let (q, w, a) = (&values[..n], &values[7..7 + n], &values[14..14 + n]);
            let equations = Equations::of(&rig);
            let torque = equations.mass(q) * DVector::from_column_slice(a)
                + equations.coriolis(q, w) * DVector::from_column_slice(w)
                + equations.gravity(q);
            let mut expected = vec![0.0; n];
            rig.chain.inverse(rig.gravity_turn_rad, q, w, a, &mut expected);
            for i in 0..n {
                prop_assert!((torque[i] - expected[i]).abs() < 1e-11, "{torque} {expected:?}");
            }
        }

        /// Lagrange: torque = d/dt (dT/dw) - dT/dq + dV/dq, every derivative by central differences of the energy.
        #[test]
        fn they_are_the_lagrangian_s(values in prop::collection::vec(-2.0f64..2.0, 9)) {
            let n = 3;
            let mut rig = rig(n);
            rig.gravity_turn_rad = 0.0; // `energy_j` knows no turned gravity
            let (q, w, a) = (&values[..3], &values[3..6], &values[6..9]);
            let equations = Equations::of(&rig);
            let torque = equations.mass(q) * DVector::from_column_slice(a)
                + equations.coriolis(q, w) * DVector::from_column_slice(w)
                + equations.gravity(q);
            let h = 1e-4;
            let lagrangian = |q: &[f64], w: &[f64]| {
                let (kinetic, potential) = rig.chain.energy_j(q, w);
                kinetic - potential
            };
            let with = |x: &[f64], i: usize, by: f64| {
                let mut x = x.to_vec();
                x[i] += by;
                x
            };
            let momentum = |i: usize, q: &[f64], w: &[f64]| {
                (lagrangian(q, &with(w, i, h)) - lagrangian(q, &with(w, i, -h))) / (2.0 * h)
            };
            let ahead = |x: &[f64], v: &[f64], by: f64| -> Vec<f64> {
                x.iter().zip(v).map(|(x, v)| x + by * v).collect()
            };
            for i in 0..n {
                let rate = (momentum(i, &ahead(q, w, h), &ahead(w, a, h))
                    - momentum(i, &ahead(q, w, -h), &ahead(w, a, -h))) / (2.0 * h);
                let force = (lagrangian(&with(q, i, h), w) - lagrangian(&with(q, i, -h), w)) / (2.0 * h);
                prop_assert!((torque[i] - (rate - force)).abs() < 2e-6, "{i}: {torque}");
            }
        }

        #[test]
        fn coriolis_forces_do_no_work(values in prop::collection::vec(-2.0f64..2.0, 8)) {
            let equations = Equations::of(&rig(4));
            let (q, w) = (&values[..4], &values[4..]);
            let h = 1e-5;
            let moved = |by: f64| -> Vec<f64> { q.iter().zip(w).map(|(q, w)| q + by * w).collect() };
            let rate = (equations.mass(&moved(h)) - equations.mass(&moved(-h))) / (2.0 * h);
            let skew = rate - 2.0 * equations.coriolis(q, w);
            prop_assert!((&skew + skew.transpose()).amax() < 1e-7, "{skew}");
        }

        #[test]
        fn the_slope_is_gravity_s(q in prop::collection::vec(-3.0f64..3.0, 4)) {
            let equations = Equations::of(&rig(4));
            let slope = equations.gravity_slope(&q);
            let h = 1e-6;
            for j in 0..4 {
                let (mut up, mut down) = (q.clone(), q.clone());
                up[j] += h;
                down[j] -= h;
                let difference = (equations.gravity(&up) - equations.gravity(&down)) / (2.0 * h);
                prop_assert!((slope.column(j) - difference).amax() < 1e-8);
            }
        }
    }
}
