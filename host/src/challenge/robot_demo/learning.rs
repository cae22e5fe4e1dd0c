//! From recordings to a better model, and from a model to the plan that the CM-5 gets.

use crate::deploy::{self, Board, BoardLaw};
use crate::diagnose::conventions::ModelFile;
use crate::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, diagnose_logs};
use crate::effects::EFFECTS;
use crate::error::{Error, Result};
use crate::fitting::{Addition, Candidate, Horizon, Progress, add_effects, candidates_named};
use crate::log::LogSet;
use crate::model::edit::{add_effect, set_step};
use crate::model::{EffectInstance, Model};
use crate::synth::controllers::BoardTiming;
use handstand_shared::plan::Plan;
use std::path::Path;

/// Largest delay of a drive that a plan can take, s: with the attitude's age it is within the three
/// inputs that the CM-5 keeps. What is beyond is left out.
const MOST_DELAY_S: f64 = 0.020;

/// Kinds of effects that are tried: those of servos and links that a designer can do something about.
/// All others are left out, that the diagnosis takes a minute; `handstand diagnose` tries them on the
/// same files.
const TRIED: [&str; 4] = ["delay", "dead_zone", "coulomb", "mass"];
/// Length of the windows that are judged, s: dry friction of the bar, which has no encoder, shows
/// in how a swing dies down, and in shorter windows their start states take it up.
const HORIZON: Horizon = Horizon::Seconds(0.6);

/// What the recordings taught.
#[derive(Debug, Clone)]
pub struct Learned {
    /// What was found.
    pub diagnosis: Diagnosis,
    /// Effects that were added, as `delay@all`; none where nothing was found.
    pub added: Vec<String>,
    /// The model file with them; the old one where there are none.
    pub model_toml: String,
}

impl Learned {
    /// Diagnoses the model of `file` and adds what is missing.
    ///
    /// # Errors
    /// Logs that cannot be read, or effects that the model has no room for.
    pub fn from_logs(
        text: &str,
        file: &Path,
        logs: &LogSet,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Learned> {
        let model = Model::parse(text, file)?;
        let options = DiagnoseOptions {
            without: (EFFECTS.iter().map(|effect| effect.info().id))
                .filter(|id| !TRIED.contains(id))
                .map(String::from)
                .collect(),
            horizon: Some(HORIZON),
            most_effects: 2,
            // Columns and drives are the recorder's own: what makes others look better is missing.
            trust_log: true,
            ..DiagnoseOptions::default()
        };
        let named = ModelFile { path: file, text };
        let found = diagnose_logs(&model, named, logs, &options, progress)?;
        let added: Vec<String> = (found.diagnosis.effects.iter())
            .map(FittedEffect::address)
            .collect();
        let model_toml = match added.is_empty() {
            true => text.to_string(),
            false => {
                let candidates = candidates_named(&added, &model)?;
                let horizon = Some(HORIZON);
                let addition =
                    add_effects(text, file, &candidates, &found.split, horizon, &|_| {})?;
                match addition {
                    Addition::Added { text, .. } => text,
                    Addition::Undetermined(_) => as_diagnosed(text, file, &found.diagnosis)?,
                    Addition::Unhelpful(_) => text.to_string(),
                }
            }
        };
        Ok(Learned {
            diagnosis: found.diagnosis,
            added,
            model_toml,
        })
    }
}

/// The model file with the effects and values of the diagnosis itself: where a dead zone takes away
/// as much as it is wide, no motion tells a smaller width, and a fit of all values is refused.
fn as_diagnosed(text: &str, file: &Path, diagnosis: &Diagnosis) -> Result<String> {
    let add = |text: String, fitted: &FittedEffect| {
        let candidate = Candidate::named(&fitted.address(), &Model::parse(&text, file)?)?;
        let instance = EffectInstance {
            effect: candidate.effect,
            joint: candidate.joint,
            values: fitted.parameters.iter().map(|it| it.value).collect(),
        };
        add_effect(&text, file, &instance, None)
    };
    let text = diagnosis.effects.iter().try_fold(text.to_string(), add)?;
    match diagnosis.shorter_step_s {
        Some(step_s) => set_step(&text, file, step_s),
        None => Ok(text),
    }
}

/// The plan for a model: its links, smooth friction and back-EMF in the gains, its drives' delay in
/// observer and gains, its dead zone and the joints' dry friction jumped over.
///
/// # Errors
/// A model that cannot be balanced.
pub fn plan_for(model: &Model) -> Result<Plan> {
    let largest = |id: &str, of: &dyn Fn(&[f64]) -> f64| {
        let driven = model.driven_joints();
        let effects = driven.iter().flat_map(|joint| model.effects_at(*joint));
        let found = effects.filter(|effect| effect.effect.info().id == id);
        let values = found.map(|effect| of(&effect.values));
        values.fold(0.0, f64::max)
    };
    let delay_s = largest("delay", &|values| values[0]);
    // What a command loses on its way is jumped over, not the width below which it does nothing: of
    // a width below the loss a command shows nothing. Dry friction costs it as much again.
    let lost = largest("dead_zone", &|values| (-values[1]).max(0.0))
        + largest("coulomb", &|values| values[0]) / Board::BIOLOID.full_nm;
    if Board::BIOLOID.slew_nm <= lost * Board::BIOLOID.full_nm {
        return Err(Error::design(
            format!("a dead zone of {:.0} %", 100.0 * lost),
            "the slew limit must exceed it: record more, or look at the diagnosis",
        ));
    }
    let mut timing = BoardTiming::HOST_ATTITUDE;
    timing.effect_s += delay_s.clamp(0.0, MOST_DELAY_S);
    // What is lost is lost of the whole command too: less than the full torque is ever left. The
    // board spreads what is left over the commands beyond the dead zone.
    let full_nm = Board::BIOLOID.full_nm * (1.0 - lost);
    let board = Board {
        dead_zone: lost,
        full_nm,
        most_nm: full_nm,
        joint_range_rad: 1.5,
        joint_speed_rad_s: 12.0,
        ..Board::BIOLOID
    };
    let machine = deploy::observer_design(model, &board, &timing)?;
    deploy::plan(model, BoardLaw::Observer(&machine), &board)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::robot_demo::HiddenRobot;
    use handstand_shared::raw::Signed;

    #[test]
    fn a_drive_with_a_dead_zone_makes_the_torque_that_the_law_asks_for() {
        let robot = HiddenRobot::draw(1).unwrap();
        assert!(robot.answer.effects[1].address.starts_with("dead_zone"));
        let model = robot.model().unwrap();
        let plan = plan_for(&model).unwrap();
        let punch = robot.answer.effects[1].parameters[1].1;
        let friction_nm = 0.05;
        for (asked_nm, input) in [(0.25, 2048), (0.5, 4096), (-1.0, -8192)] {
            let duty = f64::from(plan.joints[0].command(input)) * Signed::OUTPUT_LSB;
            let lost_nm = f64::copysign(friction_nm, asked_nm);
            let made_nm = Board::BIOLOID.full_nm * (duty - punch.abs().copysign(duty)) - lost_nm;
            assert!((made_nm - asked_nm).abs() < 4e-3, "{asked_nm} {made_nm}");
        }
    }

    #[test]
    fn a_drive_that_loses_more_than_the_slew_limit_gets_no_plan() {
        let text = HiddenRobot::draw(1).unwrap().answer.true_model_toml;
        let stuck = text.replace("torque_nm = 0.05", "torque_nm = 1.0");
        assert_ne!(stuck, text);
        let model = Model::parse(&stuck, Path::new("stuck.toml")).unwrap();
        let refused = plan_for(&model).unwrap_err().to_string();
        assert!(refused.contains("a dead zone of 56 %"), "{refused}");
    }
}
