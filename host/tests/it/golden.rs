//! What the program says, word for word.
//!
//! `INSTA_UPDATE=always cargo test --test it golden` rewrites the transcripts,
//! `tests/data/NAME.snap`; read their difference before keeping it.

use crate::common::Bench;

/// Says what the command lines say and compares it with the transcript of this name.
fn golden(bench: &Bench, name: &str, lines: &[&str]) {
    let mut said = String::new();
    for line in lines {
        let ran = bench.run(line);
        said += &format!("$ handstand {line}\n{}{}", ran.stdout, ran.stderr);
        said += &format!("(exit code {})\n\n", ran.code.unwrap());
    }
    // Windows writes the program's name with its ending.
    let said = said.replace("handstand.exe", "handstand");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../data");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, said));
}

/// A folder with the fixtures.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.put("arm.csv", include_str!("../data/arm.csv"));
    bench.put("arm.toml", include_str!("../data/arm.toml"));
    bench
}

#[test]
fn help() {
    golden(
        &bench(),
        "help",
        &["", "--help", "compare --help", "diagnose --help"],
    );
}

#[test]
fn bus() {
    golden(
        &bench(),
        "bus",
        &[
            "bus --help",
            "bus scan --port sim:ids=1-4,dead=2 --ids 1-4",
            "bus read 3 id return-delay-time present_position --port sim",
            "bus write 3 led 1 --port sim",
            "bus setup --port sim:ids=1-2 --ids 1-2",
            "bus doctor --port sim:ids=1-4,delay=0,dead=2,hot=3 --ids 1-4",
            "bus doctor --port sim:ids=1-4,delay=0,baud=34 --ids 1-4",
            "bus doctor --bring-up --yes --ids 1 --port sim-cm5:delay=0",
            "bus doctor --bring-up --ids 1 --port sim-cm5:delay=0,supply=8 --json",
            "bus log --port sim-cm5:delay=0",
            "bus log --port sim-cm5:delay=0 --json",
            "latency --port sim:ids=1-18,delay=0",
            "latency --port sim-cm5:ids=1-18,delay=0 --stream",
            "latency --port sim-cm5:ids=1-18",
        ],
    );
}

#[test]
fn servos() {
    golden(
        &bench(),
        "servos",
        &[
            "bus scan --port sim:model=XL330-M288,ids=1-3 --ids 1-4",
            "bus read 2 operating-mode current-limit bus-watchdog present-position --port sim:model=XM430-W350",
            "bus write 2 profile_velocity 100 --port sim:model=XL330-M288",
            "bus doctor --port sim:model=XL330-M288,ids=1-3,delay=0,overload=2 --ids 1-3",
            "bus reboot 2 --port sim:model=XL330-M288,ids=1-3,overload=2",
            "bus monitor --ids 1-2 --rounds 1 --port sim:model=XL330-M288,ids=1-3",
            "latency --port sim:model=XL330-M288,delay=0,turnaround=0,baud=3 --baud 1000000",
            "latency --port sim:model=XL330-M288,delay=0,turnaround=0,baud=6 --baud 4000000",
            "latency --port sim:model=XL330-M288,delay=0,firmware=45,baud=6 --baud 4000000",
            "latency --port sim:model=XL330-M288,delay=250,firmware=45",
        ],
    );
}

#[test]
fn effects() {
    golden(
        &bench(),
        "effects",
        &[
            "effects",
            "effects coulomb",
            "effects damping",
            "effects frction",
        ],
    );
}

#[test]
fn controllers() {
    golden(
        &bench(),
        "controllers",
        &[
            "controllers",
            "controllers arm.toml --controller pid",
            "controllers arm.toml --condition rain",
            "controllers arm.toml --seconds 1",
            "controllers arm.toml",
            "robust arm.toml --masses 100",
        ],
    );
}

#[test]
fn log_check() {
    golden(
        &bench(),
        "log_check",
        &[
            "log check arm.toml arm.csv",
            "log check arm.toml arm.csv:0-40 arm.csv:41-99 --json",
        ],
    );
}

#[test]
fn compare() {
    let bench = bench();
    let calmed = include_str!("../data/arm.toml")
        .replace("coefficient_nm_s_rad = 0.0", "coefficient_nm_s_rad = 0.001");
    bench.put("calmed.toml", calmed);
    golden(
        &bench,
        "compare",
        &[
            "compare arm.toml arm.csv",
            "compare arm.toml arm.csv --model calmed.toml",
        ],
    );
}

#[test]
fn next() {
    let bench = bench();
    let driven = include_str!("../data/arm.toml")
        .replace("\"passive\"", "\"duty\"\nstall_torque_nm = 1.0")
        + "input = { column = \"duty\", unit = \"1\" }\n";
    bench.put("driven.toml", driven);
    let rows = include_str!("../data/arm.csv").lines();
    let with_input = rows.enumerate().map(|(k, row)| match k {
        0 => format!("{row},duty\n"),
        _ => format!("{row},0\n"),
    });
    bench.put("driven.csv", with_input.collect::<String>());
    golden(
        &bench,
        "next",
        &[
            "next --help",
            "next driven.toml driven.csv --value link1.mass_kg -o next.csv",
            "next driven.toml driven.csv --value link1.mass_kg -o next.csv",
            "next driven.toml driven.csv --value link9.mass_kg",
            "next driven.toml driven.csv --value link1.mass_kg --angles 1..-1",
            "next driven.toml driven.csv --value link1.mass_kg --speed 0.01",
            "next arm.toml arm.csv --value link1.mass_kg",
        ],
    );
}

#[test]
fn paper() {
    golden(&bench(), "paper", &["paper"]);
}

#[test]
fn refusals() {
    let bench = bench();
    let (model, log) = (
        include_str!("../data/arm.toml"),
        include_str!("../data/arm.csv"),
    );
    bench.put("unknown_key.toml", model.replacen("mass_kg", "mas_kg", 1));
    bench.put("missing_column.csv", log.replacen("angle_rad", "angle", 1));
    bench.put(
        "infinite.csv",
        log.replacen("\n0.04,", "\n0.04,inf\n0.05,", 1),
    );
    bench.put("backwards.csv", log.replacen("\n0.04,", "\n0.01,", 1));
    golden(
        &bench,
        "refusals",
        &[
            "compare unknown_key.toml arm.csv",
            "compare arm.toml missing_column.csv",
            "compare arm.toml infinite.csv",
            "compare arm.toml backwards.csv",
            "compare arm.toml arm.csv:9-3",
            "effects colomb",
        ],
    );
}

#[test]
fn gains_in_space() {
    let bench = Bench::new();
    bench.put("pendulum.urdf", include_str!("../data/pendulum.urdf"));
    bench.put("pendulum.toml", include_str!("../data/pendulum.toml"));
    golden(
        &bench,
        "gains_in_space",
        &[
            "gains pendulum.toml --pose swing=3 --balance --c gains.h",
            "gains pendulum.toml --pose swing=3",
            "gains pendulum.toml --pose sing=3",
            "gains pendulum.toml --pose turn=3",
            "gains pendulum.toml --pose 3.1415926",
            "gains pendulum.toml --pose upright",
            "gains pendulum.toml --pose swing",
            "controllers pendulum.toml",
            "deploy pendulum.toml --dry-run",
        ],
    );
}

#[test]
fn gains() {
    let bench = bench();
    bench.put(
        "handstand.toml",
        include_str!("../../models/handstand.toml"),
    );
    golden(
        &bench,
        "gains",
        &[
            "gains handstand.toml",
            "gains handstand.toml --continuous --q 1",
            "gains handstand.toml --delay 0.013 --lqg --limit 2",
        ],
    );
}
