//! A spoiled log is found with its correction, and a good one is left alone.

use super::*;
use crate::challenge::{Motions, bench};
use crate::model::{AngleZero, ParameterPath};
use std::path::{Path, PathBuf};

/// A virtual arm whose model lacks nothing but an effect, or effects, with the first of its logs.
fn arm(kind: &'static str) -> (tempfile::TempDir, PathBuf, PathBuf) {
    arm_of(&[kind], 5)
}

fn arm_of(kinds: &[&'static str], seed: u64) -> (tempfile::TempDir, PathBuf, PathBuf) {
    let bench = bench(Motions::Arm, seed, kinds).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (model, log) = (folder.path().join("arm.toml"), folder.path().join("a.csv"));
    std::fs::write(&model, &bench.model_toml).unwrap();
    std::fs::write(&log, &bench.logs[0].csv).unwrap();
    (folder, model, log)
}

fn found(model: &Path, log: &Path, change: impl Fn(&mut Model)) -> Vec<LogFinding> {
    let text = std::fs::read_to_string(model).unwrap();
    let old = Model::parse(&text, model).unwrap();
    let mut new = old.clone();
    change(&mut new);
    let text = crate::model::edit::set_reading(&text, model, &old, &new).unwrap();
    let file = ModelFile {
        path: model,
        text: &text,
    };
    check(&[LogRequest::whole(log)], &new, file).unwrap()
}

#[test]
fn a_log_that_agrees_is_left_alone() {
    let (_folder, model, log) = arm("coulomb");
    assert_eq!(found(&model, &log, |_| ()), []);
}

#[test]
fn a_reversed_position_is_refused_with_the_line_that_mends_it() {
    let (_folder, model, log) = arm("coulomb");
    let findings = found(&model, &log, |m| {
        m.log.joints[0].position.as_mut().unwrap().columns_mut()[0].reversed = true
    });
    let first = &findings[0];
    assert_eq!(
        (first.kind, first.severity),
        ("sign", crate::log::Severity::Refuse)
    );
    // The input reversed too would do as well, and is offered second.
    let best = first.remedy.split("; or").next().unwrap();
    assert!(best.contains("position = {"), "{best}");
    assert!(!best.contains("reversed = true"), "{best}");
    let proof = first.proof.unwrap();
    assert!(proof.after_share < 0.5 * proof.before_share, "{proof:?}");
}

#[test]
fn a_wrong_mass_is_not_taken_for_another_drive() {
    // Read as torque, this arm's duty is weaker, which a heavier arm looks like.
    let (_folder, model, log) = arm_of(&["mass"], 1);
    assert_eq!(found(&model, &log, |_| ()), []);
}

#[test]
fn missing_friction_is_not_taken_for_another_drive() {
    // It whirls without; read as torque its duty is weaker, and it whirls less.
    let (_folder, model, log) = arm_of(&["coulomb", "viscous"], 2);
    assert_eq!(found(&model, &log, |_| ()), []);
}

#[test]
fn a_motor_that_protects_itself_is_not_taken_for_another_drive() {
    let bench = bench(Motions::Arm, 2, &["fold_back"]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    let logs = [&bench.logs[0], &bench.logs[2]].map(|log| {
        let path = folder.path().join(&log.name);
        std::fs::write(&path, &log.csv).unwrap();
        LogRequest::whole(path)
    });
    let model = Model::parse(&bench.model_toml, &path).unwrap();
    let text = &bench.model_toml;
    let file = ModelFile { path: &path, text };
    assert_eq!(check(&logs, &model, file).unwrap(), []);
}

/// What is found in the log of an arm that lacks nothing, with its duty written as the torque, for
/// a file that has so many times its stall torque.
fn found_of_a_torque(seed: u64, strength: f64) -> Vec<LogFinding> {
    let (_folder, model, log) = arm_of(&[], seed);
    let motor = Model::load(&model).unwrap().joints[0]
        .drive
        .motor()
        .cloned();
    let motor = motor.unwrap();
    let text = std::fs::read_to_string(&log).unwrap();
    let header = text
        .lines()
        .find(|line| line.starts_with("time_s,"))
        .unwrap();
    let place = |name: &str| header.split(',').position(|column| column == name).unwrap();
    let (duty, supply_v) = (place("duty"), place("supply_v"));
    let torques = text.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_string).collect();
        let number = |at: usize| cells.get(at).and_then(|cell| cell.parse::<f64>().ok());
        if let (Some(share), Some(volts)) = (number(duty), number(supply_v)) {
            let ratio = volts / motor.nominal_supply_v.unwrap();
            cells[duty] = (motor.stall_torque_nm * ratio * share).to_string();
        }
        cells.join(",") + "\n"
    });
    std::fs::write(&log, torques.collect::<String>()).unwrap();
    let path: ParameterPath = "joint1.stall_torque_nm".parse().unwrap();
    let text = std::fs::read_to_string(&model).unwrap();
    let stronger = [(path, strength * motor.stall_torque_nm)];
    let text = crate::model::edit::set_values(&text, &model, &stronger).unwrap();
    std::fs::write(&model, text).unwrap();
    found(&model, &log, |_| ())
}

#[test]
fn a_torque_that_is_declared_as_duty_is_found() {
    let findings = found_of_a_torque(1, 3.0);
    assert_eq!(findings[0].kind, "drive", "{findings:#?}");
}

/// A stall torque of 1.0 instead of 1.5 N m says the same.
#[test]
fn a_torque_that_may_be_a_duty_of_a_weaker_motor_is_left_to_diagnosis() {
    for seed in [1, 3] {
        assert_eq!(found_of_a_torque(seed, 1.0), []);
    }
}

#[test]
fn a_wrong_angle_zero_is_found() {
    let (_folder, model, log) = arm("viscous");
    let right = Model::load(&model).unwrap().angle_zero;
    let wrong = match right {
        AngleZero::Upright => AngleZero::Hanging,
        _ => AngleZero::Upright,
    };
    let findings = found(&model, &log, |m| m.angle_zero = wrong);
    assert_eq!(findings[0].kind, "zero", "{findings:#?}");
}

#[test]
fn milliseconds_declared_as_seconds_are_found() {
    let (_folder, model, log) = arm("coulomb");
    let text = std::fs::read_to_string(&log).unwrap();
    let milliseconds = text.lines().map(|line| {
        let (time, rest) = line.split_once(',').unwrap_or((line, ""));
        match time.parse::<f64>() {
            Ok(seconds) => format!("{},{rest}\n", 1e3 * seconds),
            Err(_) => format!("{line}\n"),
        }
    });
    std::fs::write(&log, milliseconds.collect::<String>()).unwrap();
    let findings = found(&model, &log, |_| ());
    assert_eq!(findings[0].kind, "time_unit", "{findings:#?}");
    assert!(findings[0].remedy.contains("\"ms\""), "{findings:#?}");
}

#[test]
fn what_a_model_of_guesses_says_of_a_log_is_a_hint() {
    let (_folder, model, log) = arm("coulomb");
    let findings = found(&model, &log, |m| {
        m.log.joints[0].position.as_mut().unwrap().columns_mut()[0].reversed = true;
        m.guessed = true;
    });
    let first = &findings[0];
    assert_eq!(
        (first.kind, first.severity),
        ("sign", crate::log::Severity::Warn)
    );
}

/// A level slide of 95 kg to and fro under a controller, 200 times a second: viscous and Coulomb
/// friction take most of its force. Columns say no unit.
fn rubbing_slide() -> String {
    use std::fmt::Write as _;
    const STEP_S: f64 = 1e-4;
    let (mut text, mut q, mut w, mut u, mut goal) =
        (String::from("t,x,u\n"), -0.12, 0.0, 0.0, -0.12_f64);
    for step in 0..120_000_u32 {
        let time_s = f64::from(step) * STEP_S;
        if step % 50 == 0 {
            let phase = (0.25 * time_s).fract();
            let place = 0.12
                * if phase < 0.5 {
                    4.0 * phase - 1.0
                } else {
                    3.0 - 4.0 * phase
                };
            u = 4e4 * (place - q) + 4e3 * ((place - goal) * 200.0 - w);
            goal = place;
            let _ = writeln!(text, "{time_s:.4},{q:.6},{u:.4}");
        }
        let acceleration = (u - 200.0 * w - 20.0 * f64::tanh(w / 5e-5)) / 95.0;
        w += STEP_S * acceleration;
        q += STEP_S * w;
    }
    text
}

#[test]
fn friction_that_takes_most_of_a_drive_is_no_wrong_unit() {
    let folder = tempfile::tempdir().unwrap();
    let (model, log) = (
        folder.path().join("slide.toml"),
        folder.path().join("a.csv"),
    );
    std::fs::write(&log, rubbing_slide()).unwrap();
    let text = "[rig]\nname = \"slide\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.0\n\
        mass_kg = 95.0\ninertia_kg_m2 = 1.0\n[[joint]]\naxis = \"slide\"\n\
        slide_rad = 1.5707963267948966\ndrive = \"torque\"\n[log]\n\
        time = { column = \"t\", unit = \"s\" }\n[[log.joint]]\n\
        position = { column = \"x\", unit = \"m\" }\ninput = { column = \"u\", unit = \"N\" }\n";
    std::fs::write(&model, text).unwrap();
    let findings = found(&model, &log, |_| ());
    let units: Vec<&LogFinding> = findings.iter().filter(|f| f.kind == "unit").collect();
    assert!(units.is_empty(), "{units:?}");
}
