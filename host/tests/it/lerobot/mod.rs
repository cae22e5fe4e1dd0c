//! From a data set of LeRobot and a robot's file to the first comparison, as a user goes.

mod dataset;
mod hostile;
mod tables;

use crate::common::{Bench, Ran};
use dataset::{Dataset, JOINTS, calibration, simulated};
pub use dataset::{EPISODES, ROBOT, Written};
use serde_json::{Value, json};
use std::path::Path;

/// Errors of a model that is right, mrad: those of start speeds taken from rows at 30 Hz, and of a
/// servo's counts of 1.5 mrad.
const RIGHT_MRAD: f64 = 3.0;

/// A folder with `robot.urdf` and a data set `d`.
pub fn bench(version: &'static str, names: Value, unit: Written) -> Bench {
    let bench = Bench::new();
    let angles = simulated(&bench.path(""));
    Dataset::of(version, names, &angles, unit).write(&bench.path("d"));
    let calibration = serde_json::to_vec(&calibration()).unwrap();
    bench.put("calibration.json", calibration);
    bench
}

/// Names as LeRobot writes them since v3.0, in the robot's order.
pub fn names() -> Value {
    json!(JOINTS.map(|joint| format!("{joint}.pos")))
}

fn done(ran: Ran) -> Ran {
    assert_eq!(ran.code, Some(0), "{ran:?}");
    ran
}

/// Root mean square of each joint's error, mrad, of a comparison as a user asks for it.
fn errors_mrad(bench: &Bench, model: &str, log: &str) -> Vec<f64> {
    let told = done(bench.run(&format!("compare {model} {log} --json"))).json();
    let signals = told["comparisons"][0]["signals"]
        .as_array()
        .unwrap()
        .clone();
    let rms = |signal: Value| 1e3 * signal["rms_rad"].as_f64().unwrap();
    signals.into_iter().map(rms).collect()
}

fn assert_right(bench: &Bench, model: &str, log: &str) {
    let errors = errors_mrad(bench, model, log);
    assert!(errors.iter().all(|error| *error < RIGHT_MRAD), "{errors:?}");
}

#[test]
fn a_data_set_of_each_version_is_compared_at_once() {
    let main = json!({"motors": JOINTS.map(|joint| format!("main_{joint}"))});
    for (version, names) in [("v2.0", main.clone()), ("v2.1", main), ("v3.0", names())] {
        let bench = bench(version, names, Written::Degrees);
        let init = "init d --robot robot.urdf --calibration calibration.json --unit deg -o m.toml";
        let told = done(bench.run(init)).stderr;
        assert!(
            told.contains("next: handstand compare m.toml d"),
            "{version}: {told}"
        );
        assert_right(&bench, "m.toml", "d");
        // LeRobot divides a turn of 4096 counts by 4095.
        let model = bench.get("m.toml");
        assert_eq!(
            model.matches("ticks_per_turn = 360.08791208791").count(),
            4,
            "{model}"
        );
        let json = done(bench.run("compare m.toml d --json")).json();
        let horizons = &json["comparisons"][0]["horizons"];
        assert!(horizons.is_array(), "{json}");
        // Each episode is a motion.
        let check = done(bench.run("log check m.toml d --json")).stdout;
        assert!(
            check.contains(&format!("in {EPISODES} motions")),
            "{version}: {check}"
        );
        // One file of it is a log, too, and rows of that.
        let file = match version {
            "v3.0" => "d/data/chunk-000/file-000.parquet",
            _ => "d/data/chunk-000/episode_000001.parquet",
        };
        assert_right(&bench, "m.toml", file);
        assert_right(&bench, "m.toml", &format!("{file}:20-110"));
        assert_eq!(bench.run("compare m.toml d:0-50").code, Some(2));
    }
}

#[test]
fn per_cent_of_a_calibrated_range_are_angles() {
    let bench = bench("v3.0", names(), Written::Percent);
    let init = "init d --robot robot.urdf --calibration calibration.json --unit percent -o m.toml";
    done(bench.run(init));
    assert_right(&bench, "m.toml", "d");
    let model = bench.get("m.toml");
    // 200 per cent are 2600 of 4096 counts, 100 of the gripper's 1340.
    assert!(
        model.contains("ticks_per_turn = 315.07692307692"),
        "{model}"
    );
    assert!(model.contains("ticks_per_turn = 305.6716417910"), "{model}");
    assert!(model.contains("offset_rad = -0.2"), "{model}");
    assert_eq!(model.matches("reversed = true").count(), 2, "{model}");
    // Angle and goal of each joint, and no other.
    assert_eq!(model.matches("resolution_rad").count(), 3, "{model}");
    // Per cent taken for degrees are far off.
    let lock = "init d --robot robot.urdf --unit deg --lock gripper=0.5 -o deg.toml";
    done(bench.run(lock));
    let errors = errors_mrad(&bench, "deg.toml", "d");
    assert!(
        errors.iter().any(|error| *error > 3.0 * RIGHT_MRAD),
        "{errors:?}"
    );
}

/// The masses of a robot whose model leaves its links to the robot's file: what of them is told is
/// told as sums, and what is written is read again.
#[test]
fn fitted_masses_are_written_by_their_links_names() {
    let bench = bench("v3.0", names(), Written::Rad);
    done(bench.run("init d --robot robot.urdf --unit rad -o m.toml"));
    let model = bench.get("m.toml");
    let of_file = |table: &&str| {
        let derived = ["[link", "uncertainty", "fit"];
        !derived.iter().any(|name| table.starts_with(name))
    };
    let kept: Vec<&str> = model.split("\n[").filter(of_file).collect();
    bench.put("of_file.toml", kept.join("\n["));
    let fit = |held: &str| {
        let free = [
            "mast.mass_kg",
            "mast.com_m",
            "boom.mass_kg",
            "boom.com_m",
            "jaw.mass_kg",
        ];
        let free = free.map(|own| format!("link.{own}"));
        let free = free.iter().filter(|own| *own != held);
        let free: String = free.map(|own| format!(" --free {own}")).collect();
        bench.run(&format!("fit of_file.toml d{free} -o fitted.toml"))
    };
    // A mast that slews about the vertical shows its moment alone.
    let refused = fit("");
    assert_eq!(refused.code, Some(1), "{refused:?}");
    let told = "What to do: leave `link.mast.mass_kg` out of the fit";
    assert!(refused.stdout.contains(told), "{refused:?}");
    let found = done(fit("link.mast.mass_kg")).stdout;
    assert!(!found.contains("only sums"), "{found}");
    let fitted = bench.get("fitted.toml");
    for link in ["mast", "boom", "jaw"] {
        let table = format!("[[link]]\nname = \"{link}\"\n");
        assert_eq!(fitted.matches(&table).count(), 1, "{fitted}");
    }
    assert_right(&bench, "fitted.toml", "d");
}

/// A Dynamixel with `drive_mode` 1 turns its count round itself, so LeRobot does not.
#[test]
fn the_drive_mode_counts_on_feetech_alone() {
    let bench = bench("v3.0", names(), Written::Percent);
    let info = bench.get("d/meta/info.json");
    bench.put(
        "d/meta/info.json",
        info.replace("so101_follower", "koch_follower"),
    );
    let init = "init d --robot robot.urdf --calibration calibration.json --unit percent";
    let model = done(bench.run(init)).stdout;
    assert!(!model.contains("reversed"), "{model}");
}

#[test]
fn what_unit_a_data_set_has_is_asked_where_nothing_tells() {
    let bench = bench("v3.0", names(), Written::Percent);
    let ran = bench.run("init d --robot robot.urdf --calibration calibration.json");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(
        ran.stderr.contains("--unit deg") && ran.stderr.contains("--unit percent"),
        "{ran:?}"
    );
    let ran = bench.run("init d --robot robot.urdf --unit percent");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("--calibration FILE.json"), "{ran:?}");
    // A gripper is in per cent even where the arm is in degrees.
    let ran = bench.run("init d --robot robot.urdf --unit deg");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("--lock gripper=0"), "{ran:?}");
    // Of another robot's log neither is asked.
    let ran = bench.run("init a.csv --robot robot.urdf --unit deg");
    assert_eq!(ran.code, Some(2), "{ran:?}");
}

#[test]
fn values_that_are_no_per_cent_are_degrees_or_refused() {
    let bench = Bench::new();
    let mut angles = simulated(&bench.path(""));
    for joint in &mut angles[0] {
        joint[0].iter_mut().for_each(|angle| *angle *= 4.0);
    }
    Dataset::of("v3.0", names(), &angles, Written::Degrees).write(&bench.path("d"));
    bench.put(
        "calibration.json",
        serde_json::to_vec(&calibration()).unwrap(),
    );
    let init = "init d --robot robot.urdf --calibration calibration.json";
    let told = done(bench.run(init)).stderr;
    assert!(
        told.contains("some lie beyond 100, so they are no per cent"),
        "{told}"
    );
    let ran = bench.run(&format!("{init} --unit percent"));
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.stderr.contains("shoulder_pan.pos is "), "{ran:?}");
    assert!(ran.stderr.contains("--unit deg"), "{ran:?}");
}

#[test]
fn joints_are_matched_by_names_whatever_their_order() {
    let bench = Bench::new();
    let mut angles = simulated(&bench.path(""));
    for episode in &mut angles {
        episode.iter_mut().for_each(|all| all.reverse());
    }
    let names = json!(["gripper.pos", "shoulder_lift.pos", "shoulder_pan.pos"]);
    Dataset::of("v2.1", names, &angles, Written::Rad).write(&bench.path("d"));
    let told = done(bench.run("init d --robot robot.urdf -o m.toml")).stderr;
    assert!(told.contains("in rad"), "{told}");
    assert_right(&bench, "m.toml", "d");
    let model = bench.get("m.toml");
    let pan = model.find("observation.state_3").unwrap();
    assert!(pan < model.find("observation.state_1").unwrap(), "{model}");
    // What is commanded has names, and an order, of its own.
    let info = bench.get("d/meta/info.json");
    let mut other: Value = serde_json::from_str(&info).unwrap();
    other["features"]["action"]["names"] = self::names();
    bench.put("d/meta/info.json", other.to_string());
    let model = done(bench.run("init d --robot robot.urdf")).stdout;
    let pan = model.find("column = \"observation.state_3\"").unwrap();
    let goal = model.find("column = \"action_1\"").unwrap();
    assert!(
        pan < goal && goal < model.find("observation.state_2").unwrap(),
        "{model}"
    );
    bench.put("d/meta/info.json", info);
    // Nothing is overwritten unasked.
    let ran = bench.run("init d --robot robot.urdf -o m.toml");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    done(bench.run("init d --robot robot.urdf -o m.toml --force --name arm7"));
    assert!(bench.get("m.toml").contains("name = \"arm7\""));
    // The same model without a terminal, as JSON.
    let json = done(bench.run("init d --robot robot.urdf --json")).json();
    assert_eq!(json["joints"], json!(JOINTS));
    assert!(
        json["text"].as_str().unwrap().contains("[[log.joint]]"),
        "{json}"
    );
    assert!(
        json["file"].is_null() && json["guesses"].is_array(),
        "{json}"
    );
}

#[test]
fn a_joint_without_a_name_in_the_log_is_mapped_or_held() {
    let names = json!(["shoulder_pan.pos", "shoulder_lift.pos", "jaw.pos"]);
    let bench = bench("v3.0", names, Written::Rad);
    let ran = bench.run("init d --robot robot.urdf -o m.toml");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    for word in [
        "gripper",
        "jaw.pos",
        "shoulder_pan.pos",
        "--map gripper=NAME",
        "--lock gripper=0",
    ] {
        assert!(ran.stderr.contains(word), "{word}: {ran:?}");
    }
    assert!(!bench.path("m.toml").exists());
    done(bench.run("init d --robot robot.urdf --map gripper=jaw -o m.toml"));
    assert_right(&bench, "m.toml", "d");
    let told = done(bench.run("init d --robot robot.urdf --lock gripper=0.7 -o held.toml")).stderr;
    assert!(told.contains("not taken: jaw.pos"), "{told}");
    assert_eq!(errors_mrad(&bench, "held.toml", "d").len(), 2);
}

/// Many data sets name the list, not its elements: `["motors"]` of six.
#[test]
fn a_data_set_without_names_is_read_and_mapped_by_its_columns() {
    for names in [json!(["motors"]), Value::Null] {
        let bench = bench("v2.1", names, Written::Rad);
        let ran = bench.run("init d --robot robot.urdf");
        assert_eq!(ran.code, Some(3), "{ran:?}");
        for word in [
            "info.json",
            "observation.state",
            "names",
            "--map shoulder_pan=NAME",
        ] {
            assert!(ran.stderr.contains(word), "{word}: {ran:?}");
        }
        let all = (1..).zip(JOINTS);
        let map: String = all
            .map(|(k, own)| format!(" {own}=observation.state_{k}"))
            .collect();
        done(bench.run(&format!("init d --robot robot.urdf -o m.toml --map{map}")));
        assert_right(&bench, "m.toml", "d");
        // So is a file of it, which has no names either.
        let file = "d/data/chunk-000/episode_000000.parquet";
        done(bench.run(&format!(
            "init {file} --robot robot.urdf -o f.toml --map{map}"
        )));
        assert_right(&bench, "f.toml", "d");
    }
}

/// Columns of joint states, in CSV as in MCAP: efforts drive what moves.
#[test]
fn other_logs_of_a_robot_are_matched_by_their_columns() {
    let bench = Bench::new();
    bench.put("robot.urdf", ROBOT);
    let mut text = String::from("time_s");
    for joint in JOINTS {
        text += &format!(",{joint}.position,{joint}.velocity,{joint}.effort");
    }
    for row in 0..200 {
        let t = f64::from(row) * 0.02;
        text += &format!("\n{t:.2}");
        for joint in 0..3 {
            let (angle, rate) = (0.3 * (2.0 * t + f64::from(joint)).sin(), 0.6);
            let speed = rate * (2.0 * t + f64::from(joint)).cos();
            text += &format!(",{angle:.6},{speed:.6},{:.6}", 0.1 * angle);
        }
    }
    bench.put("states.csv", text);
    done(bench.run("init states.csv --robot robot.urdf -o m.toml"));
    let model = bench.get("m.toml");
    assert_eq!(model.matches("drive = \"torque\"").count(), 3, "{model}");
    for column in ["gripper.position", "gripper.velocity", "gripper.effort"] {
        assert!(
            model.contains(&format!("column = \"{column}\"")),
            "{column}: {model}"
        );
    }
    assert_eq!(errors_mrad(&bench, "m.toml", "states.csv").len(), 3);
    // Without a drive in the log nothing moves the joints but gravity.
    done(bench.run("init states.csv --robot robot.urdf --drive passive -o free.toml"));
    let ran = bench.run("init states.csv --robot robot.urdf --drive position");
    assert_eq!(ran.code, Some(2), "{ran:?}");
}

/// Joint states of ROS say what their columns are.
#[test]
fn joint_states_of_ros_are_matched_by_their_names() {
    let bench = Bench::new();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fuzz/corpus");
    for (log, named) in [
        ("log_mcap/states_lz4.mcap", "a.mcap"),
        ("log_rosbag/states.db3", "a.db3"),
    ] {
        bench.put(named, std::fs::read(corpus.join(log)).unwrap());
        let robot = std::fs::read_to_string(corpus.join("import/two.urdf")).unwrap();
        let robot = robot.replace("name=\"s\"", "name=\"shoulder\"");
        bench.put("two.urdf", robot.replace("name=\"e\"", "name=\"elbow\""));
        let model = done(bench.run(&format!("init {named} --robot two.urdf"))).stdout;
        for joint in ["shoulder", "elbow"] {
            let column = format!("position = {{ column = \"{joint}.position\", unit = \"rad\" }}");
            assert!(model.contains(&column), "{named}: {model}");
        }
    }
}

/// The arm that most data sets are of, from its owner's file.
#[test]
fn the_so101_is_compared_with_a_data_set_by_its_own_file() {
    let Ok(data) = std::env::var("HANDSTAND_DATA") else {
        eprintln!("skipped: HANDSTAND_DATA names no folder of robots");
        return;
    };
    let bench = bench("v3.0", names(), Written::Degrees);
    for name in ["so101_new_calib.urdf", "so101_new_calib.xml"] {
        let robot = std::fs::read(format!("{data}/robots/so101/{name}")).unwrap();
        bench.put(name, robot);
        let hold = "--lock elbow_flex=0 wrist_flex=0 wrist_roll=0 gripper=0.3";
        done(bench.run(&format!("init d --robot {name} {hold} --force -o m.toml")));
        let errors = errors_mrad(&bench, "m.toml", "d");
        assert!(errors.iter().all(|error| *error < 300.0), "{errors:?}");
    }
}
