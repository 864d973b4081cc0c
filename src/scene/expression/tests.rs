//! Tests of formulas.

use super::*;

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

/// What has no value anywhere inside has none as a whole.
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
