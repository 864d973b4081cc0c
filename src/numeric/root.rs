//! Roots of scalar functions in a bracket, by Brent's method, to rounding.

/// Solves f(x) = 0 in [a, b], where f(a) and f(b) differ in sign or one of them is zero, by Brent's method (Algorithms
/// for Minimization without Derivatives, 1973, ch. 4), until the bracket is at most 2 ε |x| wide or f is exactly zero.
///
/// Returns `None` if the signs do not differ or a value is NaN.
pub fn bracketed(mut f: impl FnMut(f64) -> f64, a: f64, b: f64) -> Option<f64> {
    let ends = [a, b].map(|at| (at, f(at)));
    brent(&mut f, ends, 0.0)
}

/// Solves f(x) = 0 as [`bracketed`], between two places at which the values of f are known, to a width
/// where the last bits of the root are not needed.
///
/// # Errors
/// The first error of f.
pub fn between<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    ends: [(f64, f64); 2],
    width: f64,
) -> Result<Option<f64>, E> {
    let mut failed = None;
    let mut known = |at: f64| {
        f(at).unwrap_or_else(|error| {
            failed = Some(error);
            f64::NAN
        })
    };
    let root = brent(&mut known, ends, width);
    failed.map_or(Ok(root), Err)
}

// Compiled once, not for every function.
fn brent(f: &mut dyn FnMut(f64) -> f64, ends: [(f64, f64); 2], width: f64) -> Option<f64> {
    let [(mut a, mut fa), (mut b, mut fb)] = ends;
    if fa == 0.0 {
        return Some(a);
    }
    if fb == 0.0 {
        return Some(b);
    }
    if fa.is_nan() || fb.is_nan() || (fa > 0.0) == (fb > 0.0) {
        return None;
    }
    let (mut c, mut fc) = (a, fa);
    let mut step = b - a;
    let mut last_step = step;
    for _ in 0..200 {
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let tolerance = f64::EPSILON * b.abs() + width;
        let half = 0.5 * (c - b);
        if half.abs() <= tolerance || fb == 0.0 {
            return Some(b);
        }
        if last_step.abs() > tolerance && fa.abs() > fb.abs() {
            let s = fb / fa;
            let (mut p, mut q) = if a == c {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (
                    s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)),
                    (q - 1.0) * (r - 1.0) * (s - 1.0),
                )
            };
            if p > 0.0 {
                q = -q;
            }
            p = p.abs();
            let accepted =
                2.0 * p < (3.0 * half * q - (tolerance * q).abs()).min((last_step * q).abs());
            (last_step, step) = if accepted {
                (step, p / q)
            } else {
                (half, half)
            };
        } else {
            (last_step, step) = (half, half);
        }
        (a, fa) = (b, fb);
        b += if step.abs() > tolerance {
            step
        } else {
            tolerance.max(f64::MIN_POSITIVE).copysign(half)
        };
        fb = f(b);
        if fb.is_nan() {
            return None;
        }
        if (fb > 0.0) == (fc > 0.0) {
            (c, fc) = (a, fa);
            step = b - a;
            last_step = step;
        }
    }
    Some(b)
}
