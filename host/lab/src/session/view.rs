//! A session as pages compute with it: logs that the model in force cannot read are left out, and
//! said to be.

use super::LabSession;
use super::saved::{SavedLog, SavedSession};
use crate::log::LogRequest;
use crate::model::Model;
use crate::motion::Split;
use std::sync::{MutexGuard, PoisonError};

/// How many readings are known: those of some models and sets of logs.
const KNOWN: usize = 8;

/// A log that is left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOutLog {
    /// Its name, with its rows where it is a part.
    pub name: String,
    /// What is wrong with it.
    pub found: String,
    /// What mends it.
    pub remedy: String,
}

/// What reading logs by a model's columns gave.
#[derive(Debug)]
struct Reading {
    columns: String,
    logs: Vec<SavedLog>,
    left_out: Vec<LeftOutLog>,
    /// Motions that nobody has taken yet.
    split: Option<Split>,
}

/// The last readings.
#[derive(Debug, Default)]
pub(super) struct Readings(Vec<Reading>);

impl LabSession {
    /// What it keeps, without the logs that the model in force cannot read. Where it can read none
    /// of them all stay: then whoever reads them says why.
    pub fn view(&self) -> SavedSession {
        self.view_of(self.saved())
    }

    /// The same of what was kept at some moment.
    pub fn view_of(&self, saved: SavedSession) -> SavedSession {
        let mut view = saved;
        if let Ok(Some(model)) = self.model(&view) {
            view.left_out = self.left_out(&view, &model);
            let left_out = &view.left_out;
            let stays = |log: &SavedLog| left_out.iter().all(|left| left.name != log.name());
            view.logs.retain(stays);
            view.recall();
        }
        view
    }

    /// The motions of logs that were read to see whether they can be, once.
    pub(super) fn take_motions(&self, saved: &SavedSession, model: &Model) -> Option<Split> {
        let columns = format!("{:?}", model.log);
        let mut readings = self.readings();
        let mut known = readings.0.iter_mut();
        let known = known.find(|known| known.columns == columns && known.logs == saved.logs)?;
        known.split.take()
    }

    fn left_out(&self, saved: &SavedSession, model: &Model) -> Vec<LeftOutLog> {
        if saved.logs.is_empty() {
            return Vec::new();
        }
        let columns = format!("{:?}", model.log);
        let same = |known: &&Reading| known.columns == columns && known.logs == saved.logs;
        if let Some(known) = self.readings().0.iter().find(same) {
            return known.left_out.clone();
        }
        let (left_out, split) = match self.split(saved, model) {
            Ok(split) => (Vec::new(), Some(split)),
            Err(_) => (self.unreadable(saved, model), None),
        };
        let mut readings = self.readings();
        readings.0.insert(
            0,
            Reading {
                columns,
                logs: saved.logs.clone(),
                left_out: left_out.clone(),
                split,
            },
        );
        readings.0.truncate(KNOWN);
        left_out
    }

    /// Those that cannot be read by themselves; none where that is all of them.
    fn unreadable(&self, saved: &SavedSession, model: &Model) -> Vec<LeftOutLog> {
        let refused = |log: &SavedLog| {
            let request = LogRequest {
                path: self.log_path(&log.file),
                rows: log.rows,
            };
            let error = crate::log::read(&[request], &model.log).err()?;
            Some(LeftOutLog {
                name: log.name(),
                found: self.shortened(&error.to_string()),
                remedy: error.remedy().unwrap_or_default().into_owned(),
            })
        };
        let refused: Vec<LeftOutLog> = saved.logs.iter().filter_map(refused).collect();
        if refused.len() == saved.logs.len() {
            Vec::new()
        } else {
            refused
        }
    }

    fn readings(&self) -> MutexGuard<'_, Readings> {
        self.readings.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
