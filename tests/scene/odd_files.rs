//! Data files as instruments, spreadsheets and scripts write them: read correctly, or refused with the option that
//! describes the columns; never misread silently.

use std::f64::consts::PI;
use std::path::Path;

use slider_crank::scene::{Measured, Measurement, Reading, load_table};

const TURN: f64 = 2.0 * PI;

/// Returns time and value of a row, the same in all files: s, rad.
fn sample(row: usize) -> [f64; 2] {
    [0.25 * row as f64, 0.5 + 0.125 * row as f64]
}

/// Returns rows of a file, with time and motion in units of these sizes.
fn rows(separator: &str, [time, motion]: [f64; 2]) -> String {
    let row = |row| {
        let [t, value] = sample(row);
        format!("{}{separator}{}\n", t / time, value / motion)
    };
    (0..8).map(row).collect()
}

fn plain(header: &str) -> String {
    format!("{header}\n{}", rows(",", [1.0, 1.0]))
}

fn load(bytes: &[u8], reading: &Reading) -> Result<Measurement, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("data.csv");
    std::fs::write(&file, bytes).expect("a file");
    Measurement::load(&file, reading).map_err(|error| error.to_string())
}

fn with(set: impl FnOnce(&mut Reading)) -> Reading {
    let mut reading = Reading::default();
    set(&mut reading);
    reading
}

fn named(time: &str, motion: &str) -> Reading {
    with(|reading| {
        reading.time = (!time.is_empty()).then(|| time.to_owned());
        reading.motion = (!motion.is_empty()).then(|| motion.to_owned());
    })
}

#[track_caller]
fn is_read(bytes: &[u8], reading: &Reading, measured: Measured) -> Measurement {
    let shown = String::from_utf8_lossy(bytes).into_owned();
    let found = load(bytes, reading).unwrap_or_else(|error| panic!("{shown}\n{error}"));
    assert_eq!((found.measured(), found.len()), (measured, 8), "{shown}");
    for row in 0..8 {
        let [t, value] = sample(row);
        assert!(
            (found.times()[row] - t).abs() < 1e-12,
            "{shown}: {:?}",
            found.times()
        );
        assert!(
            (found.values()[row] - value).abs() < 1e-12,
            "{shown}: {:?}",
            found.values()
        );
    }
    found
}

#[test]
fn encodings() {
    let text = format!("t [s];\u{3b8} [\u{b0}]\n{}", rows(";", [1.0, PI / 180.0]));
    let utf16 = |join: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(join).collect::<Vec<u8>>();
    let marked = |mark: [u8; 2], bytes: &[u8]| [&mark, bytes].concat();
    let little = utf16(u16::to_le_bytes);
    for bytes in [
        little.clone(),
        marked([0xff, 0xfe], &little),
        utf16(u16::to_be_bytes),
        marked([0xfe, 0xff], &utf16(u16::to_be_bytes)),
    ] {
        let found = is_read(&bytes, &Reading::default(), Measured::Theta);
        assert!(found.notes().join("\n").contains("UTF-16"));
    }
    let marked = format!("\u{feff}{text}");
    assert!(
        is_read(marked.as_bytes(), &Reading::default(), Measured::Theta)
            .notes()
            .is_empty()
    );
    let latin = format!(
        "% Messung f\u{fc}r M\u{fc}ller \u{201e}A\u{201c}\nZeit [s];Kurbelwinkel [\u{b0}]\n{}",
        rows(";", [1.0, PI / 180.0])
    );
    let byte = |c: char| match c {
        '\u{201e}' => 0x84,
        '\u{201c}' => 0x93,
        c => c as u8,
    };
    let bytes: Vec<u8> = latin.chars().map(byte).collect();
    let notes = is_read(&bytes, &Reading::default(), Measured::Theta)
        .notes()
        .join("\n");
    assert!(
        notes.contains("Windows-1252") && notes.contains("taken as the crank angle"),
        "{notes}"
    );
    let cut = &little[..little.len() - 1];
    assert!(
        load(cut, &Reading::default())
            .unwrap_err()
            .contains("cut off")
    );
    for (bytes, what) in [
        (&b"PK\x03\x04\xff"[..], "an archive"),
        (&[0x1f, 0x8b, 8, 0, 0, 0, 0], "compressed"),
        (b"t [s],theta [rad]\n0,\0,\n1,2,\0\0", "zero byte"),
    ] {
        let error = load(bytes, &Reading::default()).unwrap_err();
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn comments_separators_and_units_below_the_header() {
    let body = rows(",", [1.0, 1.0]);
    for text in [
        format!("# of a logger\n% of MATLAB\n; of an INI file\n\nt [s],theta [rad]\n{body}\n\n"),
        format!("sep=,\nt [s],theta [rad]\n{body}"),
        format!(
            "\"sep=,\"\r\nt [s],theta [rad]\r\n{}",
            body.replace('\n', "\r\n")
        ),
        format!("sep=|\nt [s]|theta [rad]\n{}", rows("|", [1.0, 1.0])),
        format!("t,theta\ns,rad\n{body}"),
        format!("t,theta\n[s],(rad)\n{body}"),
        format!("time;theta\n[s];[rad]\n{}", rows(";", [1.0, 1.0])),
        // Output of numpy.savetxt, and a spreadsheet with empty columns and rows.
        format!("# t [s],theta [rad]\n{body}"),
        format!("t [s],theta [rad],,\n{},,,\n", body.replace('\n', ",,\n")),
        format!(
            "\"t [s]\",\"theta [rad]\"\n{}",
            body.replace(',', "\",\"")
                .replace('\n', "\"\n")
                .lines()
                .map(|row| format!("\"{row}\n"))
                .collect::<String>()
        ),
        body.replace('\n', "\r")
            .replacen("0,", "t [s],theta [rad]\r0,", 1),
    ] {
        is_read(text.as_bytes(), &Reading::default(), Measured::Theta);
    }
    let comma = with(|reading| reading.decimal_comma = true);
    let text = format!(
        "Zeit [s];Winkel [rad]\n{}",
        rows(";", [1.0, 1.0]).replace('.', ",")
    );
    is_read(text.as_bytes(), &comma, Measured::Theta);
    let text = format!("log of today\nrig 4, run 7\n{}", plain("t [s],theta [rad]"));
    is_read(
        text.as_bytes(),
        &with(|reading| reading.skip = 2),
        Measured::Theta,
    );
    let error = load(text.as_bytes(), &Reading::default()).unwrap_err();
    assert!(
        error.contains("--time") && error.contains("--skip"),
        "{error}"
    );
}

#[test]
fn words_of_headers() {
    for (header, sizes, measured) in [
        (
            "time [ms],Crank angle (deg)",
            [1e-3, PI / 180.0],
            Measured::Theta,
        ),
        ("Zeit_ms,Winkel_deg", [1e-3, PI / 180.0], Measured::Theta),
        ("t_s,crank_angle_rad", [1.0, 1.0], Measured::Theta),
        ("Time (s),angle / rev", [1.0, TURN], Measured::Theta),
        ("t / ms,slider position / mm", [1e-3, 1e-3], Measured::X),
        ("t s,x mm", [1.0, 1e-3], Measured::X),
        ("\u{feff}t[s],slider_position_mm", [1.0, 1e-3], Measured::X),
        ("t/ms,theta/(deg)", [1e-3, PI / 180.0], Measured::Theta),
        ("t_s,θ (degrees)", [1.0, PI / 180.0], Measured::Theta),
        (
            "\"time, ms\",theta deg",
            [1e-3, PI / 180.0],
            Measured::Theta,
        ),
    ] {
        let text = format!("{header}\n{}", rows(",", sizes));
        let found = is_read(text.as_bytes(), &Reading::default(), measured);
        let is_own_name = ["x mm", "theta/(deg)", "θ (degrees)", "theta deg"]
            .iter()
            .any(|name| header.ends_with(name));
        assert_eq!(
            found.notes().is_empty(),
            is_own_name,
            "{header}: {:?}",
            found.notes()
        );
    }
}

#[test]
fn columns_that_are_named() {
    let text = plain("channel 1,channel 2");
    is_read(
        text.as_bytes(),
        &named("channel 1[s]", "channel 2 [rad]"),
        Measured::Theta,
    );
    is_read(text.as_bytes(), &named("1[s]", "2[rad]"), Measured::Theta);
    is_read(text.as_bytes(), &named("1[s]", "2[m]"), Measured::X);
    // Without any header, and with the columns exchanged.
    is_read(
        rows(",", [1.0, 1.0]).as_bytes(),
        &named("1[s]", "2[rad]"),
        Measured::Theta,
    );
    let turned: String = (0..8)
        .map(sample)
        .map(|[t, value]| format!("{value},{t}\n"))
        .collect();
    is_read(turned.as_bytes(), &named("2[s]", "1[rad]"), Measured::Theta);
    let gamma = Reading {
        column: Some(Measured::Gamma),
        ..named("1[s]", "2[rad]")
    };
    is_read(text.as_bytes(), &gamma, Measured::Gamma);
    // A unit in the option overrides the one in the header.
    let text = format!("t [s],theta [rad]\n{}", rows(",", [1e-3, 1.0]));
    is_read(text.as_bytes(), &named("t[ms]", ""), Measured::Theta);
    // Selection among several columns.
    let rows: String = (0..8)
        .map(sample)
        .map(|[t, value]| format!("{t},7,{value},3\n"))
        .collect();
    let text = format!("t [s],crank angle raw [rad],crank angle [rad],angle [rad]\n{rows}");
    let error = load(text.as_bytes(), &Reading::default()).unwrap_err();
    assert!(
        error.contains("two columns `crank angle [rad]` and `angle [rad]`")
            && error.contains("--motion \"3\""),
        "{error}"
    );
    is_read(text.as_bytes(), &named("", "3"), Measured::Theta);
    is_read(text.as_bytes(), &named("", "Crank angle"), Measured::Theta);
}

#[test]
fn counts_of_an_encoder_and_the_zero_of_a_ruler() {
    let step = TURN / 1000.0;
    let counts: String = (0..8)
        .map(|row| format!("{},{}\n", 0.25 * f64::from(row), 100 + 25 * row))
        .collect();
    let reading = |motion: &str| Reading {
        counts_per_turn: Some(1000),
        ..named("", motion)
    };
    for (header, motion) in [
        ("t [s],counts", ""),
        ("t [s],encoder [counts]", ""),
        ("t [s],channel A", "2"),
        ("t [s],channel A", "2[counts]"),
    ] {
        let text = format!("{header}\n{counts}");
        let found = load(text.as_bytes(), &reading(motion))
            .unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!(found.measured(), Measured::Theta);
        assert!(
            (found.resolution() - step).abs() < 1e-15,
            "{}",
            found.resolution()
        );
        for (row, value) in found.values().iter().enumerate() {
            assert!((value - step * (100 + 25 * row) as f64).abs() < 1e-12);
        }
    }
    let text = format!("t [s],counts\n{counts}");
    assert!(
        load(text.as_bytes(), &Reading::default())
            .unwrap_err()
            .contains("--counts-per-turn")
    );
    let error = load(plain("t [s],theta [deg]").as_bytes(), &reading("")).unwrap_err();
    assert!(
        error.contains("--counts-per-turn belongs to counts"),
        "{error}"
    );
    let text: String = (0..8)
        .map(sample)
        .map(|[t, value]| format!("{t},{}\n", 1000.0 * value + 12.5))
        .collect();
    let text = format!("t [s],x [mm]\n{text}");
    let found = is_read(
        text.as_bytes(),
        &with(|reading| reading.x_zero = 0.0125),
        Measured::X,
    );
    assert_eq!(found.shown(found.values()[0]), "500 mm");
    let error = load(
        plain("t [s],theta [rad]").as_bytes(),
        &with(|reading| reading.x_zero = 0.0125),
    )
    .unwrap_err();
    assert!(error.contains("--x-zero belongs to x"), "{error}");
}

/// Files with unidentifiable columns are refused, with the options that identify them.
#[test]
fn headers_that_say_nothing_are_refused() {
    for (header, reading, parts) in [
        (
            "a,b",
            Reading::default(),
            &[
                "no column holds the time",
                "--time \"1[s]\" --motion \"2[deg]\"",
            ][..],
        ),
        (
            "t [s],b",
            Reading::default(),
            &["no column is called theta, gamma, x or omega", "--motion"],
        ),
        (
            "t,theta",
            Reading::default(),
            &["the column `theta` has no unit"],
        ),
        (
            "t [s],theta",
            Reading::default(),
            &["the column `theta` has no unit", "--motion \"2[deg]\""],
        ),
        (
            "t [s],theta [mm]",
            Reading::default(),
            &["`mm` is not the unit of"],
        ),
        (
            "t [s],speed [m/s]",
            Reading::default(),
            &["`m/s` is not the unit of"],
        ),
        (
            "t [s],p [bar]",
            named("", "2"),
            &["nothing says what `p [bar]` is"],
        ),
        (
            "t [s],b",
            named("", "3[deg]"),
            &["--motion: no column is called `3`"],
        ),
        (
            "t [s],b",
            named("", "winkel[deg]"),
            &["no column is called `winkel`; there are `t [s]`, `b`"],
        ),
        (
            "t [s],time [s]",
            Reading::default(),
            &["two columns `t [s]` and `time [s]`", "--time \"1\""],
        ),
        (
            "t [s],theta [rad]\nfoo,bar",
            Reading::default(),
            &["`foo` is not a number"],
        ),
    ] {
        let text = plain(header);
        let error = load(text.as_bytes(), &reading)
            .map(|found| format!("{found:?}"))
            .unwrap_err();
        for part in parts {
            assert!(error.contains(part), "{header}: {error}");
        }
    }
    let error = load(rows(",", [1.0, 1.0]).as_bytes(), &Reading::default()).unwrap_err();
    assert!(
        error.contains("there is no header: `0` is a number")
            && error.contains("--motion \"2[deg]\""),
        "{error}"
    );
}

/// A reported place is the row and column in the file, whatever lines precede it.
#[test]
fn places_are_those_of_the_file() {
    let text = format!(
        "sep=;\n% note\n\nt [s];theta [rad]\n{}2;\"1,5\"\n",
        rows(";", [1.0, 1.0])
    );
    let error = Measurement::parse(Path::new("data.csv"), text.clone(), &Reading::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("data.csv:13:4") && error.contains("decimal comma"),
        "{error}"
    );
    let error = Measurement::parse(
        Path::new("data.csv"),
        text.replace("\"1,5\"", "\"1.5"),
        &Reading::default(),
    )
    .unwrap_err()
    .to_string();
    assert!(
        error.contains("data.csv:13:3") && error.contains("a quote is not closed"),
        "{error}"
    );
}

/// Tables of loads may have the line ends, marks, comments and separators of data files.
#[test]
fn tables_of_loads_are_files_of_data() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("torque.csv");
    let plain = "theta [deg],torque [N m]\n0,1\n90,2.5\n180,-1\n";
    for text in [
        plain.to_owned(),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        format!("\u{feff}# of a rig\n\n{plain},\n"),
        format!("sep=;\n{}", plain.replace(',', ";")),
        plain.replace(',', "\t").replace("90", "\"90\""),
    ] {
        std::fs::write(&file, &text).expect("a file");
        let table = load_table(&file).expect("no problem").expect("a table");
        assert_eq!((table.rows, table.of.name()), (3, "theta"), "{text}");
    }
}

/// Numbers between blanks, as numpy and MATLAB write them.
#[test]
fn blanks_separate_numbers() {
    let rows = rows("   ", [1.0, PI / 180.0]);
    let columns = with(|reading| reading.columns = Some("t [s],theta [deg]".to_owned()));
    is_read(rows.as_bytes(), &columns, Measured::Theta);
    is_read(rows.as_bytes(), &named("1[s]", "2[deg]"), Measured::Theta);
    let headed = format!("# t_s theta_deg\n{rows}");
    is_read(headed.as_bytes(), &Reading::default(), Measured::Theta);
}

/// The position of an encoder is an angle, that of a slider a length.
#[test]
fn the_unit_of_a_position_says_what_it_is() {
    let angle = format!("t [s],Position [deg]\n{}", rows(",", [1.0, PI / 180.0]));
    is_read(angle.as_bytes(), &Reading::default(), Measured::Theta);
    is_read(angle.as_bytes(), &named("", "2[deg]"), Measured::Theta);
    let length = format!("t [s],Position [mm]\n{}", rows(",", [1.0, 1e-3]));
    is_read(length.as_bytes(), &Reading::default(), Measured::X);
}

/// `Grad` is a degree in German, not 1e9 rad.
#[test]
fn an_angle_takes_no_prefix_of_multiples() {
    for unit in ["Grad", "krad", "Mrad"] {
        let text = format!("t [s],theta [{unit}]\n{}", rows(",", [1.0, 1.0]));
        let said = load(text.as_bytes(), &Reading::default()).expect_err("no unit");
        assert!(said.contains(unit), "{said}");
    }
    let text = format!("t [s],theta [mrad]\n{}", rows(",", [1.0, 1e-3]));
    is_read(text.as_bytes(), &Reading::default(), Measured::Theta);
}

/// 20.171 counts are 20171 with a German separator of thousands.
#[test]
fn counts_that_are_not_whole_are_named() {
    let text = "t [s],count\n0,998\n1,1.002\n2,1.007\n3,1.011\n4,1.016\n5,1.020\n";
    let counts = with(|reading| reading.counts_per_turn = Some(3600));
    let notes = load(text.as_bytes(), &counts)
        .expect("counts")
        .notes()
        .join("\n");
    assert!(notes.contains("1.002 counts at line 3"), "{notes}");
    let whole = text.replace('.', "");
    let notes = load(whole.as_bytes(), &counts)
        .expect("counts")
        .notes()
        .join("\n");
    assert!(!notes.contains("whole numbers"), "{notes}");
}

/// Times of 400 and of 700 samples a second in whole milliseconds, and of 400 less a few rows.
#[test]
fn times_rounded_to_coarse_steps_are_even() {
    for (rate, left_out) in [(400.0, &[][..]), (400.0, &[17, 30, 31]), (700.0, &[])] {
        let rows = (0..90).filter(|k| !left_out.contains(k));
        let mut text = "t [ms],theta [rad]\n".to_owned();
        for k in rows.clone() {
            let t = f64::from(k) / rate;
            text += &format!("{:.0},{}\n", 1e3 * t, 3.0 * t);
        }
        let motion = load(text.as_bytes(), &Reading::default()).expect("samples");
        // The times of the ends stay within the written ones.
        let inner = rows.zip(motion.elapsed()).skip(1).take(85);
        for (k, elapsed) in inner {
            let off = elapsed - f64::from(k) / rate;
            assert!(off.abs() < 2e-4, "{rate} {k}: {elapsed}");
        }
    }
}
