//! `sweep`: every design agrees with its scene written out, the parts make up the whole, and nothing is lost.

use std::time::Duration;

use serde_json::Value;

use super::program::{Folder, PUMP, at, close, free, same};

const ROW: &str = "design,geometry_offset_m,rod_model,status,class,stroke_m,advance_rad,return_rad,\
time_ratio,transmission_min_rad,velocity_max_m_per_s,velocity_min_m_per_s,acceleration_max_m_per_s2,\
acceleration_min_m_per_s2,engine,t_s,theta_rad,omega_rad_per_s,error_theta_rad,error_omega_rad_per_s,\
revolutions,omega_min_rad_per_s,omega_max_rad_per_s,driving_torque_min_nm,driving_torque_max_nm,\
driving_torque_mean_nm,energy_residual,evaluations,events,notes";

/// Rows of a sweep, with named columns.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(text: &str) -> Table {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names = reader.headers().expect("a header");
        let names = names.iter().map(str::to_owned).collect();
        let rows = reader.records().map(|row| {
            let row = row.expect("rows of equal length");
            row.iter().map(str::to_owned).collect()
        });
        Table {
            names,
            rows: rows.collect(),
        }
    }

    #[track_caller]
    fn text(&self, row: usize, name: &str) -> &str {
        let column = self.names.iter().position(|known| known == name);
        &self.rows[row][column.unwrap_or_else(|| panic!("no column {name}"))]
    }

    #[track_caller]
    fn number(&self, row: usize, name: &str) -> f64 {
        let text = self.text(row, name);
        text.parse().unwrap_or_else(|_| panic!("{name} = `{text}`"))
    }
}

/// Returns a pump with a heavy rod, a motor and a table.
fn pump(offset: &str, model: &str) -> String {
    let scene = free("duration = \"0.5 s\"").replace(
        "rod = \"150 mm\"",
        &format!("rod = \"150 mm\"\noffset = \"{offset}\""),
    );
    format!(
        "{scene}\n[rod]\nmodel = \"{model}\"\nmass = \"0.4 kg\"\ncg = \"60 mm\"\ninertia = \"0.002 kg m^2\"\n\
         [[torque]]\nkind = \"motor\"\nstall = \"5 N m\"\nno_load_speed = \"60 rad/s\"\n\
         [[torque]]\nkind = \"table\"\nfile = \"torque.csv\"\nof = \"theta\"\nperiod = \"360 deg\"\n"
    )
}

const TORQUE: &str = "theta [deg],torque [N m]\n0,0.5\n90,1\n180,-0.5\n270,-1\n360,0.5\n";
const VARY: [&str; 4] = [
    "--vary",
    "geometry.offset=-10mm:20mm:4",
    "--vary",
    "rod.model=rigid,two-mass",
];

fn folder() -> Folder {
    let folder = Folder::with(&pump("3 mm", "rigid"));
    folder.write("torque.csv", TORQUE);
    folder
}

fn sweep(more: &[&str]) -> Vec<String> {
    let words = ["sweep", "scene.toml"].iter().chain(&VARY).chain(more);
    words.map(|word| (*word).to_owned()).collect()
}

#[track_caller]
fn run(folder: &Folder, more: &[&str]) -> super::program::Outcome {
    let arguments = sweep(more);
    folder.run(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Runs the whole sweep; returns its file.
#[track_caller]
fn whole(folder: &Folder) -> String {
    run(folder, &["--out", "whole.csv"]).done();
    folder.read("whole.csv")
}

#[test]
fn every_design_is_the_scene_with_its_values_written_out() {
    let folder = folder();
    let text = whole(&folder);
    assert_eq!(text.lines().next(), Some(ROW));
    let table = Table::read(&text);
    assert_eq!(table.rows.len(), 8);
    for row in 0..8 {
        let (offset, model) = ([-10, 0, 10, 20][row / 2], ["rigid", "two-mass"][row % 2]);
        folder.write("scene.toml", &pump(&format!("{offset} mm"), model));
        let turn = folder.run(&["kinematics", "scene.toml", "--json"]).done();
        let motion = folder.run(&["simulate", "scene.toml", "--json"]).done();
        let (turn, motion) = (turn.json(), motion.json());
        assert_eq!(table.number(row, "design"), row as f64 + 1.0);
        assert_eq!(
            table.number(row, "geometry_offset_m"),
            f64::from(offset) / 1e3
        );
        assert_eq!(table.text(row, "rod_model"), model);
        assert_eq!(table.text(row, "status"), "done");
        let same = |name: &str, of: &Value, path: &str| {
            let (found, wanted) = (table.number(row, name), at(of, path));
            // The JSON reader is accurate to one unit in the last place.
            let error = (found - wanted).abs();
            assert!(
                error <= 4e-16 * wanted.abs(),
                "{name} of design {row}: {found}, {wanted}"
            );
        };
        for name in [
            "stroke_m",
            "advance_rad",
            "return_rad",
            "time_ratio",
            "transmission_min_rad",
        ] {
            same(name, &turn, name);
        }
        same("velocity_max_m_per_s", &turn, "velocity_max.value");
        same("velocity_min_m_per_s", &turn, "velocity_min.value");
        same("acceleration_max_m_per_s2", &turn, "acceleration_max.value");
        same("acceleration_min_m_per_s2", &turn, "acceleration_min.value");
        for name in ["t_s", "theta_rad", "omega_rad_per_s"] {
            same(name, &motion, &format!("final.{name}"));
        }
        same("error_theta_rad", &motion, "error_estimate.theta_rad");
        same(
            "error_omega_rad_per_s",
            &motion,
            "error_estimate.omega_rad_per_s",
        );
        same("omega_min_rad_per_s", &motion, "omega_min");
        same("omega_max_rad_per_s", &motion, "omega_max");
        for name in ["revolutions", "energy_residual", "evaluations"] {
            same(name, &motion, name);
        }
        same("events", &motion, "events_total");
    }
}

#[test]
fn largest_forces_are_those_of_the_scene_with_its_values_written_out() {
    let folder = folder();
    run(&folder, &["--reactions", "--out", "forces.csv"]).done();
    let table = Table::read(&folder.read("forces.csv"));
    assert_eq!(table.rows.len(), 8);
    for row in 0..8 {
        let (offset, model) = ([-10, 0, 10, 20][row / 2], ["rigid", "two-mass"][row % 2]);
        folder.write("scene.toml", &pump(&format!("{offset} mm"), model));
        let simulate = ["simulate", "scene.toml", "--reactions", "--json"];
        let motion = folder.run(&simulate).done().json();
        for name in [
            "crank_bearing",
            "crank_pin",
            "wrist_pin",
            "guide",
            "shaking",
        ] {
            let found = table.number(row, &format!("{name}_peak_n"));
            let wanted = at(&motion, &format!("peaks.{name}.value_n"));
            assert!(found > 0.0);
            same(found, wanted);
        }
    }
    // The other columns equal those of a sweep without these options.
    folder.write("scene.toml", &pump("3 mm", "rigid"));
    let plain = Table::read(&whole(&folder));
    for (name, row) in plain
        .names
        .iter()
        .flat_map(|name| (0..8).map(move |row| (name, row)))
    {
        assert_eq!(
            table.text(row, name),
            plain.text(row, name),
            "{name} of {row}"
        );
    }
    let words = ["largest joint forces", "--no-motion"];
    run(&folder, &["--reactions", "--no-motion"]).fails(2, &words);
    let words = ["figure of the motion", "--no-motion"];
    run(&folder, &["--figures", "omega", "--no-motion"]).fails(2, &words);
}

#[test]
fn strokes_of_offset_mechanisms_are_those_of_the_triangles_at_the_dead_centres() {
    let folder = Folder::with(&free("duration = \"1 s\""));
    let vary = ["--vary", "geometry.offset=-90mm:90mm:19", "--no-motion"];
    let arguments = [&["sweep", "scene.toml", "--out", "rows.csv"], &vary[..]].concat();
    folder.run(&arguments).done();
    let table = Table::read(&folder.read("rows.csv"));
    assert_eq!(table.rows.len(), 19);
    assert!(!table.names.iter().any(|name| name == "engine"));
    for row in 0..19 {
        // Bit-identical to typed values: -90, -80, ... mm.
        let offset: f64 = format!("{}e-3", 10 * row as i32 - 90)
            .parse()
            .expect("a number");
        assert_eq!(table.number(row, "geometry_offset_m"), offset);
        let stroke =
            (0.2f64.powi(2) - offset.powi(2)).sqrt() - (0.1f64.powi(2) - offset.powi(2)).sqrt();
        close(table.number(row, "stroke_m"), stroke, 1e-15);
    }
}

#[test]
fn the_parts_put_one_after_the_other_are_the_whole() {
    let folder = folder();
    let wanted = whole(&folder);
    for parts in [1, 2, 3, 8, 11] {
        let mut all = String::new();
        for part in 1..=parts {
            run(
                &folder,
                &["--shard", &format!("{part}/{parts}"), "--out", "part.csv"],
            );
            all += &folder.read("part.csv");
        }
        assert_eq!(all, wanted, "{parts} parts");
    }
    let shown = run(&folder, &["--out", "-"]);
    assert_eq!((shown.code, shown.stdout), (Some(0), wanted));
    // With more parts than designs, the first parts are empty.
    let none = run(&folder, &["--shard", "1/1000"]);
    assert!(none.stdout.contains(", none of these"), "{none:?}");
    assert_eq!(
        folder.names(),
        ["part.csv", "scene.toml", "torque.csv", "whole.csv"]
    );
}

/// Starts a sweep of many long designs, and kills it once it has rows.
fn cut_off(folder: &Folder, arguments: &[&str]) -> String {
    let mut child = folder.start(arguments);
    let part = folder.path("rows.csv.part");
    let rows = || std::fs::read_to_string(&part).unwrap_or_default();
    for _ in 0..6000 {
        if rows().lines().count() > 20 || child.try_wait().expect("a child").is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().expect("a child");
    child.wait().expect("a child");
    rows()
}

#[test]
fn a_sweep_that_was_killed_goes_on_where_it_ended() {
    let folder = Folder::with(&free("duration = \"400 s\""));
    let vary = "motion.speed=5rad/s:50rad/s:64";
    let arguments = ["sweep", "scene.toml", "--vary", vary, "--method", "time"];
    let arguments = [
        &arguments,
        &["--no-estimate", "--out", "rows.csv", "--json"][..],
    ]
    .concat();
    let left = cut_off(&folder, &arguments);
    assert!(left.lines().count() > 20, "{left}");
    assert!(
        !folder.path("rows.csv").exists(),
        "a result before it was complete"
    );
    let summary = folder.run(&arguments).done().json();
    assert!(at(&summary, "taken_up") >= 16.0, "{summary}");
    assert_eq!(at(&summary, "status.done"), 64.0);
    let rows = folder.read("rows.csv");
    assert_eq!(Table::read(&rows).rows.len(), 64);
    assert_eq!(folder.names(), ["rows.csv", "scene.toml"]);
    // The rows already written are unchanged.
    let left: Vec<&str> = left.lines().skip(1).collect();
    assert!(left.len() > 16 && rows.starts_with(&left[..left.len() - 1].join("\n")));
}

/// A second sweep into a file in use is refused, whether it is the same sweep or another, and leaves the first one
/// undisturbed.
#[test]
fn a_file_that_another_sweep_is_writing_is_left_to_it() {
    let folder = Folder::with(&free("duration = \"400 s\""));
    let sweep = |speeds: &str| {
        let vary = format!("motion.speed={speeds}");
        let words = ["sweep", "scene.toml", "--method", "time", "--no-estimate"];
        let words = words.map(str::to_owned).to_vec();
        [
            words,
            ["--out", "rows.csv", "--vary", &vary]
                .map(str::to_owned)
                .to_vec(),
        ]
        .concat()
    };
    let long = sweep("5rad/s:50rad/s:128");
    let long: Vec<&str> = long.iter().map(String::as_str).collect();
    let mut first = folder.start(&long);
    let part = folder.path("rows.csv.part");
    for _ in 0..6000 {
        if std::fs::read_to_string(&part).is_ok_and(|text| text.lines().count() > 2) {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let before = std::fs::read_to_string(&part).expect("rows of the first");
    let words = ["rows.csv.part", "another sweep", "wait"];
    for speeds in ["5rad/s:50rad/s:128", "5rad/s,6rad/s"] {
        let other = sweep(speeds);
        let other: Vec<&str> = other.iter().map(String::as_str).collect();
        folder.run(&other).fails(2, &words);
    }
    assert_eq!(first.try_wait().expect("a child"), None, "it still runs");
    let after = std::fs::read_to_string(&part).expect("rows of the first");
    assert!(after.starts_with(&before), "left to the first");
    // The lock of a dead process is released.
    first.kill().expect("a child");
    first.wait().expect("a child");
    folder.run(&long).done();
    assert_eq!(Table::read(&folder.read("rows.csv")).rows.len(), 128);
}

#[test]
fn wherever_it_was_cut_off_the_result_is_the_same() {
    let folder = folder();
    let wanted = whole(&folder);
    let mark = mark(&folder);
    let full = format!("{mark}{wanted}");
    for length in (0..full.len())
        .step_by(97)
        .chain([full.len() - 1, full.len()])
    {
        folder.write("whole.csv.part", &full[..length]);
        std::fs::remove_file(folder.path("whole.csv")).expect("a result");
        assert_eq!(whole(&folder), wanted, "cut off after {length} bytes");
        assert_eq!(folder.names(), ["scene.toml", "torque.csv", "whole.csv"]);
    }
}

/// Returns the first line of the file that the interrupted whole sweep leaves.
fn mark(folder: &Folder) -> String {
    let varied = [VARY[1], VARY[3]].map(|text| text.parse().expect("values"));
    let draft = slider_crank::scene::Draft::load(&folder.path("scene.toml")).expect("a scene");
    let options = slider_crank::sweep::SweepOptions::default();
    let sweep = slider_crank::sweep::Sweep::new(draft, varied.to_vec(), options).expect("a sweep");
    format!("# slider-crank sweep {:016x} 0..8\n", sweep.identity())
}

#[test]
fn rows_of_another_scene_are_not_taken_up() {
    let folder = folder();
    let wanted = whole(&folder);
    let mark = mark(&folder);
    let kept: String = wanted.split_inclusive('\n').take(4).collect();
    let left = format!("{mark}{kept}");
    folder.write("whole.csv.part", &left);
    let refused = |words: &[&str]| {
        run(&folder, &["--out", "whole.csv"]).fails(2, words);
        assert_eq!(folder.read("whole.csv.part"), left, "left as it was");
        assert_eq!(folder.read("whole.csv"), wanted, "left as it was");
    };
    folder.write("whole.csv.part", "# nothing of this kind\n");
    let words = ["whole.csv.part", "another sweep", "delete"];
    run(&folder, &["--out", "whole.csv"]).fails(2, &words);
    folder.write("whole.csv.part", &left);
    folder.write("torque.csv", &TORQUE.replace("90,1\n", "90,1.25\n"));
    refused(&["whole.csv.part", "another sweep"]);
    folder.write("torque.csv", TORQUE);
    folder.write(
        "scene.toml",
        &pump("3 mm", "rigid").replace("0.4 kg", "0.5 kg"),
    );
    refused(&["whole.csv.part", "another sweep"]);
}

#[test]
fn designs_that_cannot_be_are_flagged_with_the_reason() {
    let folder = Folder::with(&free("duration = \"0.1 s\""));
    let vary = [
        "--vary",
        "geometry.rod=-20mm:160mm:10",
        "--vary",
        "friction.coefficient=0,0.1",
    ];
    let arguments = [
        &["sweep", "scene.toml", "--json", "--out", "rows.csv"],
        &vary[..],
    ]
    .concat();
    let summary = folder.run(&arguments).done().json();
    let table = Table::read(&folder.read("rows.csv"));
    assert_eq!(table.rows.len(), 20);
    for row in 0..20 {
        let rod = table.number(row, "geometry_rod_m");
        let impossible = rod <= 0.0;
        let status = table.text(row, "status");
        assert_eq!(status == "impossible", impossible, "{rod}: {status}");
        assert_eq!(table.text(row, "stroke_m").is_empty(), impossible);
        assert_eq!(
            table.text(row, "theta_rad").is_empty(),
            status == "impossible" || status == "refused"
        );
        assert!(
            status == "done" || !table.text(row, "notes").is_empty(),
            "{status} without a reason"
        );
        if rod > 0.05 + 1e-9 {
            assert_eq!(status, "done", "{rod}: {}", table.text(row, "notes"));
        }
    }
    assert_eq!(at(&summary, "status.impossible"), 4.0);
    let none = [
        "sweep",
        "scene.toml",
        "--vary",
        "geometry.rod=-2mm,-1mm",
        "--out",
        "none.csv",
    ];
    let ended = folder.run(&none);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(ended.stderr.contains("no design could be computed"));
    assert_eq!(Table::read(&folder.read("none.csv")).rows.len(), 2);
}

#[test]
fn a_run_that_ends_at_the_work_limit_is_flagged() {
    let folder = Folder::with(&free("duration = \"10 s\""));
    let vary = ["--vary", "motion.speed=10rad/s,20rad/s", "--method", "time"];
    let rest = ["--max-evaluations", "500", "--out", "rows.csv"];
    let arguments = [&["sweep", "scene.toml"], &vary[..], &rest].concat();
    folder
        .run(&arguments)
        .complains(1, &["no design could be computed"]);
    let table = Table::read(&folder.read("rows.csv"));
    for row in 0..2 {
        assert_eq!(table.text(row, "status"), "stopped");
        assert!(table.number(row, "t_s") < 10.0);
    }
}

#[test]
fn what_cannot_be_varied_is_refused_with_what_would_be_right() {
    let folder = folder();
    for (vary, words) in [
        (
            "geometry.ofset=0mm:20mm:41",
            &["ofset", "did you mean `offset`"][..],
        ),
        (
            "geometri.offset=0mm:20mm:41",
            &["geometri", "did you mean `geometry`"],
        ),
        ("offset=0mm:20mm:41", &["offset", "geometry.offset"]),
        ("geometry.offset", &["no values", "=0mm:20mm:41"]),
        (
            "geometry.offset=0mm:20mm",
            &["a distribution", "--sample", ":41"],
        ),
        ("geometry.offset=0mm:20mm:2:3:4", &["no range", "count"]),
        ("geometry.offset=20mm:0mm", &["not less"]),
        ("geometry.offset=1 +- 0 mm", &["above 0"]),
        ("geometry.offset=0mm:20mm:0", &["`0`", "number of values"]),
        ("geometry.offset=0mm:20mm:1", &["one value"]),
        ("geometry.offset=0mm:20in:5", &["different units"]),
        ("geometry.offset=0:20:5", &["no unit", "47 mm"]),
        ("geometry.offset=0kg:20kg:5", &["kg", "a length"]),
        ("geometry.offset=0mm:20mm:5:log", &["logarithm"]),
        ("geometry.offset=1mm,,2mm", &["number"]),
        ("rod.model=rigid,ridgid", &["ridgid", "two-mass"]),
        ("torque[0].stall=1Nm,2Nm", &["torque[0]", "from 1 on"]),
        ("torque[3].value=1Nm,2Nm", &["torque[3].value", "2"]),
        ("geometry[2].rod=1m,2m", &["one geometry"]),
        ("title=a,b", &["title"]),
    ] {
        let arguments = ["sweep", "scene.toml", "--vary", vary, "--out", "rows.csv"];
        folder.run(&arguments).fails(2, words);
    }
    for (more, words) in [
        (
            &["--vary", "geometry.rod=1m,2m", "--vary", "geometry.rod=3m"][..],
            &["varied twice"][..],
        ),
        (&[], &["--vary"]),
        (
            &["--vary", "geometry.rod=1m,2m", "--shard", "0/4"],
            &["1/8"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--fluctuation=nan"],
            &["a coefficient of fluctuation of NaN"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--most", "engine"],
            &["`engine` is a word"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--shard", "5/4"],
            &["1/8"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--json", "--out", "-"],
            &["standard output"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--out", "scene.toml"],
            &["overwritten"],
        ),
        (
            &["--vary", "geometry.rod=1m,2m", "--out", "torque.csv"],
            &["overwritten"],
        ),
    ] {
        let arguments = [&["sweep", "scene.toml"], more].concat();
        folder.run(&arguments).fails(2, words);
    }
    folder.write("scene.toml", "[geometry]\ncrank = 5\n");
    let arguments = [
        "sweep",
        "scene.toml",
        "--vary",
        "geometry.rod=1m,2m",
        "--out",
        "rows.csv",
    ];
    folder
        .run(&arguments)
        .fails(2, &["scene.toml:2", "no unit"]);
    assert_eq!(folder.names(), ["scene.toml", "torque.csv"]);
}

/// Named figures of the motion are those among all figures, with the same outcome and notes, and no turn is computed for them: at
/// 108.83 mm of offset the mechanism has a change point, at 120 mm the crank has limits.
#[test]
fn figures_of_the_motion_need_no_turn() {
    use slider_crank::scene::Draft;
    use slider_crank::sweep::{Design, Sweep, SweepOptions};
    let sweep = |figures: &[&str]| {
        let offsets = "geometry.offset=0mm,20mm,108.83mm,120mm".parse();
        let figures = figures.iter().map(|name| name.parse().expect("a figure"));
        let options = SweepOptions {
            figures: figures.collect(),
            ..SweepOptions::default()
        };
        Sweep::new(Draft::duarte(), vec![offsets.expect("values")], options).expect("a sweep")
    };
    let (whole, named) = (sweep(&[]), sweep(&["theta", "omega"]));
    let mut notes = 0;
    for k in 0..4 {
        let [whole, named] = [&whole, &named].map(|sweep| sweep.design(k));
        let last = |design: &Design| {
            let last = design.motion.as_ref().map(|motion| motion.last);
            last.map(|last| [last.theta_rad, last.omega_rad_per_s])
        };
        assert_eq!(last(&named), last(&whole), "{k}");
        assert_eq!(named.outcome, whole.outcome, "{k}");
        assert_eq!(named.notes, whole.notes, "{k}");
        assert!(whole.kinematics.is_some() && named.kinematics.is_none());
        notes += named.notes.len();
    }
    assert!(notes > 2, "{notes}");
}

/// A turn is shared by the designs that it belongs to, and by no others.
#[test]
fn the_turn_of_a_design_is_that_of_its_scene() {
    use slider_crank::kinematics::kinematics;
    use slider_crank::scene::{Crank, Draft, Scene};
    use slider_crank::sweep::{Sweep, SweepOptions};
    let crank = Scene::duarte().crank.expect("a crank");
    let cases = [
        (
            "crank.inertia=0.02kgm^2,0.03kgm^2",
            Scene::duarte().crank(Crank {
                inertia: 0.03,
                ..crank
            }),
        ),
        (
            "motion.speed=20rad/s,-50rad/s",
            Scene::duarte().start(Scene::duarte().motion.angle, -50.0),
        ),
        ("geometry.offset=0mm,10mm", Scene::duarte().offset(0.01)),
    ];
    for (values, scene) in cases {
        let varied = values.parse().expect("values");
        let sweep = Sweep::new(Draft::duarte(), vec![varied], SweepOptions::default());
        let of_design = sweep
            .expect("a sweep")
            .design(1)
            .kinematics
            .expect("a turn");
        let of_scene = kinematics(&scene).expect("a turn");
        assert_eq!(of_design.velocity_max, of_scene.velocity_max, "{values}");
        assert_eq!(of_design.dead_centres, of_scene.dead_centres, "{values}");
    }
}

#[test]
fn what_the_scene_lacks_may_be_varied_in() {
    let folder = Folder::with(&format!("{PUMP}[run]\nduration = \"0.2 s\"\n"));
    let vary = [
        "gravity.acceleration=0m/s^2,9.80665m/s^2",
        "motion.speed=10rad/s:1000rad/s:3:log",
    ];
    let arguments = [
        "sweep",
        "scene.toml",
        "--vary",
        vary[0],
        "--vary",
        vary[1],
        "--out",
        "rows.csv",
    ];
    let shown = folder.run(&arguments).done().stdout;
    for word in [
        "gravity.acceleration",
        "motion.speed",
        "designs",
        "omega_max_rad_per_s",
    ] {
        assert!(shown.contains(word), "no {word} in {shown}");
    }
    let table = Table::read(&folder.read("rows.csv"));
    let speeds: Vec<f64> = (0..3)
        .map(|row| table.number(row, "motion_speed_rad_per_s"))
        .collect();
    assert_eq!((speeds[0], speeds[2]), (10.0, 1000.0));
    close(speeds[1], 100.0, 1e-13);
    // Only the slider has a potential under gravity, and it moves horizontally: nothing changes.
    for row in 0..3 {
        assert_eq!(
            table.number(row, "theta_rad"),
            table.number(row + 3, "theta_rad")
        );
    }
}
