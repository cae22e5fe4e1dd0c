//! Forward dynamics of the chains of `chain.py`.

use super::median_seconds;
use handstand::dynamics::{Chain, ChainLink, Dense, Workspace};
use serde_json::Value;
use std::hint::black_box;

/// Length, centre of mass, mass, inertia about it, SI.
const PAPER_LINKS: [[f64; 4]; 3] = [
    [0.1436, 0.0687, 0.3676, 7890.7e-7],
    [0.1158, 0.0575, 0.9815, 32898.6e-7],
    [0.1840, 0.1163, 0.5764, 11328.0e-7],
];
const UNIFORM_LINK: [f64; 4] = [0.15, 0.075, 0.2, 3.75e-4];

/// The chain that `chain.py` calls by its number of links.
pub(super) fn chain(n: usize) -> Chain {
    let rows = match n {
        3 => PAPER_LINKS.to_vec(),
        n => vec![UNIFORM_LINK; n],
    };
    let link = |[length_m, com_m, mass_kg, inertia_kg_m2]: [f64; 4]| ChainLink {
        length_m,
        com_m,
        com_angle_rad: 0.0,
        mass_kg,
        inertia_kg_m2,
        armature_kg_m2: 0.0,
        slide: None,
    };
    Chain {
        links: rows.into_iter().map(link).collect(),
        gravity_m_s2: 9.81,
    }
}

/// The equations that simulations of such a chain run: in closed form up to four links, by
/// recursion beyond.
enum Equations {
    Closed(Box<Dense<3>>),
    Recursive { chain: Chain, work: Workspace },
}

impl Equations {
    fn of(n: usize) -> Equations {
        let chain = chain(n);
        match Dense::new(&chain, 0.0) {
            Some(dense) => Equations::Closed(Box::new(dense)),
            None => Equations::Recursive {
                work: Workspace::new(n),
                chain,
            },
        }
    }

    /// Accelerations, rad/s^2, from angles, speeds and torques; all as long as the chain.
    #[inline]
    fn accelerate(
        &mut self,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        torque_nm: &[f64],
        out: &mut [f64],
    ) {
        match self {
            Equations::Closed(dense) => {
                let three = |row: &[f64]| [row[0], row[1], row[2]];
                let (angle, speed, torque) =
                    (three(angle_rad), three(speed_rad_s), three(torque_nm));
                out.copy_from_slice(&dense.forward(
                    &angle,
                    &speed,
                    &torque,
                    &black_box([false; 3]),
                ));
            }
            Equations::Recursive { chain, work } => {
                let held = &HELD[..angle_rad.len()];
                let base = chain.base_m_s2(0.0);
                chain.forward(work, base, angle_rad, speed_rad_s, torque_nm, held, out);
            }
        }
    }
}

/// No joint is held, in the longest chain.
const HELD: [bool; 100] = [false; 100];

/// Median seconds of one evaluation; the angle moves a little on each, so that nothing can be saved
/// up.
pub fn forward_seconds(n: usize) -> f64 {
    let mut equations = Equations::of(n);
    let wave = |k: f64| move |i: usize| (k * (i + 1) as f64).sin();
    let mut angle: Vec<f64> = (0..n).map(wave(1.0)).collect();
    let speed: Vec<f64> = (0..n).map(wave(2.0)).collect();
    let torque: Vec<f64> = (0..n).map(wave(3.0)).collect();
    let mut out = vec![0.0; n];
    let calls = 300_000 / n;
    let seconds = median_seconds(15, || {
        for _ in 0..calls {
            angle[0] += 1e-9;
            equations.accelerate(black_box(&angle), &speed, &torque, &mut out);
            black_box(&mut out);
        }
    });
    seconds / calls as f64
}

/// Largest difference to a peer's accelerations in the file that `dynamics.py --accelerations`
/// writes, against the largest acceleration; none if the file lacks it.
pub fn farthest_off(states: &Value, n: usize, peer: &str) -> Option<f64> {
    let state = states.get(n.to_string())?;
    let list = |key: &str| -> Option<Vec<f64>> {
        let list = state.get(key)?.as_array()?;
        list.iter().map(Value::as_f64).collect()
    };
    let (angle, speed, torque) = (list("q_rad")?, list("dq_rad_s")?, list("tau_nm")?);
    let theirs = list(&format!("{peer}_rad_s2"))?;
    let mut ours = vec![0.0; n];
    Equations::of(n).accelerate(&angle, &speed, &torque, &mut ours);
    let largest = theirs.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let differences = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs());
    Some(differences.fold(0.0, f64::max) / largest)
}
