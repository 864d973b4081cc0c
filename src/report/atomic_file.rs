//! Files that take their name when they are complete.

#[cfg(target_os = "linux")]
use std::fs::File;
use std::fs::Metadata;
use std::io::{self, Write};
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

/// A file that is being written.
#[derive(Debug)]
pub(super) enum Unfinished {
    /// The file has no name at all: nothing is left of it where the program is stopped.
    #[cfg(target_os = "linux")]
    Nameless(File),
    /// The file has a hidden name, on systems without nameless files.
    Hidden(NamedTempFile),
}

/// What hidden names begin with.
const HIDDEN: &str = ".slider-crank-";

impl Unfinished {
    /// Begins a file in the folder of its name, with the permissions of the file that it is to replace.
    pub fn new(folder: &Path, before: Option<&Metadata>) -> io::Result<Unfinished> {
        #[cfg(target_os = "linux")]
        if let Some(file) = nameless(folder, before) {
            return Ok(Unfinished::Nameless(file));
        }
        let mut builder = Builder::new();
        builder.prefix(HIDDEN);
        #[cfg(unix)]
        builder.permissions(permissions(before));
        // Elsewhere a file has the permissions of its folder.
        #[cfg(not(unix))]
        let _ = before;
        builder.tempfile_in(folder).map(Unfinished::Hidden)
    }

    /// Gives the file its name, in its folder.
    pub fn finish(self, folder: &Path, path: &Path) -> io::Result<()> {
        // A file with a name is in its folder already.
        #[cfg(not(target_os = "linux"))]
        let _ = folder;
        match self {
            #[cfg(target_os = "linux")]
            Unfinished::Nameless(file) => {
                // A link does not replace a file, as another name does.
                let link = |name: &Path| link(&file, name);
                let hidden = Builder::new().prefix(HIDDEN).make_in(folder, link)?;
                hidden.persist(path).map_err(|error| error.error)?;
            }
            Unfinished::Hidden(file) => {
                file.persist(path).map_err(|error| error.error)?;
            }
        }
        Ok(())
    }
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            #[cfg(target_os = "linux")]
            Unfinished::Nameless(file) => file.write(bytes),
            Unfinished::Hidden(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Unfinished::Nameless(file) => file.flush(),
            Unfinished::Hidden(file) => file.flush(),
        }
    }
}

#[cfg(unix)]
fn permissions(before: Option<&Metadata>) -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    let new = || std::fs::Permissions::from_mode(0o666);
    before.map_or_else(new, Metadata::permissions)
}

/// Where the files that a process has open have names.
#[cfg(target_os = "linux")]
const OPEN_FILES: &str = "/proc/self/fd";

/// A file without a name; none where there are no such files, or no way to give them one.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path, before: Option<&Metadata>) -> Option<File> {
    use rustix::fs::{Mode, OFlags};
    use std::os::unix::fs::PermissionsExt;
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    let mode = Mode::from_bits_truncate(permissions(before).mode());
    let file = rustix::fs::open(folder, flags, mode).ok()?;
    Path::new(OPEN_FILES).is_dir().then(|| File::from(file))
}

#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD};
    use std::os::fd::AsRawFd;
    let open = format!("{OPEN_FILES}/{}", file.as_raw_fd());
    rustix::fs::linkat(CWD, open, CWD, name, AtFlags::SYMLINK_FOLLOW)?;
    Ok(())
}
