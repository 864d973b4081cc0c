//! Formulas: parsing, enclosures of their values, and their periods over the crank angle.

use std::f64::consts::TAU;

use slider_crank::numeric::enclosure::{Enclosed, Interval, Rectangle};
use slider_crank::scene::{Expression, Instant, Period, Periodicity, WhyNot};

#[test]
fn the_usual_mathematical_reading() {
    let now = Instant {
        t: 2.0,
        theta: 3.0,
        omega: 5.0,
        x: 7.0,
        v: 11.0,
    };
    for (text, expected) in [
        ("-2^2", -4.0),
        ("-x^2 + 1", -48.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("1e-3*x", 0.007),
        ("7 - 2 - 1", 4.0),
        ("8/2/2", 2.0),
        ("2*-omega", -10.0),
        ("t + theta*omega", 17.0),
        ("(t + theta)*omega - v", 14.0),
        ("max(min(x, 3), 2)", 3.0),
        ("mod(-1, 3)", 2.0),
        ("step(t - 2) - sign(0)", 1.0),
        ("cos(pi)", -1.0),
        ("atan2(0, 1)", 0.0),
        (".5e1", 5.0),
        ("5 − 2 + −1e−1*10", 2.0),
    ] {
        let expression = Expression::parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        assert_eq!(expression.value(&now), expected, "{text}");
    }
}

/// A formula has no value if any part of it has none.
#[test]
fn outside_a_domain_there_is_no_value() {
    for text in [
        "sqrt(-1)",
        "max(0, sqrt(t - 1))",
        "min(sqrt(t - 1), 0)",
        "step(ln(-1))",
        "sign(asin(2))",
        "mod(1, 0)",
        "sqrt(-1)^0",
        "1^ln(-1)",
        "0*ln(0)",
    ] {
        let value = Expression::parse(text).unwrap().value(&Instant::default());
        assert!(value.is_nan(), "{text} = {value}");
    }
}

#[test]
fn errors_point_at_the_place() {
    for (text, at) in [
        ("2 +", 3),
        ("2x", 1),
        ("sin theta", 4),
        ("(1 + 2", 6),
        ("1 + angle", 4),
        ("max(1)", 5),
        ("x ** 2", 2),
        ("1..2", 0),
        ("1 $ 2", 2),
        ("2*x) + 1", 3),
        ("2,5*omega", 1),
        ("sin(2,5*theta)", 5),
        ("2 × omega", 2),
        ("(1 + 2 3)", 7),
        ("x² + 1", 1),
        ("2 + _x", 4),
        ("", 0),
    ] {
        assert_eq!(Expression::parse(text).unwrap_err().at, at, "{text}");
    }
    assert!(Expression::parse(&"(".repeat(100_000)).is_err());
    assert!(Expression::parse(&"-".repeat(100_000)).is_err());
}

const FORMULAS: [&str; 27] = [
    "2 - 0.01*t + 0.3*sin(2*t)*cos(t)",
    "tan(t/3)",
    "asin(t/10) - acos(t/12) + atan(t) + atan2(t, 2) + atan2(3, t)",
    "atan2(-4, t) + atan2(t - 9, t)",
    "sinh(t/2)*cosh(t/3) - tanh(t)",
    "exp(-((t - 1)/0.4)^2)",
    "ln(t + 5)/log10(t + 6)",
    "sqrt(t + 4.5) - 1/(t + 7)",
    "abs(t)*t + abs(t - 9) - abs(t + 9)",
    "floor(t)",
    "sign(t - 1)*step(t + 1)",
    "step(t) - 2*step(-t)",
    "min(t, 2 - t) + max(0, 1 - t^2)",
    "mod(t, 1.5)",
    "mod(t, -2)",
    "mod(t - 4, 30)",
    "(t - 1)^3 - (t + 1)^-2",
    "t^2 - t^7 + 3*t^0",
    "2^t - (t + 8)^1.5",
    "(t + 5)^t",
    "(t*t)^0.5",
    "1/t",
    "max(0, sqrt(t - 1))",
    "exp(t)/(1 + exp(t))",
    "-t^2 + 0.5*sin(3*t)^2",
    "1/(1 + (t/0.3)^2)",
    "t/(t + 0.1)",
];

fn now(t: f64) -> Instant {
    Instant {
        t,
        ..Instant::default()
    }
}

/// Returns a quasi-random sequence in [0, 1): fractional parts of multiples of the golden ratio.
fn spread(i: u32) -> f64 {
    (f64::from(i) * 0.618_033_988_749_894_9).fract()
}

#[test]
fn values_lie_in_their_enclosure() {
    for text in FORMULAS {
        let expression = Expression::parse(text).unwrap();
        for i in 0..400 {
            let from = 8.0 * spread(i) - 4.0;
            let width = 10f64.powf(-3.0 * spread(7 * i + 3));
            let over = Interval::new(from, from + width);
            let enclosed = expression.enclose(|_| Enclosed::variable(over, 3.0));
            for k in 0..40 {
                let value = expression.value(&now(from + width * spread(k)));
                if value.is_finite() {
                    let room = 1e-12 * (1.0 + value.abs());
                    let real = enclosed.real.widened(room);
                    assert!(real.contains(value), "{text} over {over:?}: {value}");
                } else {
                    assert!(enclosed.real.half().is_infinite(), "{text} over {over:?}");
                }
            }
        }
    }
}

/// Values at points of the ellipse, enclosed as degenerate rectangles, lie in the enclosure of the whole.
#[test]
fn values_in_the_plane_lie_in_their_enclosure() {
    let mut seen = 0;
    for text in FORMULAS {
        let expression = Expression::parse(text).unwrap();
        for i in 0..200 {
            let from = 8.0 * spread(i) - 4.0;
            let width = 10f64.powf(-3.0 * spread(5 * i + 1));
            let over = Interval::new(from, from + width);
            let whole = Enclosed::variable(over, 3.0);
            let Enclosed {
                plane, deviation, ..
            } = expression.enclose(|_| whole);
            if deviation > 0.0 {
                continue;
            }
            let (half, middle) = (over.half(), over.middle());
            for k in 0..20 {
                let (sin, cos) = (TAU * spread(k)).sin_cos();
                let point = Rectangle {
                    re: Interval::point(middle + 0.5 * half * (3.0 + 1.0 / 3.0) * cos),
                    im: Interval::point(0.5 * half * (3.0 - 1.0 / 3.0) * sin),
                };
                let at = Enclosed {
                    real: over,
                    plane: point,
                    deviation: 0.0,
                };
                let value = expression.enclose(|_| at).plane;
                let room = 1e-9 * (1.0 + value.re.largest() + value.im.largest());
                let inside = plane.re.widened(room).contains(value.re.middle())
                    && plane.im.widened(room).contains(value.im.middle());
                assert!(inside, "{text} over {over:?}: {value:?} not in {plane:?}");
                seen += 1;
            }
        }
    }
    assert!(seen > 20_000, "{seen}");
}

/// Reference: mpmath at 1/2 + i/4.
#[test]
fn values_in_the_plane_are_those_of_another_program() {
    let point = Rectangle {
        re: Interval::point(0.5),
        im: Interval::point(0.25),
    };
    let at = Enclosed {
        real: Interval::point(0.5),
        plane: point,
        deviation: 0.0,
    };
    for (text, re, im) in PLANE {
        let value = Expression::parse(text).unwrap().enclose(|_| at).plane;
        let off = (value.re.middle() - re).hypot(value.im.middle() - im);
        assert!(off < 1e-13, "{text}: {value:?}");
    }
}

const PLANE: [(&str, f64, f64); 11] = [
    ("sin(t)", 0.494485780933195, 0.22168816414957482),
    ("cos(t)", 0.9051501505596067, -0.12110879604381165),
    ("tan(t)", 0.504500702698564, 0.3124206925025888),
    ("sinh(t)", 0.504895714387995, 0.2789791283502615),
    ("cosh(t)", 1.0925708047319176, 0.12892104172809826),
    ("tanh(t)", 0.48548728102413535, 0.19805544995134952),
    ("exp(t)", 1.5974665191199127, 0.40790017007835977),
    ("ln(t)", -0.5815754049028404, 0.4636476090008061),
    ("sqrt(t)", 0.7276733451126774, 0.17178037486125622),
    ("1/t^3", 1.024, -5.632),
    ("(t + 2)^t", 1.4857938764326848, 0.4274890522557546),
];

fn repeats(text: &str) -> Periodicity {
    Expression::parse(text).unwrap().repeats()
}

#[test]
fn periods_follow_from_the_tree() {
    for (text, turns, parts) in [
        ("sin(theta/2)", 2, 1),
        ("sin(2*theta + 1)", 1, 2),
        ("sin(theta)^2", 1, 1),
        ("tan(theta)", 1, 2),
        ("mod(theta, 4*pi)", 2, 1),
        ("mod(theta, 12.566370614359172)", 2, 1),
        ("mod(theta - 0.3, 2*pi/3)", 1, 3),
        ("2 + 3*x - v*abs(v)", 1, 1),
        ("cos(3*theta) + sin(2*theta)*t", 1, 1),
        ("cos(4*theta) + sin(6*theta)*omega", 1, 2),
        ("sin(theta/3) + cos(theta/4)", 12, 1),
        ("sin(2*pi*theta/(4*pi) + 0.1*sin(theta))", 2, 1),
        ("exp(-((mod(theta, 4*pi) - 1)/0.1)^2)", 2, 1),
        ("step(sin(0.5*theta) - 0.2)", 2, 1),
        ("sin(theta - 2*pi*floor(theta/(2*pi)))", 1, 1),
        ("cos(1.5*theta)", 2, 3),
        ("sin(2/3*theta)", 3, 2),
        ("max(0, cos(theta - 1))/(2 + sin(theta))", 1, 1),
        ("atan2(sin(theta), cos(theta))", 1, 1),
        ("(theta + sin(theta/2)) - theta", 2, 1),
    ] {
        let expected = Periodicity::After(Period::fraction(turns, parts).unwrap());
        assert_eq!(repeats(text), expected, "{text}");
    }
    for text in ["3", "omega*2 - t", "sin(omega)", "0*theta", "theta - theta"] {
        assert_eq!(repeats(text), Periodicity::Always, "{text}");
    }
}

#[test]
fn what_the_tree_does_not_prove_does_not_repeat() {
    for text in [
        "theta",
        "exp(-((theta-20.4)/0.035)^2)",
        "max(0, 1-((theta-27)/0.07)^2)",
        "sin(theta)*theta",
        "sin(theta*omega)",
        "sin(theta*theta)",
        "sin(theta)^theta",
        "mod(theta, x)",
        "atan2(theta, 1)",
        "floor(theta/3)",
    ] {
        assert_eq!(repeats(text), Periodicity::Never(WhyNot::Outside), "{text}");
    }
    for text in [
        "sin(1.4142135623730951*theta)",
        "mod(theta, 1)",
        "mod(theta, 6.283185307)",
        "mod(theta, 0)",
        "sin(theta/0)",
    ] {
        let never = Periodicity::Never(WhyNot::Incommensurable);
        assert_eq!(repeats(text), never, "{text}");
    }
    for (text, turns) in [
        ("sin(0.3333*theta)", 10000.0),
        ("sin(theta/11) + cos(theta/13)", 143.0),
    ] {
        let never = Periodicity::Never(WhyNot::TooLong(turns));
        assert_eq!(repeats(text), never, "{text}");
    }
}
