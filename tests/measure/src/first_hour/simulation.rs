//! The truth: Lagrange's equations of one or two links, in absolute angles from hanging, by
//! Runge-Kutta's fourth order in steps of 0.1 ms. Friction is smoothed within 2 mrad/s.

use super::rig::{DrawnRig, DriveKind, Hidden, command};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

const STEP_S: f64 = 1e-4;
const SMOOTH_RAD_S: f64 = 2e-3;
const GRAVITY_M_S2: f64 = 9.81;
/// Encoder: 4096 steps a turn, and noise of a tenth of one.
const ENCODER_RAD: f64 = std::f64::consts::TAU / 4096.0;
/// Length of a log, s.
const LENGTH_S: f64 = 20.0;

/// Rows of a log in SI: time, then per joint its relative angle and its input.
pub(super) fn record(rig: &DrawnRig, log: usize) -> Vec<(f64, Vec<(f64, f64)>)> {
    let joints = rig.links.len();
    let mut chance = ChaCha8Rng::seed_from_u64(1000 * rig.seed + log as u64);
    let mut state = vec![0.0; 2 * joints];
    if rig.drive == DriveKind::Passive {
        let size = 1.0 - 0.25 * log as f64;
        (0..joints).for_each(|joint| state[joint] = size * if joint == 0 { 1.2 } else { 0.8 });
    }
    let every = (1.0 / (rig.rate_hz * STEP_S)).round() as usize;
    let steps = (LENGTH_S / STEP_S) as usize;
    let mut rows = Vec::new();
    for step in 0..steps {
        let time_s = step as f64 * STEP_S;
        if step % every == 0 {
            let row = (0..joints).map(|joint| {
                let inner = if joint == 0 { 0.0 } else { state[joint - 1] };
                let noise = chance.random_range(-0.2..0.2);
                let angle = ((state[joint] - inner) / ENCODER_RAD + noise).round() * ENCODER_RAD;
                (angle, command(rig, log, joint, held(rig, time_s)))
            });
            rows.push((time_s, row.collect()));
        }
        advance(rig, log, time_s, &mut state);
    }
    rows
}

/// When the command in force was given: the recorder's host sends one a row.
fn held(rig: &DrawnRig, time_s: f64) -> f64 {
    (time_s * rig.rate_hz + 1e-6).floor() / rig.rate_hz
}

fn advance(rig: &DrawnRig, log: usize, time_s: f64, state: &mut [f64]) {
    let slope = |state: &[f64], time_s: f64| slope(rig, log, time_s, state);
    let moved = |by: f64, slope: &[f64]| -> Vec<f64> {
        state.iter().zip(slope).map(|(x, dx)| x + by * dx).collect()
    };
    let half = 0.5 * STEP_S;
    let a = slope(state, time_s);
    let b = slope(&moved(half, &a), time_s + half);
    let c = slope(&moved(half, &b), time_s + half);
    let d = slope(&moved(STEP_S, &c), time_s + STEP_S);
    for (k, x) in state.iter_mut().enumerate() {
        *x += STEP_S / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
    }
}

/// Speeds and accelerations; the state holds absolute angles, then absolute speeds.
fn slope(rig: &DrawnRig, log: usize, time_s: f64, state: &[f64]) -> Vec<f64> {
    let joints = rig.links.len();
    let (angle, speed) = state.split_at(joints);
    let torque: Vec<f64> = (0..joints)
        .map(|joint| joint_torque(rig, log, joint, time_s, angle, speed))
        .collect();
    // What a joint does to its link it does to the one before the other way.
    let on_link = |k: usize| torque[k] - torque.get(k + 1).copied().unwrap_or(0.0);
    let first = &rig.links[0];
    let mut acceleration = vec![0.0; joints];
    if let [_, second] = &rig.links[..] {
        let (l, c) = (first.length_m, second.com_m);
        let between = angle[0] - angle[1];
        let m11 =
            first.inertia_kg_m2 + first.mass_kg * first.com_m.powi(2) + second.mass_kg * l * l;
        let m22 = second.inertia_kg_m2 + second.mass_kg * c * c;
        let m12 = second.mass_kg * l * c * between.cos();
        let swirl = second.mass_kg * l * c * between.sin();
        let g1 = GRAVITY_M_S2 * (first.mass_kg * first.com_m + second.mass_kg * l) * angle[0].sin();
        let g2 = GRAVITY_M_S2 * second.mass_kg * c * angle[1].sin();
        let f1 = on_link(0) - swirl * speed[1] * speed[1] - g1;
        let f2 = on_link(1) + swirl * speed[0] * speed[0] - g2;
        let determinant = m11 * m22 - m12 * m12;
        acceleration[0] = (m22 * f1 - m12 * f2) / determinant;
        acceleration[1] = (m11 * f2 - m12 * f1) / determinant;
    } else {
        let inertia = first.inertia_kg_m2 + first.mass_kg * first.com_m.powi(2);
        let gravity = GRAVITY_M_S2 * first.mass_kg * first.com_m * angle[0].sin();
        acceleration[0] = (on_link(0) - gravity) / inertia;
    }
    speed.iter().copied().chain(acceleration).collect()
}

fn joint_torque(
    rig: &DrawnRig,
    log: usize,
    joint: usize,
    time_s: f64,
    angle: &[f64],
    speed: &[f64],
) -> f64 {
    let link = &rig.links[joint];
    let inner = |values: &[f64]| if joint == 0 { 0.0 } else { values[joint - 1] };
    let (q, w) = (angle[joint] - inner(angle), speed[joint] - inner(speed));
    let first = joint == 0;
    let late_s = match rig.hidden {
        Hidden::Delay(delay_s) => delay_s,
        _ => 0.0,
    };
    let commanded = command(rig, log, joint, held(rig, (time_s - late_s).max(0.0)));
    let dead = |share: f64, most: f64| match rig.hidden {
        Hidden::DeadZone(zone) if first && share.abs() <= zone * most => 0.0,
        Hidden::DeadZone(zone) if first => share - share.signum() * zone * most,
        _ => share,
    };
    let motor = |duty: f64| {
        let duty = dead(duty.clamp(-1.0, 1.0), 1.0);
        link.stall_nm * (duty - w / link.no_load_rad_s)
    };
    let driven = match rig.drive {
        DriveKind::Passive => 0.0,
        DriveKind::Torque => dead(commanded, link.stall_nm),
        DriveKind::Duty => motor(commanded),
        DriveKind::Position => motor(link.gain * (commanded - q)),
        DriveKind::Speed => motor(0.1 * link.gain * (commanded - w)),
    };
    let sign = (w / SMOOTH_RAD_S).tanh();
    let beside = match rig.hidden {
        Hidden::AirDrag(drag) if first => -drag * w * w.abs(),
        Hidden::Coulomb(torque) if first => -torque * sign,
        Hidden::TorqueOffset(torque) if first => torque,
        Hidden::Cogging(torque) if first => -torque * (8.0 * q).sin(),
        Hidden::Spring(stiffness) if first => -stiffness * q,
        _ => 0.0,
    };
    driven + beside - link.viscous_nm_s_rad * w - link.coulomb_nm * sign
}
