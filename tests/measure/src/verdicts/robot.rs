//! A random robot: three links on a bar, the two upper joints driven, and what is not ideal.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::fmt::Write as _;

/// A link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// From joint to joint, m.
    pub length_m: f64,
    /// From the joint to the centre of mass, m.
    pub com_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Inertia about the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
}

/// Something not ideal, at a joint counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NonIdeality {
    /// Commands act this much later, s, at both drives.
    Delay(f64),
    /// Commands up to this share of full torque do nothing; the width, and what is added beyond.
    DeadZone(usize, f64, f64),
    /// Dry friction, N m.
    Coulomb(usize, f64),
    /// Friction in proportion to the speed, N m s/rad.
    Viscous(usize, f64),
    /// No more torque than this, N m, at both drives.
    Saturation(f64),
    /// The drives make this share of their torque.
    Scale(f64),
    /// The encoder's filter, s.
    Lag(usize, f64),
    /// The encoder's play from flank to flank, rad.
    Backlash(usize, f64),
}

/// A robot, and the weights of its design.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// From the bar outwards.
    pub links: [Link; 3],
    /// Torque of a drive at full duty, N m.
    pub full_nm: f64,
    /// What is not ideal.
    pub effects: Vec<NonIdeality>,
    /// Weights of angles and speeds.
    pub q: [f64; 6],
}

/// Lengths, centres, masses and inertias of the paper's robot.
const PAPER: [[f64; 4]; 3] = [
    [0.1436, 0.0687, 0.3676, 0.000_789_07],
    [0.1158, 0.0575, 0.9815, 0.003_289_86],
    [0.184, 0.1163, 0.5764, 0.001_132_8],
];

impl Robot {
    /// The paper's, with one non-ideality and the paper's weights.
    pub fn paper(effect: NonIdeality) -> Robot {
        Robot {
            links: PAPER.map(link),
            full_nm: 2.0,
            effects: vec![effect],
            q: [100.0; 6],
        }
    }

    /// Draws one: links within 15 % of the paper's robot, one to three non-idealities, the paper's
    /// weights or those that weigh the speeds a hundredth.
    pub fn draw(random: &mut ChaCha8Rng) -> Robot {
        let links = PAPER.map(|values| {
            link(values.map(|value| rounded(value * random.random_range(0.85..1.15))))
        });
        let mut effects: Vec<NonIdeality> = Vec::new();
        for _ in 0..random.random_range(1..=3) {
            let effect = NonIdeality::draw(random);
            if !effects.iter().any(|other| other.excludes(&effect)) {
                effects.push(effect);
            }
        }
        let speeds = if random.random_bool(0.5) { 100.0 } else { 1.0 };
        Robot {
            links,
            full_nm: 2.0,
            effects,
            q: [100.0, 100.0, 100.0, speeds, speeds, speeds],
        }
    }

    /// As a model file.
    pub fn toml(&self) -> String {
        let mut text = "[rig]\nname = \"robot\"\nangle_zero = \"upright\"\nangles = \"relative\"\n\
                        step_s = 0.001\n"
            .to_string();
        for link in &self.links {
            let Link {
                length_m,
                com_m,
                mass_kg,
                inertia_kg_m2,
            } = link;
            let _ = write!(
                text,
                "\n[[link]]\nlength_m = {length_m}\ncom_m = {com_m}\nmass_kg = {mass_kg}\n\
                 inertia_kg_m2 = {inertia_kg_m2}\n"
            );
        }
        text += "\n[[joint]]\ndrive = \"passive\"\n";
        for _ in 0..2 {
            let full_nm = self.full_nm;
            let _ = write!(
                text,
                "\n[[joint]]\ndrive = \"duty\"\nstall_torque_nm = {full_nm:?}\n"
            );
        }
        for effect in &self.effects {
            let _ = write!(text, "\n[[effect]]\n{}\n", effect.toml().join("\n"));
        }
        text += "\n[log]\ntime = { column = \"t\", unit = \"s\" }\n\n[[log.joint]]\n\
                 position = { column = \"q1\", unit = \"rad\" }\n";
        for joint in 2..=3 {
            let _ = write!(
                text,
                "\n[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}\n\
                 input = {{ column = \"u{joint}\", unit = \"1\" }}\n"
            );
        }
        text
    }

    /// What is not ideal, in words.
    pub fn words(&self) -> String {
        let words = self.effects.iter().map(|effect| {
            let words = effect.toml().join(" ");
            words
                .replace("kind = ", "")
                .replace('"', "")
                .replace(" = ", " ")
        });
        words.collect::<Vec<_>>().join("; ")
    }
}

impl NonIdeality {
    fn draw(random: &mut ChaCha8Rng) -> NonIdeality {
        let driven = random.random_range(1..=2);
        let any = random.random_range(0..=2);
        let mut within = |low: f64, high: f64| rounded(random.random_range(low..high));
        let value = within(0.0, 1.0);
        let between = |low: f64, high: f64| rounded(low + (high - low) * value);
        match (within(0.0, 9.0)) as usize {
            // In whole steps of the simulation.
            0 => NonIdeality::Delay((between(0.002, 0.03) * 1e4).round() / 1e4),
            1 => NonIdeality::DeadZone(driven, between(0.01, 0.2), 0.0),
            2 => {
                let width = between(0.002, 0.1);
                NonIdeality::DeadZone(driven, width, -width)
            }
            3 => NonIdeality::Coulomb(any, between(0.002, 0.2)),
            4 => NonIdeality::Viscous(any, between(0.005, 0.1)),
            5 => NonIdeality::Saturation(between(0.1, 1.5)),
            6 => NonIdeality::Scale(between(0.5, 1.4)),
            7 => NonIdeality::Lag(any, between(0.001, 0.025)),
            _ => NonIdeality::Backlash(any, between(0.002, 0.06)),
        }
    }

    /// Whether both cannot be in one robot: the same kind twice, or two changes of the torque,
    /// whose order is a convention.
    fn excludes(&self, other: &NonIdeality) -> bool {
        let group = |effect: &NonIdeality| match effect {
            NonIdeality::Delay(_) => 0,
            NonIdeality::DeadZone(..) => 1,
            NonIdeality::Coulomb(..) => 2,
            NonIdeality::Viscous(..) => 3,
            NonIdeality::Saturation(_) | NonIdeality::Scale(_) => 4,
            NonIdeality::Lag(..) | NonIdeality::Backlash(..) => 5,
        };
        group(self) == group(other)
    }

    /// Lines of its table in a model file.
    fn toml(&self) -> Vec<String> {
        let (kind, joint, values): (&str, Option<usize>, Vec<(&str, f64)>) = match *self {
            NonIdeality::Delay(s) => ("delay", None, vec![("delay_s", s)]),
            NonIdeality::DeadZone(joint, width, punch) => {
                let values = vec![("width", width), ("punch", punch)];
                ("dead_zone", Some(joint), values)
            }
            NonIdeality::Coulomb(joint, nm) => ("coulomb", Some(joint), vec![("torque_nm", nm)]),
            NonIdeality::Viscous(joint, c) => {
                ("viscous", Some(joint), vec![("coefficient_nm_s_rad", c)])
            }
            NonIdeality::Saturation(nm) => ("torque_saturation", None, vec![("limit_nm", nm)]),
            NonIdeality::Scale(factor) => ("torque_scale", None, vec![("factor", factor)]),
            NonIdeality::Lag(joint, s) => ("sensor_lag", Some(joint), vec![("time_constant_s", s)]),
            NonIdeality::Backlash(joint, rad) => ("backlash", Some(joint), vec![("gap_rad", rad)]),
        };
        let joint = joint.map_or("\"all\"".to_string(), |joint| (joint + 1).to_string());
        let mut lines = vec![format!("kind = \"{kind}\""), format!("joint = {joint}")];
        lines.extend(
            values
                .iter()
                .map(|(key, value)| format!("{key} = {value:?}")),
        );
        lines
    }
}

fn link([length_m, com_m, mass_kg, inertia_kg_m2]: [f64; 4]) -> Link {
    Link {
        length_m,
        com_m,
        mass_kg,
        inertia_kg_m2,
    }
}

/// As a file says it: six significant places after the point.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
