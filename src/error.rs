//! Errors of the library, with value and place; printed in one place, by `main`.

use std::io;
use std::path::{Path, PathBuf};

use crate::scene::Problems;

/// Every error of the library.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene has impossible or unreadable values.
    #[error(transparent)]
    Scene(#[from] Problems),
    /// A file cannot be read.
    #[error("`{}` cannot be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A result cannot be written.
    #[error("`{target}` cannot be written: {source}")]
    Write {
        /// File name or stream.
        target: String,
        /// The system's reason.
        source: io::Error,
    },
    /// Stop by request.
    #[error("interrupted")]
    Interrupted,
    /// The results of a command are kept, but incomplete or not as wanted.
    #[error("{0}")]
    Incomplete(String),
    /// The scene cannot be computed in the requested way.
    #[error("{what}\nhelp: {help}")]
    Refused {
        /// Request and the reason of the refusal.
        what: String,
        /// Alternative for the user.
        help: String,
    },
}

impl Error {
    /// Returns a function that gives the system's reason the file that cannot be read.
    pub(crate) fn read(file: &Path) -> impl Fn(io::Error) -> Error {
        move |source| Error::Read {
            file: file.to_owned(),
            source,
        }
    }

    /// Returns a function that gives the system's reason the file or stream that cannot be written.
    #[cfg(feature = "cli")]
    pub(crate) fn write(target: impl ToString) -> impl Fn(io::Error) -> Error {
        move |source| Error::Write {
            target: target.to_string(),
            source,
        }
    }

    /// Creates a refusal with its reason and an alternative.
    pub fn refused(what: impl Into<String>, help: impl Into<String>) -> Error {
        Error::Refused {
            what: what.into(),
            help: help.into(),
        }
    }

    /// Adds notes to a refusal, each on a line of its own; other errors stay unchanged.
    pub fn with_notes(self, notes: &[String]) -> Error {
        match self {
            Error::Refused { what, mut help } => {
                for note in notes {
                    help.push_str("\nnote: ");
                    help.push_str(note);
                }
                Error::Refused { what, help }
            }
            other => other,
        }
    }

    /// Returns the exit status of the program: 2 for what the user must change, 1 for the rest.
    pub fn exit_status(&self) -> u8 {
        match self {
            Error::Write { .. } | Error::Interrupted | Error::Incomplete(_) => 1,
            _ => 2,
        }
    }

    /// Whether the reader of the output closed the pipe, which is no error.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Error::Write { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}
