//! Spellings of quantities: read correctly, and accepted by the schema as far as a regular expression can decide.

use std::f64::consts::PI;

use slider_crank::scene::schema;
use slider_crank::scene::unit::{Quantity, Uncertain, parse, uncertain};

/// Whether the schema accepts a text for a key of this quantity.
fn schema_lets(text: &str, quantity: Quantity) -> bool {
    let key = match quantity {
        Quantity::Length => "geometry/properties/crank",
        Quantity::Mass => "crank/properties/mass",
        Quantity::Inertia => "crank/properties/inertia",
        Quantity::Angle => "motion/properties/angle",
        Quantity::AngularSpeed => "motion/properties/speed",
        Quantity::Acceleration => "gravity/properties/acceleration",
        Quantity::Time => "run/properties/duration",
        Quantity::Force => "force/items/allOf/0/then/properties/value",
        Quantity::Torque => "torque/items/allOf/0/then/properties/value",
        Quantity::RotaryDamping => "torque/items/properties/coefficient",
        Quantity::LinearDamping => "force/items/properties/coefficient",
        Quantity::Stiffness => "force/items/properties/stiffness",
        Quantity::Pressure => "force/items/properties/ambient",
        Quantity::Density => "crank/properties/density",
        Quantity::Velocity => "clearance/properties/friction_threshold",
        // No key of a scene has these quantities.
        Quantity::Energy | Quantity::Power => return parse(text, quantity).is_ok(),
        Quantity::Number => return text.parse::<f64>().is_ok(),
    };
    let schema = schema();
    let pattern = schema.pointer(&format!("/properties/{key}/anyOf/0/pattern"));
    let pattern = pattern.and_then(|pattern| pattern.as_str()).expect(key);
    let pattern = regex_lite::Regex::new(pattern);
    pattern.expect("a regular expression").is_match(text)
}

#[test]
fn values_with_errors_as_people_type_them() {
    for (text, quantity, value, error) in [
        ("155.8 +- 0.1 mm", Quantity::Length, 0.1558, 1e-4),
        ("155.8mm ± 1e-4 m", Quantity::Length, 0.1558, 1e-4),
        ("0 +/- 0.1 mm", Quantity::Length, 0.0, 1e-4),
        ("-2 +- 0.5 N m", Quantity::Torque, -2.0, 0.5),
        (
            "200 rpm +- 0",
            Quantity::AngularSpeed,
            200.0 * PI / 30.0,
            0.0,
        ),
        ("47 mm", Quantity::Length, 0.047, 0.0),
    ] {
        let found = uncertain(text, quantity);
        assert_eq!(found, Ok(Uncertain { value, error }), "{text}");
        assert!(schema_lets(text, quantity), "{text}");
    }
}

#[test]
fn units_as_people_type_them() {
    for (text, quantity, expected) in [
        ("47 mm", Quantity::Length, 0.047),
        ("40mm", Quantity::Length, 0.040),
        ("27698.81 kg mm^2", Quantity::Inertia, 0.02769881),
        ("5807.55 kg·mm²", Quantity::Inertia, 0.00580755),
        ("0.2 kg m2", Quantity::Inertia, 0.2),
        ("200 rpm", Quantity::AngularSpeed, 200.0 * PI / 30.0),
        ("90 deg", Quantity::Angle, PI / 2.0),
        ("30°", Quantity::Angle, PI / 6.0),
        ("30 degrees", Quantity::Angle, PI / 6.0),
        ("2 turns", Quantity::Angle, 4.0 * PI),
        ("50 gon", Quantity::Angle, PI / 4.0),
        ("100 mgon", Quantity::Angle, PI / 2000.0),
        ("30 arcmin", Quantity::Angle, PI / 360.0),
        ("1800 arcsec", Quantity::Angle, PI / 360.0),
        ("3 radians/sec", Quantity::AngularSpeed, 3.0),
        ("5 msec", Quantity::Time, 0.005),
        ("2 N*m", Quantity::Torque, 2.0),
        ("250 N mm", Quantity::Torque, 0.25),
        ("2 Nm", Quantity::Torque, 2.0),
        ("10 bar", Quantity::Pressure, 1e6),
        ("1 lbf ft", Quantity::Torque, 1.3558179483314004),
        ("2 N-m", Quantity::Torque, 2.0),
        ("2 N.m", Quantity::Torque, 2.0),
        ("1 lbf-ft", Quantity::Torque, 1.3558179483314004),
        ("0.2 kg-m^2", Quantity::Inertia, 0.2),
        ("0.2 kg-m2", Quantity::Inertia, 0.2),
        ("0.2 kg.m²", Quantity::Inertia, 0.2),
        ("0.2 kg*m**2", Quantity::Inertia, 0.2),
        ("9.81 m-s-2", Quantity::Acceleration, 9.81),
        ("60 rev/min", Quantity::AngularSpeed, 2.0 * PI),
        ("60 r/min", Quantity::AngularSpeed, 2.0 * PI),
        ("60 RPM", Quantity::AngularSpeed, 2.0 * PI),
        ("60 U/min", Quantity::AngularSpeed, 2.0 * PI),
        ("60 1/min", Quantity::AngularSpeed, 2.0 * PI),
        ("60/min", Quantity::AngularSpeed, 2.0 * PI),
        ("60 min^-1", Quantity::AngularSpeed, 2.0 * PI),
        ("60 min-1", Quantity::AngularSpeed, 2.0 * PI),
        ("60 min⁻¹", Quantity::AngularSpeed, 2.0 * PI),
        ("3 Hz", Quantity::AngularSpeed, 6.0 * PI),
        ("0.2 kgm^2", Quantity::Inertia, 0.2),
        ("0.2 kgm2", Quantity::Inertia, 0.2),
        ("0.2 kgm²", Quantity::Inertia, 0.2),
        ("5807.55 kgmm^2", Quantity::Inertia, 0.00580755),
        ("15 Ns/m", Quantity::LinearDamping, 15.0),
        ("2 inches", Quantity::Length, 0.0508),
        ("2 lbs", Quantity::Mass, 0.90718474),
        ("10 lbf", Quantity::Force, 44.482216152605),
        ("1 lb", Quantity::Mass, 0.45359237),
        ("1 psi", Quantity::Pressure, 6894.757293168361),
        ("0.02 N m s/rad", Quantity::RotaryDamping, 0.02),
        ("0.02 N m s", Quantity::RotaryDamping, 0.02),
        ("7.8 g/cm^3", Quantity::Density, 7800.0),
        ("1 kg/(m s^2)", Quantity::Pressure, 1.0),
        ("−3 N", Quantity::Force, -3.0),
        ("3e−2 N", Quantity::Force, 0.03),
        ("9.81 m s^−2", Quantity::Acceleration, 9.81),
        ("9.80665 m s⁻²", Quantity::Acceleration, 9.80665),
        ("0", Quantity::Length, 0.0),
        ("0.1", Quantity::Number, 0.1),
    ] {
        let value = parse(text, quantity).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!(schema_lets(text, quantity), "{text}: the schema refuses it");
        let error = (value - expected).abs();
        assert!(
            error <= 2e-16 * expected.abs(),
            "{text}: {value} for {expected}"
        );
    }
}

#[test]
fn what_is_not_a_quantity_is_refused() {
    for (text, quantity) in [
        ("47", Quantity::Length),
        ("47 kg", Quantity::Length),
        ("1,5 mm", Quantity::Length),
        ("mm", Quantity::Length),
        ("1e999 m", Quantity::Length),
        ("1 furlong", Quantity::Length),
        ("1 m^", Quantity::Length),
        ("1 m^99", Quantity::Length),
        ("3 1/s", Quantity::AngularSpeed),
        ("3 s^-1", Quantity::AngularSpeed),
        ("3 1/h", Quantity::AngularSpeed),
        ("3 1/min", Quantity::Time),
        ("3 1", Quantity::Number),
        ("1 1/2 m", Quantity::Length),
        ("3 Nms", Quantity::RotaryDamping),
        ("1 N m", Quantity::Force),
        ("1 kg/m s", Quantity::Pressure),
        ("nan m", Quantity::Length),
        ("1 (m", Quantity::Length),
        ("−−3 N", Quantity::Force),
        ("−-3 N", Quantity::Force),
        ("+-3 N", Quantity::Force),
        ("3− N", Quantity::Force),
        ("3 N−m", Quantity::Force),
        ("3 N-", Quantity::Force),
        ("3 m--1", Quantity::Length),
        ("3 m-", Quantity::Length),
        ("", Quantity::Length),
    ] {
        assert!(parse(text, quantity).is_err(), "{text}");
        // A pattern knows neither the range of a double nor the dimension of a product.
        let beyond = ["1e999 m", "3 1/s", "3 s^-1", "3 1/h", "1 N m", "1 kg/m s"];
        let lets = schema_lets(text, quantity) && !beyond.contains(&text);
        assert!(!lets, "{text}: the schema takes it");
    }
    let brackets = "(".repeat(100_000);
    assert!(parse(&format!("1 {brackets}m"), Quantity::Length).is_err());
    let closed = format!("1 {brackets}m{}", ")".repeat(100_000));
    assert_eq!(parse(&closed, Quantity::Length), Ok(1.0));
}

#[test]
fn what_was_meant_is_said() {
    for (text, quantity, what) in [
        ("2 lb ft", Quantity::Torque, "`lbf ft`"),
        ("2 in-lb", Quantity::Torque, "`in-lbf`"),
        ("30 Deg", Quantity::Angle, "`deg` is"),
        ("2 KG", Quantity::Mass, "`kg` is"),
        ("3 1/s", Quantity::AngularSpeed, "200 rpm"),
        (
            "3 grads",
            Quantity::Angle,
            "deg, °, rev, turn, gon, arcmin, arcsec",
        ),
        ("3 s", Quantity::Angle, "units: rad, deg"),
    ] {
        let error = parse(text, quantity).unwrap_err().to_string();
        assert!(error.contains(what), "{text}: {error}");
    }
}
