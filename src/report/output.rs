//! Output streams: standard output, or a file that appears only when complete.

use std::fs::{File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::error::Error;

/// Paths that stand for standard output.
const STANDARD: [&str; 2] = ["-", "/dev/stdout"];

/// Folders of devices and of open file descriptors.
const OPEN: [&str; 3] = ["/dev", "/dev/fd", OPEN_FILES];

/// Folder of the file descriptors of the process.
const OPEN_FILES: &str = "/proc/self/fd";

/// Prefix of the names of incomplete files.
const HIDDEN: &str = ".slider-crank-";

/// Whether a path stands for standard output.
pub fn is_standard_output(path: &Path) -> bool {
    STANDARD.iter().any(|name| path == Path::new(name))
}

/// Whether a path is written in place, never replaced: a pipe, a device or an open file descriptor.
pub(super) fn is_stream(path: &Path) -> bool {
    let open = |folder: &Path| OPEN.iter().any(|known| folder == Path::new(known));
    let is_open = path.parent().is_some_and(open);
    path.exists() && !path.is_dir() && (is_open || !path.is_file())
}

/// Returns the canonical path of a file that may not exist yet; for a symbolic link that of its target, which keeps the
/// link itself in place.
pub fn place(path: &Path) -> PathBuf {
    let target = std::fs::read_link(path).map(|to| folder(path).join(to));
    let target = target.unwrap_or_else(|_| path.to_owned());
    let new = || {
        Some(
            std::fs::canonicalize(folder(&target))
                .ok()?
                .join(target.file_name()?),
        )
    };
    let known = std::fs::canonicalize(path).ok();
    known.or_else(new).unwrap_or(target)
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Returns the extension of a path, in lower case; empty for none.
pub fn extension(path: &Path) -> String {
    let extension = path.extension().unwrap_or_default();
    extension.to_string_lossy().to_ascii_lowercase()
}

/// Buffered output stream. [`Output::finish`] gives a file its name.
#[derive(Debug)]
pub struct Output {
    target: String,
    writer: BufWriter<Stream>,
    /// Final name of a file; none for a stream.
    path: Option<PathBuf>,
}

#[derive(Debug)]
enum Stream {
    Standard(io::Stdout),
    /// Device; on Linux also an unnamed file, of which a stopped program leaves nothing.
    File(File),
    /// Temporary file with a hidden name, on systems without unnamed files.
    Hidden(NamedTempFile),
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Stream::Standard(stream) => stream.write(bytes),
            Stream::File(file) => file.write(bytes),
            Stream::Hidden(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Stream::Standard(stream) => stream.flush(),
            Stream::File(file) => file.flush(),
            Stream::Hidden(file) => file.flush(),
        }
    }
}

impl Output {
    /// Opens the target; `-` is standard output. A target that cannot be written fails here, before any computation.
    pub fn create(path: &Path) -> Result<Output, Error> {
        if is_standard_output(path) {
            return Ok(Output::standard());
        }
        let target = path.display().to_string();
        let (stream, path) = opened(path).map_err(Error::write(&target))?;
        Ok(Output::new(target, stream, path))
    }

    /// Returns standard output.
    pub fn standard() -> Output {
        let stream = Stream::Standard(io::stdout());
        Output::new("standard output".to_owned(), stream, None)
    }

    fn new(target: String, stream: Stream, path: Option<PathBuf>) -> Output {
        Output {
            target,
            writer: BufWriter::with_capacity(1 << 16, stream),
            path,
        }
    }

    /// Returns the extension of the target, in lower case; empty for none.
    pub(super) fn extension(&self) -> String {
        extension(Path::new(&self.target))
    }

    /// Writes bytes to the buffer.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self.writer.write_all(bytes);
        written.map_err(Error::write(&self.target))
    }

    /// Writes a text and completes the output.
    pub fn text(mut self, text: &str) -> Result<(), Error> {
        self.write(text.as_bytes())?;
        self.finish()
    }

    /// Flushes the output and gives a file its name.
    pub fn finish(self) -> Result<(), Error> {
        let (target, path) = (self.target, self.path);
        let stream = self.writer.into_inner();
        let stream = stream.map_err(io::IntoInnerError::into_error);
        let finished = stream.and_then(|mut stream| {
            stream.flush()?;
            path.map_or(Ok(()), |path| named(stream, &path))
        });
        finished.map_err(Error::write(target))
    }
}

/// Opens a device, or an unnamed or temporary file in the folder of the target, with the final name.
fn opened(path: &Path) -> io::Result<(Stream, Option<PathBuf>)> {
    if is_stream(path) {
        let file = File::options().append(true).open(path)?;
        return Ok((Stream::File(file), None));
    }
    let path = place(path);
    let folder = folder(&path);
    if !folder.is_dir() {
        let why = format!("the folder `{}` does not exist", folder.display());
        return Err(io::Error::other(why));
    }
    if path.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    let before = std::fs::metadata(&path).ok();
    if before.is_some() {
        // Replacing a file needs the permission of the folder only; a file that is write-protected is refused here.
        let file = File::options().append(true).open(&path)?;
        if file.metadata()?.permissions().readonly() {
            return Err(io::Error::other("it is write-protected"));
        }
    }
    // The name of the temporary file means nothing to the user: only the kind of the error is reported.
    let stream = unfinished(folder, before.as_ref()).map_err(|error| error.kind())?;
    Ok((stream, Some(path)))
}

/// Creates an unnamed or temporary file in a folder, with the permissions of the file it will replace.
fn unfinished(folder: &Path, before: Option<&Metadata>) -> io::Result<Stream> {
    let mut builder = Builder::new();
    builder.prefix(HIDDEN);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let new = || std::fs::Permissions::from_mode(0o666);
        let permissions = before.map_or_else(new, Metadata::permissions);
        #[cfg(target_os = "linux")]
        {
            use rustix::fs::{Mode, OFlags};
            let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
            let mode = Mode::from_bits_truncate(permissions.mode());
            if let Ok(file) = rustix::fs::open(folder, flags, mode)
                && Path::new(OPEN_FILES).is_dir()
            {
                return Ok(Stream::File(File::from(file)));
            }
        }
        builder.permissions(permissions);
    }
    // Outside Unix a file has the permissions of its folder.
    #[cfg(not(unix))]
    let _ = before;
    builder.tempfile_in(folder).map(Stream::Hidden)
}

/// Gives a file its final name, in one folder.
fn named(stream: Stream, path: &Path) -> io::Result<()> {
    match stream {
        #[cfg(target_os = "linux")]
        Stream::File(file) => {
            use rustix::fs::{AtFlags, CWD};
            use std::os::fd::AsRawFd;
            let open = format!("{OPEN_FILES}/{}", file.as_raw_fd());
            let link = |name: &Path| {
                rustix::fs::linkat(CWD, &open, CWD, name, AtFlags::SYMLINK_FOLLOW)?;
                Ok(())
            };
            // A link cannot replace a file, but a rename can.
            let hidden = Builder::new().prefix(HIDDEN).make_in(folder(path), link)?;
            hidden.persist(path).map_err(|error| error.error)?;
        }
        Stream::Hidden(file) => {
            file.persist(path).map_err(|error| error.error)?;
        }
        _ => {}
    }
    Ok(())
}
