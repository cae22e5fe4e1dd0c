//! An effect added to a model file, and what is not written.

use crate::common::Bench;

#[test]
fn an_effect_is_added_with_its_value_and_provenance() {
    let bench = Bench::new();
    let ran = bench.run("add model.toml viscous --fit a.csv --holdout b.csv -o new.toml --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["effects"][0], "viscous@1");
    let value = data["values"][0]["value"].as_f64().unwrap();
    assert!((value - 0.001).abs() < 2e-5, "{value}");
    let error = &data["error"];
    assert_eq!(error["held_out"], true);
    assert!(error["after_rad"].as_f64() < error["before_rad"].as_f64());
    let text = bench.get("new.toml");
    assert!(text.starts_with("# A pendulum.\n"), "{text}");
    for part in [
        "kind = \"viscous\"",
        "[effect.fitted]",
        "intervals",
        "name = \"a.csv\", sha256",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let again = bench.run("fit new.toml b.csv -o newer.toml");
    assert_eq!(again.code, Some(0), "{again:?}");
    assert!(
        again.stdout.contains("viscous@1.coefficient_nm_s_rad"),
        "{again:?}"
    );
}

/// The errors that a file tells are those of windows, which it tells too; whoever fits again tells
/// anew.
#[test]
fn the_windows_of_a_fit_are_written_with_its_errors() {
    let bench = Bench::new();
    let freed = bench.get("model.toml") + "\n[fit]\nfree = [\"link1.com_m\"]\n";
    bench.put("model.toml", freed);
    let horizons = |name: &str| -> Vec<String> {
        let text = bench.get(name);
        let lines = text.lines().filter(|line| line.starts_with("horizon_s"));
        lines.map(str::to_string).collect()
    };
    let (quarter, half) = ("horizon_s = 0.25", "horizon_s = 0.5");
    for (line, name, written) in [
        (
            "fit model.toml a.csv --horizon 0.25 -o one.toml",
            "one.toml",
            &[quarter][..],
        ),
        (
            "add one.toml viscous --fit a.csv --horizon 0.5 -o two.toml",
            "two.toml",
            &[half, half],
        ),
        (
            "fit two.toml a.csv --free link1.com_m -o three.toml",
            "three.toml",
            &[half],
        ),
        (
            "add one.toml viscous --fit a.csv -o four.toml",
            "four.toml",
            &[],
        ),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(0), "{ran:?}");
        assert_eq!(horizons(name), written, "{}", bench.get(name));
    }
    let read = bench.run("compare three.toml a.csv");
    assert_eq!(read.code, Some(0), "{read:?}");
}

#[test]
fn values_without_effect_are_refused_and_nothing_is_written() {
    let bench = Bench::new();
    // An arm that nobody moves shows no friction.
    let still: String = (0..100)
        .map(|k| format!("{:.2},0\n", f64::from(k) * 0.01))
        .collect();
    bench.put("still.csv", format!("time_s,angle_rad\n{still}"));
    let ran = bench.run("add model.toml air_drag --fit still.csv -o new.toml");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.stdout.contains("refused"), "{ran:?}");
    assert!(!bench.path("new.toml").exists());
}

/// What the model does not lack is fitted to nothing: the error is that of before.
#[test]
fn an_effect_that_gains_nothing_is_refused_and_nothing_is_written() {
    let bench = Bench::new();
    let first = bench.run("add model.toml viscous --fit a.csv --holdout b.csv -o first.toml");
    assert_eq!(first.code, Some(0), "{first:?}");
    for effect in ["sensor_lag", "air_drag"] {
        let line = format!("add first.toml {effect} --fit a.csv --holdout b.csv -o new.toml");
        let ran = bench.run(&line);
        assert_eq!(ran.code, Some(1), "{ran:?}");
        assert!(ran.stdout.contains("nothing is written"), "{ran:?}");
        assert!(!bench.path("new.toml").exists());
    }
}

#[test]
fn nothing_is_overwritten_unasked() {
    let bench = Bench::new();
    bench.put("kept.toml", "mine");
    let line = "add model.toml viscous --fit a.csv -o kept.toml";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("--force"), "{ran:?}");
    assert_eq!(bench.get("kept.toml"), "mine");
    assert_eq!(bench.run(&format!("{line} --force")).code, Some(0));
    assert_ne!(bench.get("kept.toml"), "mine");
}

/// What a diagnosis found is added from its file, from its values.
#[test]
fn a_diagnosis_is_added_from_its_file() {
    let bench = Bench::new();
    let found = bench.run("diagnose model.toml a.csv --holdout b.csv --json");
    bench.put("d.json", &found.stdout);
    let effect = &found.json()["effects"][0];
    let expected = effect["parameters"]["coefficient_nm_s_rad"]["value"].clone();
    let expected = expected.as_f64().unwrap();
    let line = "add model.toml --from d.json --fit a.csv --holdout b.csv";
    let ran = bench.run(&format!("{line} -o new.toml --json"));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.json()["effects"][0], "viscous@1");
    assert!(
        ran.stderr.contains("viscous@1: from the values of d.json"),
        "{ran:?}"
    );
    let value = ran.json()["values"][0]["value"].as_f64().unwrap();
    assert!((value / expected - 1.0).abs() < 1e-3, "{value} {expected}");
    // An effect that it does not hold, files that are none, and neither effect nor file.
    let other = line.replace("model.toml", "model.toml coulomb");
    let other = bench.run(&format!("{other} -o other.toml"));
    assert!(
        other.stderr.contains("d.json gives no values of coulomb@1"),
        "{other:?}"
    );
    bench.put("no.json", "{}");
    let line = line.replace("d.json", "no.json");
    let refused = bench.run(&format!("{line} -o no.toml"));
    assert_eq!(refused.code, Some(3), "{refused:?}");
    assert!(refused.stderr.contains("no diagnosis"), "{refused:?}");
    let usage = bench.run("add model.toml --fit a.csv -o no.toml");
    assert_eq!(usage.code, Some(2), "{usage:?}");
}
