//! Laws that no effect of the library states, for arms that hide one: each as an equation of the
//! truth, and as the expression in which a model file can say it.

use super::rounding::rounded;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// What such a law depends on: angle, rad, and speed, rad/s, of the arm, and torque of its motor,
/// N m.
type Equation = fn(&[f64], f64, f64, f64) -> f64;

/// A kind of law.
#[derive(Debug)]
struct Kind {
    name: &'static str,
    /// `torque` or `friction`: what it is called in a model file.
    site: &'static str,
    expression: &'static str,
    /// Names of its values, with their range at random.
    values: &'static [(&'static str, f64, f64)],
    equation: Equation,
}

/// A law with its values.
#[derive(Debug, Clone)]
pub struct UnknownLaw {
    kind: &'static Kind,
    values: Vec<f64>,
}

impl PartialEq for UnknownLaw {
    fn eq(&self, other: &UnknownLaw) -> bool {
        self.kind.name == other.kind.name && self.values == other.values
    }
}

/// The names of all laws.
pub fn unknown_laws() -> impl Iterator<Item = &'static str> {
    LAWS.iter().map(|kind| kind.name)
}

impl UnknownLaw {
    /// The law of this name at random values; none of another name.
    pub fn random(rng: &mut ChaCha8Rng, name: &str) -> Option<UnknownLaw> {
        let kind = LAWS.iter().find(|kind| kind.name == name)?;
        let values = kind.values.iter();
        let values = values.map(|(_, low, high)| rounded(rng.random_range(*low..*high), 4));
        Some(UnknownLaw {
            kind,
            values: values.collect(),
        })
    }

    /// Torque on the arm beside friction, N m.
    pub fn torque_nm(&self, angle_rad: f64, speed_rad_s: f64, drive_nm: f64) -> f64 {
        match self.kind.site {
            "torque" => (self.kind.equation)(&self.values, angle_rad, speed_rad_s, drive_nm),
            _ => 0.0,
        }
    }

    /// Dry friction that it adds, N m.
    pub fn friction_nm(&self, angle_rad: f64, speed_rad_s: f64, drive_nm: f64) -> f64 {
        match self.kind.site {
            "friction" => (self.kind.equation)(&self.values, angle_rad, speed_rad_s, drive_nm),
            _ => 0.0,
        }
    }

    /// The law as tables of a model file.
    pub fn toml(&self) -> String {
        let Kind {
            name,
            site,
            expression,
            values,
            ..
        } = self.kind;
        let mut law = format!("\n[[expression]]\nname = \"{name}\"\n{site} = \"{expression}\"\n");
        let mut effect = format!("\n[[effect]]\nkind = \"{name}\"\njoint = 1\n");
        for ((key, ..), value) in values.iter().zip(&self.values) {
            law += &format!(
                "\n[[expression.parameter]]\nkey = \"{key}\"\nunit = \"1\"\nstart = {value:?}\n\
                 low = -100.0\nhigh = 100.0\n"
            );
            effect += &format!("{key} = {value:?}\n");
        }
        law + &effect
    }

    /// The law in one line, its values behind it.
    pub fn said(&self) -> String {
        let keys = self.kind.values.iter();
        let values = keys
            .zip(&self.values)
            .map(|((key, ..), value)| format!("{key} = {value}"));
        let (site, law) = (self.kind.site, self.kind.expression);
        format!("{site} = {law}; {}", values.collect::<Vec<_>>().join(", "))
    }
}

const fn torque(
    name: &'static str,
    expression: &'static str,
    values: &'static [(&'static str, f64, f64)],
    equation: Equation,
) -> Kind {
    Kind {
        name,
        site: "torque",
        expression,
        values,
        equation,
    }
}

const fn friction(
    name: &'static str,
    expression: &'static str,
    values: &'static [(&'static str, f64, f64)],
    equation: Equation,
) -> Kind {
    Kind {
        name,
        site: "friction",
        expression,
        values,
        equation,
    }
}

/// All laws, at the size of the arm: gravity asks for some 0.25 N m, and motions reach some 6 rad/s
/// and 1.5 rad.
static LAWS: [Kind; 40] = [
    torque(
        "cubic_drag",
        "-c * w^3",
        &[("c", 0.0004, 0.0012)],
        |p, _, w, _| -p[0] * w.powi(3),
    ),
    torque(
        "root_drag",
        "-c * signum(w) * sqrt(abs(w))",
        &[("c", 0.03, 0.08)],
        |p, _, w, _| -p[0] * w.signum() * w.abs().sqrt(),
    ),
    torque(
        "asymmetric_square",
        "-(c + d * signum(w)) * w * abs(w)",
        &[("c", 0.002, 0.005), ("d", 0.0008, 0.002)],
        |p, _, w, _| -(p[0] + p[1] * w.signum()) * w * w.abs(),
    ),
    torque(
        "one_way_square",
        "-c * w * (w + abs(w)) / 2",
        &[("c", 0.003, 0.008)],
        |p, _, w, _| if w > 0.0 { -p[0] * w * w } else { 0.0 },
    ),
    torque(
        "levelling_drag",
        "-c * tanh(w / k)",
        &[("c", 0.04, 0.1), ("k", 0.8, 2.0)],
        |p, _, w, _| -p[0] * (w / p[1]).tanh(),
    ),
    torque(
        "eddy_brake",
        "-c * w / (1 + (w / k)^2)",
        &[("c", 0.03, 0.08), ("k", 1.0, 2.5)],
        |p, _, w, _| -p[0] * w / (1.0 + (w / p[1]).powi(2)),
    ),
    torque(
        "two_harmonics",
        "c * sin(3 * q) + d * sin(7 * q + 1)",
        &[("c", 0.015, 0.04), ("d", 0.015, 0.04)],
        |p, q, _, _| p[0] * (3.0 * q).sin() + p[1] * (7.0 * q + 1.0).sin(),
    ),
    torque(
        "overtone",
        "c * (sin(4 * q) + sin(8 * q) / 2)",
        &[("c", 0.02, 0.05)],
        |p, q, _, _| p[0] * ((4.0 * q).sin() + 0.5 * (8.0 * q).sin()),
    ),
    torque(
        "cubic_spring",
        "-c * q^3",
        &[("c", 0.02, 0.08)],
        |p, q, _, _| -p[0] * q.powi(3),
    ),
    torque(
        "end_stop",
        "-c * (q - k + abs(q - k)) / 2",
        &[("c", 0.1, 0.4), ("k", 0.2, 0.6)],
        |p, q, _, _| -p[0] * (q - p[1]).max(0.0),
    ),
    torque(
        "stiffening_spring",
        "-c * sinh(q / k)",
        &[("c", 0.005, 0.015), ("k", 0.3, 0.5)],
        |p, q, _, _| -p[0] * (q / p[1]).sinh(),
    ),
    torque(
        "slack_spring",
        "-c * (q - (abs(q + k) - abs(q - k)) / 2)",
        &[("c", 0.05, 0.2), ("k", 0.2, 0.5)],
        |p, q, _, _| -p[0] * (q - q.clamp(-p[1], p[1])),
    ),
    torque(
        "magnetic_detent",
        "-c * (q - k) * exp(-((q - k) / 0.25)^2)",
        &[("c", 0.2, 0.6), ("k", -0.5, 0.6)],
        |p, q, _, _| -p[0] * (q - p[1]) * (-((q - p[1]) / 0.25).powi(2)).exp(),
    ),
    torque(
        "step_of_weight",
        "-c * (1 + tanh((q - k) / 0.1)) / 2",
        &[("c", 0.03, 0.08), ("k", -0.3, 0.5)],
        |p, q, _, _| -0.5 * p[0] * (1.0 + ((q - p[1]) / 0.1).tanh()),
    ),
    torque(
        "drag_over_angle",
        "-c * w * q^2",
        &[("c", 0.01, 0.03)],
        |p, q, w, _| -p[0] * w * q * q,
    ),
    torque(
        "drag_one_side",
        "-c * w * (q + abs(q)) / 2",
        &[("c", 0.02, 0.06)],
        |p, q, w, _| -p[0] * w * q.max(0.0),
    ),
    torque(
        "drag_by_sine",
        "-c * w * (1 + sin(2 * q))",
        &[("c", 0.01, 0.03)],
        |p, q, w, _| -p[0] * w * (1.0 + (2.0 * q).sin()),
    ),
    torque(
        "load_times_speed",
        "-c * abs(tau) * w",
        &[("c", 0.03, 0.1)],
        |p, _, w, drive| -p[0] * drive.abs() * w,
    ),
    torque(
        "bent_motor",
        "-c * tau * abs(tau)",
        &[("c", 0.1, 0.3)],
        |p, _, _, drive| -p[0] * drive * drive.abs(),
    ),
    torque(
        "one_way_motor",
        "-c * (tau + abs(tau)) / 2",
        &[("c", 0.08, 0.2)],
        |p, _, _, drive| -p[0] * drive.max(0.0),
    ),
    torque(
        "motor_over_angle",
        "c * tau * sin(2 * q + 1)",
        &[("c", 0.08, 0.25)],
        |p, q, _, drive| p[0] * drive * (2.0 * q + 1.0).sin(),
    ),
    torque(
        "dead_zone_at_rest",
        "-(abs(tau + c * exp(-abs(w) / k)) - abs(tau - c * exp(-abs(w) / k))) / 2",
        &[("c", 0.05, 0.12), ("k", 0.3, 1.0)],
        |p, _, w, drive| {
            let width = p[0] * (-w.abs() / p[1]).exp();
            -drive.clamp(-width, width)
        },
    ),
    torque(
        "fading_motor",
        "-c * tau * w^2",
        &[("c", 0.006, 0.02)],
        |p, _, w, drive| -p[0] * drive * w * w,
    ),
    friction(
        "friction_over_angle",
        "c * abs(q)",
        &[("c", 0.03, 0.08)],
        |p, q, _, _| p[0] * q.abs(),
    ),
    friction(
        "friction_square",
        "c * q^2",
        &[("c", 0.03, 0.1)],
        |p, q, _, _| p[0] * q * q,
    ),
    friction(
        "friction_by_sine",
        "c * (1 + sin(3 * q))",
        &[("c", 0.015, 0.04)],
        |p, q, _, _| p[0] * (1.0 + (3.0 * q).sin()),
    ),
    friction(
        "tight_spot",
        "c * exp(-((q - k) / 0.2)^2)",
        &[("c", 0.04, 0.1), ("k", -0.5, 0.5)],
        |p, q, _, _| p[0] * (-((q - p[1]) / 0.2).powi(2)).exp(),
    ),
    friction(
        "root_friction",
        "c * sqrt(abs(w))",
        &[("c", 0.02, 0.06)],
        |p, _, w, _| p[0] * w.abs().sqrt(),
    ),
    friction(
        "square_stribeck",
        "c * exp(-(w / k)^2)",
        &[("c", 0.03, 0.08), ("k", 0.3, 1.0)],
        |p, _, w, _| p[0] * (-(w / p[1]).powi(2)).exp(),
    ),
    friction(
        "friction_by_square_of_load",
        "c * tau^2",
        &[("c", 0.2, 0.6)],
        |p, _, _, drive| p[0] * drive * drive,
    ),
    friction(
        "friction_by_load_and_speed",
        "c * abs(tau) * abs(w)",
        &[("c", 0.03, 0.1)],
        |p, _, w, drive| p[0] * (drive * w).abs(),
    ),
    friction(
        "friction_upwards",
        "c * abs(q) * (1 + dir) / 2",
        &[("c", 0.04, 0.1)],
        // At rest the sign of zero is that of the push.
        |p, q, w, _| {
            if w.is_sign_positive() {
                p[0] * q.abs()
            } else {
                0.0
            }
        },
    ),
    torque(
        "exponential_spring",
        "-c * (exp(q / k) - 1)",
        &[("c", 0.01, 0.03), ("k", 0.5, 0.9)],
        |p, q, _, _| -p[0] * ((q / p[1]).exp() - 1.0),
    ),
    torque(
        "double_well",
        "c * q - d * q^3",
        &[("c", 0.02, 0.05), ("d", 0.03, 0.08)],
        |p, q, _, _| p[0] * q - p[1] * q.powi(3),
    ),
    torque(
        "logarithmic_drag",
        "-c * signum(w) * ln(1 + abs(w) / k)",
        &[("c", 0.02, 0.05), ("k", 0.3, 1.0)],
        |p, _, w, _| -p[0] * w.signum() * (1.0 + w.abs() / p[1]).ln(),
    ),
    torque(
        "swaying_drag",
        "-c * w * (1 + cos(5 * q))",
        &[("c", 0.01, 0.03)],
        |p, q, w, _| -p[0] * w * (1.0 + (5.0 * q).cos()),
    ),
    torque(
        "square_of_speed_by_angle",
        "-c * q * w^2",
        &[("c", 0.003, 0.01)],
        |p, q, w, _| -p[0] * q * w * w,
    ),
    torque(
        "saturating_motor",
        "k * tanh(tau / k) - tau",
        &[("k", 0.4, 0.8)],
        |p, _, _, drive| p[0] * (drive / p[0]).tanh() - drive,
    ),
    friction(
        "rational_friction",
        "c / (1 + (w / k)^2)",
        &[("c", 0.03, 0.08), ("k", 0.5, 1.5)],
        |p, _, w, _| p[0] / (1.0 + (w / p[1]).powi(2)),
    ),
    friction(
        "friction_by_load_and_angle",
        "c * abs(tau) * q^2",
        &[("c", 0.1, 0.3)],
        |p, q, _, drive| p[0] * drive.abs() * q * q,
    ),
];
