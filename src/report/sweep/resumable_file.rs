//! A file that is written row by row and survives being cut off.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::super::Output;
use super::file_lock;
use crate::error::Error;

/// Rows in a file beside the target, which takes the target's name when they are complete. Its first line
/// says what it belongs to.
#[derive(Debug)]
pub(super) struct Growing {
    target: PathBuf,
    part: PathBuf,
    file: File,
    /// Length of the first line.
    mark: u64,
}

impl Growing {
    /// Opens what an earlier run left and hands its whole rows on, or begins anew with this header.
    ///
    /// # Errors
    /// [`Error::Write`], [`Error::Refused`] if what is there has another mark or another process writes it, and
    /// errors of `row`.
    pub fn open(
        target: &Path,
        mark: &str,
        header: &[u8],
        row: impl FnMut(&str) -> Result<(), Error>,
    ) -> Result<Growing, Error> {
        // Whether the target can be written shows now, not when all is computed.
        drop(Output::create(target)?);
        let mut part = target.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let file = file_lock::open(&part).map_err(|source| error(&part, source))?;
        let Some(file) = file else {
            return Err(Error::refused(
                format!("another sweep is writing `{}`", part.display()),
                "wait until it is done, or write to another file",
            ));
        };
        let mark = format!("# slider-crank {mark}\n");
        let mut growing = Growing {
            target: target.to_owned(),
            part,
            file,
            mark: mark.len() as u64,
        };
        growing.take_up(&[mark.as_bytes(), header].concat(), row)?;
        Ok(growing)
    }

    fn take_up(
        &mut self,
        head: &[u8],
        mut row: impl FnMut(&str) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let failed = |source| error(&self.part, source);
        let mut reader = BufReader::new(&self.file);
        let (mut found, most) = (Vec::new(), head.len() as u64);
        let mut begun = reader.by_ref().take(most);
        begun.read_to_end(&mut found).map_err(failed)?;
        if !head.starts_with(&found) {
            return Err(self.of_another());
        }
        // Without its whole head it was cut off before its first row.
        let mut whole = if found.len() < head.len() { 0 } else { most };
        let mut text = String::new();
        while whole > 0 && reader.read_line(&mut text).map_err(failed)? > 0 && text.ends_with('\n')
        {
            row(&text)?;
            whole += text.len() as u64;
            text.clear();
        }
        self.file.set_len(whole).map_err(failed)?;
        self.file.seek(SeekFrom::End(0)).map_err(failed)?;
        match whole {
            0 => self.append(head),
            _ => Ok(()),
        }
    }

    /// Adds whole rows.
    pub fn append(&mut self, rows: &[u8]) -> Result<(), Error> {
        let written = self.file.write_all(rows);
        written.map_err(|source| error(&self.part, source))
    }

    /// Gives the rows, without the first line, the name of the target.
    pub fn finish(mut self) -> Result<(), Error> {
        let failed = |source| error(&self.part, source);
        let mut output = Output::create(&self.target)?;
        self.file.seek(SeekFrom::Start(self.mark)).map_err(failed)?;
        let mut buffer = vec![0; 1 << 16];
        loop {
            match self.file.read(&mut buffer).map_err(failed)? {
                0 => break,
                length => output.write(&buffer[..length])?,
            }
        }
        output.finish()?;
        // Where a file that is open cannot be deleted it is closed first.
        #[cfg(not(unix))]
        drop(self.file);
        std::fs::remove_file(&self.part).map_err(|source| error(&self.part, source))
    }

    /// The refusal of rows that belong to something else.
    pub fn of_another(&self) -> Error {
        let part = self.part.display();
        Error::refused(
            format!("`{part}` holds rows of another sweep that was cut off"),
            format!("delete `{part}` to begin anew, or write to another file"),
        )
    }
}

fn error(part: &Path, source: io::Error) -> Error {
    Error::Write {
        target: part.display().to_string(),
        source,
    }
}
