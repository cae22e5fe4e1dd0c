//! `deploy`: gains onto a virtual CM-5, and back.

#[allow(dead_code)] // each test file needs a part of it
mod common;

use common::Bench;

#[test]
fn gains_are_uploaded_read_back_and_replayed() {
    let bench = Bench::new();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");
    let ran = bench.run(&format!(
        "deploy {model} --port sim-cm5 --states 20000 --rust gains.rs --tap bytes.txt --json"
    ));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(
        (&data["uploaded"], &data["bytes"]),
        (&true.into(), &57.into())
    );
    // The very fingerprint that the generated file carries.
    let fingerprint = data["fingerprint"].as_str().unwrap();
    assert!(
        bench.get("gains.rs").to_uppercase().contains(fingerprint),
        "{fingerprint}"
    );
    // Another design is another table.
    let other = bench.run(&format!(
        "deploy {model} --q 1 --dry-run --states 100 --json"
    ));
    assert_ne!(
        other.json()["fingerprint"],
        data["fingerprint"],
        "{other:?}"
    );
    // A CM-5 that is not there, and a model the firmware has no law for.
    let absent = bench.run(&format!("deploy {model} --port sim --states 10"));
    assert_eq!(absent.code, Some(4), "{absent:?}");
    assert!(
        absent.stderr.contains("no Handstand firmware answers"),
        "{absent:?}"
    );
    let small = bench.run(&format!(
        "deploy {} --port sim-cm5",
        concat!(env!("CARGO_MANIFEST_DIR"), "/models/bench_arm.toml")
    ));
    assert_eq!(small.code, Some(3), "{small:?}");
}
