//! Effects by the names that people use, and where to begin.

use crate::common::Bench;

#[test]
fn alone_the_program_says_where_to_begin() {
    let bench = Bench::new();
    let ran = bench.run("");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert!(
        ran.stdout
            .starts_with("Why does my model not match my log?"),
        "{ran:?}"
    );
    for command in ["demo", "lab", "init", "diagnose", "help"] {
        assert!(
            ran.stdout.contains(&format!("  handstand {command}")),
            "{command}: {ran:?}"
        );
    }
    assert!(ran.stdout.lines().count() <= 24, "{ran:?}");
    let begin = bench.run("--json").json();
    assert_eq!(begin["begin"][0]["command"], "handstand demo");
}

#[test]
fn a_name_that_people_use_explains_the_effect() {
    let bench = Bench::new();
    for (name, id) in [
        ("stiction", "stribeck"),
        ("BackEMF", "speed_limit"),
        ("drag", "air_drag"),
        ("deadband", "dead_zone"),
        ("ripple", "cogging"),
    ] {
        let ran = bench.run(&format!("effects {name} --json"));
        assert_eq!(ran.code, Some(0), "{name}: {ran:?}");
        assert_eq!(ran.json()["id"], id, "{name}");
    }
    for (name, ids) in [
        ("play", &["gear_backlash", "backlash"][..]),
        (
            "friction",
            &["coulomb", "stribeck", "viscous", "load_friction"],
        ),
        ("damping", &["viscous", "air_drag"]),
        // No effect is called so; titles and aliases speak of it.
        ("gyro", &["rate_bias", "rate_scale", "rate_lag"]),
    ] {
        let ran = bench.run(&format!("effects {name}"));
        assert_eq!(ran.code, Some(0), "{name}: {ran:?}");
        for id in ids {
            let lines = ran.stdout.lines();
            let lines = lines.filter(|line| line.split_whitespace().next() == Some(id));
            assert_eq!(lines.count(), 1, "{name}: {id}: {ran:?}");
        }
    }
    let nonsense = bench.run("effects teleportation");
    assert_eq!(nonsense.code, Some(2), "{nonsense:?}");
    assert!(
        nonsense.stderr.contains("there is no effect"),
        "{nonsense:?}"
    );
}

#[test]
fn add_takes_a_name_of_one_effect_and_refuses_a_word_of_several_with_their_list() {
    let bench = Bench::new();
    let ran = bench.run("add model.toml friction --fit a.csv -o new.toml");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    for said in [
        "`friction` may be any of",
        "coulomb ",
        "viscous ",
        "Coulomb friction",
    ] {
        assert!(ran.stderr.contains(said), "{said}: {ran:?}");
    }
    let ran = bench.run("add model.toml dashpot@1 --fit a.csv -o new.toml --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.json()["effects"][0], "viscous@1");
    assert!(bench.get("new.toml").contains("kind = \"viscous\""));
    // So does what an effect is left out by.
    let ran = bench.run("diagnose model.toml a.csv --without friction");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("stribeck"), "{ran:?}");
}

#[test]
fn a_model_file_is_told_the_kind_that_it_means() {
    let bench = Bench::new();
    let model = bench.get("model.toml");
    for (kind, said) in [
        ("stiction", "write `stribeck`"),
        ("play", "write `gear_backlash` or `backlash`"),
        ("colomb", "did you mean `coulomb`?"),
    ] {
        let text = format!("{model}\n[[effect]]\nkind = \"{kind}\"\njoint = 1\n");
        bench.put("named.toml", text);
        let ran = bench.run("compare named.toml a.csv");
        assert_eq!(ran.code, Some(3), "{kind}: {ran:?}");
        assert!(ran.stderr.contains("named.toml:"), "{kind}: {ran:?}");
        assert!(ran.stderr.contains(said), "{kind}: {ran:?}");
    }
    let ran = bench.run("fit model.toml a.csv --free stiction@1.excess_nm -o new.toml");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("`stribeck`"), "{ran:?}");
}
