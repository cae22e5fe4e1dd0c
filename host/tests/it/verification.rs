//! What `handstand gains` says of the loop that it simulates.

use crate::common::{Bench, MODEL};

/// A driven pendulum, designed for upright, and the same with friction beyond its weight's torque.
fn bench() -> Bench {
    let bench = Bench::new();
    let driven = MODEL.replace("\"passive\"", "\"torque\"");
    let driven = driven + "input = { column = \"u\", unit = \"N m\" }\n";
    let friction = "\n[[effect]]\nkind = \"coulomb\"\njoint = 1\ntorque_nm = 0.5\n";
    bench.put("free.toml", &driven);
    bench.put("stuck.toml", driven + friction);
    bench
}

#[test]
fn a_robot_that_friction_holds_is_not_called_stabilised() {
    let bench = bench();
    let stuck = bench.run("gains stuck.toml");
    assert_eq!(stuck.code, Some(1), "{stuck:?}");
    for said in [
        "within 0.5 deg: NOT stabilised: it stays, but without control it stays, too.",
        "With all gains at zero it stays from 40 of the same 40 starts",
    ] {
        assert!(stuck.stdout.contains(said), "{said}: {}", stuck.stdout);
    }
    let verification = &bench.run("gains stuck.toml --json").json()["verification"];
    assert_eq!(verification["stays_uncontrolled"], true);
    assert_eq!(verification["held"], true);
    assert_eq!(verification["stabilised"], false);
    assert_eq!(verification["uncontrolled"]["stabilised"], 40);

    let free = bench.run("gains free.toml");
    assert!(free.stdout.contains("0.5 deg: stabilised."), "{free:?}");
    assert!(!free.stdout.contains("all gains at zero"), "{free:?}");
    let verification = &bench.run("gains free.toml --json").json()["verification"];
    assert_eq!(verification["stays_uncontrolled"], false);
    assert_eq!(verification["law"], "fixed_point");
    assert_eq!(verification["lasting"]["manner"]["manner"], "at_rest");

    // What friction holds does not count in studies either.
    let told = "controllers stuck.toml --controller dlqr --condition ideal --robots 20 \
                --region-robots 0 --json";
    let trial = &bench.run(told).json()[0];
    assert_eq!(trial["stabilised"], 0.0, "{trial}");
    assert_eq!(trial["held"], 20, "{trial}");
}

/// Coarse sensors: the filter's own loop falls, and is not called stabilised for its gains' sake.
#[test]
fn the_law_that_is_stated_is_the_one_that_runs() {
    let bench = bench();
    let coarse = bench.run("gains free.toml --lqg --position-step 0.5 --gyro-step 100");
    assert_eq!(coarse.code, Some(1), "{coarse:?}");
    for said in [
        "The law of gains and filter",
        "Noise moves it by     q1",
        "NOT stabilised",
        "without the filter",
    ] {
        assert!(coarse.stdout.contains(said), "{said}: {}", coarse.stdout);
    }
    let recovered = bench
        .run("gains free.toml --q 100 --lqg --recovery 0.1 --json")
        .json();
    let noisy = |stationary: &serde_json::Value| stationary["input_rms"][0].as_f64().unwrap();
    let before = &recovered["without_recovery"];
    let after = &recovered["estimator"]["stationary"];
    assert!(
        noisy(after) > 1.1 * noisy(&before["stationary"]),
        "{before}"
    );
    let alpha = |of: &serde_json::Value| of["margins"]["inputs"]["disk"]["alpha"].as_f64().unwrap();
    assert!(alpha(&recovered) >= alpha(before));
    // Noise alone drives the paper's robot out of the law's range.
    bench.put(
        "handstand.toml",
        include_str!("../../models/handstand.toml"),
    );
    let wild = bench.run("gains handstand.toml --q 100 --lqg --position-step 0.5 --gyro-step 100");
    assert_eq!(wild.code, Some(1), "{wild:?}");
    assert!(
        wild.stdout
            .contains("NOT linear: noise alone moves q2 by 4.91 rad"),
        "{wild:?}"
    );
    assert_eq!(recovered["estimator"]["recovery"], 0.1);
    assert_eq!(bench.run("gains free.toml --recovery 0.1").code, Some(2));
    let verification = |line: &str| bench.run(line).json()["verification"].clone();
    let exact = verification("gains free.toml --json");
    let stepped = verification("gains free.toml --json --position-step 0.02 --speeds difference");
    assert_eq!(exact["differences"], false);
    assert_eq!(stepped["differences"], true);
    let cycle = |of: &serde_json::Value| of["near"]["limit_cycle_rad"].as_f64().unwrap_or(9.0);
    assert!(cycle(&stepped) > 10.0 * cycle(&exact), "{stepped}");
}

/// Integral action is designed, verified and exported; what has no place for its sums refuses it.
#[test]
fn integral_action_reaches_every_file_that_can_hold_it() {
    let bench = bench();
    let told =
        "gains free.toml --integral 50 --c law.h --rust law.rs --state-space law.json --json";
    let data = bench.run(told).json();
    assert_eq!(data["states"][2]["name"], "int_q1", "{data}");
    assert_eq!(data["k"][0].as_array().unwrap().len(), 3);
    assert_eq!(data["integral"]["weights"][0], 50.0);
    assert_eq!(data["fixed"]["sums"]["first_state"], 3);
    assert_eq!(data["verification"]["stabilised"], true);
    assert_eq!(data["verification"]["law"], "fixed_point");
    assert!(data["margins"]["inputs"]["common"]["delay_s"].as_f64() > Some(0.0));
    assert!(
        data["stiffness"]["lean_per_torque"][0][0]
            .as_f64()
            .unwrap()
            .abs()
            < 1e-9
    );
    assert!(bench.get("law.h").contains("gains_integrate"));
    assert!(bench.get("law.rs").contains("pub fn integrate"));

    for (line, code, said) in [
        (
            "gains free.toml --integral 0",
            2,
            "the weight of integral 1 is 0",
        ),
        (
            "gains free.toml --integral 1 --continuous",
            2,
            "--continuous",
        ),
        ("gains free.toml --integral 1,2", 2, "1 are needed"),
        ("controllers free.toml --plan law.json", 3, "sums of angles"),
        (
            "deploy free.toml --integral 1 --law state --dry-run",
            2,
            "no place for the sums",
        ),
        (
            "deploy free.toml --integral 1 --dry-run",
            2,
            "--law observer",
        ),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(code), "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
    }
}

/// Gains and weights of one's own go into every study.
#[test]
fn a_plan_is_a_controller() {
    let bench = bench();
    bench.put(
        "plan.json",
        bench.run("gains free.toml --q 5,1 --json").stdout,
    );
    let told = "controllers free.toml --plan plan.json --condition ideal --robots 10 \
                --region-robots 0 --json";
    let given = bench.run(told).json();
    assert_eq!(given[0]["controller"], "plan", "{given}");
    let told = told.replace("--plan plan.json", "--controller dlqr --q 5,1");
    let weighed = bench.run(&told).json();
    for key in ["stabilised", "rms_angle_rad", "rms_torque_nm"] {
        let of = |trials: &serde_json::Value| trials[0][key].as_f64().unwrap();
        assert!(
            (of(&given) - of(&weighed)).abs() < 1e-9,
            "{given} {weighed}"
        );
    }
    let late = bench.run("delays free.toml --plan plan.json --robots 0 --ts 0.02");
    assert_eq!(late.code, Some(3), "{late:?}");
    assert!(late.stderr.contains("every 0.01 s"), "{}", late.stderr);
}

#[test]
fn a_page_shows_what_was_verified() {
    let bench = bench();
    let ran = bench.run("gains free.toml --report page.html");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let page = std::fs::read_to_string(bench.path("page.html")).unwrap();
    for section in [
        "verdict",
        "responses",
        "margins",
        "poles",
        "region",
        "design",
    ] {
        assert!(
            page.contains(&format!("section id=\"{section}\"")),
            "{section}"
        );
    }
    // A pendulum of one joint: 25 starts on a line.
    assert_eq!(page.matches("<circle").count() - 4, 25);
}

#[test]
fn a_region_that_the_search_ends_in_is_a_lower_bound() {
    let bench = bench();
    let free = bench.run("gains free.toml");
    let said = "Largest cube of starts of which 95 % are stabilised: at least 16.00 deg.";
    assert!(free.stdout.contains(said), "{}", free.stdout);
    let stuck = bench.run("gains stuck.toml");
    for said in [
        "95 % are stabilised: within 11.",
        "leaves out: at least 16.00 deg.",
        "region by coulomb at joint 1: without it at least 16.00 deg",
    ] {
        assert!(stuck.stdout.contains(said), "{said}: {}", stuck.stdout);
    }
    let verification = &bench.run("gains stuck.toml --json").json()["verification"];
    assert_eq!(verification["region_open"], false);
    assert_eq!(verification["region_as_designed_open"], true);
    assert_eq!(verification["without"][0]["region_open"], true);
}
