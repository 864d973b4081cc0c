//! Output files: complete under their final name, or absent.

use std::fs;

use super::program::{Folder, ROCKER, driven, free};

const GOOD: &str = "duration = \"0.1 s\"";

#[test]
fn a_file_holds_what_standard_output_would_show() {
    for scene in [free(GOOD), driven(GOOD)] {
        let folder = Folder::with(&scene);
        for command in ["simulate", "kinematics"] {
            let to_file = folder
                .run(&[command, "scene.toml", "--out", "rows.csv"])
                .done();
            assert!(!to_file.stdout.is_empty(), "the summary");
            let streamed = folder.run(&[command, "scene.toml", "--out", "-"]);
            assert_eq!(streamed.code, Some(0));
            assert_eq!(streamed.stdout, folder.read("rows.csv"));
        }
        assert_eq!(
            folder.names(),
            ["rows.csv", "scene.toml"],
            "nothing else is left"
        );
    }
}

#[test]
fn the_file_may_be_in_another_folder() {
    let folder = Folder::with(&free(GOOD));
    fs::create_dir(folder.path("results")).expect("a folder");
    folder
        .run(&["simulate", "scene.toml", "--out", "results/rows.csv"])
        .done();
    folder
        .run(&["simulate", "scene.toml", "--out", "rows.csv"])
        .done();
    assert_eq!(folder.read("results/rows.csv"), folder.read("rows.csv"));
}

#[test]
fn an_older_file_is_replaced() {
    let folder = Folder::with(&free(GOOD));
    folder.write("rows.csv", &"old\n".repeat(100_000));
    folder
        .run(&["simulate", "scene.toml", "--out", "rows.csv"])
        .done();
    assert!(folder.read("rows.csv").starts_with("t_s,"));
    assert!(!folder.read("rows.csv").contains("old"));
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let folder = Folder::with(&free(GOOD));
    folder.write("there.csv", "old\n");
    fs::create_dir(folder.path("results")).expect("a folder");
    for target in ["there.csv", "results/new.csv"] {
        let link = folder.path("link.csv");
        std::os::unix::fs::symlink(target, &link).expect("a link");
        folder
            .run(&["simulate", "scene.toml", "--out", "link.csv"])
            .done();
        assert!(folder.read(target).starts_with("t_s,"), "{target}");
        assert_eq!(fs::read_link(&link).expect("a link").to_str(), Some(target));
        fs::remove_file(link).expect("no link");
    }
}

#[test]
fn a_missing_folder_is_named_and_not_made() {
    let folder = Folder::with(&free(GOOD));
    for command in ["simulate", "kinematics"] {
        let outcome = folder.run(&[command, "scene.toml", "--json", "--out", "missing/rows.csv"]);
        let outcome = outcome.fails(1, &["missing/rows.csv", "cannot be written"]);
        // Users should not see the temporary name of an incomplete file.
        assert!(!outcome.stderr.contains(".slider-crank-"), "{outcome:?}");
    }
    // All outputs are opened before the first one is written.
    let outputs = ["--out", "rows.csv", "--plot", "missing/figure.svg"];
    for command in ["simulate", "kinematics", "statics", "precision"] {
        let arguments = [&[command, "scene.toml"], &outputs[..]].concat();
        folder
            .run(&arguments)
            .fails(1, &["missing/figure.svg", "cannot be written"]);
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn a_folder_is_not_a_file() {
    let folder = Folder::with(&free(GOOD));
    fs::create_dir(folder.path("results")).expect("a folder");
    for command in ["simulate", "kinematics"] {
        for target in ["results", "results/", "."] {
            let outcome = folder.run(&[command, "scene.toml", "--json", "--out", target]);
            outcome.fails(1, &[target, "folder"]);
        }
    }
    assert_eq!(folder.names(), ["results", "scene.toml"]);
    assert_eq!(
        fs::read_dir(folder.path("results"))
            .expect("a folder")
            .count(),
        0
    );
}

/// Scenes that fail after reading, and scenes that cannot be read.
#[test]
fn a_scene_that_fails_leaves_no_file_and_keeps_the_older_one() {
    let no_inertia = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[run]\nduration = \"1 s\"\n";
    let out_of_reach = format!("{ROCKER}\n[motion]\nangle = \"90 deg\"\nspeed = \"1 rad/s\"\n");
    for scene in [
        "[geometry]\ncrank = \"50 mm\"\n".to_owned(),
        free("duration = \"-1 s\""),
        free(""),
        no_inertia.to_owned(),
        out_of_reach.replace("[motion]", "[motion]\nkind = \"constant-speed\""),
        out_of_reach,
    ] {
        let folder = Folder::with(&scene);
        folder
            .run(&["simulate", "scene.toml", "--json", "--out", "rows.csv"])
            .fails(2, &[]);
        assert_eq!(folder.names(), ["scene.toml"], "{scene}");
        folder.write("rows.csv", "from before\n");
        folder
            .run(&["simulate", "scene.toml", "--json", "--out", "rows.csv"])
            .fails(2, &[]);
        assert_eq!(folder.read("rows.csv"), "from before\n", "{scene}");
        assert_eq!(folder.names(), ["rows.csv", "scene.toml"], "{scene}");
    }
}

/// A named pipe, like a device, is written to and not replaced by a file.
#[cfg(target_os = "linux")]
#[test]
fn a_named_pipe_stays_a_pipe() {
    use std::io::Read;
    use std::os::unix::fs::FileTypeExt;

    let folder = Folder::with(&free("duration = \"0.1 s\"\noutput_every = \"1 s\""));
    let pipe = folder.path("rows");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo").success());
    // Open at both ends, so that neither side waits for the other.
    let mut reader = fs::File::options()
        .read(true)
        .write(true)
        .open(&pipe)
        .expect("a pipe");
    folder
        .run(&["simulate", "scene.toml", "--out", "rows"])
        .done();
    assert!(
        fs::metadata(&pipe).expect("the pipe").file_type().is_fifo(),
        "it is a file now"
    );
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut bytes = vec![0; 1 << 16];
        let count = reader.read(&mut bytes).expect("bytes");
        sender.send(String::from_utf8_lossy(&bytes[..count]).into_owned())
    });
    let rows = receiver
        .recv_timeout(std::time::Duration::from_secs(10))
        .expect("rows in the pipe");
    assert!(rows.starts_with("t_s,"), "{rows}");
}

/// Applies to systems with unnamed files.
#[cfg(target_os = "linux")]
#[test]
fn a_run_that_is_stopped_leaves_nothing() {
    let folder = Folder::with(&free("revolutions = 100000\noutput_every = \"1 deg\""));
    folder.write("rows.csv", "old");
    let mut child = folder.start(&["simulate", "scene.toml", "--out", "rows.csv"]);
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(
        child.try_wait().expect("a state").is_none(),
        "it ran too fast"
    );
    child.kill().expect("it is stopped");
    child.wait().expect("an end");
    assert_eq!(folder.names(), ["rows.csv", "scene.toml"]);
    assert_eq!(folder.read("rows.csv"), "old");
}

/// A PNG states its width and height; a PDF states its page size in points, 72 to an inch.
#[test]
fn figures_are_written_as_their_endings_say() {
    let folder = Folder::with(&free(GOOD));
    let written = |command: &[&str], name: &str| {
        folder.run(&[command, &["--plot", name]].concat()).done();
        std::fs::read(folder.path(name)).expect("a figure")
    };
    for command in [
        &["simulate", "scene.toml"][..],
        &["kinematics", "scene.toml"],
        &["statics", "scene.toml"],
        &["inverse"],
        &[
            "precision",
            "scene.toml",
            "--repeats",
            "1",
            "--tolerances",
            "1e-6",
        ],
    ] {
        let svg = String::from_utf8(written(command, "x.svg")).expect("a text");
        let size = |name: &str| -> f64 {
            let after = svg.split(&format!("{name}=\"")).nth(1).expect("a size");
            let number = after.split('"').next().expect("a number");
            number.parse().expect("a number")
        };
        let [width, height] = ["width", "height"].map(size);
        let png = written(command, "x.PNG");
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
        let side = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().expect("four bytes"));
        assert_eq!(
            [side(16), side(20)].map(f64::from),
            [2.0 * width, 2.0 * height]
        );
        let pdf = written(command, "x.pdf");
        assert!(pdf.starts_with(b"%PDF-") && pdf.windows(5).any(|part| part == b"%%EOF"));
        let text = String::from_utf8_lossy(&pdf);
        let page = text.split("/MediaBox").nth(1).expect("a page");
        let wanted = format!("{}", 0.75 * width);
        assert!(
            page.split(']')
                .next()
                .is_some_and(|page| page.contains(&wanted)),
            "{wanted}"
        );
    }
}

#[test]
fn a_figure_has_the_ending_of_its_format() {
    let folder = Folder::with(&free(GOOD));
    for command in ["simulate", "kinematics", "statics", "precision"] {
        let words = ["x.jpg", "write it to `x.svg`"];
        let arguments = [command, "scene.toml", "--plot", "x.jpg"];
        folder.run(&arguments).fails(2, &words);
    }
    folder
        .run(&["inverse", "--plot", "x.jpg"])
        .fails(2, &["x.jpg"]);
    let page = ["simulate", "scene.toml", "--report", "x.pdf"];
    folder.run(&page).fails(2, &["x.pdf", "x.html"]);
    for name in ["x.svg", "X.SVG", "figure"] {
        folder
            .run(&["kinematics", "scene.toml", "--plot", name])
            .done();
    }
    assert_eq!(folder.names(), ["X.SVG", "figure", "scene.toml", "x.svg"]);
}

#[test]
fn a_write_protected_file_stays_as_it_is() {
    let folder = Folder::with(&free(GOOD));
    folder.write("rows.csv", "precious\n");
    let file = folder.path("rows.csv");
    let mut permissions = fs::metadata(&file).expect("a file").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).expect("a change");
    for command in ["simulate", "kinematics", "statics"] {
        let words = ["rows.csv", "cannot be written"];
        folder
            .run(&[command, "scene.toml", "--out", "rows.csv"])
            .fails(1, &words);
    }
    let sweep = [
        "sweep",
        "scene.toml",
        "--vary",
        "geometry.offset=0mm,1mm",
        "--out",
        "rows.csv",
    ];
    folder.run(&sweep).fails(1, &["rows.csv"]);
    assert_eq!(folder.read("rows.csv"), "precious\n");
    assert_eq!(folder.names(), ["rows.csv", "scene.toml"]);
}

#[cfg(unix)]
#[test]
fn rows_of_a_sweep_are_not_written_through_a_link() {
    let folder = Folder::with(&free(GOOD));
    folder.write("precious.txt", "");
    let link = folder.path("rows.csv.part");
    std::os::unix::fs::symlink("precious.txt", link).expect("a link");
    let sweep = [
        "sweep",
        "scene.toml",
        "--vary",
        "geometry.offset=0mm,1mm",
        "--out",
        "rows.csv",
    ];
    folder.run(&sweep).fails(1, &["rows.csv.part", "link"]);
    assert_eq!(
        folder.names(),
        ["precious.txt", "rows.csv.part", "scene.toml"]
    );
    assert_eq!(folder.read("precious.txt"), "");
}
