//! Where results go: standard output, or a file that appears only when it is complete.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::atomic_file::Unfinished;
use crate::error::Error;

/// Names of standard output.
const STANDARD: [&str; 2] = ["-", "/dev/stdout"];

/// Folders of devices, and of files that are open already.
const OPEN: [&str; 3] = ["/dev", "/dev/fd", "/proc/self/fd"];

/// Whether a path stands for standard output.
pub fn is_standard_output(path: &Path) -> bool {
    STANDARD.iter().any(|name| path == Path::new(name))
}

/// Whether what is at a path is written as it is, and never replaced: a pipe, a device, a file that is open already.
pub(super) fn is_stream(path: &Path) -> bool {
    let open = |folder: &Path| OPEN.iter().any(|known| folder == Path::new(known));
    let is_open = path.parent().is_some_and(open);
    path.exists() && !path.is_dir() && (is_open || !path.is_file())
}

/// The file that a link leads to, for a link stays a link.
fn followed(path: &Path) -> PathBuf {
    std::fs::canonicalize(path)
        .or_else(|_| std::fs::read_link(path).map(|to| folder(path).join(to)))
        .unwrap_or_else(|_| path.to_owned())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Whether a file may be written, as its own permissions say.
fn writable(path: &Path) -> io::Result<()> {
    let file = std::fs::File::options().append(true).open(path)?;
    if file.metadata()?.permissions().readonly() {
        return Err(io::Error::other("it is write-protected"));
    }
    Ok(())
}

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
    pub fn create(path: &Path) -> Result<Output, Error> {
        let target = path.display().to_string();
        if is_standard_output(path) {
            return Ok(Output::standard());
        }
        let failed = |source| Error::Write {
            target: target.clone(),
            source,
        };
        if is_stream(path) {
            let file = std::fs::File::options().append(true).open(path);
            return Ok(Output {
                stream: Stream::Device(BufWriter::new(file.map_err(failed)?)),
                target,
            });
        }
        let path = &followed(path);
        let folder = folder(path);
        if !folder.is_dir() {
            let why = format!("the folder `{}` does not exist", folder.display());
            return Err(failed(io::Error::other(why)));
        }
        if path.is_dir() {
            return Err(failed(io::Error::other("it is a folder")));
        }
        let before = std::fs::metadata(path).ok();
        if before.is_some() {
            // Another file would take its name, for which the folder's permission is enough.
            writable(path).map_err(failed)?;
        }
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
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let result = match &mut self.stream {
            Stream::Standard(writer) => writer.write_all(bytes),
            Stream::Device(writer) => writer.write_all(bytes),
            Stream::File { writer, .. } => writer.write_all(bytes),
        };
        result.map_err(|source| self.error(source))
    }

    /// Writes a text that is all there is to write.
    pub fn text(mut self, text: &str) -> Result<(), Error> {
        self.write(text.as_bytes())?;
        self.finish()
    }

    /// Completes the output; a file gets its name now.
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
