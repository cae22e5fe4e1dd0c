//! A session: the logs, the models one after the other, and what is running.

mod aside;
mod card;
mod commands;
mod data;
mod evaluation;
mod example;
mod findings;
mod given;
mod job;
mod round;
mod saved;
mod steps;
mod store;
mod work;

pub use aside::aside;
pub(super) use card::{CardRole, SavedCard, SavedDiagnosis};
pub(super) use data::{LogFacts, MOST_BYTES};
pub(super) use evaluation::{SessionEvaluation, pooled_rms};
pub(super) use example::EXAMPLES;
pub use given::Given;
pub(super) use job::{JobReport, JobSlot};
pub(super) use round::{Round, RoundResult};
pub(super) use saved::{ChosenWindow, SavedSession, SavedStep};
pub(super) use store::SessionStore;

use crate::error::Result;
use evaluation::Evaluations;
use findings::KnownFindings;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

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
            job: JobSlot::default(),
        }
    }

    /// The session of a folder.
    ///
    /// # Errors
    /// As [`SavedSession::load`].
    pub fn load(number: u32, folder: PathBuf) -> Result<LabSession> {
        let session = LabSession::new(number, folder);
        *session.lock() = SavedSession::load(&session.folder)?;
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
}
