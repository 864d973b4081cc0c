//! Exclusive opening of a file, by an advisory lock (Unix) or denied sharing (Windows).

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;

/// Opens or creates a file with exclusive access until it is closed; none while another process holds it. File systems
/// without locks give access to all processes.
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
        // If the previous holder has deleted the file in between, the handle has no name: open again.
        let mine = file.metadata()?;
        if std::fs::metadata(path).is_ok_and(|named| named.ino() == mine.ino()) {
            return Ok(Some(file));
        }
    }
}

#[cfg(windows)]
fn alone(options: &OpenOptions, path: &Path) -> io::Result<Option<File>> {
    use std::os::windows::fs::OpenOptionsExt;
    /// Windows error code: the file is open elsewhere, without sharing.
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
