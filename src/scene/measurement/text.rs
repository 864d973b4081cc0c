//! The text of a data file.

use std::path::Path;

use crate::scene::{Problem, Problems};

/// How files begin that are no plain text, and what they are.
const NO_TEXT: [(&[u8], &str); 4] = [
    (&[0xff, 0xfe], "UTF-16 text"),
    (&[0xfe, 0xff], "UTF-16 text"),
    (
        b"PK\x03\x04",
        "an archive, as workbooks of spreadsheets are",
    ),
    (&[0x1f, 0x8b], "compressed"),
];

/// The text of a file, or where it stops being one.
pub(super) fn text(file: &Path, bytes: Vec<u8>) -> Result<String, Problems> {
    let wrong = |what: String| {
        let help = "save the data as plain CSV text in UTF-8";
        Problems::in_file(file, "", vec![Problem::new("", what, help)])
    };
    if let Some((_, kind)) = NO_TEXT.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Err(wrong(format!("the file is {kind}")));
    }
    let line = |at: usize| bytes[..at].iter().filter(|b| **b == b'\n').count() + 1;
    if bytes.contains(&0) {
        let at = bytes.iter().take_while(|byte| **byte != 0).count();
        return Err(wrong(format!(
            "line {}: the file is not text, it has a zero byte",
            line(at)
        )));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let bytes = error.as_bytes();
            let line = bytes[..at].iter().filter(|b| **b == b'\n').count() + 1;
            let start = bytes[..at]
                .iter()
                .rposition(|b| *b == b'\n')
                .map_or(0, |n| n + 1);
            Err(wrong(format!(
                "line {line}, column {}: the byte 0x{:02x} is not UTF-8 text",
                at - start + 1,
                bytes[at]
            )))
        }
    }
}

/// A text whose lines end with line feeds, as those of old systems with carriage returns alone do not.
pub(super) fn with_line_feeds(text: String) -> String {
    if !text.contains('\n') && text.contains('\r') {
        text.replace('\r', "\n")
    } else {
        text
    }
}
