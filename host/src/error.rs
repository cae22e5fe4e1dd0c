//! What can go wrong, said with the place, what was found there, and the remedy.

use std::fmt;
use std::path::{Path, PathBuf};

/// Result of everything in this crate that can fail.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Where in a file something was found; lines and columns count from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Line, if the trouble sits on one.
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

/// An error with everything its reader needs to mend it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line asks for something that makes no sense.
    #[error("{what}")]
    Usage {
        /// What is wrong with the request.
        what: String,
        /// How to ask instead.
        remedy: String,
    },
    /// A file's content is refused.
    #[error("{place}: {what}")]
    Data {
        /// File, line and column.
        place: Place,
        /// What was found, and why it is refused.
        what: String,
        /// What to do about it.
        remedy: String,
    },
    /// The operating system refused a file.
    #[error("{path}: cannot {action}: {reason}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What was tried: "read", "write", ...
        action: &'static str,
        /// The system's own reason. Part of the message, hence no `source`, which a chain would say again.
        reason: std::io::Error,
    },
    /// Model, weights and timing are well formed, but no design follows from them.
    #[error("{what}")]
    Design {
        /// What stands in the way.
        what: String,
        /// What to change.
        remedy: String,
    },
    /// A device (serial port, servo) failed or fell silent.
    #[error("{what}")]
    Device {
        /// What failed.
        what: String,
        /// What to try.
        remedy: String,
    },
}

impl Error {
    /// A file's content is refused: `what` was found at `place`; `remedy` mends it.
    pub fn data(place: Place, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Data {
            place,
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    /// The request makes no sense.
    pub fn usage(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Usage {
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    /// No design follows from what was given: `what` stands in the way.
    pub fn design(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Design {
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    /// The system refused `action` on `path`.
    pub fn file(path: impl AsRef<Path>, action: &'static str, reason: std::io::Error) -> Self {
        Error::File {
            path: path.as_ref().to_path_buf(),
            action,
            reason,
        }
    }

    /// The process exit code of this error: 2 usage, 3 bad data or file, 4 device.
    ///
    /// 5 is kept for a drive stopped for safety, 1 is an answer (no), and 101 a bug; none of them is an error.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage { .. } => 2,
            Error::Data { .. } | Error::Design { .. } | Error::File { .. } => 3,
            Error::Device { .. } => 4,
        }
    }

    /// What the reader can do about it, if anything is known.
    pub fn remedy(&self) -> Option<&str> {
        match self {
            Error::Usage { remedy, .. }
            | Error::Data { remedy, .. }
            | Error::Design { remedy, .. }
            | Error::Device { remedy, .. } => Some(remedy),
            Error::File { .. } => None,
        }
    }
}

impl miette::Diagnostic for Error {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.remedy()
            .map(|remedy| Box::new(remedy) as Box<dyn fmt::Display>)
    }
}
