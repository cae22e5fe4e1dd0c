//! Errors of the whole crate: place, what was found there, exit code and remedy.

use crate::output::readable;
use std::borrow::Cow;
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Result of everything in this crate that can fail.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Where in a file something was found; lines and columns count from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Line, if it is on one.
    pub line: Option<usize>,
    /// Column: a character in TOML, a field in CSV.
    pub column: Option<usize>,
}

impl Place {
    /// The file as a whole.
    pub fn file(file: impl AsRef<Path>) -> Self {
        Place {
            file: file.as_ref().to_path_buf(),
            line: None,
            column: None,
        }
    }

    /// A line and column of the file.
    pub fn at(file: impl AsRef<Path>, line: usize, column: usize) -> Self {
        Place {
            file: file.as_ref().to_path_buf(),
            line: Some(line),
            column: Some(column),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
            if let Some(column) = self.column {
                write!(f, ":{column}")?;
            }
        }
        Ok(())
    }
}

/// What was found and what mends it, in words made where the condition is seen.
///
/// Whoever knows the place, or that the request is to blame, makes an [`Error`] of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// What was found, and why it is refused.
    pub what: String,
    /// What to do about it.
    pub remedy: String,
}

impl Problem {
    /// `what` was found; `remedy` mends it.
    pub fn new(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Problem {
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    /// It was found in a file.
    pub fn at(self, place: Place) -> Error {
        Error::Data {
            place,
            problem: self,
        }
    }

    /// The request is to blame.
    pub fn usage(self) -> Error {
        Error::Usage(self)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl std::error::Error for Problem {}

/// An error with everything its reader needs to mend it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line asks for something that makes no sense.
    #[error("{}", readable(.0))]
    Usage(Problem),
    /// A file's content is refused.
    #[error("{place}: {}", readable(problem))]
    Data {
        /// File, line and column.
        place: Place,
        /// What was found there.
        problem: Problem,
    },
    /// The operating system refused a file.
    #[error("{path}: cannot {action}: {refusal}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What was tried: "read", "write", ...
        action: &'static str,
        /// The system's own reason. Part of the message, hence no `source`, which a chain would
        /// say again.
        refusal: std::io::Error,
    },
    /// Model, weights and timing are well formed, but no design follows from them.
    #[error("{}", readable(problem))]
    Design {
        /// What stands in the way.
        problem: Problem,
        /// Whether it lies in the request's own numbers, whatever the model is.
        in_request: bool,
    },
    /// A device (serial port, servo) failed or fell silent.
    #[error("{}", readable(.0))]
    Device(Problem),
}

impl Error {
    /// A file's content is refused: `what` was found at `place`; `remedy` mends it.
    pub fn data(place: Place, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Problem::new(what, remedy).at(place)
    }

    /// The request makes no sense.
    pub fn usage(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Usage(Problem::new(what, remedy))
    }

    /// No design follows from what was given: `what` stands in the way.
    pub fn design(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Design {
            problem: Problem::new(what, remedy),
            in_request: false,
        }
    }

    /// A device failed or fell silent.
    pub fn device(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Device(Problem::new(what, remedy))
    }

    /// The system refused `action` on `path`.
    pub fn file(path: impl AsRef<Path>, action: &'static str, refusal: std::io::Error) -> Self {
        Error::File {
            path: path.as_ref().to_path_buf(),
            action,
            refusal,
        }
    }

    /// The process exit code of this error: 2 usage, 3 bad data or file, 4 device.
    ///
    /// 5 is kept for a drive stopped for safety, 1 is an answer (no), and 101 a bug; none of them
    /// is an error.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage(_) => 2,
            Error::Data { .. } | Error::Design { .. } | Error::File { .. } => 3,
            Error::Device(_) => 4,
        }
    }

    /// What the reader can do about it, if anything is known.
    pub fn remedy(&self) -> Option<Cow<'_, str>> {
        match self {
            Error::File {
                path,
                action,
                refusal,
            } => of_system(path, action, refusal.kind()),
            Error::Usage(problem)
            | Error::Data { problem, .. }
            | Error::Design { problem, .. }
            | Error::Device(problem) => Some(readable(&problem.remedy).into()),
        }
    }
}

/// What to do where the system refuses a file.
fn of_system(path: &Path, action: &str, kind: ErrorKind) -> Option<Cow<'static, str>> {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(Path::new(".")).display();
    Some(match (action, kind) {
        ("write", ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            format!("create the folder first: mkdir -p {folder}").into()
        }
        ("write", ErrorKind::PermissionDenied) => {
            format!("name a file in a folder that you may write to: {folder} is none").into()
        }
        ("read", ErrorKind::IsADirectory) => "this is a folder: name a file in it".into(),
        ("read", ErrorKind::InvalidData) => {
            "this is no text: name a text file, saved as UTF-8".into()
        }
        ("read", ErrorKind::NotFound) => "check the name and the folder that you are in".into(),
        ("read", ErrorKind::PermissionDenied) => "allow yourself to read it".into(),
        _ => return None,
    })
}
