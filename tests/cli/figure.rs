//! Figures: their contents, and validity of the SVG for any data.

use std::f64::consts::TAU;

use slider_crank::figure::{Axis, Figure, Shape, sheet};

fn svg(figure: &Figure) -> String {
    let text = figure.to_svg().expect("a figure");
    check(&text);
    text
}

/// Checks that every tag is closed and every number is finite.
fn check(svg: &str) {
    let mut open = Vec::new();
    for part in svg.split('<').skip(1) {
        let (tag, after) = part.split_once('>').expect("a closed tag");
        assert!(!after.contains('>'), "`>` in text: {after}");
        let name = tag.split_whitespace().next().expect("a name");
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name.to_owned()));
        } else if !tag.ends_with('/') {
            open.push(name.to_owned());
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        assert!(!tag.contains("NaN") && !tag.contains("inf"), "{tag}");
    }
    assert!(open.is_empty(), "{open:?}");
    assert!(!svg.contains(|c: char| c.is_control() && c != '\n'));
}

/// Returns the texts in document order.
fn texts(svg: &str) -> Vec<String> {
    let tags = svg.split("<text").skip(1);
    let inner = tags.filter_map(|tag| tag.split_once('>')?.1.split_once('<'));
    inner.map(|(text, _)| text.trim().to_owned()).collect()
}

fn attribute(tag: &str, name: &str) -> String {
    let found = tag.split_once(&format!(" {name}=\""));
    let (_, rest) = found.unwrap_or_else(|| panic!("no {name} in {tag}"));
    rest.split('"').next().expect("a value").to_owned()
}

/// Returns the points of all lines of one colour.
fn lines(svg: &str, colour: &str) -> Vec<Vec<(f64, f64)>> {
    let tags = svg.split('<').filter(|tag| tag.starts_with("polyline"));
    tags.filter(|tag| attribute(tag, "stroke") == colour)
        .map(|tag| {
            let points = attribute(tag, "points");
            let pairs = points.split_whitespace().map(|pair| {
                let (x, y) = pair.split_once(',').expect("x,y");
                (x.parse().expect("x"), y.parse().expect("y"))
            });
            pairs.collect()
        })
        .collect()
}

/// Colour of the first series.
const FIRST: &str = "#0072B2";

fn axes() -> (Axis, Axis) {
    (Axis::linear("x [m]"), Axis::linear("y [N]"))
}

fn plain() -> Figure {
    let (x, y) = axes();
    Figure::new("A title", x, y)
}

fn sine(points: usize) -> Vec<(f64, f64)> {
    let angle = |i| TAU * i as f64 / (points - 1) as f64;
    (0..points).map(|i| (angle(i), angle(i).sin())).collect()
}

#[test]
fn title_axes_ticks_and_legend_are_written() {
    let figure = plain()
        .line("computed", sine(50))
        .points("measured", sine(9))
        .vertical_mark(1.0, "dead centre");
    let texts = texts(&svg(&figure));
    for text in [
        "A title",
        "x [m]",
        "y [N]",
        "computed",
        "measured",
        "dead centre",
        "0",
        "6",
        "-1.0",
        "0.5",
    ] {
        assert!(texts.iter().any(|found| found == text), "{text}: {texts:?}");
    }
}

#[test]
fn the_same_figure_gives_the_same_text() {
    let figure = || plain().line("a", sine(30)).dashed("b", sine(30));
    assert_eq!(svg(&figure()), svg(&figure()));
    assert_ne!(svg(&figure()), svg(&plain().line("a", sine(30))));
}

#[test]
fn a_point_lies_where_its_values_say() {
    let (x, y) = axes();
    let figure = Figure::new("", x.range(0.0, 4.0), y.range(0.0, 1.0));
    let svg = svg(&figure.line("", vec![(0.0, 0.0), (1.0, 0.25), (2.0, 1.0), (4.0, 0.5)]));
    let line = &lines(&svg, FIRST)[0];
    let (origin, end) = (line[0], line[3]);
    let (width, height) = (end.0 - origin.0, line[2].1 - origin.1);
    // SVG counts y downward; coordinates are in pixels, to a hundredth.
    assert!(width > 500.0 && height < -300.0);
    assert!((line[1].0 - origin.0 - 0.25 * width).abs() <= 0.02);
    assert!((line[1].1 - origin.1 - 0.25 * height).abs() <= 0.02);
    assert!((line[2].0 - origin.0 - 0.5 * width).abs() <= 0.02);
    assert!((end.1 - origin.1 - 0.5 * height).abs() <= 0.02);
}

#[test]
fn a_logarithmic_axis_spaces_decades_evenly() {
    let points = (-14..=-2).map(|k| (f64::from(k), 10f64.powi(k))).collect();
    let figure = Figure::new("", Axis::linear("k"), Axis::log("error [rad]"));
    let svg = svg(&figure.line("a", points));
    let line = &lines(&svg, FIRST)[0];
    let steps: Vec<_> = line.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    assert_eq!(steps.len(), 12);
    assert!(steps.iter().all(|step| (step - steps[0]).abs() <= 0.03));
    let texts = texts(&svg);
    assert!(texts.contains(&"1e-14".to_owned()) || texts.contains(&"1e-13".to_owned()));
    assert!(texts.contains(&"1e-4".to_owned()) || texts.contains(&"1e-3".to_owned()));
}

#[test]
fn what_has_no_logarithm_is_left_out_and_breaks_the_line() {
    let figure = Figure::new("", Axis::log("x [s]"), Axis::log("y [rad]"));
    let points = vec![
        (1.0, 1.0),
        (2.0, 3.0),
        (3.0, 0.0),
        (4.0, 2.0),
        (5.0, 1.0),
        (-1.0, 1.0),
        (6.0, 2.0),
        (7.0, 4.0),
    ];
    let line = lines(&svg(&figure.line("", points)), FIRST);
    assert_eq!(line.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 2]);
}

#[test]
fn lines_have_gaps_where_a_value_is_missing() {
    let mut points = sine(101);
    points[30].1 = f64::NAN;
    points[60].1 = f64::INFINITY;
    points[61].1 = f64::NAN;
    let line = lines(&svg(&plain().line("", points)), FIRST);
    assert_eq!(line.iter().map(Vec::len).collect::<Vec<_>>(), [30, 29, 39]);
}

#[test]
fn a_range_cuts_lines_at_its_border() {
    let (x, y) = axes();
    let figure = Figure::new("", x.range(0.0, 1.0), y.range(-1.0, 1.0));
    let steep = vec![
        (-1.0, -3.0),
        (0.5, 0.0),
        (2.0, 3.0),
        (2.0, -5.0),
        (0.5, -0.5),
    ];
    let figure = figure
        .line("", steep)
        .points("", vec![(0.5, 0.5), (3.0, 0.0)]);
    let svg = svg(&figure);
    let line = lines(&svg, FIRST);
    assert_eq!(line.iter().map(Vec::len).collect::<Vec<_>>(), [3, 2]);
    // y = 2 (x - 0.5) leaves the axes at the corners (0, -1) and (1, 1).
    let (first, last) = (line[0][0], line[0][2]);
    let middle = line[0][1];
    assert!((first.0 + last.0 - 2.0 * middle.0).abs() <= 0.05);
    for point in line.concat() {
        let inside = |a: f64, b: f64, c: f64| (a.min(b) - 0.01..=a.max(b) + 0.01).contains(&c);
        assert!(inside(first.0, last.0, point.0) && inside(first.1, last.1, point.1));
    }
    assert_eq!(
        svg.matches("fill=\"#D55E00\"").count(),
        1,
        "one point is outside"
    );
}

#[test]
fn bands_lie_between_low_and_high() {
    let band = vec![
        (0.0, -1.0, 1.0),
        (1.0, -2.0, 2.0),
        (2.0, f64::NAN, 1.0),
        (3.0, 0.0, 1.0),
    ];
    let figure = plain()
        .band("", band)
        .line("", vec![(0.0, -2.0), (3.0, 2.0)]);
    let svg = svg(&figure);
    let tags = svg.split('<').filter(|tag| tag.starts_with("polygon"));
    let corners: Vec<_> = tags
        .map(|tag| attribute(tag, "points").split_whitespace().count())
        .collect();
    assert_eq!(corners, [4], "one piece; a single point has no area");
}

#[test]
fn series_of_one_label_share_colour_and_entry() {
    let band = sine(9).into_iter().map(|(x, y)| (x, y - 0.1, y + 0.1));
    let figure = plain()
        .band("force", band.collect())
        .line("force", sine(9))
        .line("other", sine(5));
    let svg = svg(&figure);
    assert_eq!(
        texts(&svg).iter().filter(|text| *text == "force").count(),
        1
    );
    assert_eq!(lines(&svg, FIRST).len(), 2, "the line and its sample");
    let unnamed = plain().line("", sine(9)).line("", sine(5));
    let unnamed = unnamed.to_svg().expect("a figure");
    assert_eq!(lines(&unnamed, FIRST).len(), 1, "no sample");
    // Line styles differ as well: the second line is dashed.
    let dashes = |colour| {
        let mut tags = unnamed.split('<').filter(|tag| tag.starts_with("polyline"));
        let tag = tags.find(|tag| attribute(tag, "stroke") == colour);
        attribute(tag.expect("a line"), "stroke-dasharray")
    };
    assert_eq!([dashes(FIRST), dashes("#D55E00")], ["none", "15 4"]);
}

#[test]
fn hardly_any_data_is_no_failure() {
    let cases: [&[(f64, f64)]; 9] = [
        &[],
        &[(1.0, 2.0)],
        &[(0.0, 0.0), (0.0, 0.0)],
        &[(f64::NAN, 1.0), (1.0, f64::INFINITY)],
        &[(0.0, 98.38), (1.0, 98.38)],
        &[(1e300, -1e300), (-1e300, 1e300), (f64::MAX, f64::MIN)],
        &[(1e-300, 5e-324), (2e-300, 1e-310)],
        &[(1.0, 1.0 + f64::EPSILON), (2.0, 1.0)],
        &[(62831.0, -1e-9), (62831.0 + 1e-6, 1e-9)],
    ];
    for points in cases {
        for [x, y] in [
            [Axis::linear("x"), Axis::linear("y")],
            [Axis::linear("x"), Axis::log("y")],
            [Axis::log("x"), Axis::log("y")],
            [
                Axis::linear("x").range(1.0, 1.0),
                Axis::log("y").range(-1.0, 1.0),
            ],
        ] {
            let points = points.to_vec();
            let figure = Figure::new("title", x, y)
                .line("line", points.clone())
                .dashed("dashed", points.clone())
                .line_with_points("both", points.clone())
                .points("points", points.clone())
                .band(
                    "band",
                    points.iter().map(|&(x, y)| (x, y, 2.0 * y)).collect(),
                )
                .vertical_mark(points.first().map_or(f64::NAN, |point| point.0), "mark");
            let svg = svg(&figure);
            let ticks = texts(&svg).len();
            assert!(ticks < 60, "{ticks} texts for {points:?}");
        }
    }
    let nothing = svg(&plain());
    assert!(texts(&nothing).contains(&"nothing to show".to_owned()));
}

#[test]
fn ticks_are_numbers_that_differ() {
    for scale in [1e-12, 1e-3, 1.0, 7.0, 1e4, 3e9] {
        for offset in [0.0, 1.0, -1234.5] {
            let points = sine(20).into_iter().map(|(x, y)| (x, offset + scale * y));
            let figure = Figure::new("", Axis::linear(""), Axis::linear(""));
            let svg = svg(&figure.line("", points.collect()));
            let vertical = svg.split("<text").filter(|tag| tag.contains("\"end\""));
            let vertical = format!("<text{}", vertical.collect::<Vec<_>>().join("<text"));
            let ticks: Vec<f64> = texts(&vertical)
                .iter()
                .map(|text| text.parse().unwrap_or_else(|_| panic!("{text}")))
                .collect();
            assert!((4..=12).contains(&ticks.len()), "{ticks:?}");
            let step = ticks[1] - ticks[0];
            assert!(step.abs() > 0.1 * scale, "{ticks:?}");
            for pair in ticks.windows(2) {
                let error = (pair[1] - pair[0] - step).abs();
                assert!(
                    error < 1e-3 * step.abs() + 1e-12 * offset.abs(),
                    "{ticks:?}"
                );
            }
        }
    }
}

#[test]
fn any_text_is_safe() {
    let figure = Figure::new(
        "a < b & \"c\" > 'd' \u{1} \n \t $x$",
        Axis::linear("<x>"),
        Axis::linear("&amp;"),
    )
    .line("</svg>", sine(5));
    let texts = texts(&svg(&figure));
    assert!(texts.contains(&"&lt;x&gt;".to_owned()), "{texts:?}");
    assert!(texts.contains(&"&lt;/svg&gt;".to_owned()), "{texts:?}");
    let long = "word ".repeat(60);
    let figure = plain()
        .line(long.trim(), sine(5))
        .line("x".repeat(500), sine(5));
    let svg = svg(&Figure::new(long, Axis::linear(""), Axis::linear("")).line("", sine(5)));
    assert!(
        svg.matches("word word").count() > 3,
        "a long title has lines"
    );
    figure.to_svg().expect("a figure");
}

#[test]
fn many_series_are_told_apart() {
    let mut figure = plain();
    for k in 0..35 {
        let points = sine(5).into_iter().map(|(x, y)| (x, y + f64::from(k)));
        figure = figure.line_with_points(format!("series {k}"), points.collect());
    }
    let svg = svg(&figure);
    let all = texts(&svg);
    assert!((0..35).all(|k| all.contains(&format!("series {k}"))));
    // The legend lies inside the sheet.
    let height: f64 = attribute(&svg, "height").parse().expect("a height");
    let lowest = svg.split("<text").skip(1).map(|tag| attribute(tag, "y"));
    let lowest = lowest.map(|y| y.parse::<f64>().expect("a place"));
    assert!(lowest.fold(0.0, f64::max) < height);
}

#[test]
fn panels_stand_side_by_side() {
    let figures: Vec<_> = ["one", "two", "three"]
        .iter()
        .map(|title| {
            let (x, y) = axes();
            Figure::new(*title, x, y).line("a", sine(20))
        })
        .collect();
    let size = |text: &str| -> (f64, f64) {
        let number = |name| attribute(text, name).parse().expect("a number");
        (number("width"), number("height"))
    };
    let one = size(&svg(&figures[0]));
    let panels = |title, figures: &[Figure], columns| {
        sheet(title, columns, None, figures).expect("a figure")
    };
    let two = panels("All", &figures, 2);
    check(&two);
    assert_eq!(size(&two).0, 2.0 * one.0);
    assert!(size(&two).1 > 2.0 * one.1);
    for text in ["All", "one", "two", "three"] {
        assert!(texts(&two).contains(&text.to_owned()), "{text}");
    }
    for columns in [0, 1, 3, 100] {
        check(&panels("", &figures, columns));
    }
    check(&panels("none", &[], 2));
}

#[test]
fn a_sheet_has_the_size_it_is_given() {
    let (x, y) = axes();
    let figures = [Figure::new("one", x, y).line("a", sine(20))];
    let of = |width, height| sheet("All & <more>", 0, Some(Shape { width, height }), &figures);
    let svg = of(90.0, 70.0).expect("a figure");
    check(&svg);
    assert_eq!(attribute(&svg, "width"), "90mm");
    assert_eq!(attribute(&svg, "height"), "70mm");
    assert!(svg.contains("<title>All &amp; &lt;more&gt;</title>"));
    let small = of(10.0, 70.0).expect_err("too small");
    assert!(
        small.to_string().contains("too small for 1 panels"),
        "{small}"
    );
}
