//! Torques that follow from a joint's speed and angle.

use super::{
    FEW_PERIODS, LawDefinition, LawParameter, LawSite, PERIODS, Scales, centre_rad, exponent, per,
    periods, phase_rad, skew, term, torque_nm, width_rad, width_rad_s,
};

/// Torques that follow from the speed.
pub(super) fn speed(at: &Scales) -> Vec<LawDefinition> {
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
pub(super) fn angle(at: &Scales) -> Vec<LawDefinition> {
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
    ]
}

/// Torques that lie in one place, or come again over the angle.
pub(super) fn place(at: &Scales) -> Vec<LawDefinition> {
    let torque = |name: &str, expression: String, parameters: Vec<LawParameter>| {
        term(name, LawSite::Torque, expression, parameters)
    };
    vec![
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
