//! From a log, or a robot's file, to a model that the other commands take.

use crate::common::{Bench, swing};
use assert_cmd::Command;
use std::path::{Path, PathBuf};

/// Logs of public rigs, where they are.
fn data() -> Option<PathBuf> {
    std::env::var_os("HANDSTAND_DATA").map(PathBuf::from)
}

#[test]
fn a_model_begun_from_a_log_is_checked_compared_and_diagnosed() {
    let bench = Bench::new();
    let begun = bench.run("init a.csv -o begun.toml --mass 0.2 --json");
    assert_eq!(begun.code, Some(0), "{begun:?}");
    let guesses = begun.json()["guesses"].as_array().unwrap().clone();
    assert!(guesses.iter().any(|guess| guess["what"] == "angle zero"));
    // What is known, estimated and guessed is told apart.
    let values = begun.json()["values"].as_array().unwrap().clone();
    let at = |path: &str| {
        let mut own = values.iter().filter(|value| value["path"] == path);
        own.next()
            .unwrap_or_else(|| panic!("{path}: {values:?}"))
            .clone()
    };
    assert_eq!(at("link1.mass_kg")["origin"], "given");
    assert_eq!(at("link1.inertia_kg_m2")["origin"], "guess");
    assert!(at("link1.inertia_kg_m2")["low"].is_null());
    let friction = at("viscous@1.coefficient_nm_s_rad");
    assert_eq!(friction["origin"], "estimated");
    let [low, value, high] = ["low", "value", "high"].map(|key| friction[key].as_f64().unwrap());
    assert!(low < value && value < high, "{friction}");
    assert!(
        begun
            .stderr
            .contains("next: handstand log check begun.toml a.csv")
    );
    assert_eq!(bench.run("init a.csv -o begun.toml").code, Some(2));
    assert_eq!(bench.run("log check begun.toml a.csv b.csv").code, Some(0));
    // Friction is what no header tells: it is estimated, and with it nothing is missing.
    let text = bench.get("begun.toml");
    assert!(text.contains("kind = \"viscous\""), "{text}");
    let found = bench.run("diagnose begun.toml a.csv --holdout b.csv --json");
    let diagnosis = found.json();
    assert_eq!(diagnosis["verdict"], "nominal", "{found:?}");
    let error = |key: &str| diagnosis["error"][key].as_f64().unwrap();
    assert!(error("before_rad") < 2.0 * error("floor_rad"), "{found:?}");
    let fitted = bench.run("fit begun.toml a.csv b.csv -o fitted.toml");
    assert_eq!(fitted.code, Some(0), "{fitted:?}");
    assert_eq!(bench.run("compare fitted.toml b.csv").code, Some(0));
}

#[test]
fn models_begun_from_public_logs_are_read_and_checked() {
    let Some(data) = data() else {
        println!("HANDSTAND_DATA is not set: nothing begun");
        return;
    };
    let logs = [
        ("multiarm/single_id.csv", ["upright", "passive"]),
        ("multiarm/triple_id.csv", ["upright", "passive"]),
        ("mx106_drop/drop.csv", ["horizontal", "passive"]),
        ("htd45h/sin_sin.csv", ["hanging", "position"]),
        ("dfki_pendulum/ddp_measured.csv", ["hanging", "torque"]),
        (
            "dfki_double/design_A.0_20220815_sys_id_trajectory_00.csv",
            ["hanging", "torque"],
        ),
    ];
    for (log, [zero, drive]) in logs {
        let bench = Bench::new();
        let log = data.join(log);
        let log = log.display();
        assert_eq!(
            bench.run(&format!("init {log} -o begun.toml")).code,
            Some(0),
            "{log}"
        );
        let text = bench.get("begun.toml");
        assert!(
            text.contains(&format!("angle_zero = \"{zero}\"")),
            "{log}: {text}"
        );
        assert!(
            text.contains(&format!("drive = \"{drive}\"")),
            "{log}: {text}"
        );
        let compared = bench.run(&format!("compare begun.toml {log}"));
        assert_eq!(compared.code, Some(0), "{log}: {compared:?}");
    }
}

#[test]
fn a_folder_and_the_standard_input_are_logs() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("runs")).unwrap();
    bench.put("runs/1.csv", swing(1.0));
    bench.put("runs/2.csv", swing(-0.8));
    bench.put("runs/notes.md", "no log");
    let folder = bench.run("compare model.toml runs --json").json();
    let single = bench
        .run("compare model.toml runs/1.csv runs/2.csv --json")
        .json();
    assert_eq!(folder["comparisons"], single["comparisons"]);
    let piped = Command::new(env!("CARGO_BIN_EXE_handstand"))
        .args(["compare", "model.toml", "-", "--json"])
        .current_dir(bench.path("."))
        .write_stdin(swing(1.0))
        .output()
        .unwrap();
    assert!(
        piped.status.success(),
        "{}",
        String::from_utf8_lossy(&piped.stderr)
    );
}

#[test]
fn files_of_other_programs_are_logs() {
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/logs");
    let bench = Bench::new();
    for file in ["states_zstd.mcap", "states.db3"] {
        let log = logs.join(file);
        let log = log.display();
        assert_eq!(
            bench
                .run(&format!("init {log} -o model_of.toml --force"))
                .code,
            Some(0),
            "{file}"
        );
        let compared = bench.run(&format!("compare model_of.toml {log}"));
        assert_eq!(compared.code, Some(0), "{file}: {compared:?}");
    }
}

#[test]
fn a_robot_of_another_simulator_becomes_a_model() {
    let bench = Bench::new();
    assert_eq!(
        bench
            .run("model export model.toml --to mjcf -o robot.xml")
            .code,
        Some(0)
    );
    let imported = bench.run("import robot.xml -o again.toml --json");
    assert_eq!(imported.code, Some(0), "{imported:?}");
    assert_eq!(imported.json()["joints"], serde_json::json!(["joint1"]));
    let again = bench.run("model export again.toml --to mjcf").stdout;
    let inertial = |text: &str| -> Vec<f64> {
        let line = text.lines().find(|line| line.contains("<inertial"));
        let words = line.unwrap().split(['"', ' ']);
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let (before, after) = (inertial(&bench.get("robot.xml")), inertial(&again));
    assert_eq!((before.len(), after.len()), (7, 7), "{again}");
    for (before, after) in before.iter().zip(&after) {
        assert!((before - after).abs() < 1e-15, "{again}");
    }
    assert_eq!(bench.run("import robot.xml --joints knee").code, Some(2));
    bench.put("broken.urdf", "<robot><link name='a'>");
    let broken = bench.run("import broken.urdf");
    assert_eq!(broken.code, Some(3));
    assert!(
        broken.stderr.contains("broken.urdf:1:"),
        "{}",
        broken.stderr
    );
}

#[test]
fn a_log_is_drawn_before_any_model_reads_it() {
    let bench = Bench::new();
    let drawn = bench.run("log plot a.csv");
    assert_eq!(drawn.code, Some(0), "{drawn:?}");
    assert!(drawn.stdout.contains("angle_rad: "), "{drawn:?}");
    let page = bench.run("log plot a.csv --column angle_rad --report raw.html --json");
    assert_eq!(page.json()["columns"][1]["name"], "angle_rad", "{page:?}");
    assert!(bench.get("raw.html").contains("<svg"));
    assert_eq!(bench.run("log plot a.csv --report raw.html").code, Some(2));
    let wrong = bench.run("log plot a.csv --column angel_rad");
    assert_eq!(wrong.code, Some(2), "{wrong:?}");
    assert!(wrong.stderr.contains("angle_rad"), "{wrong:?}");
    bench.put("none.csv", "q\nx\n");
    assert_eq!(bench.run("log plot none.csv").code, Some(0));
}

#[test]
fn two_recorders_logs_become_one_that_is_compared() {
    let bench = Bench::new();
    let made = bench.run("challenge new --seed 5 --effect coulomb -o riddle");
    assert_eq!(made.code, Some(0), "{made:?}");
    // A camera saw the same motion, on a clock of its own and from the hundredth row on.
    let camera = |text: &str| {
        let numbers = |line: &str| -> Vec<f64> {
            line.split(',')
                .filter_map(|cell| cell.parse().ok())
                .collect()
        };
        let rows = text.lines().map(numbers).filter(|row| row.len() > 1);
        let rows = rows.skip(100).map(|row| {
            let (time_s, angle_deg) = (row[0] + 71.25, row[1].to_degrees());
            format!("{time_s},{angle_deg}\n")
        });
        "stamp_s,marker_deg\n".to_string() + &rows.collect::<String>()
    };
    bench.put("camera.csv", camera(&bench.get("riddle/a.csv")));
    let merged = bench.run("log merge riddle/a.csv camera.csv -o both.csv --json");
    assert_eq!(merged.code, Some(0), "{merged:?}");
    let offset_s = merged.json()["offset_s"].as_f64().unwrap();
    assert!((offset_s + 71.25).abs() < 2e-3, "{offset_s}");
    assert_eq!(
        bench.run("compare riddle/nominal.toml both.csv").code,
        Some(0)
    );
    let again = "log merge riddle/a.csv camera.csv -o both.csv";
    assert_eq!(bench.run(again).code, Some(2));
    let far = bench.run("log merge riddle/a.csv camera.csv -o far.csv --offset 1e6");
    assert_eq!(far.code, Some(2), "{far:?}");
    // A swing that dies away slowly fits itself a period later.
    bench.put("swing.csv", camera(&bench.get("a.csv")));
    let repeats = bench.run("log merge a.csv swing.csv -o far.csv");
    assert!(repeats.stderr.contains("repeat themselves"), "{repeats:?}");
    assert!(!bench.path("far.csv").exists());
}

/// The input's column, its drive in the model begun, and what else is said.
const INPUTS: [(&str, &str); 8] = [
    ("motor_torque_nm", "torque"),
    ("torque_nm", "torque"),
    ("tau", "torque"),
    ("torque", "torque"),
    ("u", "torque"),
    ("m1_tau", "torque"),
    ("motor_duty", "duty"),
    ("goal_deg", "position"),
];

/// A log of one joint, `shoulder_deg`, and an input of this name.
fn with_input(name: &str) -> String {
    let row = |k: u32| {
        let t = 0.01 * f64::from(k);
        let (angle, input) = (30.0 * (3.0 * t).sin(), 0.5 * (5.0 * t).cos());
        format!("{},{angle:.3},{input:.5}\n", 1e3 * t)
    };
    let rows: String = (0..400).map(row).collect();
    format!("stamp_ms,shoulder_deg,{name}\n{rows}")
}

#[test]
fn the_only_input_belongs_to_the_only_joint() {
    let bench = Bench::new();
    for (name, drive) in INPUTS {
        bench.put("log.csv", with_input(name));
        let ran = bench.run("init log.csv");
        assert_eq!(ran.code, Some(0), "{name}: {ran:?}");
        let line = format!("drive = \"{drive}\"");
        assert!(ran.stdout.contains(&line), "{name}: {}", ran.stdout);
        let column = format!("input = {{ column = \"{name}\"");
        assert!(ran.stdout.contains(&column), "{name}: {}", ran.stdout);
        assert!(!ran.stderr.contains("not used"), "{name}: {}", ran.stderr);
    }
    // What a current is in N m, no header tells.
    bench.put("log.csv", with_input("current_a"));
    let ran = bench.run("init log.csv");
    assert!(ran.stderr.contains("torque_constant_nm_a"), "{ran:?}");
}

#[test]
fn a_drive_without_its_input_and_a_log_without_joints_are_refused() {
    let bench = Bench::new();
    bench.put("log.csv", with_input("tau"));
    assert_eq!(bench.run("init log.csv --drive torque").code, Some(0));
    assert_eq!(bench.run("init log.csv --drive passive").code, Some(0));
    let ran = bench.run("init log.csv --drive duty");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    let said = "no column of log.csv that changes is named as a duty: stamp_ms, shoulder_deg, tau";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
    bench.put("log.csv", "t,angle_rad\n");
    let ran = bench.run("init log.csv");
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(
        ran.stderr.contains("log.csv: the log holds no sample"),
        "{ran:?}"
    );
    bench.put("log.csv", "t,foo\n0,1\n1,2\n");
    let ran = bench.run("init log.csv");
    assert_eq!(ran.code, Some(3), "{ran:?}");
    let said = "log.csv: no column is named as an angle or a speed: \"t\", \"foo\"";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
}
