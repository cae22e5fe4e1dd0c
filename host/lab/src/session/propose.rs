//! The next experiment: proposed from the diagnosis of the model in force, as `handstand next`
//! does.

use super::LabSession;
use super::data::model_file;
use super::job::JobReport;
use super::kept::{DiagnosedFiles, SavedProposal};
use super::saved::SavedSession;
use super::work::{no_model, unchanged};
use crate::diagnose::{Diagnosis, Verdict};
use crate::error::{Error, Result};
use crate::experiment::{
    Criterion, ExperimentLimits, FollowUp, ProposeOptions, inputs_alone, is_replayable, propose,
};
use crate::log::to_csv;
use crate::model::JointNames;
use crate::output::write_new;
use crate::report::{next_steps, proposal_text};
use std::path::Path;
use std::sync::PoisonError;

/// File of the motion, in the session's folder.
pub const MOTION_FILE: &str = "next.csv";
/// Longest duration, s, as `handstand next` has it.
const SECONDS: f64 = 20.0;

impl LabSession {
    /// Proposes the next experiment; a model that was not diagnosed yet is diagnosed before.
    ///
    /// # Errors
    /// A model without a drive; logs that cannot be read; a session that was changed meanwhile.
    pub fn propose(&self, report: &JobReport) -> Result<()> {
        let begun = self.saved();
        let view = self.view_of(begun.clone());
        let model = self.model_at(&view)?;
        if model.driven_joints().is_empty() {
            return Err(Error::usage(
                "no joint is driven: nothing but a person can move this rig",
                "record another motion by hand: let it go from other angles",
            ));
        }
        model.hinges_only("proposed motions are for servos that turn")?;
        let (of, diagnosis) = self.diagnosis_for(report, &begun, &view)?;
        report.tell("motions");
        let logs = self.log_set(&view);
        let split = logs.read(&model.log)?;
        let motions = [split.training, split.held_out].concat();
        let options = ProposeOptions {
            limits: ExperimentLimits::of_logs(&model, &motions, SECONDS),
            mass_kg: None,
            criterion: Criterion::D,
            seed: 1,
        };
        let proposal = match diagnosis.verdict {
            Verdict::Unfit => None,
            _ => Some(propose(&model, &diagnosis, motions, &options)?),
        };
        let experiment = proposal
            .as_ref()
            .and_then(|found| found.experiment.as_ref());
        let motion_csv = experiment.map(|experiment| {
            let comments = [experiment.instructions.join("\n")];
            to_csv(&experiment.motion, &inputs_alone(&model), &comments)
        });
        let follow_up = FollowUp {
            model: &model_file(view.current),
            logs: &logs,
            motion: motion_csv.as_ref().map(|_| Path::new(MOTION_FILE)),
            replayable: is_replayable(&model),
            values: &[],
            without: &[],
            known: &[],
            trust_log: false,
            horizon: view.window.by_hand(),
        };
        let (diagnosed, proposal) = (Some(&diagnosis), proposal.as_ref());
        let steps = next_steps(diagnosed, proposal, &follow_up);
        let names = JointNames::of(&model);
        let told = |text: &str| names.in_text(&self.typed_here(text));
        let saved = SavedProposal {
            steps: steps.iter().map(|step| told(step)).collect(),
            text: told(&proposal_text(diagnosed, proposal, &follow_up)),
            motion_csv,
        };
        if let Some(text) = &saved.motion_csv {
            write_new(&self.folder().join(MOTION_FILE), text, true)?;
        }
        self.change(|own| {
            unchanged(own, &begun)?;
            let kept = own.kept.iter_mut().find(|kept| kept.of == of);
            kept.ok_or_else(no_model)?.proposal = Some(saved);
            Ok(())
        })
    }

    /// The diagnosis of a view's model: the one that was made last, if it is that, else a new one.
    fn diagnosis_for(
        &self,
        report: &JobReport,
        begun: &SavedSession,
        view: &SavedSession,
    ) -> Result<(DiagnosedFiles, Diagnosis)> {
        let of = view.files_of(view.current).ok_or_else(no_model)?;
        let known = {
            let known = self.diagnosed.lock();
            known.unwrap_or_else(PoisonError::into_inner).clone()
        };
        match known {
            Some((known, diagnosis)) if known == of => Ok((of, diagnosis)),
            _ => {
                let (of, diagnosis) = self.diagnosis_of(report, view)?;
                self.keep_diagnosis(begun, of.clone(), &diagnosis)?;
                Ok((of, diagnosis))
            }
        }
    }
}
