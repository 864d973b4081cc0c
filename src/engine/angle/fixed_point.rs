//! Periodic motion as the fixed point of the Poincaré map of the kinetic energy, by bracketing and Brent's method.
//!
//! The map of the kinetic energy over a cycle is monotone, for two motions cannot cross. A motion therefore approaches
//! the nearest energy at which a cycle gains nothing: upwards where it gains, downwards where it loses.

use super::super::energy::NotApplicable;
use crate::numeric::root;

/// Reason why there is no periodic motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCycle {
    /// Cycle that cannot be computed over the angle.
    NotApplicable(NotApplicable),
    /// Gain of energy in every cycle, up to the largest energy searched.
    Gains,
    /// Loss of energy in every cycle, or cycles not completed.
    Stops,
    /// No cycle completed, at any energy.
    Incomplete,
}

impl From<NotApplicable> for NoCycle {
    fn from(why: NotApplicable) -> NoCycle {
        NoCycle::NotApplicable(why)
    }
}

/// Poincaré map: gain of kinetic energy over a cycle as a function of the energy at its start.
pub trait CycleMap {
    /// Returns the energy at which the search starts, J.
    fn first(&self) -> f64;

    /// Returns the energy gained by a cycle from this one on, J.
    ///
    /// # Errors
    /// [`NotApplicable`] where the crank does not complete the cycle.
    fn gain(&mut self, kinetic: f64) -> Result<f64, NotApplicable>;

    /// Returns the largest kinetic energy in the last cycle, J.
    fn largest_kinetic(&self) -> f64;

    /// Returns the error of a gain, relative to [`Self::largest_kinetic`].
    fn noise(&self) -> f64;
}

/// Fixed point of the map: an energy whose cycle gains nothing.
#[derive(Clone, Copy, Debug)]
pub struct FixedPoint {
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
/// [`NoCycle`] with the reason.
pub fn fixed_point(map: &mut dyn CycleMap, step: f64) -> Result<FixedPoint, NoCycle> {
    let first = map.first();
    let (low, high, approached) = bracket(map, first, step)?;
    // Close to the root rounding may change a sign: the values that made the bracket are kept.
    let ends = [low, high].map(|end| (end.kinetic, end.gain));
    // An error of the gain moves the fixed point by no less.
    let width = map.noise() * low.kinetic;
    let kinetic = root::between(|kinetic| map.gain(kinetic), ends, width)?;
    let kinetic = kinetic.ok_or(NotApplicable::NotSmooth)?;
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
fn slope(map: &mut dyn CycleMap, kinetic: f64) -> Result<(f64, f64), NotApplicable> {
    slope_over(map, kinetic, 2.5e-3)
        .or_else(|_| slope_over(map, kinetic, 1e-5))
        .or_else(|_| slope_over(map, kinetic, 1e-7))
}

/// Computes the slope over distances of `part` of the energy, twice and four times as much.
fn slope_over(
    map: &mut dyn CycleMap,
    kinetic: f64,
    part: f64,
) -> Result<(f64, f64), NotApplicable> {
    let mut slopes = [0.0; 3];
    let mut largest = kinetic;
    for (slope, times) in slopes.iter_mut().zip([1.0, 2.0, 4.0]) {
        let way = times * part * kinetic;
        let ahead = map.gain(kinetic + way)?;
        *slope = (ahead - map.gain(kinetic - way)?) / (2.0 * way);
        largest = largest.max(map.largest_kinetic());
    }
    // Richardson: the errors are of second and fourth order in the distance.
    let better = [0, 1].map(|i| (4.0 * slopes[i] - slopes[i + 1]) / 3.0);
    let best = (16.0 * better[0] - better[1]) / 15.0;
    let noise = map.noise() * largest / (part * kinetic);
    Ok((best, (best - better[0]).abs() + noise))
}

/// Evaluates a cycle; none if the crank does not complete it.
fn evaluate(map: &mut dyn CycleMap, kinetic: f64) -> Result<Option<CycleGain>, NoCycle> {
    match map.gain(kinetic) {
        Ok(gain) => Ok(Some(CycleGain { kinetic, gain })),
        Err(NotApplicable::TooSlow | NotApplicable::NotSmooth) => Ok(None),
        Err(why) => Err(why.into()),
    }
}

/// Returns a cycle that gains, one above it that loses, and whether the motion from the first energy leads there.
fn bracket(
    map: &mut dyn CycleMap,
    first: f64,
    step: f64,
) -> Result<(CycleGain, CycleGain, bool), NoCycle> {
    let at_first = evaluate(map, first)?;
    let gain = at_first.map(|cycle| cycle.gain);
    if let Some(cycle) = at_first.filter(|cycle| cycle.gain <= 0.0)
        && let Some((low, high)) = below(map, cycle, step)?
    {
        return Ok((low, high, true));
    }
    let (low, high) = above(map, at_first, first, step)?;
    Ok((low, high, gain.is_some_and(|gain| gain > 0.0)))
}

/// True if the search goes on at this ratio of energies; no machine turns beyond it, with speeds in the ratio 1e13.
fn is_in_range(ratio: f64) -> bool {
    ratio.ln() < 60.0
}

/// Returns the next search step, as ln of the energy ratio: twice this one, up to a factor of 1.5.
fn longer(step: f64) -> f64 {
    let longest = 0.4;
    (2.0 * step).min(longest)
}

/// Returns the nearest bracket below a cycle that loses.
fn below(
    map: &mut dyn CycleMap,
    first: CycleGain,
    mut step: f64,
) -> Result<Option<(CycleGain, CycleGain)>, NoCycle> {
    let mut high = first;
    if first.gain == 0.0 {
        return Ok(Some((first, first)));
    }
    while is_in_range(first.kinetic / high.kinetic) {
        let kinetic = high.kinetic * (-step).exp();
        match evaluate(map, kinetic)? {
            Some(cycle) if cycle.gain >= 0.0 => return Ok(Some((cycle, high))),
            Some(cycle) => high = cycle,
            None => return near_stop(map, kinetic, high),
        }
        step = longer(step);
    }
    Ok(None)
}

/// Returns the nearest bracket above the first energy.
fn above(
    map: &mut dyn CycleMap,
    at_first: Option<CycleGain>,
    first: f64,
    mut step: f64,
) -> Result<(CycleGain, CycleGain), NoCycle> {
    let mut kinetic = first;
    let (mut gains, mut stops, mut turned) = (None, None, false);
    let mut cycle = at_first;
    while is_in_range(kinetic / first) {
        turned |= cycle.is_some();
        match cycle {
            None => (gains, stops) = (None, Some(kinetic)),
            Some(cycle) if cycle.gain >= 0.0 => gains = Some(cycle),
            Some(loses) => {
                if let Some(low) = gains {
                    return Ok((low, loses));
                }
                if let Some(stops) = stops.take()
                    && let Some(found) = near_stop(map, stops, loses)?
                {
                    return Ok(found);
                }
            }
        }
        kinetic *= step.exp();
        step = longer(step);
        cycle = evaluate(map, kinetic)?;
    }
    Err(match (gains, turned) {
        (Some(_), _) => NoCycle::Gains,
        (None, true) => NoCycle::Stops,
        (None, false) => NoCycle::Incomplete,
    })
}

/// Returns a bracket between an energy at which the cycle is not completed and a cycle that loses.
fn near_stop(
    map: &mut dyn CycleMap,
    mut stops: f64,
    mut loses: CycleGain,
) -> Result<Option<(CycleGain, CycleGain)>, NoCycle> {
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
