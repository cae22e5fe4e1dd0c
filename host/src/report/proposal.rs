//! A proposed experiment as text.

use crate::diagnose::{Diagnosis, Verdict};
use crate::experiment::{ExperimentProposal, ProposedExperiment, TightenedValue};
use crate::output::number::{given, percent, short, with_unit};
use std::fmt::Write as _;

/// What the logs leave open, what to do next, and what that is expected to give. `file` is where
/// the motion was written, `replayable` whether `handstand replay` plays it.
pub fn proposal_text(
    diagnosis: Option<&Diagnosis>,
    proposal: Option<&ExperimentProposal>,
    file: Option<&str>,
    replayable: bool,
) -> String {
    let mut text = String::new();
    for line in diagnosis.iter().flat_map(|d| &d.summary) {
        let _ = writeln!(text, "{line}");
    }
    let Some(proposal) = proposal else {
        for line in diagnosis.iter().flat_map(|d| &d.next) {
            let _ = writeln!(text, "{line}");
        }
        return text;
    };
    if let Some(experiment) = &proposal.experiment {
        text += &experiment_text(experiment, file, replayable);
    }
    text += &separations_text(proposal);
    text += &alike_text(proposal);
    for value in &proposal.values {
        let _ = writeln!(text, "{}", tightened(value));
    }
    text += &measure_text(proposal);
    if !proposal.helps() {
        text += &no_help(proposal);
    }
    if proposal.simulated > 0 {
        let (all, within) = (proposal.simulated, proposal.within_limits);
        let _ = writeln!(
            text,
            "Simulated: {all} experiments; {within} stay within the limits."
        );
    }
    text
}

fn experiment_text(experiment: &ProposedExperiment, file: Option<&str>, playable: bool) -> String {
    let mut text = String::from("\nDo this next:\n");
    let mut number = 0;
    let mut step = |line: &str| {
        number += 1;
        let _ = writeln!(text, "{number}. {line}");
    };
    for line in &experiment.instructions {
        step(line);
    }
    let kinds: Vec<&str> = experiment.motions.iter().map(|kind| kind.name()).collect();
    let motion = format!(
        "{}, {} s at {} Hz, over {} of the allowed angles",
        kinds.join(", "),
        given((10.0 * experiment.seconds).round() / 10.0),
        given(experiment.hz),
        percent(experiment.width)
    );
    match (file, playable) {
        (Some(file), true) => {
            step(&format!(
                "Play {file} ({motion}): handstand replay {file} --record LOG"
            ));
        }
        (Some(file), false) => step(&format!(
            "Play {file} ({motion}) by the rig's own controller: its columns are inputs of the \
             drives, not goals of servos, and `replay` does not play them."
        )),
        (None, _) => step(&format!(
            "Play the motion that -o MOTION.csv writes ({motion})."
        )),
    }
    step("Diagnose again, with the new log added.");
    text.push('\n');
    text
}

fn separations_text(proposal: &ExperimentProposal) -> String {
    let mut text = String::new();
    for pair in &proposal.separations {
        let (a, b) = pair.rivals;
        let (a, b) = (&proposal.rivals[a].name, &proposal.rivals[b].name);
        let apart = short(pair.standard_errors);
        let end = if pair.parted { "" } else { ": not enough" };
        let _ = writeln!(text, "{a} from {b}: {apart} standard errors{end}");
    }
    text
}

fn alike_text(proposal: &ExperimentProposal) -> String {
    let mut text = String::new();
    for &(a, b) in &proposal.alike {
        let _ = writeln!(
            text,
            "{} and {} are one law here: each predicts what the other does, in every experiment \
             within the limits. Either will do.",
            proposal.rivals[a].name, proposal.rivals[b].name
        );
    }
    text
}

/// "link1.mass_kg = 0.2 kg: standard error 0.01 -> 0.002 kg".
fn tightened(value: &TightenedValue) -> String {
    let (before, after) = (value.standard_error_before, value.standard_error_after);
    format!(
        "{} = {}: standard error {} -> {}",
        value.path,
        with_unit(&short(value.value), &value.unit),
        short(before),
        with_unit(&short(after), &value.unit)
    )
}

fn measure_text(proposal: &ExperimentProposal) -> String {
    let mut text = String::new();
    for value in &proposal.measure {
        let path = &value.path;
        let _ = writeln!(
            text,
            "No motion within the limits parts {path} from the rest: {}. If the file is right, \
             diagnose again with --known {path}; if not, mend the file first.",
            value.instruction
        );
    }
    text
}

fn no_help(proposal: &ExperimentProposal) -> String {
    match proposal.verdict {
        Some(Verdict::Unexplained) => "No explanation is left that an experiment could part from \
            another: something is missing that the library does not hold. Write it as an \
            expression, or see where the model fails: handstand compare.\n"
            .to_string(),
        _ if proposal.simulated == 0 => {
            "Nothing is free to be tightened: name a value by --value link1.mass_kg.\n".to_string()
        }
        _ if proposal.within_limits == 0 => {
            "Every motion leaves the limits: allow wider --angles or a higher --speed.\n"
                .to_string()
        }
        _ if proposal.all_alike() => String::new(),
        _ => "No motion within the limits parts these explanations: allow wider --angles, a \
              higher --speed, more --seconds or a known --mass.\n"
            .to_string(),
    }
}
