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
    assert_eq!(stuck.code, Some(0), "{stuck:?}");
    for said in [
        "within 0.5 deg: it stays, but without control it stays, too.",
        "With all gains at zero it stays from 40 of the same 40 starts",
    ] {
        assert!(stuck.stdout.contains(said), "{said}: {}", stuck.stdout);
    }
    let verification = &bench.run("gains stuck.toml --json").json()["verification"];
    assert_eq!(verification["stays_uncontrolled"], true);
    assert_eq!(verification["uncontrolled"]["stabilised"], 40);

    let free = bench.run("gains free.toml");
    assert!(free.stdout.contains("0.5 deg: stabilised."), "{free:?}");
    assert!(!free.stdout.contains("all gains at zero"), "{free:?}");
    let verification = &bench.run("gains free.toml --json").json()["verification"];
    assert_eq!(verification["stays_uncontrolled"], false);
}

#[test]
fn a_region_that_the_search_ends_in_is_a_lower_bound() {
    let bench = bench();
    let free = bench.run("gains free.toml");
    let said = "Largest cube of starts of which 95 % are stabilised: at least 16.0 deg.";
    assert!(free.stdout.contains(said), "{}", free.stdout);
    let stuck = bench.run("gains stuck.toml");
    for said in [
        "95 % are stabilised: within 11.",
        "leaves out: at least 16.0 deg.",
        "coulomb at joint 1: without it at least 16.0 deg.",
    ] {
        assert!(stuck.stdout.contains(said), "{said}: {}", stuck.stdout);
    }
    let verification = &bench.run("gains stuck.toml --json").json()["verification"];
    assert_eq!(verification["region_open"], false);
    assert_eq!(verification["region_as_designed_open"], true);
    assert_eq!(verification["without"][0]["region_open"], true);
}
