//! Equations of motion of a short chain with a dense mass matrix, in absolute angles.
//!
//! The closed form is that of [`EquationsOfMotion`](super::EquationsOfMotion); solved by LDL^T. For
//! few links that is faster than [`Chain::forward`]'s O(n), and [`Lanes`] run several chains at
//! once.
//!
//! Rest on it in `cargo xtask peers`: "forward dynamics, n = 3, closed form", the closed-loop runs.

use super::chain::Chain;
use super::equations::{LinkTerms, Turned, coupling, weight};
use super::lanes::{Lane, Lanes, each};
use super::runge_kutta::runge_kutta;
use std::array::from_fn;

/// Constants of a chain of `N` links, or of several in lanes.
#[derive(Debug, Clone)]
pub struct Dense<const N: usize, V = f64> {
    /// Joint to next joint, m.
    length_m: [V; N],
    /// First moment of a link and all it carries, along and across it, kg m.
    along: [V; N],
    across: [V; N],
    /// Diagonal of the mass matrix, kg m^2.
    diagonal: [V; N],
    /// Reflected rotor inertia of each joint, kg m^2: couples a link with the one before.
    armature: [V; N],
    /// Stands for gravity, m/s^2: see [`Chain::base_m_s2`].
    base_m_s2: [V; 2],
}

impl<const N: usize> Dense<N> {
    /// Equations of `chain`, gravity turned counter-clockwise by `gravity_turn_rad`; none unless it
    /// has `N` links, all on hinges.
    pub fn new(chain: &Chain, gravity_turn_rad: f64) -> Option<Self> {
        if chain.slides() {
            return None;
        }
        let terms: [LinkTerms; N] = LinkTerms::of(chain).try_into().ok()?;
        Some(Dense {
            length_m: terms.map(|t| t.length_m),
            along: terms.map(|t| t.along),
            across: terms.map(|t| t.across),
            diagonal: terms.map(|t| t.diagonal),
            armature: terms.map(|t| t.armature_kg_m2),
            base_m_s2: chain.base_m_s2(gravity_turn_rad),
        })
    }
}

impl<const N: usize> Dense<N> {
    /// [`Chain::forward`] at relative angles and speeds: accelerations of the joints, rad/s^2, and
    /// for held joints the torque that holds them, N m.
    #[inline]
    pub fn forward(
        &self,
        angle_rad: &[f64; N],
        speed_rad_s: &[f64; N],
        torque_nm: &[f64; N],
        held: &[bool; N],
    ) -> [f64; N] {
        let (angle, speed, load) = absolute(angle_rad, speed_rad_s, torque_nm);
        let (mass, rest) = self.equations(&angle, &speed, &load);
        if held.contains(&true) {
            forward_held(mass, rest, held)
        } else {
            differences(solve_at_once(&mass, &rest))
        }
    }

    /// A step of `step_s` with the joints' angles and speeds as [`Dense::forward`] has them, under
    /// constant torques; held joints stay where they are. `first` are the accelerations at the
    /// beginning where they are known already, which is of use only with joints held.
    #[inline]
    pub fn step(
        &self,
        angle_rad: &mut [f64; N],
        speed_rad_s: &mut [f64; N],
        torque_nm: &[f64; N],
        held: &[bool; N],
        step_s: f64,
        first: Option<&[f64; N]>,
    ) {
        if held.contains(&true) {
            let accelerate = |angle: &[f64; N], speed: &[f64; N]| {
                let found = self.forward(angle, speed, torque_nm, held);
                each(|i| if held[i] { 0.0 } else { found[i] })
            };
            let state = (*angle_rad, *speed_rad_s);
            (*angle_rad, *speed_rad_s) = runge_kutta(state, step_s, first.copied(), accelerate);
        } else {
            let (mut angle, mut speed, load) = absolute(angle_rad, speed_rad_s, torque_nm);
            self.advance(&mut angle, &mut speed, &load, step_s, 1);
            (*angle_rad, *speed_rad_s) = (differences(angle), differences(speed));
        }
    }
}

/// Angles and speeds from the world, and the moment on each link, from those of the joints.
#[inline(always)]
fn absolute<const N: usize>(
    angle: &[f64; N],
    speed: &[f64; N],
    torque: &[f64; N],
) -> ([f64; N], [f64; N], [f64; N]) {
    let (mut angle, mut speed, mut load) = (*angle, *speed, *torque);
    for i in 1..N {
        angle[i] += angle[i - 1];
        speed[i] += speed[i - 1];
        load[i - 1] -= torque[i];
    }
    (angle, speed, load)
}

/// Of the joints, from those of the links.
#[inline(always)]
fn differences<const N: usize>(mut links: [f64; N]) -> [f64; N] {
    for i in (1..N).rev() {
        links[i] -= links[i - 1];
    }
    links
}

impl<const N: usize, const L: usize> Dense<N, Lanes<L>> {
    /// Several chains side by side.
    pub fn beside(chains: [&Dense<N>; L]) -> Self {
        let row = |of: fn(&Dense<N>) -> &[f64; N]| {
            from_fn(|i| Lanes(from_fn(|lane| of(chains[lane])[i])))
        };
        Dense {
            length_m: row(|d| &d.length_m),
            along: row(|d| &d.along),
            across: row(|d| &d.across),
            diagonal: row(|d| &d.diagonal),
            armature: row(|d| &d.armature),
            base_m_s2: from_fn(|i| Lanes(from_fn(|lane| chains[lane].base_m_s2[i]))),
        }
    }
}

impl<const N: usize, V: Lane> Dense<N, V> {
    /// Absolute accelerations, rad/s^2, at absolute angles and speeds under a moment `load_nm` on
    /// each link.
    #[inline(always)]
    pub fn accelerate(&self, angle_rad: &[V; N], speed_rad_s: &[V; N], load_nm: &[V; N]) -> [V; N] {
        let (mass, rest) = self.equations(angle_rad, speed_rad_s, load_nm);
        solve(mass, rest)
    }

    /// Mass matrix, of which only the lower triangle is filled, and the moments it answers to.
    #[inline(always)]
    fn equations(
        &self,
        angle_rad: &[V; N],
        speed_rad_s: &[V; N],
        load_nm: &[V; N],
    ) -> ([[V; N]; N], [V; N]) {
        let zero = V::splat(0.0);
        let mut turned = [Turned {
            lever: [zero; 2],
            moment: [zero; 2],
        }; N];
        let (mut rest, mut square) = (*load_nm, [zero; N]);
        let (sin, cos) = V::sin_cos_of(*angle_rad);
        for i in 0..N {
            let moment = [self.along[i], self.across[i]];
            turned[i] = Turned::new(self.length_m[i], moment, (sin[i], cos[i]));
            rest[i] = rest[i] - weight(self.base_m_s2, &turned[i]);
            square[i] = speed_rad_s[i] * speed_rad_s[i];
        }
        let mut mass = [[zero; N]; N];
        for j in 0..N {
            for i in 0..j {
                let [entry, slope] = coupling(&turned[i], &turned[j]);
                mass[j][i] = entry;
                rest[i] = rest[i] + slope * square[j];
                rest[j] = rest[j] - slope * square[i];
            }
            mass[j][j] = self.diagonal[j];
            if j > 0 {
                mass[j][j - 1] = mass[j][j - 1] - self.armature[j];
            }
        }
        (mass, rest)
    }

    /// Runs `steps` steps of classical Runge-Kutta of fourth order, `step_s` each, under constant
    /// moments.
    #[inline(always)]
    pub fn advance(
        &self,
        angle_rad: &mut [V; N],
        speed_rad_s: &mut [V; N],
        load_nm: &[V; N],
        step_s: V,
        steps: usize,
    ) {
        let mut state = (*angle_rad, *speed_rad_s);
        for _ in 0..steps {
            // A closure that is called four times is not inlined by itself.
            state = runge_kutta(
                state,
                step_s,
                None,
                #[inline(always)]
                |q, w| self.accelerate(q, w, load_nm),
            );
        }
        (*angle_rad, *speed_rad_s) = state;
    }
}

/// [`Dense::forward`] with joints held: a link behind a held joint is one body with the link before
/// it, so their equations are added up; what they then lack is the torque that holds.
#[inline(never)]
#[expect(
    clippy::needless_range_loop,
    reason = "loops over places are unrolled, filtered ones are not: that takes half as long again"
)]
fn forward_held<const N: usize>(mass: [[f64; N]; N], rest: [f64; N], held: &[bool; N]) -> [f64; N] {
    let (mut joined, mut right) = (mass, rest);
    for i in (0..N).rev() {
        if !held[i] {
            continue;
        }
        if i > 0 {
            // The entry on the diagonal, and that beside it from both sides.
            joined[i - 1][i - 1] += 2.0 * joined[i][i - 1] + joined[i][i];
            for k in 0..i - 1 {
                joined[i - 1][k] += joined[i][k];
            }
            for k in i + 1..N {
                joined[k][i - 1] += joined[k][i];
            }
            right[i - 1] += right[i];
        }
        for k in 0..N {
            joined[i.max(k)][i.min(k)] = 0.0;
        }
        (joined[i][i], right[i]) = (1.0, 0.0);
    }
    let mut angular = solve_at_once(&joined, &right);
    for i in 0..N {
        if held[i] {
            angular[i] = if i == 0 { 0.0 } else { angular[i - 1] };
        }
    }
    let (mut out, mut beyond_nm) = (differences(angular), 0.0);
    for i in (0..N).rev() {
        let mut moment = -rest[i];
        for k in 0..N {
            moment += mass[i.max(k)][i.min(k)] * angular[k];
        }
        beyond_nm += moment;
        if held[i] {
            out[i] = beyond_nm;
        }
    }
    out
}

/// [`solve`] where the next evaluation waits for the result. By cofactors two or three links take
/// one division instead of one after another: more work, done sooner (three links 43 ns instead of
/// 62 ns). Where evaluations overlap, as in [`Dense::advance`], the work counts: 123 ns a step by
/// [`solve`], 146 ns by this.
#[inline(always)]
fn solve_at_once<const N: usize>(mass: &[[f64; N]; N], right: &[f64; N]) -> [f64; N] {
    let m = |i: usize, k: usize| mass[i][k];
    let mut out = *right;
    match N {
        2 => {
            let [a, b, c] = [m(0, 0), m(1, 0), m(1, 1)];
            let inverse = 1.0 / (a * c - b * b);
            out[0] = (c * right[0] - b * right[1]) * inverse;
            out[1] = (a * right[1] - b * right[0]) * inverse;
            out
        }
        3 => {
            let [a, b, c, d, e, f] = [m(0, 0), m(1, 0), m(2, 0), m(1, 1), m(2, 1), m(2, 2)];
            let [ab, ac, bc] = [c * e - b * f, b * e - c * d, b * c - a * e];
            let cofactors = [
                [d * f - e * e, ab, ac],
                [ab, a * f - c * c, bc],
                [ac, bc, a * d - b * b],
            ];
            let inverse = 1.0 / (a * cofactors[0][0] + b * ab + c * ac);
            for (out, row) in out.iter_mut().zip(cofactors) {
                *out = (row[0] * right[0] + row[1] * right[1] + row[2] * right[2]) * inverse;
            }
            out
        }
        _ => solve(*mass, *right),
    }
}

/// Solves `mass x = right`; of the symmetric matrix only the lower triangle is read.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "a matrix is read by its places")]
fn solve<const N: usize, V: Lane>(mut mass: [[V; N]; N], mut right: [V; N]) -> [V; N] {
    let mut inverse = [V::splat(0.0); N];
    for j in 0..N {
        inverse[j] = mass[j][j].inverse();
        for i in j + 1..N {
            let share = mass[i][j] * inverse[j];
            for k in j + 1..=i {
                mass[i][k] = mass[i][k] - share * mass[k][j];
            }
            right[i] = right[i] - share * right[j];
        }
    }
    // The columns now hold L D: one division by D for each row is left.
    for i in (0..N).rev() {
        let mut sum = right[i];
        for k in i + 1..N {
            sum = sum - mass[k][i] * right[k];
        }
        right[i] = sum * inverse[i];
    }
    right
}

#[cfg(test)]
mod tests;
