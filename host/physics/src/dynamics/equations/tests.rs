use super::*;
use crate::dynamics::ChainLink;
use proptest::prelude::*;

fn chain(n: usize) -> Chain {
    let link = |i: usize| ChainLink {
        length_m: 0.1 + 0.03 * i as f64,
        com_m: 0.05 + 0.02 * i as f64,
        com_angle_rad: 0.1 * i as f64 - 0.1,
        mass_kg: 0.3 + 0.1 * i as f64,
        inertia_kg_m2: 1e-3,
        armature_kg_m2: if i == 1 { 2e-3 } else { 0.0 },
        slide: None,
    };
    Chain {
        links: (0..n).map(link).collect(),
        gravity_m_s2: 9.81,
    }
}

proptest! {
    #[test]
    fn they_are_the_torques_newton_and_euler_ask_for(
        n in 1usize..7,
        values in prop::collection::vec(-3.0f64..3.0, 21),
    ) {
        let (chain, turn) = (chain(n), 0.2);
        let (q, w, a) = (&values[..n], &values[7..7 + n], &values[14..14 + n]);
        let equations = EquationsOfMotion::new(&chain, turn);
        let torque = equations.mass(q) * DVector::from_column_slice(a)
            + equations.coriolis(q, w) * DVector::from_column_slice(w)
            + equations.gravity(q);
        let mut expected = vec![0.0; n];
        chain.inverse(turn, q, w, a, &mut expected);
        for i in 0..n {
            prop_assert!((torque[i] - expected[i]).abs() < 1e-11, "{torque} {expected:?}");
        }
    }

    /// Lagrange: torque = d/dt (dT/dw) - dT/dq + dV/dq, every derivative by central differences
    /// of the energy.
    #[test]
    fn they_are_the_lagrangian_s(values in prop::collection::vec(-2.0f64..2.0, 9)) {
        let n = 3;
        let chain = chain(n);
        let (q, w, a) = (&values[..3], &values[3..6], &values[6..9]);
        let equations = EquationsOfMotion::new(&chain, 0.0);
        let torque = equations.mass(q) * DVector::from_column_slice(a)
            + equations.coriolis(q, w) * DVector::from_column_slice(w)
            + equations.gravity(q);
        let h = 1e-4;
        let lagrangian = |q: &[f64], w: &[f64]| {
            let (kinetic, potential) = chain.energy_j(q, w);
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
            let moved = |by: f64| lagrangian(&with(q, i, by), w);
            let force = (moved(h) - moved(-h)) / (2.0 * h);
            prop_assert!((torque[i] - (rate - force)).abs() < 2e-6, "{i}: {torque}");
        }
    }

    #[test]
    fn coriolis_forces_do_no_work(values in prop::collection::vec(-2.0f64..2.0, 8)) {
        let equations = EquationsOfMotion::new(&chain(4), 0.2);
        let (q, w) = (&values[..4], &values[4..]);
        let h = 1e-5;
        let moved = |by: f64| -> Vec<f64> {
            q.iter().zip(w).map(|(q, w)| q + by * w).collect()
        };
        let rate = (equations.mass(&moved(h)) - equations.mass(&moved(-h))) / (2.0 * h);
        let skew = rate - 2.0 * equations.coriolis(q, w);
        prop_assert!((&skew + skew.transpose()).amax() < 1e-7, "{skew}");
    }

    #[test]
    fn the_slope_is_gravity_s(q in prop::collection::vec(-3.0f64..3.0, 4)) {
        let equations = EquationsOfMotion::new(&chain(4), 0.2);
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
