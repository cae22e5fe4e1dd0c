//! The terms of which an unknown law is put together: the library of candidate functions of sparse
//! regression (Brunton, Proctor, Kutz, PNAS 113 (2016) 3932), as torques and frictions of a joint
//! in its angle, speed, load, input, supply and time.
//!
//! A term is an effect that a model file can hold. Its size is the torque at the end of what the
//! motions cover, so that sizes compare, and what shapes it (an exponent, a centre, a width) is
//! fitted with it.

use super::scales::Scales;
use crate::effects::expression::{LawDefinition, LawParameter, LawSite};
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
    let terms = [speed(at), angle(at), load(at), friction(at), signals(at)];
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

/// Torques that follow from the speed.
fn speed(at: &Scales) -> Vec<LawDefinition> {
    let (w, q) = (per("w", at.speed_rad_s), per("q", at.angle_rad));
    let torque = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Torque, expression, parameters)
    };
    vec![
        torque(
            "drag_power",
            format!("-torque_nm * dir * abs({w})^exponent"),
            vec![torque_nm(at), exponent(&[0.5, 2.0, 3.0])],
        ),
        torque(
            "push_of_speed",
            format!("torque_nm * abs({w})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        torque(
            "drag_by_direction",
            format!("-torque_nm * (dir + skew) / 2 * abs({w})^exponent"),
            vec![torque_nm(at), skew(), exponent(&[1.0, 2.0])],
        ),
        torque(
            "drag_at_low_speed",
            "-torque_nm * w / width_rad_s * exp(1 - abs(w) / width_rad_s)".to_string(),
            vec![torque_nm(at), width_rad_s(at)],
        ),
        torque(
            "drag_with_a_peak",
            "-torque_nm * 2 * w / width_rad_s / (1 + (w / width_rad_s)^2)".to_string(),
            vec![torque_nm(at), width_rad_s(at)],
        ),
        torque(
            "drag_that_levels_off",
            "-torque_nm * tanh(w / width_rad_s)".to_string(),
            vec![torque_nm(at), width_rad_s(at)],
        ),
        torque(
            "drag_growing_with_angle",
            format!("-torque_nm * {w} * abs({q})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        torque(
            "drag_changing_over_zero",
            format!("-torque_nm * {w} * {q}"),
            vec![torque_nm(at)],
        ),
        torque(
            "drag_ripple",
            format!("-torque_nm * {w} * sin(periods * q + phase_rad)"),
            vec![torque_nm(at), periods(&FEW_PERIODS), phase_rad()],
        ),
        torque(
            "drag_in_a_place",
            format!("-torque_nm * {w} * exp(-((q - centre_rad) / width_rad)^2)"),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.2, 0.5, 0.8]),
                width_rad(at),
            ],
        ),
    ]
}

/// Torques that follow from the angle.
fn angle(at: &Scales) -> Vec<LawDefinition> {
    let q = per("q", at.angle_rad);
    let away = match at.angle_rad {
        1.0 => "q - centre_rad".to_string(),
        scale => format!("(q - centre_rad) / {scale}"),
    };
    let twice = 2.0 * at.angle_rad;
    let torque = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Torque, expression, parameters)
    };
    vec![
        torque("constant", "torque_nm".to_string(), vec![torque_nm(at)]),
        torque(
            "spring_power",
            format!("-torque_nm * signum(q) * abs({q})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0, 3.0])],
        ),
        torque(
            "spring_about_a_place",
            format!("-torque_nm * signum(q - centre_rad) * abs({away})^exponent"),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.2, 0.5, 0.8]),
                exponent(&[1.0, 3.0]),
            ],
        ),
        torque(
            "push_of_angle",
            format!("torque_nm * abs({q})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        torque(
            "spring_above",
            format!("-torque_nm * (q - centre_rad + abs(q - centre_rad)) / {twice}"),
            vec![torque_nm(at), centre_rad(at, &[0.5, 0.8])],
        ),
        torque(
            "spring_below",
            format!("-torque_nm * (q - centre_rad - abs(q - centre_rad)) / {twice}"),
            vec![torque_nm(at), centre_rad(at, &[0.2, 0.5])],
        ),
        torque(
            "detent",
            "-torque_nm * (q - centre_rad) / width_rad * exp(0.5 - ((q - centre_rad) / \
             width_rad)^2 / 2)"
                .to_string(),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.1, 0.3, 0.5, 0.7, 0.9]),
                width_rad(at),
            ],
        ),
        torque(
            "push_in_a_place",
            "torque_nm * exp(-((q - centre_rad) / width_rad)^2)".to_string(),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.1, 0.3, 0.5, 0.7, 0.9]),
                width_rad(at),
            ],
        ),
        torque(
            "step_at_a_place",
            "torque_nm * (1 + tanh((q - centre_rad) / width_rad)) / 2".to_string(),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.2, 0.5, 0.8]),
                width_rad(at),
            ],
        ),
        torque(
            "ripple",
            "torque_nm * sin(periods * q + phase_rad)".to_string(),
            vec![torque_nm(at), periods(&PERIODS), phase_rad()],
        ),
        torque(
            "second_ripple",
            "torque_nm * sin(periods * q + phase_rad)".to_string(),
            vec![torque_nm(at), periods(&PERIODS), phase_rad()],
        ),
    ]
}

/// Torques that follow from the torque of the drive: what a gear or a driver does to it.
fn load(at: &Scales) -> Vec<LawDefinition> {
    let (w, tau) = (per("w", at.speed_rad_s), per("tau", at.drive_nm));
    let torque = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Torque, expression, parameters)
    };
    let limit = |by: &str| format!("-(abs(tau + torque_nm{by}) - abs(tau - torque_nm{by})) / 2");
    vec![
        torque(
            "drag_under_load",
            format!("-torque_nm * {w} * abs({tau})"),
            vec![torque_nm(at)],
        ),
        torque(
            "loss_of_torque_with_speed",
            format!("-torque_nm * {tau} * abs({w})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        torque(
            "loss_of_torque_at_low_speed",
            "-share * tau * exp(-abs(w) / width_rad_s)".to_string(),
            vec![share(0.05), width_rad_s(at)],
        ),
        torque(
            "bent_torque",
            format!("-torque_nm * signum(tau) * abs({tau})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0, 3.0])],
        ),
        torque(
            "loss_of_torque_by_direction",
            format!("-torque_nm * (signum(tau) + skew) / 2 * abs({tau})^exponent"),
            vec![torque_nm(at), skew(), exponent(&[1.0, 2.0])],
        ),
        torque(
            "push_of_torque",
            format!("torque_nm * abs({tau})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        torque(
            "torque_by_angle",
            "share * tau * sin(periods * q + phase_rad)".to_string(),
            vec![share(0.05), periods(&FEW_PERIODS), phase_rad()],
        ),
        torque("torque_threshold", limit(""), vec![torque_nm(at)]),
        torque(
            "threshold_at_low_speed",
            limit(" * exp(-abs(w) / width_rad_s)"),
            vec![torque_nm(at), width_rad_s(at)],
        ),
        torque(
            "threshold_with_speed",
            limit(&format!(" * abs({w})")),
            vec![torque_nm(at)],
        ),
    ]
}

/// Frictions: they hold the joint at rest.
fn friction(at: &Scales) -> Vec<LawDefinition> {
    let [w, q, tau] = [
        per("w", at.speed_rad_s),
        per("q", at.angle_rad),
        per("tau", at.drive_nm),
    ];
    let friction = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Friction, expression, parameters)
    };
    vec![
        friction(
            "friction_with_speed",
            format!("torque_nm * abs({w})^exponent"),
            vec![torque_nm(at), exponent(&[0.3, 2.0])],
        ),
        friction(
            "friction_at_low_speed",
            "torque_nm * exp(-abs(w / width_rad_s)^exponent)".to_string(),
            vec![torque_nm(at), width_rad_s(at), exponent(&[1.0, 2.0])],
        ),
        friction(
            "friction_with_angle",
            format!("torque_nm * abs({q})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        friction(
            "friction_rising_over_angle",
            format!("torque_nm * {q}"),
            vec![torque_nm(at)],
        ),
        friction(
            "friction_by_direction_and_angle",
            format!("torque_nm * (1 + skew * dir) * abs({q})^exponent"),
            vec![torque_nm(at), skew(), exponent(&[1.0, 2.0])],
        ),
        friction(
            "friction_in_a_place",
            "torque_nm * exp(-((q - centre_rad) / width_rad)^2)".to_string(),
            vec![
                torque_nm(at),
                centre_rad(at, &[0.2, 0.5, 0.8]),
                width_rad(at),
            ],
        ),
        friction(
            "friction_ripple",
            "torque_nm * sin(periods * q + phase_rad)".to_string(),
            vec![torque_nm(at), periods(&PERIODS), phase_rad()],
        ),
        friction(
            "friction_under_torque",
            format!("torque_nm * abs({tau})^exponent"),
            vec![torque_nm(at), exponent(&[1.0, 2.0])],
        ),
        friction(
            "friction_under_torque_with_speed",
            format!("torque_nm * abs({tau}) * abs({w})"),
            vec![torque_nm(at)],
        ),
        friction(
            "friction_by_direction",
            "torque_nm * dir".to_string(),
            vec![torque_nm(at)],
        ),
    ]
}

/// What follows from the input, the supply and the time.
fn signals(at: &Scales) -> Vec<LawDefinition> {
    let (w, input) = (per("w", at.speed_rad_s), per("input", at.input));
    let time = per("time", at.time_s);
    let torque = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Torque, expression, parameters)
    };
    let bounds = (1e-2 * at.time_s, 10.0 * at.time_s);
    let starts = [0.1 * at.time_s, 0.5 * at.time_s];
    let time_s = parameter("time_s", "s", "time in which it comes", &starts, bounds);
    let mut terms = vec![
        torque(
            "push_of_input",
            format!("torque_nm * abs({input})"),
            vec![torque_nm(at)],
        ),
        torque(
            "push_with_time",
            format!("torque_nm * {time}"),
            vec![torque_nm(at)],
        ),
        torque(
            "drag_with_time",
            format!("-torque_nm * {w} * {time}"),
            vec![torque_nm(at)],
        ),
        torque(
            "loss_of_torque_with_time",
            "-share * tau * (1 - exp(-time / time_s))".to_string(),
            vec![share(0.05), time_s],
        ),
        term(
            "friction_with_time",
            LawSite::Friction,
            format!("torque_nm * {time}"),
            vec![torque_nm(at)],
        ),
    ];
    if at.supply_moves {
        terms.push(torque(
            "torque_with_supply",
            "share * tau * (supply - 1)".to_string(),
            vec![share(0.5)],
        ));
    }
    terms
}
