//! `handstand --help`: the commands by the people who need them.

#[cfg(feature = "robot")]
use super::gains::GainsArgs;
#[cfg(feature = "robot")]
use clap::Args as _;
use clap::Command;
use std::fmt::Write as _;

/// What people do, and the commands for it in the order in which they are used.
const GROUPS: [(&str, &[&str]); 5] = [
    (
        "Measure",
        &[
            "excite", "init", "log", "compare", "diagnose", "discover", "next", "add", "fit",
            "drift", "effects", "import", "model", "view", "identify", "map",
        ],
    ),
    (
        "Control",
        &["gains", "study", "controllers", "delays", "robust", "paper"],
    ),
    (
        "Robot",
        &[
            "bus", "record", "replay", "balance", "latency", "flash", "deploy", "virtual",
        ],
    ),
    ("Learn", &["lab", "demo", "challenge"]),
    ("Help", &["doctor", "completions", "man"]),
];

#[cfg(feature = "robot")]
/// A command that deploys, the options apart that only gains on plain states have.
fn parted(command: Command) -> Command {
    let gains = GainsArgs::augment_args(Command::new("gains"));
    let shared = ["model", "force"];
    let own =
        |id: &str| !shared.contains(&id) && gains.get_arguments().any(|arg| *arg.get_id() == *id);
    command.mut_args(|arg| {
        if own(arg.get_id().as_str()) {
            arg.help_heading("With --law state alone")
        } else {
            arg
        }
    })
}

/// The command line with its commands grouped in the help.
pub fn grouped(command: Command) -> Command {
    #[cfg(feature = "robot")]
    let command = command
        .mut_subcommand("deploy", parted)
        .mut_subcommand("gains", |gains| gains.mut_subcommand("deploy", parted));
    let (header, literal) = {
        let styles = command.get_styles();
        (*styles.get_header(), *styles.get_literal())
    };
    let names = GROUPS.iter().flat_map(|(_, names)| names.iter());
    let width = names.map(|name| name.len()).max().unwrap_or_default();
    let mut text = String::new();
    for (title, names) in GROUPS {
        let _ = writeln!(text, "{header}{title}:{header:#}");
        for name in names {
            // A build may leave a command out.
            let Some(command) = command.find_subcommand(name) else {
                continue;
            };
            let about = command
                .get_about()
                .map(ToString::to_string)
                .unwrap_or_default();
            let _ = writeln!(text, "  {literal}{name:<width$}{literal:#}  {about}");
        }
        text.push('\n');
    }
    let options = format!("{header}Options:{header:#}");
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{text}{options}\n{{options}}{{after-help}}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory as _, FromArgMatches as _};

    #[test]
    fn every_command_has_its_place() {
        let command = super::super::Cli::command();
        let mut there: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        let mut listed: Vec<&str> = GROUPS
            .iter()
            .flat_map(|(_, names)| names.to_vec())
            .collect();
        there.sort_unstable();
        listed.sort_unstable();
        assert_eq!(there, listed);
    }

    /// What the help lists as for plain states alone is what `--law observer` refuses.
    #[test]
    fn options_for_plain_states_are_refused_by_the_observer() {
        let gains = GainsArgs::augment_args(Command::new("gains"));
        let with_lqg = ["gyro_step", "process", "recovery"];
        for arg in gains.get_arguments() {
            let id = arg.get_id().as_str();
            if ["model", "force"].contains(&id) {
                continue;
            }
            let option = format!("--{}", arg.get_long().expect("an option"));
            let mut line = vec!["gains", "a.toml", option.as_str()];
            if arg.get_action().takes_values() {
                line.push(value_of(id));
            }
            if with_lqg.contains(&id) {
                line.push("--lqg");
            }
            if id == "r" {
                line.extend(["--q", "1"]);
            }
            let command = GainsArgs::augment_args(Command::new("gains"));
            let parsed = command.try_get_matches_from(&line);
            let parsed = parsed.unwrap_or_else(|error| panic!("{line:?}: {error}"));
            let args = GainsArgs::from_arg_matches(&parsed).expect("arguments");
            assert!(args.for_plain_states().is_some(), "{option}");
        }
    }

    /// A value that is not the default, of an option of `gains`.
    fn value_of(id: &str) -> &'static str {
        match id {
            "ts" | "delay" => "0.02",
            "pose" => "0.1",
            "speeds" => "difference",
            "without" => "coulomb",
            "rust" => "a.rs",
            "c" => "a.h",
            "csv" => "a.csv",
            "state_space" => "a.json",
            "report" => "a.html",
            "name" => "arm",
            _ => "0.5",
        }
    }
}
