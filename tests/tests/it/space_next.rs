//! The next experiment with a robot in space.

use crate::space::{CRANE, import_crane, printed, refused, run, swung};
use handstand::Model;
use handstand::experiment::{Criterion, ExperimentLimits, ProposeOptions, propose_values};
use handstand::fitting::{Horizon, free_parameters};
use handstand::log::{LogRequest, read};
use std::path::Path;

/// A crane in this folder with a log of it.
fn crane(at: &Path) -> Model {
    import_crane(at, CRANE);
    let model = Model::load(&at.join("crane.toml")).unwrap();
    std::fs::write(at.join("a.csv"), swung(&model, 1)).unwrap();
    model
}

/// Of a crane that is driven by torques: what holds it at goals needs the tree's gravity.
#[test]
fn a_proposed_motion_tightens_a_value_over_most_of_the_range_and_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let model = crane(folder.path());
    let motions = read(
        &[LogRequest::whole(folder.path().join("a.csv"))],
        &model.log,
    )
    .unwrap();
    let limits = ExperimentLimits::of_logs(&model, &motions, 8.0);
    let options = ProposeOptions {
        limits: limits.clone(),
        mass_kg: None,
        criterion: Criterion::D,
        seed: 1,
    };
    let values = free_parameters(&model, &["link3.mass_kg".to_string()]).unwrap();
    let proposal =
        propose_values(&model, &values, motions.clone(), Horizon::Whole, &options).unwrap();
    let value = &proposal.values[0];
    assert!(
        value.standard_error_after < value.standard_error_before,
        "{value:?}"
    );
    let experiment = proposal.experiment.unwrap();
    let condition = experiment.condition;
    assert!(
        condition.payload_kg == 0.0 && !condition.turned,
        "{condition:?}"
    );
    assert!(limits.keeps(&model, &experiment.motion));
    for joint in 0..3 {
        let span = |motion: &handstand::motion::Motion| {
            let angles = &motion.position_rad[joint];
            let [low, high] = [f64::min, f64::max].map(|of| angles.iter().copied().reduce(of));
            high.unwrap() - low.unwrap()
        };
        let (asked, logged) = (span(&experiment.motion), span(&motions[0]));
        assert!(
            asked > 0.25 * logged,
            "joint {joint}: {asked} of {logged} rad"
        );
    }
    // Of a joint that rests in the logs nothing is asked.
    let mut resting = motions;
    for (joint, place) in [(0, 0.2), (2, -0.1)] {
        resting[0].position_rad[joint].fill(place);
    }
    let options = ProposeOptions {
        limits: ExperimentLimits::of_logs(&model, &resting, 8.0),
        ..options
    };
    let proposal = propose_values(&model, &values, resting, Horizon::Whole, &options).unwrap();
    let moved = proposal.experiment.unwrap().motion;
    let most = |joint: usize, from: f64| {
        let angles = moved.position_rad[joint].iter();
        angles.fold(0.0, |most: f64, angle| most.max((angle - from).abs()))
    };
    let [slew, luff, roll] = [most(0, 0.2), most(1, 0.0), most(2, -0.1)];
    assert!(
        slew < 0.05 && roll < 0.05 && luff > 0.1,
        "{slew} {luff} {roll}"
    );
}

#[test]
fn the_command_writes_the_log_s_own_columns_and_calls_links_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    crane(at);
    let next = [
        "next",
        "crane.toml",
        "a.csv",
        "--value",
        "link3.mass_kg",
        "--seconds",
        "4",
        "-o",
        "next.csv",
    ];
    let [said, _] = printed(at, &next);
    assert!(said.contains("link.head.mass_kg"), "{said}");
    assert!(!said.contains("link3"), "{said}");
    let motion = std::fs::read_to_string(at.join("next.csv")).unwrap();
    let header = motion.lines().find(|line| !line.starts_with('#')).unwrap();
    assert!(
        header.starts_with("time_s,slew.effort,luff.effort,roll.effort"),
        "{header}"
    );
}

#[test]
fn first_motions_clear_the_floor_and_are_called_by_the_joints_names() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    crane(at);
    // A crane hangs below its base.
    let floor = ["excite", "first.csv", "--model", "crane.toml"];
    let (code, said) = refused(at, &floor);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("dips boom into the plane"), "{said}");
    assert!(said.contains("--floor"), "{said}");
    let excite = [&floor[..], &["--floor", "none", "--json"]].concat();
    let (data, _) = run(at, &excite);
    let names = data["joints"].as_array().unwrap().iter();
    let names: Vec<&str> = names
        .map(|joint| joint["joint"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["slew", "luff", "roll"]);
    assert_eq!(data["motions"].as_array().unwrap().len(), 4, "{data}");
    let width = data["width"].as_f64().unwrap();
    assert!((0.1..=0.85).contains(&width), "{width}");
    let text = std::fs::read_to_string(at.join("first.csv")).unwrap();
    let header = text.lines().find(|line| !line.starts_with('#')).unwrap();
    assert_eq!(header, "time_s,slew.effort,luff.effort,roll.effort");
    let both = [&floor[..], &["--joints", "1", "--force"]].concat();
    assert_eq!(refused(at, &both).0, 2);
}

#[test]
fn a_robots_file_alone_leads_to_first_goals_of_its_servos() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("crane.urdf"), CRANE).unwrap();
    let import = [
        "import",
        "crane.urdf",
        "--drive",
        "position",
        "-o",
        "crane.toml",
    ];
    let [_, said] = printed(at, &import);
    assert!(
        said.contains("motors: of slew, luff, roll: 1.5 N m"),
        "{said}"
    );
    let model = Model::load(&at.join("crane.toml")).unwrap();
    assert!(model.guessed);
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert_eq!(free.len(), 6, "{free:?}");
    assert!(
        free.contains(&"joint2.gain_per_rad".to_string()),
        "{free:?}"
    );
    let excite = ["excite", "first.csv", "--model", "crane.toml"];
    let (data, _) = run(at, &[&excite[..], &["--floor", "none", "--json"]].concat());
    let text = std::fs::read_to_string(at.join("first.csv")).unwrap();
    let header = text.lines().find(|line| !line.starts_with('#')).unwrap();
    assert_eq!(header, "time_s,slew.goal,luff.goal,roll.goal");
    assert!(data["width"].as_f64().unwrap() >= 0.1, "{data}");
}

/// A chain in a plane gets servos too; what its file drives already stays as it is.
#[test]
fn servos_are_given_to_the_joints_that_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let arm = "<mujoco><worldbody><body><joint name=\"a\" axis=\"0 1 0\" armature=\"0.03\"/>\
               <geom type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0 0 -0.2\"/>\
               <body pos=\"0 0 -0.2\"><joint name=\"b\" axis=\"0 1 0\" armature=\"0.02\"/>\
               <geom type=\"capsule\" size=\"0.02\" fromto=\"0 0 0 0 0 -0.2\"/></body></body>\
               </worldbody><actuator><position joint=\"a\" kp=\"9\" kv=\"0.3\" \
               forcerange=\"-2 2\"/></actuator></mujoco>";
    std::fs::write(at.join("arm.xml"), arm).unwrap();
    let import = ["import", "arm.xml", "--drive", "position", "-o", "arm.toml"];
    let [_, said] = printed(at, &import);
    assert!(said.contains("motors: of b: 1.5 N m"), "{said}");
    let model = Model::load(&at.join("arm.toml")).unwrap();
    assert!(model.guessed);
    let text = std::fs::read_to_string(at.join("arm.toml")).unwrap();
    assert!(
        text.contains("free = [\n    \"joint2.gain_per_rad\",\n]"),
        "{text}"
    );
    assert!(text.contains("gain_per_rad = 4.5"), "{text}");
    assert!(text.contains("inertia_kg_m2 = 0.03"), "{text}");
}
