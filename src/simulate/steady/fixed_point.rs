//! Periodic motion as the fixed point of the Poincaré map of the kinetic energy, by bracketing and Brent's method.
//!
//! The map of the kinetic energy over a cycle is monotone, for two motions cannot cross. A motion therefore approaches
//! the nearest energy at which a cycle gains nothing: upwards where it gains, downwards where it loses.

use super::cycles::{CycleMap, not_computed};
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::numeric::root;

/// Fixed point of the map: an energy whose cycle gains nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct FixedPoint {
    /// Kinetic energy at the start of the cycle, J.
    pub kinetic: f64,
    /// Derivative of the gain with respect to the energy.
    pub slope: f64,
    /// Error bound of the slope.
    pub slope_error: f64,
    /// True if the motion from the first energy approaches it.
    pub approached: bool,
}

/// Finds the periodic motion that a motion from the first energy approaches, or the next faster one if it stops; `step`
/// is the first search step in ln of the energy.
///
/// # Errors
/// The reason why there is no periodic motion, or none was found.
pub(super) fn fixed_point(map: &mut CycleMap<'_>, step: f64) -> Result<FixedPoint, Error> {
    let first = map.first();
    let (low, high, approached) = bracket(map, first, step)?;
    // Close to the root rounding may change a sign: the values that made the bracket are kept.
    let ends = [low, high].map(|end| (end.kinetic, end.gain));
    // An error of the gain moves the fixed point by no less.
    let width = map.noise * low.kinetic;
    let kinetic = root::between(|kinetic| map.gain_of_complete(kinetic), ends, width)?;
    let kinetic = kinetic.ok_or_else(|| not_computed(NotApplicable::NotSmooth))?;
    let (slope, slope_error) = slope(map, kinetic)?;
    Ok(FixedPoint {
        kinetic,
        slope,
        slope_error,
        approached,
    })
}

/// Energy gained by a cycle.
#[derive(Clone, Copy, Debug)]
struct CycleGain {
    /// Kinetic energy at the start, J.
    kinetic: f64,
    /// Energy gained, J.
    gain: f64,
}

/// Computes d gain/d energy and its error bound by central differences over three distances, extrapolated; over shorter
/// ones where the crank does not complete a cycle.
fn slope(map: &mut CycleMap<'_>, kinetic: f64) -> Result<(f64, f64), Error> {
    slope_over(map, kinetic, 2.5e-3)
        .or_else(|_| slope_over(map, kinetic, 1e-5))
        .or_else(|_| slope_over(map, kinetic, 1e-7))
}

/// Computes the slope over distances of `part` of the energy, twice and four times as much.
fn slope_over(map: &mut CycleMap<'_>, kinetic: f64, part: f64) -> Result<(f64, f64), Error> {
    let mut slopes = [0.0; 3];
    let mut largest = kinetic;
    for (slope, times) in slopes.iter_mut().zip([1.0, 2.0, 4.0]) {
        let way = times * part * kinetic;
        let ahead = map.gain_of_complete(kinetic + way)?;
        *slope = (ahead - map.gain_of_complete(kinetic - way)?) / (2.0 * way);
        largest = largest.max(map.largest_kinetic);
    }
    // Richardson: the errors are of second and fourth order in the distance.
    let better = [0, 1].map(|i| (4.0 * slopes[i] - slopes[i + 1]) / 3.0);
    let best = (16.0 * better[0] - better[1]) / 15.0;
    let noise = map.noise * largest / (part * kinetic);
    Ok((best, (best - better[0]).abs() + noise))
}

/// Evaluates a cycle; none if the crank does not complete it.
fn evaluate(map: &mut CycleMap<'_>, kinetic: f64) -> Result<Option<CycleGain>, Error> {
    let gain = map.gain(kinetic)?;
    Ok(gain.map(|gain| CycleGain { kinetic, gain }))
}

/// Returns a cycle that gains, one above it that loses, and whether the motion from the first energy leads there.
fn bracket(
    map: &mut CycleMap<'_>,
    first: f64,
    step: f64,
) -> Result<(CycleGain, CycleGain, bool), Error> {
    let at_first = evaluate(map, first)?;
    let gain = at_first.map_or(f64::NAN, |cycle| cycle.gain);
    if let Some(cycle) = at_first.filter(|cycle| cycle.gain == 0.0) {
        return Ok((cycle, cycle, true));
    }
    if gain < 0.0
        && let Ok((low, high)) = search(map, first, at_first, -step)?
    {
        return Ok((low, high, true));
    }
    let (low, high) = search(map, first, at_first, step)??;
    Ok((low, high, gain > 0.0))
}

/// Walks from the first energy by steps in its logarithm, of either sign, to a cycle that gains and the next one above,
/// which loses; the inner error tells why there are none.
fn search(
    map: &mut CycleMap<'_>,
    first: f64,
    at_first: Option<CycleGain>,
    mut step: f64,
) -> Result<Result<(CycleGain, CycleGain), Error>, Error> {
    // No machine turns beyond this ratio of energies, with speeds in the ratio 1e13. Steps grow up to a factor of 1.5.
    let (widest, longest): (f64, f64) = (60.0, 0.4);
    let (mut kinetic, mut here, mut turned) = (first, at_first, at_first.is_some());
    while (kinetic / first).ln().abs() < widest {
        let ahead = kinetic * step.exp();
        let next = evaluate(map, ahead)?;
        let (lowest, [low, high]) = match step > 0.0 {
            true => (kinetic, [here, next]),
            false => (ahead, [next, here]),
        };
        if let Some(high) = high.filter(|high| high.gain < 0.0) {
            let found = match low {
                Some(low) => (low.gain >= 0.0).then_some((low, high)),
                None => near_stop(map, lowest, high)?,
            };
            if let Some(found) = found {
                return Ok(Ok(found));
            }
            if low.is_none() && step < 0.0 {
                break;
            }
        }
        turned |= next.is_some();
        (kinetic, here) = (ahead, next);
        step = (2.0 * step).clamp(-longest, longest);
    }
    Ok(Err(match (here, map.stopped.take()) {
        (Some(cycle), _) if cycle.gain >= 0.0 => Error::refused(
            "no steady state: at every speed a cycle gains energy",
            "add a load that brakes the more the faster the crank turns",
        ),
        _ if turned => Error::refused(
            "no steady state: at every speed a cycle loses energy or is not completed, the crank stops",
            "add a load that drives the crank in the sense of motion.speed",
        ),
        (_, Some(stopped)) => Error::refused(
            format!("no steady state: at no speed the crank completes a cycle: {stopped}"),
            "change what ends the cycle there",
        ),
        // The reason is not a lack of energy.
        (_, None) => not_computed(NotApplicable::NotSmooth),
    }))
}

/// Returns a bracket between an energy at which the cycle is not completed and a cycle that loses.
fn near_stop(
    map: &mut CycleMap<'_>,
    mut stops: f64,
    mut loses: CycleGain,
) -> Result<Option<(CycleGain, CycleGain)>, Error> {
    // A search step halved so often is 4e-13 of the energy.
    let halvings = 40;
    for _ in 0..halvings {
        let kinetic = (stops * loses.kinetic).sqrt();
        match evaluate(map, kinetic)? {
            None => stops = kinetic,
            Some(cycle) if cycle.gain >= 0.0 => return Ok(Some((cycle, loses))),
            Some(cycle) => loses = cycle,
        }
    }
    Ok(None)
}
