use super::*;
use crate::dynamics::{ChainLink, Workspace};
use proptest::prelude::*;

/// Links of which none is like another, some eccentric, some with a rotor.
fn chain(n: usize) -> Chain {
    let link = |i: usize| ChainLink {
        length_m: 0.1 + 0.03 * i as f64,
        com_m: 0.05 + 0.02 * i as f64,
        com_angle_rad: 0.2 * i as f64 - 0.1,
        mass_kg: 0.3 + 0.1 * i as f64,
        inertia_kg_m2: 1e-3 * (1.0 + i as f64),
        armature_kg_m2: 1e-3 * (i % 2) as f64,
        slide: None,
    };
    Chain {
        links: (0..n).map(link).collect(),
        gravity_m_s2: 9.81,
    }
}

/// Largest difference to the O(n) equations against the largest acceleration, whichever joints
/// are held.
fn differs<const N: usize>(turn: f64, angle: &[f64], speed: &[f64], torque: &[f64]) -> f64 {
    let chain = chain(N);
    let dense = Dense::<N>::new(&chain, turn).unwrap();
    let (angle, torque) = (from_fn(|i| angle[i]), from_fn(|i| torque[i]));
    let differs = |mask: usize| {
        let held: [bool; N] = from_fn(|i| mask >> i & 1 == 1);
        let speed = from_fn(|i| if held[i] { 0.0 } else { speed[i] });
        let mut theirs = [0.0; N];
        chain.forward(
            &mut Workspace::new(N),
            chain.base_m_s2(turn),
            &angle,
            &speed,
            &torque,
            &held,
            &mut theirs,
        );
        let ours = dense.forward(&angle, &speed, &torque, &held);
        let largest = theirs.iter().fold(1.0, |m: f64, a| m.max(a.abs()));
        let off = (0..N).fold(0.0, |m: f64, i| m.max((ours[i] - theirs[i]).abs()));
        off / largest
    };
    (0..1 << N).map(differs).fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn agrees_with_the_articulated_bodies(
        turn in -3.0f64..3.0,
        values in prop::collection::vec(-3.0f64..3.0, 12),
    ) {
        let (q, w, t) = (&values[..4], &values[4..8], &values[8..]);
        prop_assert!(differs::<1>(turn, q, w, t) < 1e-11);
        prop_assert!(differs::<2>(turn, q, w, t) < 1e-11);
        prop_assert!(differs::<3>(turn, q, w, t) < 1e-11);
        prop_assert!(differs::<4>(turn, q, w, t) < 1e-11);
    }
}

#[test]
fn lanes_give_the_same_bits() {
    let chains: [Dense<3>; 2] = from_fn(|k| Dense::new(&chain(3), 0.3 * k as f64).unwrap());
    let both = Dense::beside([&chains[0], &chains[1]]);
    let start = |k: usize| {
        (
            [1.0 + k as f64, 1.5, 9.2],
            [0.1, 0.2 * k as f64, -0.3],
            [0.1, 0.0, k as f64],
        )
    };
    let mut alone = [start(0), start(1)];
    let lanes = |x: [[f64; 3]; 2]| from_fn::<_, 3, _>(|i| Lanes([x[0][i], x[1][i]]));
    let mut q = lanes(alone.map(|s| s.0));
    let mut w = lanes(alone.map(|s| s.1));
    both.advance(
        &mut q,
        &mut w,
        &lanes(alone.map(|s| s.2)),
        Lanes([1e-3, 2e-3]),
        300,
    );
    for (k, (angle, speed, load)) in alone.iter_mut().enumerate() {
        chains[k].advance(angle, speed, load, [1e-3, 2e-3][k], 300);
    }
    assert_eq!(
        (q, w),
        (lanes(alone.map(|s| s.0)), lanes(alone.map(|s| s.1)))
    );
}

#[test]
fn energy_is_kept_without_friction() {
    let chain = chain(3);
    let dense = Dense::<3>::new(&chain, 0.0).unwrap();
    let energy = |q: &[f64; 3], w: &[f64; 3]| {
        let relative = |x: &[f64; 3]| [x[0], x[1] - x[0], x[2] - x[1]];
        let (kinetic, potential) = chain.energy_j(&relative(q), &relative(w));
        kinetic + potential
    };
    let (mut q, mut w) = ([1.0, 1.5, 1.2], [0.0; 3]);
    let before = energy(&q, &w);
    dense.advance(&mut q, &mut w, &[0.0; 3], 1e-3, 5000);
    assert!((energy(&q, &w) - before).abs() < 1e-8);
}
