//! The terms of which an unknown law is put together: the library of candidate functions of sparse
//! regression (Brunton, Proctor, Kutz, PNAS 113 (2016) 3932), as torques and frictions of a joint
//! in its angle, speed, load, input, supply and time.
//!
//! A term is an effect that a model file can hold. Its size is the torque at the end of what the
//! motions cover, so that sizes compare, and what shapes it (an exponent, a centre, a width) is
//! fitted with it.

mod of_drive;
mod of_motion;

use super::scales::Scales;
use crate::effects::expression::{LawDefinition, LawParameter, LawSite};
use of_drive::{friction, load, signals};
use of_motion::{angle, place, speed};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The one angle that slides have, too.
const PHASE: &str = "phase_rad";
/// Unit of a ripple over an angle.
const PER_TURN: &str = "1/turn";
/// How many times a term worth a look a size may be, either way.
const LARGEST: f64 = 200.0;
/// Periods per turn of a ripple.
const PERIODS: [f64; 12] = [
    1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0,
];

/// Those of what a link or a coil does.
const FEW_PERIODS: [f64; 3] = [1.0, 2.0, 3.0];

/// All terms for what these motions cover.
pub(super) fn vocabulary(at: &Scales) -> Vec<LawDefinition> {
    let terms = [
        speed(at),
        angle(at),
        place(at),
        load(at),
        friction(at),
        signals(at),
    ];
    let terms = terms.into_iter().flatten();
    if at.slides {
        terms.map(on_slide).collect()
    } else {
        terms.collect()
    }
}

/// The term in the units of joints that slide.
fn on_slide(mut term: LawDefinition) -> LawDefinition {
    let other = |name: &str| {
        let pairs = [("torque_nm", "force_n"), ("_rad_s", "_m_s"), ("_rad", "_m")];
        let pairs = pairs.into_iter().filter(|(from, _)| name.ends_with(from));
        let mut pairs = pairs.map(|(from, to)| name.replace(from, to));
        // An angle of a sine stays one.
        pairs.next().filter(|_| name != PHASE)
    };
    for parameter in &mut term.parameters {
        if let Some(key) = other(&parameter.key) {
            term.expression = term.expression.replace(&parameter.key, &key);
            parameter.key = key;
            let unit = parameter.unit.replace("N m", "N").replace("rad", "m");
            parameter.unit = unit;
        } else if parameter.unit == PER_TURN {
            parameter.unit = "rad/m".to_string();
        }
    }
    term.slides = true;
    term
}

fn parameter(
    key: &str,
    unit: &str,
    meaning: &str,
    starts: &[f64],
    (low, high): (f64, f64),
) -> LawParameter {
    LawParameter {
        key: key.to_string(),
        unit: unit.to_string(),
        meaning: meaning.to_string(),
        starts: starts.iter().map(|start| start.clamp(low, high)).collect(),
        bounds: (low, high),
    }
}

/// A torque that sizes a term.
fn torque_nm(at: &Scales) -> LawParameter {
    let most = LARGEST * at.term_nm;
    parameter(
        "torque_nm",
        "N m",
        "size of the term",
        &[at.term_nm],
        (-most, most),
    )
}

fn share(start: f64) -> LawParameter {
    parameter("share", "1", "share", &[start], (-5.0, 5.0))
}

fn exponent(starts: &[f64]) -> LawParameter {
    parameter("exponent", "1", "exponent", starts, (0.2, 6.0))
}

/// A variable as a share of its scale: "w / 4".
fn per(variable: &str, scale: f64) -> String {
    if scale == 1.0 {
        variable.to_string()
    } else {
        format!("{variable} / {scale}")
    }
}

/// How much more one way than the other: 1 is one way alone.
fn skew() -> LawParameter {
    parameter(
        "skew",
        "1",
        "difference of the ways",
        &[1.0, -1.0],
        (-3.0, 3.0),
    )
}

fn width_rad_s(at: &Scales) -> LawParameter {
    let most = at.speed_rad_s;
    let starts = [0.05 * most, 0.3 * most];
    let bounds = (1e-3 * most, 3.0 * most);
    parameter(
        "width_rad_s",
        "rad/s",
        "speed at which it fades",
        &starts,
        bounds,
    )
}

fn centre_rad(at: &Scales, shares: &[f64]) -> LawParameter {
    let span = at.high_rad - at.low_rad;
    let starts: Vec<f64> = shares
        .iter()
        .map(|share| at.low_rad + share * span)
        .collect();
    let bounds = (
        at.low_rad - 0.1 * span.abs(),
        at.high_rad + 0.1 * span.abs(),
    );
    parameter("centre_rad", "rad", "where it lies", &starts, bounds)
}

fn width_rad(at: &Scales) -> LawParameter {
    let span = (at.high_rad - at.low_rad).max(1e-3);
    let bounds = (0.005 * span, 2.0 * span);
    parameter(
        "width_rad",
        "rad",
        "how far it reaches",
        &[0.1 * span, 0.3 * span],
        bounds,
    )
}

fn periods(starts: &[f64]) -> LawParameter {
    let meaning = "periods per turn";
    parameter("periods", PER_TURN, meaning, starts, (0.3, 40.0))
}

fn phase_rad() -> LawParameter {
    let starts = [0.0, FRAC_PI_2];
    parameter(
        "phase_rad",
        "rad",
        "where its sine begins",
        &starts,
        (-TAU, TAU),
    )
}

fn term(
    name: &str,
    site: LawSite,
    expression: String,
    parameters: impl IntoIterator<Item = LawParameter>,
) -> LawDefinition {
    LawDefinition {
        name: name.to_string(),
        site,
        expression,
        parameters: parameters.into_iter().collect(),
        slides: false,
    }
}
