//! Resumable file: rows are appended to a file beside the target, which survives an interruption.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::file_lock;
use crate::error::Error;
use crate::report::Output;

/// File `<target>.part` of rows, copied to the target when complete. The first line is a mark that identifies the
/// sweep.
#[derive(Debug)]
pub(super) struct ResumableFile {
    target: PathBuf,
    part: PathBuf,
    file: File,
    /// Length of the first line, bytes.
    mark: u64,
}

impl ResumableFile {
    /// Opens the file of an interrupted run and passes its complete rows to `row`, or starts a new one with `header`.
    /// Refused if the file has another mark or another process writes it.
    pub fn open(
        target: &Path,
        mark: &str,
        header: &[u8],
        row: impl FnMut(&str) -> Result<(), Error>,
    ) -> Result<ResumableFile, Error> {
        // A target that cannot be written fails here, before the computation.
        drop(Output::create(target)?);
        let mut part = target.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let file = file_lock::open(&part).map_err(Error::write(part.display()))?;
        let Some(file) = file else {
            return Err(Error::refused(
                format!("another sweep is writing `{}`", part.display()),
                "wait until it is done, or write to another file",
            ));
        };
        let mark = format!("# slider-crank {mark}\n");
        let mut file_of_rows = ResumableFile {
            target: target.to_owned(),
            part,
            file,
            mark: mark.len() as u64,
        };
        file_of_rows.resume(&[mark.as_bytes(), header].concat(), row)?;
        Ok(file_of_rows)
    }

    fn resume(
        &mut self,
        head: &[u8],
        mut row: impl FnMut(&str) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let failed = Error::write(self.part.display().to_string());
        let mut reader = BufReader::new(&self.file);
        let (mut found, most) = (Vec::new(), head.len() as u64);
        let mut begun = reader.by_ref().take(most);
        begun.read_to_end(&mut found).map_err(&failed)?;
        if !head.starts_with(&found) {
            return Err(self.of_another());
        }
        // An incomplete head means an interruption before the first row.
        let mut whole = if found.len() < head.len() { 0 } else { most };
        let mut text = String::new();
        while whole > 0 && reader.read_line(&mut text).map_err(&failed)? > 0 && text.ends_with('\n')
        {
            row(&text)?;
            whole += text.len() as u64;
            text.clear();
        }
        self.file.set_len(whole).map_err(&failed)?;
        self.file.seek(SeekFrom::End(0)).map_err(&failed)?;
        match whole {
            0 => self.append(head),
            _ => Ok(()),
        }
    }

    /// Appends complete rows.
    pub fn append(&mut self, rows: &[u8]) -> Result<(), Error> {
        let written = self.file.write_all(rows);
        written.map_err(Error::write(self.part.display()))
    }

    /// Copies the rows, without the first line, to the target, and deletes the file.
    pub fn finish(mut self) -> Result<(), Error> {
        let failed = Error::write(self.part.display());
        let mut output = Output::create(&self.target)?;
        self.file
            .seek(SeekFrom::Start(self.mark))
            .map_err(&failed)?;
        let mut buffer = vec![0; 1 << 16];
        loop {
            match self.file.read(&mut buffer).map_err(&failed)? {
                0 => break,
                length => output.write(&buffer[..length])?,
            }
        }
        output.finish()?;
        // Systems other than Unix cannot delete an open file.
        #[cfg(not(unix))]
        drop(self.file);
        std::fs::remove_file(&self.part).map_err(failed)
    }

    /// Returns the refusal of a file that belongs to another sweep.
    pub fn of_another(&self) -> Error {
        let part = self.part.display();
        Error::refused(
            format!("`{part}` holds rows of another sweep that was cut off"),
            format!("delete `{part}` to begin anew, or write to another file"),
        )
    }
}
