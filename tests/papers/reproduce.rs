//! Verdicts of `reproduce` compared with the known ones, and the numbers behind them with values computed in 40 digits
//! by other software.

use crate::support::close;
use slider_crank::reproduce::{Paper, Reproduction, Verdict, reproduce};

fn all() -> Reproduction {
    reproduce(&Paper::ALL).unwrap()
}

#[test]
fn every_verdict_is_the_known_one() {
    let result = all();
    let surprises: Vec<_> = result.surprises().collect();
    assert!(surprises.is_empty(), "{surprises:#?}");
    for verdict in [Verdict::Reproduces, Verdict::OnlyIf, Verdict::Cannot] {
        let count = result
            .entries
            .iter()
            .filter(|e| e.verdict == verdict)
            .count();
        assert!(count > 20, "{verdict:?}: {count}");
    }
    for entry in &result.entries {
        assert_eq!(
            entry.condition.is_empty(),
            entry.verdict == Verdict::Reproduces,
            "{entry:?}"
        );
        assert!(entry.ours.is_none_or(f64::is_finite), "{entry:?}");
        assert!(entry.conditional.is_none_or(f64::is_finite), "{entry:?}");
    }
}

/// Paper, place, part of the description, our value, and the value under the condition.
const KNOWN: &[(&str, &str, &str, f64, Option<f64>)] = &[
    (
        "obaseki-alfred",
        "(8)",
        "slider position",
        0.05649373433,
        None,
    ),
    (
        "obaseki-alfred",
        "(10)",
        "slider position",
        0.04750626567,
        None,
    ),
    (
        "obaseki-alfred",
        "(13)",
        "slider velocity",
        16.79314860,
        None,
    ),
    (
        "obaseki-alfred",
        "(18)",
        "dv2",
        -1.681694416,
        Some(-1.681694416),
    ),
    (
        "obaseki-alfred",
        "(20)",
        "d2s/dt2",
        939.4781244,
        Some(939.4781244),
    ),
    ("obaseki-alfred", "(27)", "rod", 155.5154753, None),
    ("obaseki-alfred", "(29)", "dv_c", -93.97723228, None),
    ("obaseki-alfred", "(30)", "rod", -23588.28530, None),
    ("obaseki-alfred", "(38)", "reaction", -1463.006229, None),
    ("obaseki-alfred", "(39)", "reaction", 1006.104053, None),
    ("obaseki-alfred", "(40)", "tangential", 1649.963699, None),
    ("obaseki-alfred", "(41)", "axial", 1809.918518, None),
    (
        "obaseki-alfred",
        "(42b)",
        "inertia force",
        986.4520307,
        None,
    ),
    (
        "obaseki-alfred",
        "(48)",
        "driving torque, with (20) mended",
        65.99854797,
        None,
    ),
    ("obaseki-alfred", "(49)", "e = 20 mm", 0.08879230742, None),
    ("obaseki-alfred", "(52)", "at 1 rad", -797.6521238, None),
    ("obaseki-alfred", "(53)", "at 1 rad", -39.38294173, None),
    (
        "obaseki-alfred",
        "4.2.1",
        "crank angle of the return",
        134.6447990,
        Some(172.5748879),
    ),
    (
        "obaseki-alfred",
        "4.2.1",
        "time of the return",
        0.009362530131,
        None,
    ),
    (
        "obaseki-alfred",
        "4.2.1",
        "crank angle of the forward",
        225.3552010,
        Some(186.9561286),
    ),
    (
        "obaseki-alfred",
        "4.2.1",
        "time of the forward",
        0.01567008066,
        None,
    ),
    (
        "obaseki-alfred",
        "4.2.1",
        "time ratio",
        1.673701493,
        Some(13.0 / 12.0),
    ),
    (
        "obaseki-alfred",
        "4.3, figure 16",
        "return stroke, e = 20 mm",
        316.0611128,
        None,
    ),
    (
        "obaseki-alfred",
        "4.3, figure 16",
        "advance stroke, e = 20 mm",
        81.30245599,
        None,
    ),
    (
        "obaseki-alfred",
        "4.3, figure 16",
        "return stroke, e = 10 mm",
        133.7494065,
        None,
    ),
    (
        "obaseki-alfred",
        "4.3, figure 16",
        "advance stroke, e = 10 mm",
        90.42377844,
        None,
    ),
    (
        "obaseki-alfred",
        "4.3, figure 16",
        "advance stroke, e = 0 mm",
        105.0859843,
        None,
    ),
    (
        "obaseki-alfred",
        "table 3",
        "this model, maximum acc",
        12.59437513,
        None,
    ),
    (
        "obaseki-alfred",
        "table 3",
        "existing model, minimum acc",
        -20.99062521,
        None,
    ),
    ("gupta", "(2)", "slider position", 0.1814970640, None),
    ("gupta", "(6)", "rod speed", 8.744117982, None),
    ("gupta", "(7)", "slider velocity", -2.224172530, None),
    ("gupta", "(10)", "rod acceleration", 420.7021035, None),
    ("gupta", "(11)", "slider acceleration", 126.1077347, None),
    ("gupta", "1.2.2", "mass of AB", 0.6552, None),
    ("ng", "discussion", "least force", 88.00926123, None),
    (
        "duarte",
        "(9)",
        "factor of the acceleration",
        0.03006015904,
        None,
    ),
    ("duarte", "(9)", "factor of the speed", 0.001227803339, None),
    (
        "duarte",
        "(9)",
        "half the derivative",
        0.0003039574355,
        Some(0.0003039574355),
    ),
    ("duarte", "(9)", "weight", 0.2039306753, None),
    ("duarte", "(8)", "height", 0.0203551787910, None),
    ("duarte", "(6)", "work", -0.01402229287, None),
];

#[test]
fn ours_are_the_numbers_of_the_mechanics() {
    let result = all();
    for (paper, place, what, ours, conditional) in KNOWN {
        let found: Vec<_> = result
            .entries
            .iter()
            .filter(|e| e.paper == *paper && e.place == *place && e.what.contains(what))
            .collect();
        assert_eq!(found.len(), 1, "{paper} {place} {what}: {found:?}");
        close(what, found[0].ours.unwrap(), *ours, ours.abs(), 1e-9);
        if let Some(conditional) = conditional {
            close(
                what,
                found[0].conditional.unwrap(),
                *conditional,
                conditional.abs(),
                1e-9,
            );
        }
    }
}

/// Twelve digits where mechanics alone decides: by differentiation of the loop closure in 40 digits.
#[test]
fn ours_have_twelve_digits() {
    let result = all();
    for (paper, place, what, ours) in [
        (
            "obaseki-alfred",
            "(8)",
            "slider position",
            0.05649373432723109,
        ),
        (
            "obaseki-alfred",
            "(13)",
            "slider velocity",
            16.79314860216054,
        ),
        ("obaseki-alfred", "(20)", "d2s/dt2", 939.4781244439409),
        ("obaseki-alfred", "(27)", "rod", 155.5154753474646),
        ("obaseki-alfred", "(30)", "rod", -23588.28530120142),
        (
            "obaseki-alfred",
            "(48)",
            "driving torque, with (20) mended",
            65.99854796764734,
        ),
        ("obaseki-alfred", "(49)", "e = 20 mm", 0.08879230741596299),
        (
            "obaseki-alfred",
            "4.2.1",
            "crank angle of the return",
            134.64479897289132,
        ),
        (
            "obaseki-alfred",
            "4.2.1",
            "time of the return",
            0.009362530130529215,
        ),
        ("obaseki-alfred", "4.2.1", "time ratio", 1.6737014927140297),
        (
            "obaseki-alfred",
            "4.3, figure 16",
            "return stroke, e = 20 mm",
            316.06111278241855,
        ),
        (
            "obaseki-alfred",
            "4.3, figure 16",
            "advance stroke, e = 20 mm",
            81.30245598735283,
        ),
        (
            "obaseki-alfred",
            "4.3, figure 16",
            "return stroke, e = 10 mm",
            133.74940646778592,
        ),
        (
            "obaseki-alfred",
            "4.3, figure 16",
            "advance stroke, e = 10 mm",
            90.42377844169059,
        ),
        ("ng", "discussion", "least force", 88.00926122867985),
        (
            "duarte",
            "(9)",
            "factor of the acceleration",
            0.030060159037770536,
        ),
        (
            "duarte",
            "(9)",
            "factor of the speed",
            0.0012278033391790672,
        ),
        ("duarte", "(9)", "weight", 0.20393067532849327),
        ("duarte", "(8)", "height", 0.020355178791028456),
        ("duarte", "(6)", "work", -0.014022292870408518),
    ] {
        let mut entries = result.entries.iter();
        let found = entries.find(|e| e.paper == paper && e.place == place && e.what.contains(what));
        close(what, found.unwrap().ours.unwrap(), ours, ours.abs(), 1e-12);
    }
}

/// Values of the formulas as printed.
#[test]
fn printed_formulas_are_evaluated_as_printed() {
    let result = all();
    for (paper, place, what, printed) in [
        ("obaseki-alfred", "(10)", "slider position", 0.1172695499),
        ("obaseki-alfred", "(18)", "dv2", 1382.143828),
        ("obaseki-alfred", "(20)", "read as", 345556.5175),
        ("obaseki-alfred", "(30)", "rod", -97996.61801),
        ("obaseki-alfred", "(38)", "reaction", -476.5541980),
        ("obaseki-alfred", "(39)", "reaction", -742.1891892),
        ("obaseki-alfred", "(40)", "tangential", -1956.232846),
        ("obaseki-alfred", "(41)", "axial", -2145.878758),
        ("obaseki-alfred", "(42b)", "inertia force", -65761.27874),
        ("obaseki-alfred", "(43)", "horizontal", -1169.558981),
        ("obaseki-alfred", "(46b)", "sum of mass", 509.8978327),
        ("obaseki-alfred", "(47)", "torque", -19.06216792),
        ("obaseki-alfred", "(48)", "(20) mended", 31.37527280),
        ("obaseki-alfred", "(52)", "at 1 rad", -706.1417516),
        ("obaseki-alfred", "(53)", "at 1 rad", -41.20616387),
        ("duarte", "(9)", "factor of the acceleration", 0.02845697349),
        ("duarte", "(9)", "factor of the speed", 0.0002632465862),
        ("duarte", "(9)", "weight", 1.335367404),
        ("duarte", "(8)", "height", 0.133288639489),
        ("duarte", "(3)", "theta2", 0.23516650),
    ] {
        let entry = result
            .entries
            .iter()
            .find(|e| e.paper == paper && e.place == place && e.what.contains(what))
            .unwrap_or_else(|| panic!("{paper} {place} {what}"));
        let value: f64 = entry.printed.parse().unwrap();
        close(what, value, printed, printed.abs(), 1e-7);
    }
}

/// F and F' of Ng's table 2 by (6) and (8) with the torque as described, and the reconstruction, with 46 of 48 numbers
/// rounded and 2 truncated.
#[test]
fn table_2_of_ng() {
    let result = reproduce(&[Paper::Ng]).unwrap();
    let entry = |what: &str| result.entries.iter().find(|e| e.what == what).unwrap();
    for (degrees, force, with_friction, beta) in [
        (10, 22.7225, 0.5 * 42.6999, 166.5433),
        (60, 5.17489, 0.5 * 7.08654, 102.5002),
        (90, 5.29740, 0.5 * 6.67198, 69.68249),
        (120, 7.47822, 0.5 * 10.2407, 42.50015),
        (160, 23.0693, 0.5 * 40.6203, 13.17963),
    ] {
        let check = |what: &str, want: f64| {
            let got = entry(&format!("{what} at {degrees} deg")).ours.unwrap();
            close(what, got, want, want, 4e-6);
        };
        check("F", force);
        check("F' by theory", with_friction);
        check("transmission angle", beta);
    }
    let table: Vec<_> = result
        .entries
        .iter()
        .filter(|e| e.place == "table 2" && !e.what.contains("experiment"))
        .collect();
    assert_eq!(table.len(), 48);
    let cut = table
        .iter()
        .filter(|e| e.condition.contains("cut off"))
        .count();
    assert_eq!(cut, 2);
}

/// Figures of the papers that can be drawn, with data in each.
#[test]
fn every_figure_has_data_and_names() {
    let result = all();
    for (paper, numbers) in [
        ("obaseki-alfred", (5..=19).collect::<Vec<_>>()),
        ("gupta", (4..=12).chain(14..=16).chain(19..=22).collect()),
        ("ng", vec![7, 8]),
        ("duarte", (2..=6).collect()),
    ] {
        let mut found: Vec<u32> = result
            .drawings
            .iter()
            .filter(|drawing| drawing.paper == paper)
            .map(|drawing| drawing.name.trim_start_matches("figure-").parse().unwrap())
            .collect();
        found.sort_unstable();
        assert_eq!(found, numbers, "{paper}");
    }
    for drawing in &result.drawings {
        for plot in &drawing.plots {
            let [x, y] = [&plot.x.label, &plot.y.label];
            assert!(x.contains('[') && y.contains('['), "{plot:?}");
            for series in &plot.series {
                assert!(!series.label.is_empty());
                let drawn = series
                    .points
                    .iter()
                    .filter(|(x, y, _)| x.is_finite() && y.is_finite());
                assert!(drawn.count() >= 2, "{} {}", drawing.name, series.label);
            }
        }
    }
}

/// Turning points of Duarte's polynomial, where the crank speed is zero.
#[test]
fn the_motion_of_duarte_turns_where_its_polynomial_says() {
    let result = reproduce(&[Paper::Duarte]).unwrap();
    let series = |name: &str| {
        let drawing = result.drawings.iter().find(|d| d.name == name).unwrap();
        drawing.plots[0].series[0].points.clone()
    };
    let (angle, speed) = (series("figure-03"), series("figure-04"));
    let turns: Vec<f64> = speed
        .windows(2)
        .filter(|w| w[0].1 * w[1].1 < 0.0)
        .map(|w| w[0].0 - w[0].1 * (w[1].0 - w[0].0) / (w[1].1 - w[0].1))
        .collect();
    assert_eq!(turns.len(), 2);
    close("first", turns[0], 1.125048994, 1.0, 1e-5);
    close("second", turns[1], 2.361942489, 1.0, 1e-5);
    let most = angle.iter().map(|p| p.1).fold(f64::MIN, f64::max);
    close("largest angle", most, 1.118216410, 1.0, 1e-5);
    // The force is by far the largest where the crank is closest to the dead centre.
    let force = series("figure-06");
    let peak = force
        .iter()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .unwrap();
    assert!((peak.0 - turns[1]).abs() < 0.02, "{peak:?}");
}

/// Statements of the papers in words, on clearance, energy and torque.
#[test]
fn what_is_said_in_words_has_a_row() {
    let result = all();
    let rows = |paper: &str, place: &str| {
        let rows = result
            .entries
            .iter()
            .filter(|e| e.paper == paper && e.place == place);
        rows.cloned().collect::<Vec<_>>()
    };
    let clearance = rows("gupta", "2.3, figure 14");
    assert_eq!(clearance.len(), 5);
    for row in &clearance {
        // 1 mm of a stroke of 289.8 mm, and slightly more where the loaded joint yields.
        let off = row.ours.unwrap();
        assert!(off > 0.02 && off < 0.8, "{row:?}");
    }
    // M at 0.7 rad by (7), and complete: computed independently of the program.
    let [energy] = &rows("duarte", "(7)")[..] else {
        panic!("one row of (7)")
    };
    close(
        "(7)",
        energy.printed.parse().unwrap(),
        0.02876701070,
        1.0,
        1e-9,
    );
    close(
        "(7), complete",
        energy.ours.unwrap(),
        0.03006015904,
        1.0,
        1e-9,
    );
    let torques = rows("obaseki-alfred", "4.3, figure 16");
    let less = torques
        .iter()
        .find(|e| e.printed == "less than 50")
        .unwrap();
    assert!(less.what.contains("advance stroke, e = 20 mm"), "{less:?}");
}
