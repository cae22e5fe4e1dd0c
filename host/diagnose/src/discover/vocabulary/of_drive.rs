//! Torques that follow from the torque of the drive, from input, supply and time; frictions.

use super::{
    FEW_PERIODS, LawDefinition, LawParameter, LawSite, PERIODS, Scales, centre_rad, exponent,
    parameter, per, periods, phase_rad, share, skew, term, torque_nm, width_rad, width_rad_s,
};

/// Torques that follow from the torque of the drive: what a gear or a driver does to it.
pub(super) fn load(at: &Scales) -> Vec<LawDefinition> {
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
pub(super) fn friction(at: &Scales) -> Vec<LawDefinition> {
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
pub(super) fn signals(at: &Scales) -> Vec<LawDefinition> {
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
