//! Student's distribution.

/// Half of a 95 % band in standard errors: the 97.5 % point of Student's distribution with this many degrees of
/// freedom (Abramowitz and Stegun, 26.7.5; exact for 1 and 2).
pub fn half_band(freedom: f64) -> f64 {
    const NORMAL: f64 = 1.959_963_984_540_054;
    let x = NORMAL;
    if freedom < 1.5 {
        return 12.706_204_736_432_1;
    }
    if freedom < 2.5 {
        return 4.302_652_729_696_14;
    }
    let (x3, x5, x7, x9) = (x.powi(3), x.powi(5), x.powi(7), x.powi(9));
    let g1 = (x3 + x) / 4.0;
    let g2 = (5.0 * x5 + 16.0 * x3 + 3.0 * x) / 96.0;
    let g3 = (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / 384.0;
    let g4 = (79.0 * x9 + 776.0 * x7 + 1482.0 * x5 - 1920.0 * x3 - 945.0 * x) / 92160.0;
    let per = 1.0 / freedom;
    x + per * (g1 + per * (g2 + per * (g3 + per * g4)))
}

#[cfg(test)]
mod tests {
    use super::half_band;

    #[test]
    fn printed_tables() {
        for (freedom, expected) in [
            (1.0, 12.706),
            (3.0, 3.182),
            (5.0, 2.571),
            (10.0, 2.228),
            (30.0, 2.042),
        ] {
            let found = half_band(freedom);
            assert!(
                (found - expected).abs() < 0.03 * (1.0 + 2.0 / freedom),
                "{freedom}: {found}"
            );
        }
        assert!((half_band(10.0) - 2.228).abs() < 1e-3);
        assert!((half_band(1e9) - 1.959964).abs() < 1e-6);
    }
}
