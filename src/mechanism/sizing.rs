//! Crank and rod from stroke, rod ratio and offset, in closed form.

use crate::error::Error;
use crate::scene::LARGEST_VALUE;

/// Solves for crank and rod (m) of a crank that turns fully, from the stroke (m), the ratio rod/crank and the offset
/// (m), exactly: the stroke S = sqrt((l + r)² − e²) − sqrt((l − r)² − e²) with l = ρ r gives
/// 16 ρ² r⁴ − 4 (ρ² + 1) S² r² + S² (S² + 4 e²) = 0.
///
/// Of two solutions the longer crank is taken, which keeps clear of the limit l = r + |e|. For e = 0 the crank is
/// r = S/2, Obaseki & Alfred (49).
///
/// # Errors
/// [`Error::Refused`] if no crank fits.
///
/// ```
/// use slider_crank::mechanism::{size_from_stroke, Limits, Linkage};
/// use slider_crank::scene::{Branch, Geometry};
/// let (crank, rod) = size_from_stroke(0.08, 1.6, 0.015).unwrap();
/// let geometry = Geometry { crank, rod, offset: 0.015, branch: Branch::Right };
/// let stroke = Limits::new(&Linkage::new(&geometry), 0.0).stroke;
/// assert!((stroke - 0.08).abs() < 1e-16);
/// ```
pub fn size_from_stroke(stroke: f64, ratio: f64, offset: f64) -> Result<(f64, f64), Error> {
    let finite = [stroke, ratio, offset].into_iter().all(f64::is_finite);
    if !finite || stroke <= 0.0 || ratio <= 1.0 {
        return Err(Error::refused(
            format!(
                "a stroke of {stroke} m with a rod of {ratio} crank lengths and an offset of {offset} m is no crank that turns fully"
            ),
            "give a stroke above zero and a ratio above one",
        ));
    }
    // In units of the stroke, r² is (ρ² + 1 ± root)/(8 ρ²).
    let e = offset / stroke;
    let squared = ratio * ratio;
    let difference = (ratio - 1.0) * (ratio + 1.0);
    let under_root = (difference - 4.0 * ratio * e) * (difference + 4.0 * ratio * e);
    let crank = stroke * ((squared + 1.0 + under_root.max(0.0).sqrt()) / (8.0 * squared)).sqrt();
    if under_root < 0.0 || crank * (ratio - 1.0) <= offset.abs() {
        let most = stroke * difference / (4.0 * ratio);
        return Err(Error::refused(
            format!(
                "no crank that turns fully has a stroke of {stroke} m with a rod of {ratio} crank lengths and an offset of {offset} m"
            ),
            format!("the offset must be below {most} m, or the ratio greater"),
        ));
    }
    let rod = ratio * crank;
    if !(0.0..=LARGEST_VALUE).contains(&rod) {
        return Err(Error::refused(
            format!(
                "a rod of {ratio:e} crank lengths for a stroke of {stroke:e} m is too long to be computed with"
            ),
            format!("give a ratio and a stroke with which it is below {LARGEST_VALUE:e} m"),
        ));
    }
    Ok((crank, rod))
}
