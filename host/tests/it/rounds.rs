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
