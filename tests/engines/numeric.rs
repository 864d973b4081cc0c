//! Numerical tools compared with closed forms and published values.

mod chebyshev {
    use slider_crank::numeric::chebyshev::Rule;

    #[test]
    fn a_smooth_function_is_right_to_rounding() {
        for degree in [24, 32] {
            let rule = Rule::of(degree);
            let values = rule.values(|x| (3.0 * x + 0.2).exp());
            let series = rule.series(&values);
            let primitive = series.integral();
            let mut at_points = rule.values(|x| x);
            series.values(&mut at_points);
            for (here, value) in at_points.iter().zip(&values).take(degree + 1) {
                assert!((here - value).abs() < 4e-15 * 3.2f64.exp());
            }
            let slope = series.derivative();
            for x in [-0.9f64, 0.1, 0.8] {
                let exact = 3.0 * (3.0 * x + 0.2).exp();
                assert!((slope.value(x) / exact - 1.0).abs() < 1e-12, "{x}");
            }
            assert!(series.tail() < 1e-15);
            for x in [-1.0f64, -0.7, 0.0, 0.3, 1.0] {
                let exact = (3.0 * x + 0.2).exp();
                // Rounding is relative to the largest value, e^3.2.
                assert!((series.value(x) - exact).abs() < 4e-15 * 3.2f64.exp());
                let exact = ((3.0 * x + 0.2).exp() - (-2.8f64).exp()) / 3.0;
                assert!((primitive.value(x) - exact).abs() < 1e-14, "{x}");
            }
            let (sum, rest) = rule.integral(&values);
            let exact = ((3.2f64).exp() - (-2.8f64).exp()) / 3.0;
            assert!((sum + rest - exact).abs() < 2e-14);
        }
    }

    #[test]
    fn polynomials_of_the_degree_are_reproduced() {
        for degree in Rule::DEGREES {
            let rule = Rule::of(degree);
            // T_k itself: its only nonzero coefficient is 1.
            for k in 0..=degree {
                let values = rule.values(|x| (k as f64 * x.acos()).cos());
                let series = rule.series(&values);
                for i in 0..=degree {
                    let c = series.coefficient(i);
                    let exact = if i == k { 1.0 } else { 0.0 };
                    assert!((c - exact).abs() < 1e-13, "{degree} {k} {i}: {c}");
                }
            }
        }
    }

    #[test]
    fn integrals_at_the_points_are_those_of_the_function() {
        for degree in [16, 24, 32] {
            let rule = Rule::of(degree);
            let values = rule.values(|x| (2.0 * x).cos() + x * x * x);
            for (sum, x) in rule.integrals(&values).iter().zip(rule.points()) {
                let exact = 0.5 * ((2.0 * x).sin() + 2f64.sin()) + 0.25 * (x.powi(4) - 1.0);
                assert!((sum - exact).abs() < 1e-15, "{x}: {sum} {exact}");
            }
        }
    }

    /// The coefficients of 1/(a − x) fall by the factor ρ = a + √(a² − 1) from each to the next (Trefethen, ch. 8).
    #[test]
    fn the_degree_of_a_tail_is_foretold() {
        for a in [1.1f64, 1.3, 2.0] {
            let rho = a + (a * a - 1.0).sqrt();
            let series = Rule::of(16).series(&Rule::of(16).values(|x| 1.0 / (a - x)));
            for tail in [1e-12, 1e-20] {
                let exact = -f64::ln(tail) / rho.ln();
                let foretold = series.degree_of_tail(tail);
                assert!(
                    (foretold / exact - 1.0).abs() < 0.15,
                    "{a} {tail}: {foretold} {exact}"
                );
            }
        }
        let rule = Rule::of(24);
        assert_eq!(
            rule.series(&rule.values(|x| (0.1 * x).exp()))
                .degree_of_tail(1e-10),
            24.0
        );
        // The terms of |x - 0.1| fall with the square of their index alone.
        assert!(
            rule.series(&rule.values(|x| (x - 0.1).abs()))
                .degree_of_tail(1e-10)
                > 100.0
        );
    }

    #[test]
    fn a_corner_is_not_taken_for_smooth() {
        let rule = Rule::of(32);
        assert!(rule.series(&rule.values(|x| (x - 0.1).abs())).tail() > 1e-5);
    }
}

mod root {
    use slider_crank::numeric::root::bracketed;

    #[test]
    fn roots_are_right_to_the_last_bits() {
        for target in [0.1, 1.0, std::f64::consts::E, 1e-9] {
            let root = bracketed(|x| x * x * x - target, 0.0, 3.0).unwrap();
            assert!((root / target.cbrt() - 1.0).abs() < 1e-15, "{root}");
        }
        assert_eq!(bracketed(f64::sin, -1.0, 0.5), Some(0.0));
        assert_eq!(bracketed(|x| x * x + 1.0, -1.0, 1.0), None);
    }
}

mod maximum {
    use slider_crank::numeric::maximum::{among_rows, beside, largest};

    /// Rises to 1.79 at 0.79 and falls thirty times as steeply.
    fn corner(x: f64) -> f64 {
        (1.0 + x).min(1.79 - 30.0 * (x - 0.79))
    }

    /// Two rows at one place, as at a corner, may differ by rounding in either sense.
    #[test]
    fn a_maximum_behind_two_rows_at_one_place_is_found() {
        let behind = 0.4f64.next_up();
        let mut rows = [0.0, 0.2, 0.4, behind, 0.81, 0.82, 0.83].map(|x| (x, corner(x)));
        rows[3].1 = rows[2].1.next_down();
        let found = among_rows(&rows, |known| beside(corner, known)).expect("rows");
        assert!((found.1 - 1.79).abs() < 1e-8, "{found:?}");
    }

    /// Beside each of twenty jumps the slopes promise more than there is.
    #[test]
    fn jumps_do_not_hide_a_maximum() {
        let saw = |x: f64| match x < 20.0 {
            true => 1.7 * (1.0 - x.fract().powi(2)),
            false => corner(x - 20.0),
        };
        let mut rows = Vec::new();
        for i in 0..20 {
            let x = f64::from(i);
            let parts = (0..40).map(|part| x + f64::from(part) / 40.0);
            rows.extend(parts.map(|x| (x, saw(x))));
            rows.push(((x + 1.0).next_down(), 0.0));
        }
        rows.extend([20.0, 20.4, 20.81, 20.82].map(|x| (x, saw(x))));
        let found = among_rows(&rows, |known| beside(saw, known)).expect("rows");
        assert!((found.1 - 1.79).abs() < 1e-7, "{found:?}");
    }

    #[test]
    fn the_top_of_a_parabola_is_found() {
        for (a, b) in [(-1.0, 4.0), (4.0, -1.0), (0.3, 4.0), (-1.0, 0.3)] {
            let mut calls = 0;
            let parabola = |t: f64| {
                calls += 1;
                2.0 - (t - 0.3).powi(2)
            };
            let (t, value) = largest(parabola, a, b);
            assert!((t - 0.3).abs() < 1e-7 && (value - 2.0).abs() < 1e-15);
            // Golden section search alone takes 45.
            assert!(calls < 45, "{calls}");
        }
    }

    #[test]
    fn a_peak_between_slopes_is_found() {
        for at in [0.0, 0.123, 0.5, 0.9999, 1.0] {
            let (t, value) = largest(|t| -(t - at).abs(), 0.0, 1.0);
            assert!((t - at).abs() < 1e-8 && value > -1e-8, "{at}: {t}");
        }
    }

    #[test]
    fn what_has_no_value_ends() {
        let (t, _) = largest(|_| f64::NAN, 0.0, 1.0);
        assert!((0.0..=1.0).contains(&t));
        assert_eq!(largest(|_| 3.0, 2.0, 2.0), (2.0, 3.0));
    }
}

mod difference {
    use slider_crank::numeric::difference::slope;

    #[test]
    fn polynomials_of_degree_six_are_exact() {
        let got = slope(|x| x.powi(6) - 3.0 * x.powi(5) + x, 0.7, 0.125);
        let want = 6.0 * 0.7f64.powi(5) - 15.0 * 0.7f64.powi(4) + 1.0;
        assert!((got - want).abs() < 1e-14, "{got} {want}");
    }
}

mod exact {
    use slider_crank::numeric::exact::sum3;

    #[test]
    fn cancelling_terms_leave_the_exact_rest() {
        assert_eq!(sum3(1.0, 1e-17, -1.0), 1e-17);
        assert_eq!(sum3(0.15, -0.1, -0.05), 0.15 - 0.1 - 0.05);
    }
}

mod median {
    use slider_crank::numeric::median::median;

    #[test]
    fn of_few_numbers() {
        assert_eq!(median([]), None);
        assert_eq!(median([3.0, -1.0, 2.0]), Some(2.0));
        assert_eq!(median([4.0, 1.0]), Some(4.0));
    }
}

mod angle {
    use std::f64::consts::TAU;

    use slider_crank::numeric::angle::Angle;

    #[test]
    fn whole_turns_leave_no_trace() {
        let far = Angle {
            turns: 1e6,
            rest: 0.25,
        };
        let same = Angle {
            turns: 0.0,
            rest: TAU + 0.25,
        }
        .reduced();
        assert_eq!(same.turns, 1.0);
        assert!((same.rest - 0.25).abs() < 1e-15);
        let small = Angle::from(-1e-5);
        assert_eq!(small.reduced(), small);
        assert_eq!(
            far.minus(Angle {
                turns: 1e6,
                rest: 0.0
            }),
            0.25
        );
    }
}

mod student {
    use slider_crank::numeric::student::half_band;

    /// Root of the regularized incomplete beta function, computed to 30 digits.
    #[test]
    fn the_point_is_exact_for_any_degrees_of_freedom() {
        for (freedom, expected) in [
            (1.0, 12.706_204_736_174_7),
            (1.25, 8.027_951_377_252_06),
            (1.7, 5.118_838_988_253_06),
            (2.0, 4.302_652_729_749_46),
            (3.0, 3.182_446_305_283_71),
            (4.0, 2.776_445_105_197_79),
            (5.0, 2.570_581_835_636_32),
            (7.5, 2.333_039_626_864_97),
            (10.0, 2.228_138_851_986_27),
            (33.3, 2.033_819_224_134_05),
            (100.0, 1.983_971_518_523_55),
            (1999.0, 1.961_151_420_170_56),
            (3000.0, 1.960_755_055_322_46),
            (1e5, 1.959_987_707_534_61),
            (1e9, 1.959_963_986_912_33),
        ] {
            let found = half_band(freedom);
            let error = (found / expected - 1.0).abs();
            assert!(error < 2e-14, "{freedom}: {found}");
        }
    }

    #[test]
    fn the_series_takes_over_without_a_step() {
        let (below, above) = (half_band(2000.0), half_band(2000.0 + 1e-9));
        assert!((below / above - 1.0).abs() < 1e-14, "{below} {above}");
    }
}

mod gauss {
    use std::cell::Cell;

    use slider_crank::numeric::gauss::{
        adaptive, composite, legendre, legendre_change, legendre_series,
    };

    #[test]
    fn polynomials_are_integrated_exactly() {
        for degree in 0..28 {
            let sum: f64 = (0..14)
                .map(|i| legendre(14, i))
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            assert!(
                (sum * f64::from(degree + 1) - 1.0).abs() < 1e-14,
                "{degree}"
            );
        }
        let peak = adaptive(&|x| 1e-3 / (x * x + 1e-6), &[0.0, 1.0], 1e-13);
        assert!((peak - 1e3f64.atan()).abs() < 1e-12, "{peak}");
        // Positive and negative parts cancel, far from zero.
        let calls = std::cell::Cell::new(0);
        let wave = |x: f64| {
            calls.set(calls.get() + 1);
            (x - 2e4).sin()
        };
        assert!(adaptive(&wave, &[2e4 - 1.0, 2e4 + 1.0], 0.0).abs() < 1e-11);
        assert!(calls.get() < 500, "{}", calls.get());
        assert!((composite(|x| x.powi(5), 0.0, 2.0, 3) - 64.0 / 6.0).abs() < 1e-13);
    }

    /// Over parts of [−1, 1], long and short: a bound that is not exceeded, and reached by each polynomial alone.
    #[test]
    fn a_legendre_series_changes_by_no_more_than_its_bound() {
        for part in [1.0f64, 0.5, 0.1, 0.01] {
            let places: [f64; 101] = std::array::from_fn(|i| -1.0 + 0.02 * i as f64);
            let change = |coefficients: &[f64; 8]| {
                let ends = places.map(|x| (x + 2.0 * part).min(1.0));
                let [here, there] = [places, ends].map(|x| legendre_series(coefficients, x));
                let pairs = here.into_iter().zip(there);
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let mixed: [f64; 8] = std::array::from_fn(|k| (1.7 * k as f64).sin());
            assert!(change(&mixed) <= legendre_change(&mixed, part));
            for k in 1..8 {
                let single: [f64; 8] = std::array::from_fn(|i| f64::from(u8::from(i == k)));
                let ratio = change(&single) / legendre_change(&single, part);
                assert!((0.4..=1.0 + 1e-12).contains(&ratio), "{k} {part}: {ratio}");
            }
        }
    }

    /// Beside its zero the integrand is rounding of the argument, which no bisection removes.
    #[test]
    fn an_adaptive_rule_ends_where_the_integrand_is_rounding() {
        let calls = Cell::new(0);
        let ramp = |x: f64| {
            calls.set(calls.get() + 1);
            ((1.0 + x) - 1.0).max(0.0)
        };
        assert!((adaptive(&ramp, &[0.0, 1.0], 0.0) - 0.5).abs() < 1e-15);
        assert!(calls.get() < 1000, "{}", calls.get());
        // So is a piece on which it is hardly there.
        calls.set(0);
        let step = |x: f64| {
            calls.set(calls.get() + 1);
            let hardly = (1.0 + 1e-13 * x) - 1.0;
            if x < 1.0 { 1.0 } else { hardly }
        };
        assert!((adaptive(&step, &[0.0, 1.0, 2.0], 0.0) - 1.0).abs() < 1e-12);
        assert!(calls.get() < 200, "{}", calls.get());
    }
}

mod partition {
    use std::cell::Cell;

    use slider_crank::numeric::enclosure::{
        Enclosed, Interval, PanelResolution, Variation, partition,
    };

    /// Far from zero an interval has few halvings until its middle is one of its ends.
    #[test]
    fn a_corner_is_located_to_the_last_place_far_from_zero() {
        let calls = Cell::new(0);
        for begin in [0.0, 5.7, -3e3, 1e6] {
            let corner = begin + 0.3;
            let [from, beyond] = [begin, 0.3].map(Enclosed::point);
            let variation = |part: Interval, ellipse: f64| {
                calls.set(calls.get() + 1);
                let distance = Enclosed::variable(part, ellipse) - from - beyond;
                Variation::of(distance.abs())
            };
            let wanted = PanelResolution {
                nodes: 24,
                part: 1e-20,
            };
            let ends = partition(variation, Interval::new(begin, begin + 0.5), wanted, 0.0);
            let nearest = ends.iter().map(|end| (end - corner).abs());
            let off = nearest.fold(f64::INFINITY, f64::min);
            assert!(off <= 2.0 * f64::EPSILON * begin.abs().max(1.0), "{ends:?}");
            assert!(ends.len() < 5 && calls.get() < 2000, "{}", calls.get());
        }
    }
}

mod trigonometry {
    use std::f64::consts::PI;

    use slider_crank::numeric::trigonometry::sin_cos;

    #[test]
    fn values_are_right_to_the_last_place_or_two() {
        let mut angle = -40.0;
        while angle < 40.0 {
            let angles: [f64; 4] = std::array::from_fn(|i| angle + 0.003 * i as f64);
            let (sin, cos) = sin_cos(&angles);
            for i in 0..4 {
                let (s, c) = angles[i].sin_cos();
                assert!(
                    (sin[i] - s).abs() <= 2.3e-16 * s.abs().max(1e-3),
                    "{}",
                    angles[i]
                );
                assert!(
                    (cos[i] - c).abs() <= 2.3e-16 * c.abs().max(1e-3),
                    "{}",
                    angles[i]
                );
            }
            angle += 0.0121;
        }
        let quarters: [f64; 8] = std::array::from_fn(|i| (i as f64 - 3.0) * 0.5 * PI);
        let (sin, cos) = sin_cos(&quarters);
        for i in 0..8 {
            let (s, c) = quarters[i].sin_cos();
            assert!(
                (sin[i] - s).abs() < 1e-20 + 2e-16 * s.abs(),
                "{} {s}",
                sin[i]
            );
            assert!(
                (cos[i] - c).abs() < 1e-20 + 2e-16 * c.abs(),
                "{} {c}",
                cos[i]
            );
        }
    }

    #[test]
    fn angles_far_away_and_none_at_all_are_served() {
        let (sin, cos) = sin_cos(&[1e9, 0.5, f64::NAN, f64::INFINITY]);
        assert_eq!((sin[0], cos[0]), 1e9f64.sin_cos());
        assert_eq!((sin[1], cos[1]), 0.5f64.sin_cos());
        assert!(sin[2].is_nan() && cos[2].is_nan() && sin[3].is_nan() && cos[3].is_nan());
    }
}
