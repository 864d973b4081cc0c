//! Reads and decodes text files: scenes, tables, data.

use std::path::Path;

use crate::error::Error;

/// First bytes of files that are not plain text, and what these files are.
const NO_TEXT: [(&[u8], &str); 4] = [
    (&[0xff, 0xfe], "UTF-16 text"),
    (&[0xfe, 0xff], "UTF-16 text"),
    (
        b"PK\x03\x04",
        "an archive, as workbooks of spreadsheets are",
    ),
    (&[0x1f, 0x8b], "compressed"),
];

/// Reads the bytes of a file; `-` is standard input.
pub(super) fn bytes(file: &Path) -> Result<Vec<u8>, Error> {
    let read = if file == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut std::io::stdin(), &mut bytes).map(|_| bytes)
    } else {
        std::fs::read(file)
    };
    read.map_err(Error::read(file))
}

/// Decodes UTF-8 text; the error names the first byte that is no text.
pub(super) fn decoded(bytes: Vec<u8>) -> Result<String, String> {
    if let Some((_, kind)) = NO_TEXT.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Err(format!("the file is {kind}"));
    }
    let valid = std::str::from_utf8(&bytes).map_or_else(|e| e.valid_up_to(), str::len);
    let zero = bytes[..valid].iter().position(|byte| *byte == 0);
    let before = &bytes[..zero.unwrap_or(valid)];
    let Some(byte) = bytes.get(before.len()) else {
        let text = String::from_utf8(bytes).map_err(|error| error.to_string())?;
        return Ok(with_line_feeds(text));
    };
    let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
    let in_line = before.iter().rev().take_while(|byte| **byte != b'\n');
    let column = in_line.count() + 1;
    Err(match byte {
        0 => format!("line {line}: the file is not text, it has a zero byte"),
        byte => format!("line {line}, column {column}: the byte 0x{byte:02x} is not UTF-8 text"),
    })
}

/// Decodes a data file and names its encoding unless it is UTF-8. UTF-16 shows by its byte order mark or zero bytes;
/// all else is read as Windows-1252, which shares digits and unaccented letters with other encodings.
pub(super) fn decoded_from_any(bytes: Vec<u8>) -> Result<(String, Option<&'static str>), String> {
    let join: Option<fn([u8; 2]) -> u16> = match bytes[..] {
        [0xfe, 0xff, ..] | [0, 1..=255, 0, 1..=255, ..] => Some(u16::from_be_bytes),
        [0xff, 0xfe, ..] | [1..=255, 0, 1..=255, 0, ..] => Some(u16::from_le_bytes),
        _ => None,
    };
    if let Some(join) = join {
        let (pairs, rest) = bytes.as_chunks::<2>();
        let text = String::from_utf16(&pairs.iter().map(|pair| join(*pair)).collect::<Vec<u16>>());
        return match text {
            Ok(text) if rest.is_empty() => Ok((text, Some("UTF-16"))),
            _ => Err("the file is UTF-16 text with characters cut off".to_owned()),
        };
    }
    if NO_TEXT.iter().any(|(start, _)| bytes.starts_with(start))
        || bytes.contains(&0)
        || std::str::from_utf8(&bytes).is_ok()
    {
        return decoded(bytes).map(|text| (text, None));
    }
    let letter = |byte: &u8| match byte {
        0x80..0xa0 => WINDOWS_1252
            .chars()
            .nth(usize::from(byte - 0x80))
            .unwrap_or_default(),
        byte => char::from(*byte),
    };
    Ok((bytes.iter().map(letter).collect(), Some("Windows-1252")))
}

/// Characters of the Windows-1252 bytes 0x80 to 0x9f; replacement characters for unused ones.
const WINDOWS_1252: &str = "€\u{fffd}‚ƒ„…†‡ˆ‰Š‹Œ\u{fffd}Ž\u{fffd}\u{fffd}‘’“”•–—˜™š›œ\u{fffd}žŸ";

/// Returns a text with line feeds for carriage returns if lines end with these alone, as on old systems.
pub(super) fn with_line_feeds(text: String) -> String {
    if !text.contains('\n') && text.contains('\r') {
        text.replace('\r', "\n")
    } else {
        text
    }
}
