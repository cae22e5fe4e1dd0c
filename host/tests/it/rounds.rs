//! Comparing, diagnosing and scoring, seen from outside.

use crate::common::Bench;

#[test]
fn models_stand_side_by_side_and_the_page_is_not_overwritten() {
    let bench = Bench::new();
    let add = bench.run("add model.toml viscous --fit a.csv -o new.toml");
    assert_eq!(add.code, Some(0), "{add:?}");
    let line = "compare model.toml b.csv --model new.toml --report page.html --json";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    let rms = |model: usize| {
        data["comparisons"][model]["signals"][0]["rms_rad"]
            .as_f64()
            .unwrap()
    };
    assert!(rms(1) < 0.1 * rms(0), "{} {}", rms(0), rms(1));
    assert_eq!(data["provenance"]["logs"][0]["name"], "b.csv");
    assert!(bench.get("page.html").contains("</html>"));
    let again = bench.run(line);
    assert_eq!(again.code, Some(2), "{again:?}");
    assert!(again.stderr.contains("--force"), "{again:?}");
    let text = bench.run("compare model.toml b.csv --model new.toml");
    assert!(text.stdout.contains("new.toml"), "{text:?}");
}

#[test]
fn a_refused_log_makes_a_diagnosis_unfit() {
    let bench = Bench::new();
    bench.put(
        "bad.csv",
        bench.get("a.csv").replacen("0.03,", "0.03,nan", 1),
    );
    let ran = bench.run("diagnose model.toml bad.csv b.csv --json");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["verdict"], "unfit");
    assert!(
        data["summary"].to_string().contains("bad.csv:5:2"),
        "{data}"
    );
    let wrong = bench.run("diagnose model.toml a.csv --without coulom");
    assert_eq!(wrong.code, Some(2), "{wrong:?}");
    assert!(wrong.stderr.contains("did you mean `coulomb`"), "{wrong:?}");
}

#[test]
fn a_reversed_position_is_never_named() {
    let bench = Bench::new();
    let made = bench.run("challenge new --seed 5 --effect coulomb -o riddle");
    assert_eq!(made.code, Some(0), "{made:?}");
    let model = bench.get("riddle/nominal.toml");
    let reversed = model.replacen("position = { ", "position = { reversed = true, ", 1);
    assert_ne!(model, reversed);
    bench.put("reversed.toml", reversed);
    let ran = bench.run("diagnose reversed.toml riddle/a.csv riddle/b.csv --json");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["verdict"], "unfit");
    assert!(
        data["next"].to_string().contains("reversed.toml:"),
        "{data}"
    );
    let checked = bench
        .run("log check reversed.toml riddle/a.csv --json")
        .json();
    let first = &checked["findings"][0];
    assert_eq!(first["kind"], "sign");
    let share = |key: &str| first["proof"][key].as_f64().unwrap();
    assert!(
        share("after_share") < 0.8 * share("before_share"),
        "{first}"
    );
}

#[test]
fn a_law_of_the_users_is_diagnosed_and_added() {
    let bench = Bench::new();
    let law = "[[expression]]\nname = \"calm\"\ntorque = \"-c * w\"\n\
               parameter = [{ key = \"c\", unit = \"N m s/rad\", start = 1e-3, low = 0.0, \
               high = 1.0 }]\n\n[log]";
    bench.put(
        "law.toml",
        bench.get("model.toml").replacen("[log]", law, 1),
    );
    let ran = bench.run("diagnose law.toml a.csv b.csv --without viscous --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["effects"][0]["kind"], "calm", "{data}");
    let add = bench.run("add law.toml calm --fit a.csv --holdout b.csv -o new.toml");
    assert_eq!(add.code, Some(0), "{add:?}");
    let (with, without) = (
        "compare new.toml b.csv --json",
        "compare law.toml b.csv --json",
    );
    let rms = |line: &str| {
        let data = bench.run(line).json();
        data["comparisons"][0]["signals"][0]["rms_rad"]
            .as_f64()
            .unwrap()
    };
    assert!(rms(with) < 0.1 * rms(without));
    bench.put(
        "wrong.toml",
        bench.get("law.toml").replacen("-c * w", "-c * v", 1),
    );
    let wrong = bench.run("compare wrong.toml b.csv");
    assert_eq!(wrong.code, Some(3), "{wrong:?}");
    assert!(wrong.stderr.contains("wrong.toml:"), "{wrong:?}");
}

#[test]
fn a_model_is_exported_with_what_it_loses() {
    let bench = Bench::new();
    let ran = bench.run("model export model.toml --to mjcf -o model.xml");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(bench.get("model.xml").contains("<mujoco"));
    let again = bench.run("model export model.toml --to mjcf -o model.xml");
    assert_eq!(again.code, Some(2), "{again:?}");
    let urdf = bench.run("model export model.toml --to urdf --json").json();
    assert!(urdf["text"].as_str().unwrap().contains("<robot"), "{urdf}");
    assert_eq!(urdf["not_carried"][0]["part"], "gravity_m_s2");
}

#[test]
fn a_challenge_is_made_once_and_scored() {
    let bench = Bench::new();
    let line = "challenge new --seed 5 --effect delay -o riddle";
    assert_eq!(bench.run(line).code, Some(0));
    assert_eq!(bench.run(line).code, Some(2), "nothing is overwritten");
    let nothing = bench.run("challenge score riddle riddle/nominal.toml --json");
    assert_eq!(nothing.code, Some(1), "{nothing:?}");
    assert_eq!(nothing.json()["hidden"], "delay@1");
    let add =
        bench.run("add riddle/nominal.toml delay --fit riddle/a.csv riddle/b.csv -o mine.toml");
    assert_eq!(add.code, Some(0), "{add:?}");
    let scored = bench.run("challenge score riddle mine.toml --json");
    assert_eq!(scored.code, Some(0), "{scored:?}");
    assert_eq!(scored.json()["solved"], true);
    let unknown = bench.run("challenge new --seed 5 --effect delai -o other");
    assert_eq!(unknown.code, Some(2), "{unknown:?}");
}

#[test]
fn a_wrong_value_is_named_before_any_missing_effect() {
    let bench = Bench::new();
    let model = bench.get("model.toml").replace(
        "[log]",
        "[[effect]]\nkind = \"viscous\"\njoint = 1\ncoefficient_nm_s_rad = 0.00017\n\n[log]",
    );
    bench.put("sixth.toml", model);
    let ran = bench.run("diagnose sixth.toml a.csv --holdout b.csv --report page.html --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["verdict"], "wrong_value", "{data}");
    assert_eq!(data["effects"].as_array().map(Vec::len), Some(0));
    let wrong = &data["wrong_values"][0];
    assert_eq!(wrong["path"], "viscous@1.coefficient_nm_s_rad");
    assert_eq!(wrong["given"], 0.00017);
    assert!(
        (wrong["value"].as_f64().unwrap() / 0.001 - 1.0).abs() < 0.02,
        "{wrong}"
    );
    // The page shows what it would mend.
    let page = bench.get("page.html");
    assert!(page.contains("with another value of viscous friction at joint 1"));
    // What is printed to mend it does.
    let fit = data["next"][0]
        .as_str()
        .unwrap()
        .split_once("handstand ")
        .unwrap()
        .1;
    assert_eq!(bench.run(fit).code, Some(0), "{fit}");
    let mended = bench
        .run("diagnose better.toml a.csv --holdout b.csv --json")
        .json();
    assert_eq!(mended["verdict"], "nominal", "{mended}");
}

#[test]
fn an_effect_that_does_not_help_is_not_added() {
    let bench = Bench::new();
    assert_eq!(
        bench
            .run("add model.toml viscous --fit a.csv --holdout b.csv -o new.toml")
            .code,
        Some(0)
    );
    let ran = bench.run("add new.toml base_tilt --fit a.csv --holdout b.csv -o worse.toml");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.stdout.contains("refused"), "{ran:?}");
    assert!(!bench.path("worse.toml").exists());
}

#[test]
fn several_effects_are_added_at_once() {
    let bench = Bench::new();
    let line = "add model.toml viscous air_drag --fit a.csv -o both.toml --json";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(
        ran.json()["effects"],
        serde_json::json!(["viscous@1", "air_drag@1"])
    );
    let twice = bench.run("add model.toml viscous viscous@1 --fit a.csv -o twice.toml");
    assert_eq!(twice.code, Some(2), "{twice:?}");
}

#[test]
fn rows_that_are_fitted_cannot_be_held_out() {
    let bench = Bench::new();
    let ran = bench.run("diagnose model.toml a.csv:0-50 --holdout a.csv:50-90");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(
        ran.stderr.contains("shares rows with a.csv:0-50"),
        "{ran:?}"
    );
}
