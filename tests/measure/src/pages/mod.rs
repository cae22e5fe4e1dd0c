//! The pages of `docs/measured`: which renew in minutes, and one row of each that is measured
//! again.

mod sample_row;

use sample_row::row;
pub use sample_row::{Answer, Program, Programs, SampleRow};

/// One page.
#[derive(Debug)]
pub struct MeasuredPage {
    /// Its file, without the ending.
    pub name: &'static str,
    /// How it is renewed.
    pub cost: Cost,
    /// What of it is measured again.
    pub sample: Sample,
}

/// How a page is renewed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// In minutes, by the command that stands on the page.
    Cheap,
    /// As said here; by the command that stands on the page.
    Dear(&'static str),
    /// By a script of its own.
    Script(&'static str, &'static str),
}

/// What of a page is measured again.
#[derive(Debug)]
pub enum Sample {
    /// A row that takes seconds: the tests measure it.
    Seconds(SampleRow),
    /// A row that takes longer, as said here: `cargo xtask measured --rows` measures it.
    Longer(&'static str, SampleRow),
    /// No row, and why.
    Nothing(&'static str),
}

const fn page(name: &'static str, cost: Cost, sample: Sample) -> MeasuredPage {
    MeasuredPage { name, cost, sample }
}

/// All pages.
pub const PAGES: &[MeasuredPage] = &[
    page(
        "ablation",
        Cost::Dear("hours; a part of the search in some ten minutes"),
        Sample::Nothing("every row is of some sixty diagnoses, each done twice"),
    ),
    page(
        "bench-firmware",
        Cost::Dear("an hour; an ELF and simavr"),
        Sample::Nothing(
            "its rows are times of the firmware's image, which simavr runs for minutes",
        ),
    ),
    page(
        "bench-read",
        Cost::Cheap,
        Sample::Nothing("every row is a time on the clock and a peak of memory"),
    ),
    page(
        "bench-record",
        Cost::Dear("some 10 minutes"),
        Sample::Nothing("the clock decides when a recorder is killed, and so what is left"),
    ),
    page(
        "control",
        Cost::Script(
            "minutes, after `cargo build --release -p handstand`",
            "docs/measured/control.sh",
        ),
        Sample::Seconds(SampleRow {
            program: Program::Handstand,
            ..row(
                "--quiet gains robot.toml",
                "Limited, with these gains, limit cycle by coulomb at joint 2:",
            )
        }),
    ),
    page(
        "conventions",
        Cost::Dear("an hour, after 60 MB"),
        Sample::Nothing("its rows count the answers of all arms"),
    ),
    page(
        "detection",
        Cost::Dear("some two hours"),
        Sample::Longer(
            "a minute",
            row(
                "detection --seeds 1 --effects viscous",
                "viscous coefficient_nm_s_rad",
            ),
        ),
    ),
    page(
        "discover",
        Cost::Dear("half an hour"),
        Sample::Seconds(row(
            "discover --seed0 31 --laws cubic_drag --nothing 0",
            "cubic_drag 31",
        )),
    ),
    page(
        "first-hour",
        Cost::Dear("half an hour"),
        Sample::Seconds(row(
            "first-hour --program {handstand} --seed0 13 --seeds 1",
            "13 1 position coulomb",
        )),
    ),
    page(
        "hidden",
        Cost::Dear("hours"),
        Sample::Seconds(row(
            "hidden --families single --seeds 1 --seed0 50101 --effects direction_asymmetry",
            "single, seed 50101, direction_asymmetry@1:",
        )),
    ),
    page(
        "hidden-approximate",
        Cost::Dear("an hour or two"),
        Sample::Seconds(row(
            "hidden --families approximate --seeds 1 --seed0 12000 --effects torque_offset",
            "approximate, seed 12000, torque_offset@1:",
        )),
    ),
    page(
        "hidden-approximate-mujoco",
        Cost::Dear("hours; MuJoCo"),
        Sample::Longer(
            "a minute, after 60 MB of packages",
            row(
                "hidden --truth mujoco --families approximate --seeds 1 --effects coulomb",
                "coulomb approximate",
            ),
        ),
    ),
    page(
        "hidden-space",
        Cost::Dear("half an hour; MuJoCo"),
        Sample::Longer(
            "a minute or two, after 60 MB of packages",
            row(
                "hidden --truth mujoco --families space --seeds 1 --effects coulomb",
                "coulomb space",
            ),
        ),
    ),
    page(
        "hidden-chain",
        Cost::Dear("hours"),
        Sample::Longer(
            "a minute",
            row(
                "hidden --families hanging --seeds 1 --effects direction_asymmetry",
                "hanging, seed 1, direction_asymmetry@3:",
            ),
        ),
    ),
    page(
        "hidden-chain-mujoco",
        Cost::Dear("hours; MuJoCo"),
        Sample::Longer(
            "a minute, after 60 MB of packages",
            row(
                "hidden --truth mujoco --families hanging --seeds 1 --effects direction_asymmetry",
                "hanging, seed 1, direction_asymmetry@3:",
            ),
        ),
    ),
    page(
        "hidden-mujoco",
        Cost::Dear("hours; MuJoCo"),
        Sample::Longer(
            "seconds, after 60 MB of packages",
            row(
                "hidden --truth mujoco --families single --seeds 1 --effects direction_asymmetry",
                "single, seed 1, direction_asymmetry@1:",
            ),
        ),
    ),
    page(
        "hidden-robot",
        Cost::Dear("an hour or so"),
        Sample::Longer(
            "a minute or two",
            row(
                "hidden --truth robot --families robot --seeds 1 --seed0 6 --effects torque_scale",
                "robot, seed 6, torque_scale@3:",
            ),
        ),
    ),
    page(
        "lab",
        Cost::Cheap,
        Sample::Nothing("every row is a time on the clock"),
    ),
    page(
        "next",
        Cost::Dear("half an hour"),
        Sample::Seconds(row(
            "next --seeds 1 --effects direction_asymmetry",
            "direction_asymmetry 1",
        )),
    ),
    page(
        "peers",
        Cost::Dear("some 20 minutes; 600 MB of packages, and a machine without other work"),
        Sample::Nothing("its rows are times on the clock, or need the 600 MB of the peers"),
    ),
    page(
        "real",
        Cost::Dear("some 10 minutes; HANDSTAND_DATA"),
        Sample::Seconds(SampleRow {
            public_logs: true,
            ..row("real --only off", "HTD-45H, torque off")
        }),
    ),
    page(
        "refit",
        Cost::Dear("some 10 minutes"),
        Sample::Seconds(row(
            "refit --cases 120 --shard 111/120",
            "pendulum, air_drag, lasting noise and steps, seed 56 fit",
        )),
    ),
    page(
        "robot-demo",
        Cost::Dear("some 10 minutes"),
        Sample::Longer(
            "two minutes",
            row("robot-demo --seed 401 --seeds 1", "401 delay@all"),
        ),
    ),
    page(
        "spoiled",
        Cost::Dear("half an hour; HANDSTAND_DATA"),
        Sample::Seconds(SampleRow {
            public_logs: true,
            ..row("spoiled --only arm.csv --alarms 0 --simulated 0", "arm.csv")
        }),
    ),
    page(
        "verdicts",
        Cost::Cheap,
        Sample::Seconds(row(
            "verdicts --gains --robots 1",
            "viscous joint 3 coefficient_nm_s_rad 0.047547;",
        )),
    ),
    page(
        "within",
        Cost::Dear("two hours or so"),
        Sample::Nothing("the clock ends the search, and each row says how long it took"),
    ),
];

impl MeasuredPage {
    /// The row that is measured again, if there is one.
    pub fn row(&self) -> Option<&SampleRow> {
        match &self.sample {
            Sample::Seconds(row) | Sample::Longer(_, row) => Some(row),
            Sample::Nothing(_) => None,
        }
    }
}

/// The command that stands on a page of `docs/measured`, without `cargo xtask`.
///
/// # Errors
/// A page that names none, or one with quotes, which no one shell reads as another.
pub fn command(page: &str) -> Result<Vec<String>, String> {
    let mut lines = page.lines().skip_while(|line| *line != "```sh").skip(1);
    let typed = lines.next().unwrap_or_default();
    let words = typed.strip_prefix("cargo xtask ").ok_or(
        "the page names no command: write `cargo xtask ...` behind its first line ```sh"
            .to_string(),
    )?;
    if words.contains('"') {
        return Err(format!(
            "`{typed}` holds quotes: run it by hand, with --write"
        ));
    }
    Ok(words.split_whitespace().map(String::from).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pages_command_is_read_from_it() {
        let page = "# Peers\n\nMeasured by\n\n```sh\ncargo xtask peers --rounds 5\n```\n";
        assert_eq!(command(page).unwrap(), ["peers", "--rounds", "5"]);
        let bare = command("# Peers\n").unwrap_err();
        assert!(bare.contains("cargo xtask ..."), "{bare}");
        let quoted = command("```sh\ncargo xtask real --only \"MX 106\"\n```").unwrap_err();
        assert!(quoted.contains("by hand"), "{quoted}");
    }
}
