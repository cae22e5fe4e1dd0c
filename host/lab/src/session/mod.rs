//! A session: the logs, the models one after the other, and what is running.

mod aside;
mod bring;
mod card;
mod commands;
mod data;
mod dataset;
mod evaluation;
mod example;
mod facts;
mod file;
mod findings;
mod given;
mod job;
mod kept;
mod names;
mod propose;
mod robot_file;
mod round;
mod saved;
mod steps;
mod store;
mod view;
mod work;

pub use aside::aside;
pub(super) use bring::{MODEL_ENDINGS, is_model};
pub(super) use card::{CardRole, SavedCard, SavedDiagnosis};
pub(super) use data::{LogPart, MOST_BYTES};
pub(super) use evaluation::{SessionEvaluation, ShownUnit, in_degrees, over, pooled_rms};
pub(super) use example::EXAMPLES;
pub(super) use facts::LogFacts;
pub(super) use file::SessionFile;
pub use given::ProjectFiles;
pub(super) use job::{Ending, JobReport, JobSlot};
pub(super) use kept::{SavedProposal, model_sha256};
pub(super) use names::{effect_name, effect_of, listed, value_name};
pub(super) use propose::MOTION_FILE;
pub(super) use round::{Round, RoundResult};
pub(super) use saved::{ChosenWindow, SavedSession, SavedStep};
pub(super) use store::SessionStore;
pub(super) use work::{ChosenBounds, with_bounds};

use crate::diagnose::Diagnosis;
use crate::error::Result;
use evaluation::Evaluations;
use findings::KnownFindings;
use kept::DiagnosedFiles;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use view::Readings;

/// One session.
#[derive(Debug)]
pub(super) struct LabSession {
    /// Its number, which names its folder and its address.
    pub number: u32,
    folder: PathBuf,
    saved: Mutex<SavedSession>,
    evaluations: Mutex<Evaluations>,
    /// Held while an evaluation is made: who wants the same one waits for it.
    evaluating: Mutex<()>,
    findings: Mutex<KnownFindings>,
    readings: Mutex<Readings>,
    /// The last diagnosis as a whole, which a proposal of the next experiment begins with.
    diagnosed: Mutex<Option<(DiagnosedFiles, Diagnosis)>>,
    /// What is running.
    pub job: JobSlot,
}

impl LabSession {
    fn new(number: u32, folder: PathBuf) -> LabSession {
        LabSession {
            number,
            folder,
            saved: Mutex::default(),
            evaluations: Mutex::default(),
            evaluating: Mutex::default(),
            findings: Mutex::default(),
            readings: Mutex::default(),
            diagnosed: Mutex::default(),
            job: JobSlot::default(),
        }
    }

    /// The session of a folder.
    ///
    /// # Errors
    /// As [`SavedSession::load`].
    pub fn load(number: u32, folder: PathBuf) -> Result<LabSession> {
        let session = LabSession::new(number, folder);
        let mut saved = SavedSession::load(&session.folder)?;
        session.take_up(&mut saved);
        *session.lock() = saved;
        Ok(session)
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A copy of what it keeps.
    pub fn saved(&self) -> SavedSession {
        self.lock().clone()
    }

    /// Changes what it keeps, and writes that before anyone sees it. A change that cannot be
    /// written is none.
    ///
    /// # Errors
    /// Those of `change`, and the system's refusal.
    pub fn change<T>(&self, change: impl FnOnce(&mut SavedSession) -> Result<T>) -> Result<T> {
        let mut saved = self.lock();
        let mut next = saved.clone();
        let value = change(&mut next)?;
        next.recall();
        next.save(&self.folder)?;
        *saved = next;
        Ok(value)
    }

    /// Writes it.
    fn save(&self) -> Result<()> {
        self.lock().save(&self.folder)
    }

    fn lock(&self) -> MutexGuard<'_, SavedSession> {
        self.saved.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Text for people: the session's folder, which every log is in, is left out.
    pub fn shortened(&self, text: &str) -> String {
        let folder = format!("{}/", self.folder.display());
        text.replace(&format!("{folder}logs/"), "")
            .replace(&folder, "")
    }

    /// Commands as they are typed in the session's folder.
    fn typed_here(&self, text: &str) -> String {
        text.replace(&format!("{}/", self.folder.display()), "")
    }
}
