//! Rows of plain numbers are read in parallel pieces: samples and messages must equal those of reading the whole text.

use std::path::Path;

use slider_crank::scene::{Measurement, Problems, Reading};

/// Style of a file.
#[derive(Clone, Copy, Debug)]
struct Style {
    delimiter: &'static str,
    end: &'static str,
    /// Text between some of the rows.
    between: &'static str,
    pad: &'static str,
    more: &'static str,
}

const PLAIN: Style = Style {
    delimiter: ",",
    end: "\n",
    between: "",
    pad: "",
    more: "",
};

/// Number of rows, enough for several pieces of text.
const ROWS: usize = 60_000;

fn numbers(row: usize) -> [String; 2] {
    let value = 1.5 + 1e-3 * (row as f64).sqrt();
    let value = match row % 3 {
        0 => format!("{value:.9}"),
        1 => format!("{value:e}"),
        _ => format!("+{value}"),
    };
    [format!("{:.6}", 1e-4 * row as f64), value]
}

fn text(style: &Style, cell: impl Fn(usize, &str) -> String) -> String {
    let Style {
        delimiter,
        end,
        between,
        pad,
        more,
    } = style;
    let mut text = format!("t [s]{delimiter}theta [rad]");
    for _ in more.chars() {
        text += &format!("{delimiter}other");
    }
    text += end;
    for row in 0..ROWS {
        let [time, value] = numbers(row);
        text += &format!("{pad}{time}{pad}{delimiter}{}", cell(row, &value));
        for letter in more.chars() {
            text += &format!("{delimiter}{letter}");
        }
        text += end;
        if row % 1000 == 17 {
            text += between;
        }
    }
    text
}

fn read(text: String) -> Result<Measurement, Problems> {
    Measurement::parse(Path::new("motion.csv"), text, &Reading::default())
}

#[test]
fn samples_are_those_of_the_whole_text() {
    let styles = [
        PLAIN,
        Style {
            end: "\r\n",
            between: "\r\n# a comment, with \u{3b8}\r\n",
            ..PLAIN
        },
        Style {
            delimiter: ";",
            between: "\n\n#\n",
            pad: "  ",
            more: "ab",
            ..PLAIN
        },
        Style {
            delimiter: "\t",
            end: "\r",
            ..PLAIN
        },
    ];
    for style in styles {
        let plain = read(text(&style, |_, value| value.to_owned())).expect("numbers");
        // A quote makes the reader take the file as a whole.
        let quoted = |row, value: &str| match row {
            40_000 => format!("\"{value}\""),
            _ => value.to_owned(),
        };
        let quoted = read(text(&style, quoted)).expect("numbers");
        assert_eq!(plain.len(), ROWS, "{style:?}");
        for row in 0..ROWS {
            let [time, value] = numbers(row).map(|text| text.parse::<f64>().expect("a number"));
            let found = [plain.times()[row], plain.values()[row]];
            assert_eq!(found, [time, value], "{style:?}, row {row}");
        }
        assert_eq!(plain.times(), quoted.times());
        assert_eq!(plain.values(), quoted.values());
        assert_eq!(plain.resolution(), quoted.resolution());
        assert_eq!(plain.place(ROWS - 1), quoted.place(ROWS - 1));
    }
}

#[test]
fn a_wrong_row_among_many_is_found() {
    for (wrong, what) in [
        ("1.5x", "`1.5x` is not a number"),
        ("", "the value is missing"),
        ("inf", "`inf` is not a finite number"),
        ("1,5", "3 values where the header has 2 columns"),
    ] {
        let damaged = |row, value: &str| match row {
            50_000 => wrong.to_owned(),
            _ => value.to_owned(),
        };
        let problems = read(text(&PLAIN, damaged)).expect_err("a wrong row");
        let shown = problems.to_string();
        assert!(shown.contains(what), "{shown}");
        assert!(shown.contains("50002"), "{shown}");
    }
}

/// Five significant digits from 0.1 to 1000: larger numbers have fewer decimals, and trailing zeros are omitted.
#[test]
fn digits_are_those_of_values_of_each_size() {
    let digits = |row: usize| {
        let value = 0.1 * 10f64.powf(4.0 * row as f64 / ROWS as f64);
        let decimals = 4 - value.log10().floor() as i32;
        let text = format!("{value:.*}", decimals.max(0) as usize);
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        }
    };
    let found = read(text(&PLAIN, |row, _| digits(row))).expect("numbers");
    // A quarter of the rows each have the resolution 1e-5, 1e-4, 1e-3 and 1e-2.
    let squares: f64 = (2..6).map(|k| 100f64.powi(-k)).sum();
    let expected = (squares / 4.0).sqrt();
    assert!((found.resolution() / expected - 1.0).abs() < 1e-3);
    // Equal numbers of decimals, except for trailing zeros.
    let plain = |row: usize| (2.0 + 1e-4 * row as f64).to_string();
    let found = read(text(&PLAIN, |row, _| {
        plain(row)[..6.min(plain(row).len())].to_owned()
    }));
    assert_eq!(found.expect("numbers").resolution(), 1e-4);
}
