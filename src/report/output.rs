//! Where results go: standard output, or a file that appears only when it is complete.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::unfinished::Unfinished;
use crate::error::Error;

/// A stream of output. A file takes its name in [`Output::finish`].
#[derive(Debug)]
pub struct Output {
    target: String,
    stream: Stream,
}

#[derive(Debug)]
enum Stream {
    Standard(BufWriter<io::Stdout>),
    Device(BufWriter<std::fs::File>),
    File {
        writer: BufWriter<Unfinished>,
        folder: PathBuf,
        path: PathBuf,
    },
}

impl Output {
    /// Opens the target; `-` is standard output. A target that cannot be written fails here, before the
    /// work is done.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn create(path: &Path) -> Result<Output, Error> {
        let target = path.display().to_string();
        if path == Path::new("-") {
            return Ok(Output::standard());
        }
        // A link stays a link: its target is written.
        let linked = std::fs::canonicalize(path);
        let path = linked.as_deref().unwrap_or(path);
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let failed = |source| Error::Write {
            target: target.clone(),
            source,
        };
        if !folder.is_dir() {
            let why = format!("the folder `{}` does not exist", folder.display());
            return Err(failed(io::Error::other(why)));
        }
        if path.is_dir() {
            return Err(failed(io::Error::other("it is a folder")));
        }
        if path.exists() && !path.is_file() {
            // A pipe or a device is written to as it is.
            let file = std::fs::File::options().write(true).open(path);
            return Ok(Output {
                stream: Stream::Device(BufWriter::new(file.map_err(failed)?)),
                target,
            });
        }
        let before = std::fs::metadata(path).ok();
        // Until it is complete its name means nothing to the user: the system's reason is given without it.
        let file = Unfinished::new(folder, before.as_ref())
            .map_err(|error| failed(error.kind().into()))?;
        Ok(Output {
            target,
            stream: Stream::File {
                writer: BufWriter::with_capacity(1 << 16, file),
                folder: folder.to_owned(),
                path: path.to_owned(),
            },
        })
    }

    /// Standard output.
    pub fn standard() -> Output {
        Output {
            target: "standard output".to_owned(),
            stream: Stream::Standard(BufWriter::with_capacity(1 << 16, io::stdout())),
        }
    }

    /// Writes bytes.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let result = match &mut self.stream {
            Stream::Standard(writer) => writer.write_all(bytes),
            Stream::Device(writer) => writer.write_all(bytes),
            Stream::File { writer, .. } => writer.write_all(bytes),
        };
        result.map_err(|source| self.error(source))
    }

    /// Writes a text that is all there is to write.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn text(mut self, text: &str) -> Result<(), Error> {
        self.write(text.as_bytes())?;
        self.finish()
    }

    /// Completes the output; a file gets its name now.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(self) -> Result<(), Error> {
        let failed = |source| Error::Write {
            target: self.target.clone(),
            source,
        };
        match self.stream {
            Stream::Standard(mut writer) => writer.flush().map_err(failed),
            Stream::Device(mut writer) => writer.flush().map_err(failed),
            Stream::File {
                writer,
                folder,
                path,
            } => {
                let file = writer.into_inner().map_err(|e| failed(e.into_error()))?;
                file.finish(&folder, &path).map_err(failed)
            }
        }
    }

    fn error(&self, source: io::Error) -> Error {
        Error::Write {
            target: self.target.clone(),
            source,
        }
    }
}
