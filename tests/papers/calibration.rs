//! Straight-line calibration compared with numbers computed in 40 digits, and its inverse use with a line of known
//! scatter.

use std::path::Path;

use crate::support::close;
use slider_crank::numeric::line_fit::LineFit;
use slider_crank::statics::calibrate;

const NG: [(f64, f64); 6] = [
    (2.45, 50.0),
    (4.91, 95.0),
    (7.36, 148.0),
    (9.81, 190.0),
    (12.27, 238.0),
    (14.72, 290.0),
];

#[test]
fn the_line_of_ng() {
    let with_zero: Vec<_> = NG.into_iter().chain([(0.0, 0.0)]).collect();
    for (points, intercept, slope, r_squared) in [
        (NG.to_vec(), 1.4266849, 19.4572960, 0.9992314),
        (with_zero, 0.7643846, 19.5195906, 0.9995055),
    ] {
        let fit = LineFit::new(&points).unwrap();
        close("intercept", fit.intercept, intercept, 1.0, 6e-8);
        close("slope", fit.slope, slope, 1.0, 6e-8);
        close("R2", fit.r_squared.unwrap(), r_squared, 1.0, 6e-8);
        let about_zero = LineFit::r_squared_about_zero(&points).unwrap();
        close("R2 about zero", about_zero, 0.9998429, 1.0, 6e-8);
    }
}

/// Standard errors by another textbook formula: the covariance (XᵀX)⁻¹ s² written out.
#[test]
fn standard_errors() {
    let fit = LineFit::new(&NG).unwrap();
    let n = NG.len() as f64;
    let (sx, sxx) = NG
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, _)| (a + x, b + x * x));
    let value = |x: f64| fit.intercept + fit.slope * x;
    let rest: f64 = NG.iter().map(|(x, y)| (y - value(*x)).powi(2)).sum();
    let variance = rest / (n - 2.0);
    let determinant = n * sxx - sx * sx;
    close(
        "slope",
        fit.slope_se.unwrap(),
        (variance * n / determinant).sqrt(),
        1.0,
        1e-13,
    );
    close(
        "intercept",
        fit.intercept_se.unwrap(),
        (variance * sxx / determinant).sqrt(),
        1.0,
        1e-12,
    );
    let (force, se) = fit.inverse(190.0).unwrap();
    close("there and back", value(force), 190.0, 190.0, 1e-14);
    let mean = sx / n;
    let spread = sxx - sx * mean;
    let want =
        variance.sqrt() / fit.slope * (1.0 + 1.0 / n + (force - mean).powi(2) / spread).sqrt();
    close("uncertainty", se.unwrap(), want, want, 1e-12);
}

/// A line far from the origin keeps its digits.
#[test]
fn far_from_the_origin() {
    let points: Vec<_> = (0..1000)
        .map(|i| (1e8 + f64::from(i), 3.0 * f64::from(i) - 7.0))
        .collect();
    let fit = LineFit::new(&points).unwrap();
    close("slope", fit.slope, 3.0, 3.0, 1e-14);
    close("place", fit.inverse(-7.0).unwrap().0, 1e8, 1e8, 2e-16);
    assert!(fit.residual_sd.unwrap() < 1e-11);
}

#[test]
fn what_is_no_line() {
    assert!(LineFit::new(&[]).is_none() && LineFit::new(&[(1.0, 2.0)]).is_none());
    assert!(LineFit::new(&[(1.0, 2.0), (1.0, 3.0)]).is_none());
    assert!(LineFit::new(&[(1.0, f64::NAN), (2.0, 3.0)]).is_none());
    let two = LineFit::new(&[(0.0, 1.0), (1.0, 3.0)]).unwrap();
    assert_eq!(
        (two.slope, two.intercept, two.residual_sd),
        (2.0, 1.0, None)
    );
    assert_eq!(two.inverse(2.0), Some((0.5, None)));
    let level = LineFit::new(&[(0.0, 1.0), (1.0, 1.0), (2.0, 1.0)]).unwrap();
    assert_eq!((level.r_squared, level.inverse(1.0)), (None, None));
}

#[test]
fn files() {
    let result = calibrate(Path::new("data/ng-calibration.csv"), &[190.0, 400.0]).unwrap();
    close("slope", result.fit.slope, 19.4572960, 1.0, 6e-8);
    close(
        "force",
        result.forces[0].force_n,
        (190.0 - 1.4266849) / 19.4572960,
        1.0,
        1e-7,
    );
    assert_eq!(result.warnings.len(), 1, "{:?}", result.warnings);
    let folder = tempfile::tempdir().unwrap();
    let refused = |text: &str, words: &[&str]| {
        let file = folder.path().join("calibration.csv");
        std::fs::write(&file, text).unwrap();
        let said = calibrate(&file, &[1.0]).unwrap_err().to_string();
        for word in words {
            assert!(said.contains(word), "{word} in {said}");
        }
    };
    refused(
        "load [N],reading\n1,2\n2,x\n",
        &["line 3", "column 2", "`x`"],
    );
    refused("load [N],reading\n1,2\n2\n", &["line 3", "1 value"]);
    refused("load [mm],reading\n1,2\n", &["line 1", "mm"]);
    refused("load,reading\n1,2\n", &["line 1", "unit"]);
    refused("1,2\n2,4\n", &["line 1", "name"]);
    refused("load [N],reading\n1,2\n", &["line"]);
    refused("load [N],reading\n1,2\n2,2\n3,2\n", &["depend"]);
    refused("load [N],reading\n1,2\n2,inf\n", &["line 3", "finite"]);
    refused("", &["line"]);
    assert!(calibrate(Path::new("no-such.csv"), &[]).is_err());
    for reading in [f64::NAN, f64::INFINITY] {
        let said = calibrate(Path::new("data/ng-calibration.csv"), &[reading]);
        assert!(said.unwrap_err().to_string().contains("finite"));
    }
}
