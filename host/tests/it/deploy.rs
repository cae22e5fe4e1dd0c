//! `deploy`: gains onto a virtual CM-5, and back.

use crate::common::Bench;
use handstand_shared::image::mark;

#[test]
fn gains_are_uploaded_read_back_verified_and_replayed() {
    let bench = Bench::new();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");
    let ran = bench.run(&format!(
        "gains deploy {model} --law state --unstable --port sim-cm5 --states 20000 \
         --rust gains.rs --header plan.rs --tap bytes.txt --json"
    ));
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(
        (&data["uploaded"], &data["law"]),
        (&true.into(), &"state".into())
    );
    // The very fingerprint that the generated file carries.
    let fingerprint = data["fingerprint"].as_str().unwrap();
    let (plan, table) = (bench.get("plan.rs"), bench.get("gains.rs"));
    assert!(plan.contains(fingerprint), "{fingerprint}: {plan}");
    assert!(table.contains("pub const K"), "{table}");
    let steps: Vec<&str> = (data["steps"].as_array().unwrap().iter())
        .map(|step| step.as_str().unwrap().split(':').next().unwrap())
        .collect();
    assert_eq!(
        steps,
        [
            "designed",
            "wrote plan.rs",
            "uploaded",
            "read back",
            "replayed"
        ]
    );
    // What no register takes, and what the firmware prescribes.
    for (option, code, said) in [
        ("--dead-zone 1.5", 2, "--dead-zone"),
        ("--slew 0", 2, "--slew"),
        ("--fallen 9", 2, "give 0 to 6.55"),
        ("--gyro-per-code 1000", 2, "give -2.05 to 2.05"),
        ("--joints 1+2", 2, "--joints names 1"),
        ("--joints 300/11", 2, "--joints"),
        ("--q 10", 2, "--law state"),
        ("--law state --state-step 1,1,1,1,1,1", 2, "--state-step"),
        ("--law state --ts 0.02", 3, "ticks every 0.01 s"),
        ("--law state", 3, "it is unstable"),
        ("--supply 11.1", 2, "at which supply"),
        ("--drive-delay 2", 2, "--drive-delay"),
    ] {
        let ran = bench.run(&format!(
            "gains deploy {model} --dry-run --states 10 {option}"
        ));
        assert_eq!(ran.code, Some(code), "{option}: {ran:?}");
        assert!(ran.stderr.contains(said), "{option}: {ran:?}");
    }
    // Another design is another table.
    let other = bench.run(&format!(
        "deploy {model} --law state --unstable --q 1 --dry-run --states 100 --json"
    ));
    // It falls, as its radius says.
    assert_eq!(other.code, Some(1), "{other:?}");
    assert_eq!(other.json()["verdict"]["stood"], 0);
    assert!(other.json()["radius"].as_f64().unwrap() > 1.0);
    assert_ne!(
        other.json()["fingerprint"],
        data["fingerprint"],
        "{other:?}"
    );
    // The law that stands is the one that comes without asking.
    let standing = bench.run(&format!("gains deploy {model} --port sim-cm5 --json"));
    assert_eq!(standing.code, Some(0), "{standing:?}");
    let standing = standing.json();
    assert_eq!(
        (
            &standing["law"],
            &standing["way"],
            &standing["states_replayed"]
        ),
        (&"observer".into(), &"upload".into(), &1_000_000.into())
    );
    assert_ne!(standing["fingerprint"], data["fingerprint"]);
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

/// The build with the plan compiled in, and the boot loader: what runs afterwards is not there, and
/// missed.
#[cfg(unix)]
#[test]
fn a_plan_is_compiled_in_and_flashed() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = Bench::new();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");
    let none = bench.run(&format!(
        "gains deploy {model} --flash --port sim --states 10"
    ));
    assert_eq!(none.code, Some(2), "{none:?}");
    assert!(
        none.stderr.contains("no source of the firmware"),
        "{none:?}"
    );
    // A cargo that notes the plan it is given, and "builds" a whole program of next to nothing.
    std::fs::create_dir(bench.path("firmware")).unwrap();
    std::fs::create_dir(bench.path("tools")).unwrap();
    bench.put("firmware/Cargo.toml", "");
    let program = [0x0c, 0x94, 0x46, 0x00];
    bench.put("image.bin", [&program[..], &mark(&program)].concat());
    bench.put(
        "tools/cargo",
        "#!/bin/sh\ncp \"$5\" seen.rs\necho \"{\\\"bin\\\": \\\"$PWD/image.bin\\\"}\"\n",
    );
    let tool = bench.path("tools/cargo");
    std::fs::set_permissions(&tool, std::fs::Permissions::from_mode(0o755)).unwrap();
    let loader = crate::common::boot_loader::start(crate::common::boot_loader::Trouble::None);
    let line = format!(
        "gains deploy {model} --flash --port {} --wait 5 --states 10",
        loader.port
    );
    let ran = bench.run_with(
        &line,
        &[(
            "PATH",
            format!("{}:/usr/bin:/bin", bench.path("tools").display()),
        )],
    );
    let steps = ["sys", "flash", "app", "go"];
    let did = steps.map(|_| loader.did.recv().map(|(step, _)| step));
    assert_eq!(did, steps.map(|step| Ok(step.to_string())), "{ran:?}");
    assert!(bench.get("seen.rs").contains("// Fingerprint "), "{ran:?}");
    assert!(ran.stderr.contains("3. flashed"), "{ran:?}");
    assert_eq!(ran.code, Some(4), "no firmware runs on the loader: {ran:?}");
}
