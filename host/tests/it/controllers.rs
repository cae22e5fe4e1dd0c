//! `handstand controllers`, `delays` and `robust` seen from outside.

use crate::common::Bench;

fn bench() -> Bench {
    let bench = Bench::new();
    bench.put(
        "handstand.toml",
        include_str!("../../models/handstand.toml"),
    );
    bench
}

#[test]
fn the_best_controller_holds_what_the_paper_s_does_not() {
    let bench = bench();
    let line = "controllers handstand.toml --condition all --controller dlqr --controller best --robots 100 \
                --region-robots 20 --csv held.csv --plot held.svg";
    let ran = bench.run(&format!("{line} --json"));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    let held = |row: usize| data[row]["stabilised"].as_f64().unwrap();
    assert_eq!(data[0]["controller"], "dlqr");
    assert!(held(0) < 0.5 && held(1) >= 0.9, "{data}");
    assert_eq!(data[0]["region_rad"], 0.0);
    assert!(
        data[1]["region_rad"].as_f64().unwrap() > 1f64.to_radians(),
        "{data}"
    );
    let (csv, svg) = (bench.get("held.csv"), bench.get("held.svg"));
    assert_eq!(csv.lines().count(), 3, "{csv}");
    assert!(
        svg.starts_with("<svg") && svg.contains("all at once"),
        "{svg}"
    );

    let refused = bench.run(line);
    assert_eq!(refused.code, Some(2), "{refused:?}");
    // The same bytes whoever does the work.
    let again = bench.run(&format!("{line} --json --force"));
    assert_eq!(again.stdout, ran.stdout);

    let none = bench.run("controllers handstand.toml --condition all --controller dlqr --robots 20 --region-robots 0");
    assert_eq!(none.code, Some(1), "{none:?}");
}

#[test]
fn wrong_masses_fell_the_paper_s_gains() {
    let ran = bench().run("robust handstand.toml --draws 400 --seed 3 --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    let lost: Vec<f64> = (0..3)
        .map(|row| data[row]["unstable"].as_f64().unwrap())
        .collect();
    assert!(
        (0.18..0.30).contains(&lost[0]) && (0.11..0.23).contains(&lost[1]),
        "{lost:?}"
    );
    assert!(lost[2] <= 0.02, "{lost:?}");
    assert!(data[2]["largest_error"].as_f64().unwrap() > 0.15, "{data}");
}

/// The gains of `gains --json` as they are: told nothing of the drives' delay they let every robot
/// fall, told of it they are the DLQR of the table.
#[test]
fn robust_has_the_model_s_delay_and_takes_gains_of_a_file() {
    let bench = bench();
    let late = "\n[[effect]]\nkind = \"delay\"\njoint = \"all\"\ndelay_s = 0.014\n";
    bench.put("late.toml", bench.get("handstand.toml") + late);
    bench.put(
        "unaware.json",
        bench.run("gains late.toml --delay 0 --json").stdout,
    );
    bench.put(
        "aware.json",
        bench.run("gains late.toml --q 100 --json").stdout,
    );
    let judged = |plan: &str| {
        bench.run(&format!(
            "robust late.toml --plan {plan} --draws 100 --json"
        ))
    };
    let unaware = judged("unaware.json");
    assert_eq!(unaware.code, Some(1), "{unaware:?}");
    assert_eq!(unaware.json()[0]["unstable"], 1.0, "{unaware:?}");
    let aware = judged("aware.json").json();
    assert_eq!(aware[0]["unstable"], aware[1]["unstable"]);
    assert!(aware[0]["unstable"].as_f64().unwrap() < 1.0, "{aware}");
    assert!(aware[3]["k"][0].as_array().unwrap().len() > 6, "{aware}");
    let arm = r#"{"u0": [0], "x0": [0, 0], "k": [[1, 2]], "sampled": null}"#;
    bench.put("arm.json", arm);
    let slower = bench.run("gains late.toml --ts 0.02 --json").stdout;
    bench.put("slower.json", slower);
    for (plan, said) in [("arm.json", "`u0` has 1 values"), ("slower.json", "0.02 s")] {
        let other = judged(plan);
        assert_eq!(other.code, Some(3), "{other:?}");
        assert!(other.stderr.contains(said), "{other:?}");
    }
}

#[test]
fn robust_judges_the_regulator_of_one_s_weights() {
    let bench = bench();
    let judged = |weights: &str| {
        bench.run(&format!(
            "robust handstand.toml --draws 200 --json {weights}"
        ))
    };
    // The paper's robot: 20 % of its robots fall with the paper's weights, none with these.
    let own = judged("--q 1,1,1,0.01,0.01,0.01");
    assert_eq!(own.code, Some(0), "{own:?}");
    assert_eq!(own.json()[0]["unstable"], 0.0, "{own:?}");
    assert_eq!(own.json().as_array().unwrap().len(), 4);
    let paper = judged("--q 100 --r 1");
    assert_eq!(paper.code, Some(1), "{paper:?}");
    assert_eq!(paper.json()[0]["unstable"], paper.json()[1]["unstable"]);
    for (weights, said) in [("--q 1,2", "Q has 2 values"), ("--r 2", "--q <WEIGHT>")] {
        let refused = judged(weights);
        assert_eq!(refused.code, Some(2), "{refused:?}");
        assert!(refused.stderr.contains(said), "{}", refused.stderr);
    }
}

#[test]
fn one_sample_of_delay_is_too_much_for_the_paper_s_gains() {
    let ran = bench().run(
        "delays handstand.toml --controller dlqr --controller lqg --robots 0 --until-ms 40 --json",
    );
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    let longest = |row: usize, told: &str| data["controllers"][row][told]["delay_s"].as_f64();
    assert_eq!(longest(0, "uncompensated"), Some(0.0085));
    assert_eq!(longest(1, "compensated"), Some(0.04));
    assert!(
        longest(1, "compensated_one_sample").unwrap() > 0.01,
        "{data}"
    );
    assert_eq!(data["paths"].as_array().unwrap().len(), 18);
}

/// A delay that `best` does not know: its filter's first gains do not fell it, nor ask for much.
#[test]
fn the_best_controller_bears_a_delay_that_it_does_not_know() {
    let line = "study sweep delay --controller best --levels 0,1,2,5,8 --runs 60 --json";
    let sweep = Bench::new().run(line).json();
    let levels = sweep[0]["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 5);
    for level in levels {
        let figures = &level["figures"];
        assert_eq!(figures["stabilised"], 60, "{level}");
        assert!(figures["rms_torque_nm"].as_f64().unwrap() < 0.15, "{level}");
    }
}
