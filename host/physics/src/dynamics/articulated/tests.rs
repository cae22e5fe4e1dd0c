use super::*;
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
            slide: None,
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
        let (mut work, base) = (Workspace::new(n), chain.base_m_s2(turn));
        chain.forward(&mut work, base, q, w, &torque, &vec![false; n], &mut out);
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

/// A base that is pushed by what the chain asks of it stays where it is; one that is free moves so
/// that the momentum of base and chain stays.
#[test]
fn a_free_base_takes_what_the_chain_asks_of_it() {
    let chain = chain(3);
    let (q, w, torque) = ([0.4, -0.7, 1.1], [2.0, -1.0, 3.0], [0.3, -0.2, 0.1]);
    let mut work = Workspace::new(3);
    let held = [false; 3];
    let gravity = chain.base_m_s2(0.3);
    let mut fixed = [0.0; 3];
    chain.forward(&mut work, gravity, &q, &w, &torque, &held, &mut fixed);
    let mut asked = [0.0; 2];
    chain.newton_euler(0.3, [&q, &w, &fixed], |i, _, force| {
        if i == 0 {
            asked = force;
        }
    });
    let mut on = |base: FreeBase| {
        let mut out = [0.0; 3];
        let own = chain.forward_on(base, &mut work, gravity, &q, &w, &torque, &held, &mut out);
        (own, out)
    };
    let (own, out) = on(FreeBase {
        mass_kg: 2.0,
        force_n: asked,
    });
    assert!(own.iter().all(|a| a.abs() < 1e-9), "{own:?}");
    assert!(out.iter().zip(fixed).all(|(a, b)| (a - b).abs() < 1e-9));

    let free = FreeBase {
        mass_kg: 2.0,
        force_n: [0.0; 2],
    };
    let (own, out) = on(free);
    // What turns gravity into an acceleration of the base turns this one into gravity.
    let felt = [gravity[0] + own[0], gravity[1] + own[1]];
    let mut accelerated = [0.0; 3];
    chain.forward(&mut work, felt, &q, &w, &torque, &held, &mut accelerated);
    assert!(
        out.iter()
            .zip(accelerated)
            .all(|(a, b)| (a - b).abs() < 1e-9)
    );
    let mut turned = chain.clone();
    turned.gravity_m_s2 = felt[0].hypot(felt[1]);
    let turn = (-felt[0]).atan2(felt[1]);
    turned.newton_euler(turn, [&q, &w, &out], |i, _, force| {
        if i == 0 {
            asked = force;
        }
    });
    for k in 0..2 {
        assert!((2.0 * own[k] + asked[k]).abs() < 1e-9, "{own:?} {asked:?}");
    }
}
