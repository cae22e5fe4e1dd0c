//! Equations of motion of three links on a bar, by the Jacobians of their centres of mass.
//!
//! With q the angles between links, upright at 0, link b at t_b = q_1 + .. + q_b, its centre of
//! mass is p_b = sum_{i<b} l_i e(t_i) + c_b e(t_b), e(t) = (sin t, cos t). Joint j turns everything
//! beyond it, so that column j of the Jacobian is p_b - (place of joint j), turned by a right
//! angle. Then M = sum m J'J + I w'w, and the forces are sum J' m (g - acceleration at q'' = 0).

use super::robot::Link;

/// Gravity, m/s^2.
const G_M_S2: f64 = 9.806_65;

/// A vector of the joints.
pub type Joints = [f64; 3];

/// Mass matrix and what acts without any torque, N m.
#[derive(Debug, Clone, Copy)]
pub struct Equations {
    /// Mass matrix.
    pub mass: [Joints; 3],
    /// Gravity, centrifugal and Coriolis torques.
    pub force: Joints,
}

impl Equations {
    /// At these angles and speeds.
    pub fn at(links: &[Link; 3], q: &Joints, w: &Joints) -> Equations {
        let mut equations = Equations {
            mass: [[0.0; 3]; 3],
            force: [0.0; 3],
        };
        // Place and acceleration of each joint, and angle and speed of its link.
        let mut joints = [[0.0_f64; 2]; 3];
        let (mut place, mut acceleration) = ([0.0_f64; 2], [0.0_f64; 2]);
        let (mut angle, mut speed) = (0.0_f64, 0.0_f64);
        for (b, link) in links.iter().enumerate() {
            joints[b] = place;
            angle += q[b];
            speed += w[b];
            let (sin, cos) = angle.sin_cos();
            let centre = [place[0] + link.com_m * sin, place[1] + link.com_m * cos];
            let inward = link.com_m * speed * speed;
            let drag = [
                acceleration[0] - inward * sin,
                acceleration[1] - inward * cos,
            ];
            // A turn of joint j by dq moves (x, y) about it by dq (y, -x).
            let column = |j: usize| [centre[1] - joints[j][1], joints[j][0] - centre[0]];
            for j in 0..=b {
                let own = column(j);
                for k in 0..=b {
                    let other = column(k);
                    let dot = own[0] * other[0] + own[1] * other[1];
                    equations.mass[j][k] += link.mass_kg * dot + link.inertia_kg_m2;
                }
                let along = own[0] * drag[0] + own[1] * (drag[1] + G_M_S2);
                equations.force[j] -= link.mass_kg * along;
            }
            let end = link.length_m * speed * speed;
            place = [
                place[0] + link.length_m * sin,
                place[1] + link.length_m * cos,
            ];
            acceleration = [acceleration[0] - end * sin, acceleration[1] - end * cos];
        }
        equations
    }

    /// Accelerations under these torques, rad/s^2.
    pub fn accelerate(&self, torque: &Joints) -> Joints {
        let right = std::array::from_fn(|j| self.force[j] + torque[j]);
        solve(&self.mass, right)
    }
}

/// x of M x = b, M symmetric and positive, by Cramer's rule.
pub fn solve(m: &[Joints; 3], b: Joints) -> Joints {
    let det = |m: &[Joints; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(m);
    std::array::from_fn(|column| {
        let mut with = *m;
        for (row, value) in with.iter_mut().zip(b) {
            row[column] = value;
        }
        det(&with) / whole
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINKS: [Link; 3] = [
        Link {
            length_m: 0.14,
            com_m: 0.07,
            mass_kg: 0.4,
            inertia_kg_m2: 8e-4,
        },
        Link {
            length_m: 0.12,
            com_m: 0.06,
            mass_kg: 1.0,
            inertia_kg_m2: 3e-3,
        },
        Link {
            length_m: 0.18,
            com_m: 0.12,
            mass_kg: 0.6,
            inertia_kg_m2: 1e-3,
        },
    ];

    /// Energy of the chain, J, by positions and their differences.
    fn energy(q: &Joints, w: &Joints) -> f64 {
        let places = |q: &Joints| {
            let (mut angle, mut place, mut all) = (0.0, [0.0, 0.0], Vec::new());
            for (link, turn) in LINKS.iter().zip(q) {
                angle += turn;
                let at = |length: f64| {
                    [
                        place[0] + length * f64::sin(angle),
                        place[1] + length * f64::cos(angle),
                    ]
                };
                all.push((at(link.com_m), angle));
                place = at(link.length_m);
            }
            all
        };
        let h = 1e-5;
        let moved = |sign: f64| places(&std::array::from_fn(|j| q[j] + sign * h * w[j]));
        let (after, before, now) = (moved(1.0), moved(-1.0), places(q));
        let each = LINKS.iter().enumerate().map(|(b, link)| {
            let rate = |axis: usize| (after[b].0[axis] - before[b].0[axis]) / (2.0 * h);
            let turn = (after[b].1 - before[b].1) / (2.0 * h);
            0.5 * link.mass_kg * (rate(0).powi(2) + rate(1).powi(2))
                + 0.5 * link.inertia_kg_m2 * turn * turn
                + link.mass_kg * G_M_S2 * now[b].0[1]
        });
        each.sum()
    }

    /// A free fall keeps its energy, which is computed another way.
    #[test]
    fn energy_is_kept() {
        let (mut q, mut w): (Joints, Joints) = ([0.3, -0.5, 0.8], [1.0, -2.0, 3.0]);
        let before = energy(&q, &w);
        for _ in 0..20_000 {
            // The midpoint rule in steps of 10 us.
            let h = 1e-5;
            let a = Equations::at(&LINKS, &q, &w).accelerate(&[0.0; 3]);
            let half_q = std::array::from_fn(|j| q[j] + 0.5 * h * w[j]);
            let half_w: Joints = std::array::from_fn(|j| w[j] + 0.5 * h * a[j]);
            let a = Equations::at(&LINKS, &half_q, &half_w).accelerate(&[0.0; 3]);
            for j in 0..3 {
                q[j] += h * half_w[j];
                w[j] += h * a[j];
            }
        }
        assert!((energy(&q, &w) - before).abs() < 1e-5 * before.abs().max(1.0));
    }
}
