//! The paper against its own model, and the equations of any n against Lagrange's.

use super::*;
use handstand_model::dynamics::{Chain, ChainLink, Workspace};

#[test]
fn every_number_agrees_or_is_a_misprint() {
    let computed = Computed::new().unwrap();
    let rows = check(&computed);
    assert_eq!(rows.len(), 60);
    let misprints: Vec<String> = rows
        .iter()
        .filter(|row| row.verdict != Agreement::Agrees)
        .map(|row| format!("{} {}", row.printed.quantity.name(), row.verdict))
        .collect();
    assert_eq!(
        misprints,
        [
            "A[6,1] misprint: sign lost",
            "k[1,1] misprint: -114.7206 for -146.7206",
            "k[1,5] misprint: sign lost",
            "k[2,1] misprint: sign lost",
            "k[2,5] misprint: sign lost",
        ]
    );
}

/// A wrong model must show: a link 1 mm longer spoils A.
#[test]
fn another_robot_differs() {
    let mut computed = Computed::new().unwrap();
    computed.model.links[1].length_m += 1e-3;
    computed.plant =
        crate::synth::linearise(&computed.model, &crate::synth::upright(&computed.model))
            .unwrap()
            .plant;
    let wrong = check(&computed);
    let differing = wrong.iter().filter(|row| row.verdict == Agreement::Differs);
    assert!(differing.count() >= 10);
}

/// While the torques hold shoulder and hip, the robot is one rigid body on the bar.
#[test]
fn the_zeros_of_the_held_joints_are_a_rigid_pendulum_s() {
    let computed = Computed::new().unwrap();
    let (mut moment, mut inertia, mut base) = (0.0, 0.0, 0.0);
    for link in &computed.model.links {
        let at = base + link.com_m;
        moment += link.mass_kg * at;
        inertia += link.inertia_kg_m2 + link.mass_kg * at * at;
        base += link.length_m;
    }
    let zeros = computed.zeros.iter().find(|z| z.outputs == [2, 3]).unwrap();
    assert!((zeros.squared - 9.81 * moment / inertia).abs() < 1e-9 * zeros.squared);
}

fn chain(n: usize) -> Chain {
    let link = |i: usize| ChainLink {
        length_m: 0.12 + 0.02 * i as f64,
        com_m: 0.05 + 0.013 * i as f64,
        com_angle_rad: 0.07 * i as f64,
        mass_kg: 0.9 / (1.0 + i as f64),
        inertia_kg_m2: 8e-4,
        armature_kg_m2: 0.0,
        slide: None,
    };
    Chain {
        links: (0..n).map(link).collect(),
        gravity_m_s2: 9.81,
    }
}

/// Lagrange's equations with every derivative by differences of kinetic and potential energy, n = 1
/// to 6.
#[test]
fn inverse_dynamics_are_lagrange_s_for_any_n() {
    for n in 1..=6 {
        let chain = chain(n);
        let wave =
            |scale: f64| -> Vec<f64> { (0..n).map(|i| (scale * (i + 1) as f64).sin()).collect() };
        let (q, w, a) = (wave(1.3), wave(2.1), wave(0.7));
        let mut torque = vec![0.0; n];
        chain.inverse(0.0, &q, &w, &a, &mut torque);
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
        let ahead = |x: &[f64], v: &[f64], by: f64| -> Vec<f64> {
            x.iter().zip(v).map(|(x, v)| x + by * v).collect()
        };
        for (i, torque) in torque.iter().enumerate() {
            let momentum = |q: &[f64], w: &[f64]| {
                (lagrangian(q, &with(w, i, h)) - lagrangian(q, &with(w, i, -h))) / (2.0 * h)
            };
            let rate = (momentum(&ahead(&q, &w, h), &ahead(&w, &a, h))
                - momentum(&ahead(&q, &w, -h), &ahead(&w, &a, -h)))
                / (2.0 * h);
            let force =
                (lagrangian(&with(&q, i, h), &w) - lagrangian(&with(&q, i, -h), &w)) / (2.0 * h);
            let off = (torque - (rate - force)).abs();
            assert!(off < 1e-6, "n = {n}, joint {i}: {off}");
        }
    }
}

/// Half a second of free fall by forward dynamics, n = 1 to 6.
#[test]
fn energy_is_kept_for_any_n() {
    for n in 1..=6 {
        let chain = chain(n);
        let mut work = Workspace::new(n);
        let (mut q, mut w) = (vec![1.2; n], vec![0.0; n]);
        let total = |q: &[f64], w: &[f64]| {
            let (kinetic, potential) = chain.energy_j(q, w);
            kinetic + potential
        };
        let before = total(&q, &w);
        let h = 1e-4;
        for _ in 0..5000 {
            let mut accelerate = |q: &[f64], w: &[f64]| {
                let mut out = vec![0.0; n];
                let (none, base) = (vec![0.0; n], chain.base_m_s2(0.0));
                chain.forward(&mut work, base, q, w, &none, &vec![false; n], &mut out);
                out
            };
            let add = |x: &[f64], k: f64, dx: &[f64]| -> Vec<f64> {
                x.iter().zip(dx).map(|(x, d)| x + k * d).collect()
            };
            let a1 = accelerate(&q, &w);
            let (q2, w2) = (add(&q, h / 2.0, &w), add(&w, h / 2.0, &a1));
            let a2 = accelerate(&q2, &w2);
            (q, w) = (add(&q, h, &w2), add(&w, h, &a2));
        }
        let (kinetic, _) = chain.energy_j(&q, &w);
        let off = (total(&q, &w) - before).abs();
        assert!(kinetic > 0.05, "n = {n}: it moves");
        assert!(off < 1e-5 * kinetic.max(1.0), "n = {n}: {off}");
    }
}

/// What the figures and findings conclude, as the documentation states it.
#[test]
fn figures_and_findings_conclude() {
    let study = reproduce(&|_| ()).unwrap();
    for figure in &study.figures {
        println!(
            "{} {}: {}",
            figure.number,
            figure.holds.words(),
            figure.sentence
        );
    }
    for finding in &study.findings {
        println!(
            "{} {}: {}",
            finding.number,
            finding.holds.words(),
            finding.said
        );
    }
    let numbers: Vec<&str> = study.figures.iter().map(|figure| figure.number).collect();
    assert_eq!(
        numbers,
        ["4", "5", "7", "9", "10", "12", "13", "14 a,c,e", "14 b,d,f"]
    );
    for number in ["4", "5", "7", "10", "12", "13", "14 a,c,e"] {
        let figure = study
            .figures
            .iter()
            .find(|figure| figure.number == number)
            .unwrap();
        assert_eq!(figure.holds, Holds::Yes, "{number}: {}", figure.sentence);
    }
    assert_eq!(study.findings.len(), 16);
}
