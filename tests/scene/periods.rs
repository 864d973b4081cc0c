//! Periods of tables and formulas over the crank angle.

use slider_crank::scene::{
    Expression, Interpolation, Period, Periodicity, Table, Variable, WhyNot,
};

/// Returns the repetition of a table over the crank angle with this period (rad).
fn of_table(period: f64) -> Periodicity {
    let arguments = [0.0, 0.5 * period];
    let table = Table::new(
        Variable::Theta,
        &arguments,
        &[0.0, 1.0],
        Interpolation::Linear,
        Some(period),
    );
    table.expect("a table").repeats()
}

fn of_formula(text: &str) -> Periodicity {
    Expression::parse(text).expect("a formula").repeats()
}

fn after(turns: u32, parts: u32) -> Periodicity {
    Periodicity::After(Period::fraction(turns, parts).expect("a period"))
}

/// A period in degrees is the exact fraction as written.
#[test]
fn degrees_are_exact() {
    for (degrees, turns, parts) in [
        (360.0, 1, 1),
        (720.0, 2, 1),
        (120.0, 1, 3),
        (540.0, 3, 2),
        (240.0, 2, 3),
        (0.5, 1, 720),
        (7200.0, 20, 1),
        (11.25, 1, 32),
    ] {
        let angle = f64::to_radians(degrees);
        assert_eq!(of_table(angle), after(turns, parts), "{degrees}");
    }
    for (degrees, turns) in [(361.0, 361.0), (359.9, 3599.0)] {
        let found = of_table(f64::to_radians(degrees));
        assert_eq!(found, Periodicity::Never(WhyNot::TooLong(turns)));
    }
}

/// A period in radians is rounded: 2π to five digits is a turn, but a number near a fraction by chance is not that
/// fraction.
#[test]
#[expect(clippy::approx_constant, reason = "turns as calculators show them")]
fn radians_are_fractions_as_far_as_their_digits_tell() {
    for (angle, turns, parts) in [
        (6.283185307, 1, 1),
        (6.283185307179586, 1, 1),
        (6.2832, 1, 1),
        (12.566, 2, 1),
        (3.1416, 1, 2),
        (2.0943951, 1, 3),
        (31.415926535, 5, 1),
    ] {
        assert_eq!(of_table(angle), after(turns, parts), "{angle}");
    }
    for angle in [
        1e-3, 1e-300, 1.0, 3.0, 6.0, 6.3, 4.27, 4.269881, 2.5, 0.1, 6.2833,
    ] {
        let found = of_table(angle);
        assert_eq!(
            found,
            Periodicity::Never(WhyNot::Incommensurable),
            "{angle}"
        );
    }
    // A formula means exactly the number written in it.
    let found = of_formula("mod(theta, 6.283185307)");
    assert_eq!(found, Periodicity::Never(WhyNot::Incommensurable));
}

#[test]
fn both_repeat_after_the_least_common_multiple() {
    for (text, turns, parts) in [
        ("sin(2*theta) + sin(3*theta)", 1, 1),
        ("sin(theta*2/3) + sin(theta/2)", 6, 1),
        ("sin(4*theta) + sin(6*theta)", 1, 2),
        ("omega + sin(theta/2)", 2, 1),
    ] {
        assert_eq!(of_formula(text), after(turns, parts), "{text}");
    }
    let found = of_formula("sin(theta/11) + sin(theta/13)");
    assert_eq!(found, Periodicity::Never(WhyNot::TooLong(143.0)));
}
