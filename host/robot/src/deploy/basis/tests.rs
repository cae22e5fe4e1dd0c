//! Plans for the paper's robot with effects of its drives.

use super::*;
use handstand_shared::plan::Law;
use handstand_shared::raw::Signed;
use std::path::Path;

/// The paper's robot on drives of 2 N m, with these effects.
fn robot(effects: &str) -> Model {
    let text = include_str!("robot.toml").replace("# effects", effects);
    Model::parse(&text, Path::new("robot.toml")).unwrap()
}

fn basis(effects: &str, told: &ToldDrives) -> PlanBasis {
    let timing = BoardTiming::HOST_ATTITUDE;
    PlanBasis::of(&robot(effects), &Board::BIOLOID, &timing, told).unwrap()
}

fn effect(kind: &str, joint: &str, values: &str) -> String {
    format!("[[effect]]\nkind = \"{kind}\"\njoint = {joint}\n{values}\n")
}

#[test]
fn a_clean_model_loses_nothing_and_is_not_late() {
    let clean = basis("", &ToldDrives::default());
    assert_eq!(clean.board.dead_zone, [0.0; 2]);
    assert_eq!(clean.board.full_nm, [2.0; 2]);
    assert_eq!(clean.timing, BoardTiming::HOST_ATTITUDE);
}

/// Each effect of a drive has its place, and makes another plan than the clean model's.
#[test]
fn what_was_learned_is_in_the_plan() {
    let none = ToldDrives::default();
    let clean = basis("", &none).plan(&robot("")).unwrap();
    for (kind, joint, values, place) in [
        ("delay", "\"all\"", "delay_s = 0.018", UsePlace::Observer),
        (
            "sensor_lag",
            "2",
            "time_constant_s = 0.01",
            UsePlace::Observer,
        ),
        (
            "dead_zone",
            "\"all\"",
            "width = 0.2\npunch = -0.2",
            UsePlace::Compensation,
        ),
        (
            "dead_zone",
            "\"all\"",
            "width = 0.2\npunch = 0.0",
            UsePlace::Compensation,
        ),
        ("coulomb", "2", "torque_nm = 0.2", UsePlace::Compensation),
        (
            "torque_saturation",
            "\"all\"",
            "limit_nm = 1.0",
            UsePlace::Limit,
        ),
        ("torque_scale", "3", "factor = 0.7", UsePlace::Gains),
        (
            "viscous",
            "2",
            "coefficient_nm_s_rad = 0.05",
            UsePlace::Gains,
        ),
        ("mass", "2", "added_kg = 0.1", UsePlace::Gains),
    ] {
        let text = effect(kind, joint, values);
        let made = basis(&text, &none);
        let used = made.uses.last().unwrap();
        assert_eq!(used.place, place, "{kind}: {}", used.how);
        let plan = made.plan(&robot(&text)).unwrap();
        assert_ne!(plan.fingerprint(), clean.fingerprint(), "{kind}");
    }
}

#[test]
fn what_no_plan_holds_is_said() {
    let text =
        effect("backlash", "2", "gap_rad = 0.03") + &effect("coulomb", "1", "torque_nm = 0.01");
    let made = basis(&text, &ToldDrives::default());
    let nowhere = made.uses.iter().filter(|it| it.place == UsePlace::Nowhere);
    let nowhere: Vec<&str> = nowhere.map(|it| it.effect.as_str()).collect();
    assert_eq!(nowhere, ["backlash@2", "coulomb@1"]);
    // A delay beyond the inputs that are kept is taken as far as they reach.
    let late = basis(
        &effect("delay", "\"all\"", "delay_s = 0.037"),
        &ToldDrives::default(),
    );
    let how = &late.uses.last().unwrap().how;
    assert!(how.starts_with("20.7 of 37.0 ms"), "{how}");
    late.plan(&robot("")).unwrap();
}

#[test]
fn what_is_told_goes_before_the_model() {
    let text = effect("delay", "\"all\"", "delay_s = 0.018")
        + &effect("dead_zone", "\"all\"", "width = 0.2\npunch = -0.2");
    let told = ToldDrives {
        dead_zone: Some(0.1),
        delay_s: Some(0.005),
        full_nm: Some(1.5),
        most_share: 0.5,
        ..ToldDrives::default()
    };
    let made = basis(&text, &told);
    let board = &made.board;
    assert_eq!((board.dead_zone, board.full_nm), ([0.1; 2], [1.5; 2]));
    assert_eq!((board.most_nm, board.least_nm), ([0.75; 2], [0.0; 2]));
    assert_eq!(made.timing.drive_delay_s, [0.005; 2]);
    let supply = ToldDrives {
        supply_v: Some(11.1),
        ..ToldDrives::default()
    };
    let timing = BoardTiming::HOST_ATTITUDE;
    let refused = PlanBasis::of(&robot(""), &Board::BIOLOID, &timing, &supply);
    assert!(refused.unwrap_err().to_string().contains("which supply"));
}

/// What a drive with a dead zone and friction makes of a command is what the law asks for.
#[test]
fn a_lossy_drive_makes_the_torque_that_the_law_asks_for() {
    let text = effect("dead_zone", "\"all\"", "width = 0.06\npunch = -0.06")
        + &effect("coulomb", "2", "torque_nm = 0.05");
    let plan = basis(&text, &ToldDrives::default())
        .plan(&robot(&text))
        .unwrap();
    assert!(matches!(plan.law, Law::Observer(_)));
    for (asked_nm, input) in [(0.25, 2048), (0.5, 4096), (-1.0, -8192)] {
        let duty = f64::from(plan.joints[0].command(input)) * Signed::OUTPUT_LSB;
        let lost_nm = f64::copysign(0.05, asked_nm);
        let made_nm = 2.0 * (duty - 0.06_f64.copysign(duty)) - lost_nm;
        assert!((made_nm - asked_nm).abs() < 4e-3, "{asked_nm} {made_nm}");
    }
}

#[test]
fn a_drive_that_loses_more_than_the_slew_limit_gets_no_plan() {
    let stuck = robot(&effect("coulomb", "2", "torque_nm = 1.1"));
    let timing = BoardTiming::HOST_ATTITUDE;
    let refused = PlanBasis::of(&stuck, &Board::BIOLOID, &timing, &ToldDrives::default());
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("a dead zone of 55 %"), "{refused}");
}
