//! What `handstand gains` says of a robot in space, and what is refused of one.

use crate::space::{CRANE, import_crane, printed, refused, run};
use serde_json::{Value, json};

/// A folder with the crane and its model, whose joints all take torques; the boom has a range.
fn crane() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let boom = "<axis xyz=\"0 1 0\"/>";
    let ranged = CRANE.replacen(
        boom,
        &format!("{boom}<limit lower=\"-1\" upper=\"1.5\" effort=\"2\" velocity=\"0\"/>"),
        1,
    );
    let luff = "<joint name=\"luff\" type=\"continuous\">";
    let ranged = ranged.replace(luff, "<joint name=\"luff\" type=\"revolute\">");
    import_crane(at, &ranged);
    folder
}

#[test]
fn states_and_inputs_have_the_names_of_joints_in_every_output() {
    let folder = crane();
    let at = folder.path();
    let files = ["--c", "gains.h", "--rust", "gains.rs", "--csv", "k.csv"];
    let gains = ["gains", "crane.toml", "--pose", "luff=0.6"];
    let [text, said] = printed(at, &[&gains[..], &files].concat());
    assert!(
        said.contains("not named by --pose: slew 0 rad, roll 0 rad"),
        "{said}"
    );
    assert!(text.contains("at slew 0, luff 0.6, roll 0 rad"), "{text}");
    assert!(
        text.contains("After 15 s 20 of 20 stand, at rest."),
        "{text}"
    );
    for numbered in ["q1", "u2", "joint 1"] {
        assert!(!text.contains(numbered), "{numbered}: {text}");
    }
    let (data, _) = run(at, &[&gains[..], &["--json"]].concat());
    assert_eq!(data["joint_names"], json!(["slew", "luff", "roll"]));
    assert_eq!(
        data["states"][1],
        json!({ "name": "q_luff", "unit": "rad" })
    );
    assert_eq!(
        data["states"][5],
        json!({ "name": "dq_roll", "unit": "rad/s" })
    );
    assert_eq!(
        data["inputs"][2],
        json!({ "name": "u_roll", "unit": "N m" })
    );
    let held = data["u0"][1].as_f64().unwrap();
    assert!(text.contains(&format!("u_luff {held:.6}")), "{held} {text}");
    let read = |name: &str| std::fs::read_to_string(at.join(name)).unwrap();
    assert!(read("gains.h").contains("#define GAINS_STATE_STEP_DQ_ROLL "));
    assert!(read("gains.rs").contains("// States x: q_slew [rad], q_luff [rad]"));
    assert!(
        read("k.csv").starts_with("input,q_slew,q_luff,q_roll,dq_slew"),
        "{}",
        read("k.csv")
    );
}

/// Integral action, a filter, continuous time, a search of weights.
#[test]
fn every_kind_of_design_is_made_in_space() {
    let folder = crane();
    let at = folder.path();
    let of = |options: &[&str]| -> Value {
        let (data, _) = run(
            at,
            &[
                &["gains", "crane.toml", "--pose=0,0.6,0", "--json"][..],
                options,
            ]
            .concat(),
        );
        assert_eq!(
            data["verification"]["stabilised"], true,
            "{options:?}: {data}"
        );
        data
    };
    let name = |data: &Value, state: usize| data["states"][state]["name"].clone();
    assert_eq!(name(&of(&["--integral", "1"]), 6), "int_q_slew");
    assert_eq!(name(&of(&["--delay", "0.013"]), 6), "u_slew(k-1)");
    let filtered = of(&["--lqg", "--range", "0.5,0.5,0.5,20,20,20"]);
    assert_eq!(filtered["estimator"]["outputs"][3]["name"], "dq_slew");
    assert!(of(&["--continuous"])["fixed"].is_null());
}

#[test]
fn poses_that_are_none_are_refused_with_what_to_do() {
    let folder = crane();
    for (pose, said, help) in [
        ("luf=0.6", "no joint `luf`", "did you mean `luff`?"),
        ("luff=1.6", "beyond its range from -1 to 1.5 rad", "within"),
        ("0.6", "1 angles, the model 3 joints", "slew, luff, roll"),
        ("luff=1,2=1", "joint 2 twice", "once"),
        ("upright", "is a robot in space", "by joint"),
        ("luff", "luff", "by name"),
    ] {
        let (code, text) = refused(folder.path(), &["gains", "crane.toml", "--pose", pose]);
        assert_eq!(code, 2, "{pose}: {text}");
        assert!(text.contains(said) && text.contains(help), "{pose}: {text}");
    }
}

#[test]
fn what_is_for_planar_chains_alone_says_so() {
    let folder = crane();
    let at = folder.path();
    std::fs::write(at.join("study.toml"), "[robot]\nmodel = \"crane.toml\"\n").unwrap();
    for arguments in [
        &["deploy", "crane.toml", "--dry-run"][..],
        &["deploy", "crane.toml", "--dry-run", "--law", "state"],
        &["balance", "crane.toml", "--dry-run"],
        &["controllers", "crane.toml"],
        &["robust", "crane.toml"],
        &["delays", "crane.toml"],
        &["study", "monte-carlo", "study.toml", "-o", "runs"],
        &["study", "sweep", "delay", "--study", "study.toml"],
        &["virtual", "--pty", "--robot", "crane.toml"],
        &["record", "a.csv", "--port", "sim:robot=crane.toml"],
    ] {
        let (code, said) = refused(at, arguments);
        assert_eq!(code, 3, "{arguments:?}: {said}");
        assert!(
            said.contains("is a robot in space, and"),
            "{arguments:?}: {said}"
        );
    }
}
