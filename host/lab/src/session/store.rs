//! The sessions of one folder, each in a folder of its own.

use super::{Ending, LabSession, ProjectFiles};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The sessions, by number.
#[derive(Debug)]
pub struct SessionStore {
    folder: PathBuf,
    given: ProjectFiles,
    open: Mutex<OpenSessions>,
}

#[derive(Debug, Default)]
struct OpenSessions {
    sessions: BTreeMap<u32, Arc<LabSession>>,
    /// Those that a browser has been sent to since the start.
    taken: BTreeSet<u32>,
}

impl SessionStore {
    /// Reads what there is in `folder`, which is made if need be. New sessions start with `given`,
    /// which must be readable.
    ///
    /// # Errors
    /// A folder, session, model or log that cannot be read.
    pub fn open(folder: PathBuf, given: ProjectFiles) -> Result<SessionStore> {
        let refused = |error| Error::file(&folder, "make", error);
        std::fs::create_dir_all(&folder).map_err(refused)?;
        let folder = folder.canonicalize().map_err(refused)?;
        given.check()?;
        let mut open = OpenSessions::default();
        for entry in std::fs::read_dir(&folder).map_err(refused)?.flatten() {
            let name = entry.file_name();
            let number = name.to_str().and_then(|name| name.parse::<u32>().ok());
            let path = entry.path();
            if let Some(number) = number.filter(|_| path.join("session.json").is_file()) {
                open.sessions
                    .insert(number, Arc::new(LabSession::load(number, path)?));
            }
        }
        Ok(SessionStore {
            folder,
            given,
            open: Mutex::new(open),
        })
    }

    /// Where they are.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A session by its number.
    pub fn get(&self, number: u32) -> Option<Arc<LabSession>> {
        self.lock().sessions.get(&number).cloned()
    }

    /// All of them, the oldest first.
    pub fn all(&self) -> Vec<Arc<LabSession>> {
        self.lock().sessions.values().cloned().collect()
    }

    /// A session for a browser that has none: a new one, unless earlier ones wait to be chosen
    /// from.
    ///
    /// # Errors
    /// As [`SessionStore::begin`].
    pub fn for_newcomer(&self) -> Result<Option<Arc<LabSession>>> {
        let waiting = {
            let open = self.lock();
            open.sessions
                .keys()
                .any(|number| !open.taken.contains(number))
        };
        if waiting {
            Ok(None)
        } else {
            self.begin().map(Some)
        }
    }

    /// A new session with what the lab was opened with.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn begin(&self) -> Result<Arc<LabSession>> {
        self.add(|session| session.bring(&self.given))
    }

    /// A new session, filled by `fill` before anyone sees it.
    ///
    /// # Errors
    /// Those of `fill`, and the system's refusal.
    pub fn add(&self, fill: impl FnOnce(&LabSession) -> Result<()>) -> Result<Arc<LabSession>> {
        let (number, folder) = self.reserve()?;
        let session = LabSession::new(number, folder);
        fill(&session)?;
        session.save()?;
        let session = Arc::new(session);
        let mut open = self.lock();
        open.taken.insert(number);
        open.sessions.insert(number, session.clone());
        Ok(session)
    }

    /// Deletes a session with its folder; what runs in it is stopped.
    ///
    /// # Errors
    /// There is no such session; the system's refusal.
    pub fn delete(&self, number: u32) -> Result<()> {
        let session = self.lock().sessions.remove(&number);
        let session =
            session.ok_or_else(|| Error::usage("there is no such session", "reload the page"))?;
        session.job.end(Ending::Stopped);
        let folder = session.folder();
        std::fs::remove_dir_all(folder).map_err(|why| Error::file(folder, "remove", why))
    }

    /// A folder that nobody else has.
    fn reserve(&self) -> Result<(u32, PathBuf)> {
        let mut number = self
            .lock()
            .sessions
            .keys()
            .next_back()
            .map_or(1, |last| last + 1);
        loop {
            let folder = self.folder.join(number.to_string());
            match std::fs::create_dir(&folder) {
                Ok(()) => return Ok((number, folder)),
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(Error::file(&folder, "make", error)),
            }
        }
    }

    /// A browser has been sent to this session.
    pub fn take(&self, number: u32) {
        self.lock().taken.insert(number);
    }

    fn lock(&self) -> MutexGuard<'_, OpenSessions> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
