//! A file that one process has to itself.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;

/// Opens a file, or makes it, for this process alone until it is closed; none while another process has it. On a
/// file system that cannot keep processes apart it is open to all.
pub(super) fn open(path: &Path) -> io::Result<Option<File>> {
    if std::fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink()) {
        return Err(io::Error::other("it is a link to another file"));
    }
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    alone(&options, path)
}

#[cfg(unix)]
fn alone(options: &OpenOptions, path: &Path) -> io::Result<Option<File>> {
    use rustix::fs::{FlockOperation, OFlags, flock};
    use rustix::io::Errno;
    use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
    let mut options = options.clone();
    options.custom_flags(OFlags::NOFOLLOW.bits().cast_signed());
    loop {
        let file = options.open(path)?;
        if flock(&file, FlockOperation::NonBlockingLockExclusive) == Err(Errno::WOULDBLOCK) {
            return Ok(None);
        }
        // The one who had it may have deleted it in between; then this is a file without a name.
        let mine = file.metadata()?;
        if std::fs::metadata(path).is_ok_and(|named| named.ino() == mine.ino()) {
            return Ok(Some(file));
        }
    }
}

#[cfg(windows)]
fn alone(options: &OpenOptions, path: &Path) -> io::Result<Option<File>> {
    use std::os::windows::fs::OpenOptionsExt;
    /// The file is open elsewhere and not shared.
    const ERROR_SHARING_VIOLATION: i32 = 32;
    match options.clone().share_mode(0).open(path) {
        Err(error) if error.raw_os_error() == Some(ERROR_SHARING_VIOLATION) => Ok(None),
        opened => opened.map(Some),
    }
}

#[cfg(not(any(unix, windows)))]
fn alone(options: &OpenOptions, path: &Path) -> io::Result<Option<File>> {
    options.open(path).map(Some)
}
