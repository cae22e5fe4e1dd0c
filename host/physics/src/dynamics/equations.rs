//! The chain's equations of motion in closed form: M(q) q'' + C(q, q') q' + G(q) = torque, for any
//! n.
//!
//! With absolute angles t, the centre of mass of link j lies at the sum of the lengths before it
//! and its own lever. As complex numbers the kinetic energy is (1/2) sum_ij M_ij t_i' t_j' with
//!
//! ```text
//! M_ii = I_i + m_i c_i^2 + l_i^2 (m_{i+1} + ..)      M_ij = l_i Re(p_j e^{i (t_j - t_i)}),  i < j
//! p_j  = m_j c_j e^{i d_j} + l_j (m_{j+1} + ..)      G_j  = base . (p_j e^{i t_j})
//! ```
//!
//! where d is the angle of the centre of mass off the link's line and base is [`Chain::base_m_s2`].
//! M depends on differences of angles only, so Lagrange's equations leave C_ij = (dM_ij / dt_j)
//! t_j', for which dM/dt - 2 C is skew. A rotor of inertia J at joint i adds J to M_ii and
//! M_{i-1,i-1} and takes J from M_{i,i-1}. Relative angles q follow from t = L q with L the lower
//! triangle of ones: M becomes L^T M L, and so on. (Spong, Hutchinson, Vidyasagar, Robot Modeling
//! and Control (2006), chapter 7.)

use super::chain::Chain;
use super::jacobians::Jacobians;
use super::lanes::Lane;
use nalgebra::{DMatrix, DVector};

/// One link's constants in the equations of motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinkTerms {
    /// Joint to next joint, m.
    pub length_m: f64,
    /// p_j above: first moment of the link and all it carries, along and across it, kg m.
    pub along: f64,
    pub across: f64,
    /// M_ii above with the rotors, kg m^2.
    pub diagonal: f64,
    /// Reflected rotor inertia of the link's joint: couples the link with the one before.
    pub armature_kg_m2: f64,
}

impl LinkTerms {
    /// Of every link, from the base outwards.
    pub fn of(chain: &Chain) -> Vec<LinkTerms> {
        let (mut beyond_kg, mut next_armature) = (0.0, 0.0);
        let mut terms = Vec::with_capacity(chain.len());
        for link in chain.links.iter().rev() {
            let (sin, cos) = link.com_angle_rad.sin_cos();
            let moment = link.mass_kg * link.com_m;
            terms.push(LinkTerms {
                length_m: link.length_m,
                along: moment * cos + link.length_m * beyond_kg,
                across: moment * sin,
                diagonal: link.inertia_kg_m2
                    + moment * link.com_m
                    + link.length_m * link.length_m * beyond_kg
                    + link.armature_kg_m2
                    + next_armature,
                armature_kg_m2: link.armature_kg_m2,
            });
            beyond_kg += link.mass_kg;
            next_armature = link.armature_kg_m2;
        }
        terms.reverse();
        terms
    }
}

/// A link at its absolute angle t: l e^{i t}, m, and p e^{i t}, kg m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turned<V> {
    pub lever: [V; 2],
    pub moment: [V; 2],
}

impl<V: Lane> Turned<V> {
    #[inline(always)]
    pub fn new(length_m: V, [along, across]: [V; 2], (sin, cos): (V, V)) -> Turned<V> {
        Turned {
            lever: [length_m * cos, length_m * sin],
            moment: [along * cos - across * sin, along * sin + across * cos],
        }
    }
}

/// Real and imaginary part of l_i p_j e^{i (t_j - t_i)} for i < j: M_ij, and -dM_ij/dt_j.
#[inline(always)]
pub(super) fn coupling<V: Lane>(i: &Turned<V>, j: &Turned<V>) -> [V; 2] {
    let ([a, b], [p, r]) = (i.lever, j.moment);
    [a * p + b * r, a * r - b * p]
}

/// G_j: the moment that holds link j against gravity, N m.
#[inline(always)]
pub(super) fn weight<V: Lane>(base_m_s2: [V; 2], link: &Turned<V>) -> V {
    base_m_s2[0] * link.moment[0] + base_m_s2[1] * link.moment[1]
}

/// Closed-form equations of a planar chain of any length, angles relative, the first from hanging:
/// for analysis.
///
/// [`Dense`](super::Dense) runs the same formulas in simulations; [`Chain::forward`] computes the
/// same motion by recursion.
#[derive(Debug, Clone)]
pub struct EquationsOfMotion {
    terms: Vec<LinkTerms>,
    base_m_s2: [f64; 2],
    /// The chain, if a joint of it slides: its equations have no such terms.
    slides: Option<Chain>,
}

impl EquationsOfMotion {
    /// The equations of `chain`, gravity turned counter-clockwise by `gravity_turn_rad`.
    pub fn new(chain: &Chain, gravity_turn_rad: f64) -> EquationsOfMotion {
        EquationsOfMotion {
            terms: LinkTerms::of(chain),
            base_m_s2: chain.base_m_s2(gravity_turn_rad),
            slides: chain.slides().then(|| chain.clone()),
        }
    }

    /// Whether any joint slides; [`EquationsOfMotion::moments_kg_m`] then does not hold.
    pub fn slides(&self) -> bool {
        self.slides.is_some()
    }

    /// Moment of each link with all that hangs on its end, p_j above: along the link and across it,
    /// kg m.
    pub fn moments_kg_m(&self) -> Vec<[f64; 2]> {
        self.terms.iter().map(|t| [t.along, t.across]).collect()
    }

    /// M(q), n x n, kg m^2 (kg m, kg where joints slide): symmetric, positive definite.
    pub fn mass(&self, angle_rad: &[f64]) -> DMatrix<f64> {
        if let Some(chain) = &self.slides {
            return Jacobians::new(chain, angle_rad).mass(chain);
        }
        let turned = self.turned(angle_rad);
        relative(self.square(|i, j| match j - i {
            0 => self.terms[i].diagonal,
            1 => coupling(&turned[i], &turned[j])[0] - self.terms[j].armature_kg_m2,
            _ => coupling(&turned[i], &turned[j])[0],
        }))
    }

    /// C(q, q'), n x n, kg m^2/s: C q' are the Coriolis and centrifugal torques, and dM/dt - 2 C is
    /// skew.
    pub fn coriolis(&self, angle_rad: &[f64], speed_rad_s: &[f64]) -> DMatrix<f64> {
        if let Some(chain) = &self.slides {
            return Jacobians::new(chain, angle_rad).coriolis(chain, speed_rad_s);
        }
        let turned = self.turned(angle_rad);
        let mut c = self.square(|i, j| {
            if i == j {
                0.0
            } else {
                coupling(&turned[i], &turned[j])[1]
            }
        });
        for (j, speed) in absolute(speed_rad_s).into_iter().enumerate() {
            c.column_mut(j).scale_mut(speed);
            c.view_mut((0, j), (j, 1)).neg_mut();
        }
        relative(c)
    }

    /// G(q), n, N m (N where joints slide): the torques that hold the chain at rest.
    pub fn gravity(&self, angle_rad: &[f64]) -> DVector<f64> {
        if let Some(chain) = &self.slides {
            return Jacobians::new(chain, angle_rad).gravity(chain, self.base_m_s2);
        }
        let turned = self.turned(angle_rad);
        let weights = turned.iter().map(|link| weight(self.base_m_s2, link));
        let mut torque = DVector::from_iterator(turned.len(), weights);
        for i in (1..torque.len()).rev() {
            torque[i - 1] += torque[i];
        }
        torque
    }

    /// dG/dq, n x n, N m/rad.
    pub fn gravity_slope(&self, angle_rad: &[f64]) -> DMatrix<f64> {
        if let Some(chain) = &self.slides {
            return Jacobians::new(chain, angle_rad).gravity_slope(chain, self.base_m_s2);
        }
        let [x, y] = self.base_m_s2;
        let turned = self.turned(angle_rad);
        // A turn by dt moves (a, b) by (-b, a) dt.
        let slopes = turned.iter().map(|link| weight([y, -x], link));
        relative(DMatrix::from_diagonal(&DVector::from_iterator(
            turned.len(),
            slopes,
        )))
    }

    fn turned(&self, angle_rad: &[f64]) -> Vec<Turned<f64>> {
        let links = self.terms.iter().zip(absolute(angle_rad));
        links
            .map(|(t, angle)| Turned::new(t.length_m, [t.along, t.across], Lane::sin_cos(angle)))
            .collect()
    }

    /// A symmetric matrix of `of(i, j)` with i <= j.
    fn square(&self, of: impl Fn(usize, usize) -> f64) -> DMatrix<f64> {
        let n = self.terms.len();
        DMatrix::from_fn(n, n, |i, j| of(i.min(j), i.max(j)))
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
mod tests;
