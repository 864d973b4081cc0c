//! What can go wrong, with value and place; printed in one place, by `main`.

use std::path::PathBuf;

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
        source: std::io::Error,
    },
    /// A result cannot be written.
    #[error("`{target}` cannot be written: {source}")]
    Write {
        /// File name or stream.
        target: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The scene cannot be computed the way it is asked for.
    #[error("{what}\nhelp: {help}")]
    Refused {
        /// What is asked for and why it cannot be.
        what: String,
        /// What to do instead.
        help: String,
    },
}

impl Error {
    /// A refusal with its reason and what to do instead.
    pub fn refused(what: impl Into<String>, help: impl Into<String>) -> Error {
        Error::Refused {
            what: what.into(),
            help: help.into(),
        }
    }

    /// A refusal with what else is known, each on a line of its own.
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

    /// Exit status of the program: 2 for what the user must change, 1 for the rest.
    pub fn exit_status(&self) -> u8 {
        match self {
            Error::Write { .. } | Error::Interrupted => 1,
            _ => 2,
        }
    }

    /// Whether the reader of our output went away, which is no error.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Error::Write { source, .. } if source.kind() == std::io::ErrorKind::BrokenPipe)
    }
}
