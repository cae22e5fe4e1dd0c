//! A proposed experiment as text.

use crate::diagnose::{Diagnosis, Verdict};
use crate::experiment::{ExperimentProposal, FollowUp, ProposedExperiment, TightenedValue};
use crate::output::number::{given, percent, short, with_unit};
use std::fmt::Write as _;

/// What the logs leave open, what to do next, and what that is expected to give.
pub fn proposal_text(
    diagnosis: Option<&Diagnosis>,
    proposal: Option<&ExperimentProposal>,
    follow_up: &FollowUp,
) -> String {
    let mut text = String::new();
    for line in diagnosis.iter().flat_map(|d| &d.summary) {
        let _ = writeln!(text, "{line}");
    }
    let steps = next_steps(diagnosis, proposal, follow_up);
    let Some(proposal) = proposal else {
        return text + &lines(&steps);
    };
    if proposal.experiment.is_some() {
        text += "\nDo this next:\n";
        for (index, step) in steps.iter().enumerate() {
            let _ = writeln!(text, "{}. {step}", index + 1);
        }
        text.push('\n');
    }
    text += &separations_text(proposal);
    text += &alike_text(proposal);
    for value in &proposal.values {
        let _ = writeln!(text, "{}", tightened(value));
    }
    text += &lines(&measures(proposal, follow_up));
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

/// What to do next, with the commands: the experiment and what follows it; without one the values
/// to measure; without a proposal what the diagnosis says.
pub fn next_steps(
    diagnosis: Option<&Diagnosis>,
    proposal: Option<&ExperimentProposal>,
    follow_up: &FollowUp,
) -> Vec<String> {
    match proposal {
        None => diagnosis.map_or(Vec::new(), |found| found.next.clone()),
        Some(proposal) => match &proposal.experiment {
            Some(experiment) => experiment_steps(experiment, follow_up),
            None => measures(proposal, follow_up),
        },
    }
}

fn experiment_steps(experiment: &ProposedExperiment, follow_up: &FollowUp) -> Vec<String> {
    let kinds: Vec<&str> = experiment.motions.iter().map(|kind| kind.name()).collect();
    let motion = format!(
        "{}, {} s at {} Hz, over {} of the allowed angles",
        kinds.join(", "),
        given((10.0 * experiment.seconds).round() / 10.0),
        given(experiment.hz),
        percent(experiment.width)
    );
    let mut steps = experiment.instructions.clone();
    steps.push(match (follow_up.motion, follow_up.replay()) {
        (Some(file), Some(replay)) => format!("Play {} ({motion}): {replay}", file.display()),
        (Some(file), None) => format!(
            "Play {} ({motion}) by the rig's own controller, and record {}: its columns are the \
             drives' inputs as the log names them; `replay` plays goals of servos, goal1_rad and \
             so on.",
            file.display(),
            follow_up.new_log()
        ),
        (None, _) => format!(
            "Play the motion that -o MOTION.csv writes ({motion}), and record {}.",
            follow_up.new_log()
        ),
    });
    let what = match follow_up.values {
        [] => "Diagnose",
        _ => "Fit",
    };
    steps.push(format!(
        "{what} again, with the new log added: {}",
        follow_up.again()
    ));
    steps
}

fn lines(sentences: &[String]) -> String {
    sentences.iter().map(|line| format!("{line}\n")).collect()
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

fn measures(proposal: &ExperimentProposal, follow_up: &FollowUp) -> Vec<String> {
    let values = proposal.measure.iter().map(|value| {
        let path = &value.path;
        format!(
            "No motion within the limits parts {path} from the rest: {}. If the file is right, \
             diagnose again: {}; if not, mend the file first.",
            value.instruction,
            follow_up.with_known(path)
        )
    });
    values.collect()
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
