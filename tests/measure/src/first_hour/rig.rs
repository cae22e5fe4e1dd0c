//! A rig as drawn: links, drives, what is hidden, and how its logs are written.

use super::names::{Names, names};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// What moves the joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveKind {
    /// Nothing.
    Passive,
    /// A torque, N m.
    Torque,
    /// A share of the voltage.
    Duty,
    /// A goal angle.
    Position,
    /// A goal speed.
    Speed,
}

/// Every kind of drive, in the order in which rigs are drawn.
const KINDS: [DriveKind; 5] = [
    DriveKind::Passive,
    DriveKind::Torque,
    DriveKind::Duty,
    DriveKind::Position,
    DriveKind::Speed,
];

/// A rig.
#[derive(Debug, Clone)]
pub struct DrawnRig {
    /// What it was drawn from.
    pub seed: u64,
    /// What moves the joints.
    pub drive: DriveKind,
    /// Links from the base outwards.
    pub links: Vec<DrawnLink>,
    /// The effect beyond friction and what a data sheet says.
    pub hidden: Hidden,
    /// Columns of the logs.
    pub names: Names,
    /// Samples a second.
    pub rate_hz: f64,
}

/// A link with the joint before it.
#[derive(Debug, Clone)]
pub struct DrawnLink {
    /// Joint to next joint, m.
    pub length_m: f64,
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// About the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
    /// Viscous friction, N m s/rad.
    pub viscous_nm_s_rad: f64,
    /// Coulomb friction, N m.
    pub coulomb_nm: f64,
    /// Torque at standstill, N m.
    pub stall_nm: f64,
    /// Speed without load, rad/s.
    pub no_load_rad_s: f64,
    /// Duty per rad, or per rad/s.
    pub gain: f64,
}

/// What is hidden, with its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hidden {
    /// Torque against the square of the speed, N m s^2/rad^2.
    AirDrag(f64),
    /// Coulomb friction of this size alone, N m.
    Coulomb(f64),
    /// Commands act so much later, s.
    Delay(f64),
    /// Duties or torques below this share of the most do nothing.
    DeadZone(f64),
    /// A torque beside the drive's, N m.
    TorqueOffset(f64),
    /// Torque of the first joint's cogging, N m, eight times a turn.
    Cogging(f64),
    /// A spring to angle zero, N m/rad.
    Spring(f64),
}

impl DrawnLink {
    /// Torque that holds the link alone level, N m.
    fn level_nm(&self) -> f64 {
        9.81 * self.mass_kg * self.com_m
    }
}

impl Hidden {
    /// Ids of the library's effects that say it.
    pub fn ids(self) -> &'static [&'static str] {
        match self {
            Hidden::AirDrag(_) => &["air_drag"],
            Hidden::Coulomb(_) => &["coulomb"],
            Hidden::Delay(_) => &["delay", "time_offset"],
            Hidden::DeadZone(_) => &["dead_zone"],
            Hidden::TorqueOffset(_) => &["torque_offset"],
            Hidden::Cogging(_) => &["cogging"],
            Hidden::Spring(_) => &["cable_spring"],
        }
    }
}

impl DrawnRig {
    /// The rig of this seed.
    pub fn draw(seed: u64) -> DrawnRig {
        let mut chance = ChaCha8Rng::seed_from_u64(seed);
        let drive = KINDS[(seed % 5) as usize];
        let count = if seed % 3 == 2 { 2 } else { 1 };
        let links: Vec<DrawnLink> = (0..count).map(|_| link(&mut chance)).collect();
        let level_nm = links[0].level_nm();
        let hidden = hidden(&mut chance, drive, level_nm);
        let mut rig = DrawnRig {
            seed,
            drive,
            hidden,
            names: names(&mut chance, drive, count),
            rate_hz: [50.0, 100.0, 200.0][chance.random_range(0..3)],
            links,
        };
        rig.strengthen();
        rig
    }

    /// Drives that move what hangs on them.
    fn strengthen(&mut self) {
        let mut level_nm = 0.0;
        for link in self.links.iter_mut().rev() {
            level_nm += link.level_nm() + 0.3 * 9.81 * link.mass_kg * link.length_m;
            link.stall_nm *= level_nm;
        }
    }
}

fn link(chance: &mut ChaCha8Rng) -> DrawnLink {
    let length_m = chance.random_range(0.12..0.4);
    let mass_kg = chance.random_range(0.1..0.6);
    let com_m = length_m * chance.random_range(0.4..0.7);
    let level_nm = 9.81 * mass_kg * com_m;
    DrawnLink {
        length_m,
        com_m,
        mass_kg,
        inertia_kg_m2: mass_kg * length_m * length_m / 12.0 * chance.random_range(0.8..1.4),
        viscous_nm_s_rad: level_nm * chance.random_range(0.01..0.05),
        coulomb_nm: 0.0,
        stall_nm: chance.random_range(1.2..2.0),
        no_load_rad_s: chance.random_range(6.0..14.0),
        gain: chance.random_range(4.0..12.0),
    }
}

fn hidden(chance: &mut ChaCha8Rng, drive: DriveKind, level_nm: f64) -> Hidden {
    let part =
        |chance: &mut ChaCha8Rng, low: f64, high: f64| level_nm * chance.random_range(low..high);
    let kind = chance.random_range(0..4);
    match (drive, kind) {
        (DriveKind::Passive, 0 | 1) => Hidden::AirDrag(part(chance, 0.004, 0.02)),
        (DriveKind::Passive, _) => Hidden::Coulomb(part(chance, 0.005, 0.03)),
        (DriveKind::Torque, 0) => Hidden::Spring(part(chance, 0.3, 0.8)),
        (DriveKind::Torque | DriveKind::Duty, 1) => {
            Hidden::DeadZone(chance.random_range(0.05..0.12))
        }
        (DriveKind::Torque | DriveKind::Duty, 2) => Hidden::Cogging(part(chance, 0.1, 0.3)),
        (DriveKind::Torque | DriveKind::Duty, _) => Hidden::Delay(chance.random_range(0.02..0.06)),
        (_, 0) => Hidden::TorqueOffset(part(chance, 0.2, 0.5)),
        (_, 1) => Hidden::Coulomb(part(chance, 0.1, 0.3)),
        (_, _) => Hidden::Delay(chance.random_range(0.03..0.09)),
    }
}

/// The command of a joint at a time, before the drive: sums of sines and steps, other in each log.
pub(super) fn command(rig: &DrawnRig, log: usize, joint: usize, time_s: f64) -> f64 {
    let base = 0.23 + 0.11 * log as f64 + 0.07 * joint as f64;
    let sines: f64 = [1.0, 2.3, 4.1]
        .iter()
        .enumerate()
        .map(|(k, factor)| {
            (2.0 * PI * base * factor * time_s + (k + log) as f64).sin() / (1.0 + k as f64)
        })
        .sum();
    let step = if (time_s / (2.5 + 0.5 * log as f64)) as i64 % 2 == 0 {
        1.0
    } else {
        -1.0
    };
    let mixed = 0.35 * sines + 0.25 * step;
    let link = &rig.links[joint];
    // Arms are swung within their cables' reach, not whirled.
    let level_nm: f64 = rig.links[joint..].iter().map(DrawnLink::level_nm).sum();
    match rig.drive {
        DriveKind::Passive => 0.0,
        DriveKind::Torque => 0.9 * level_nm * mixed,
        DriveKind::Duty => 0.9 * level_nm / link.stall_nm * mixed,
        DriveKind::Position => 1.1 * mixed,
        DriveKind::Speed => 3.0 * mixed,
    }
}
