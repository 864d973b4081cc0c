//! The periodic motion itself: the root of the energy that a cycle gains.
//!
//! The map of the kinetic energy over a cycle rises, as two motions cannot cross. So a motion approaches the
//! nearest energy, up where it gains and down where it loses, whose cycle gains nothing.

use super::super::energy::NotApplicable;
use crate::numeric::root;

/// How far from the first energy it is looked for: ln of the ratio.
const FARTHEST: f64 = 60.0;
/// The longest step in the logarithm of the energy.
const LONGEST_LOG_STEP: f64 = 0.4;
/// Halvings between an energy at which the crank stops in its turn and one that loses.
const HALVINGS: usize = 40;

/// Why there is no periodic motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCycle {
    /// The cycle cannot be computed over the angle.
    NotApplicable(NotApplicable),
    /// Every turn gains energy, up to the largest that was looked at.
    Gains,
    /// Every turn loses energy, or is not completed.
    Stops,
}

impl From<NotApplicable> for NoCycle {
    fn from(unserved: NotApplicable) -> NoCycle {
        NoCycle::NotApplicable(unserved)
    }
}

/// The kinetic energy at the end of a cycle, from that at its start.
pub trait CycleMap {
    /// The energy that is looked at first, J.
    fn first(&self) -> f64;

    /// Energy that a cycle from this one on gains, J.
    ///
    /// # Errors
    /// [`NotApplicable`] where the crank does not complete it.
    fn gain(&mut self, kinetic: f64) -> Result<f64, NotApplicable>;

    /// Largest kinetic energy in the last cycle, J.
    fn largest(&self) -> f64;

    /// Error of a gain, relative to that.
    fn noise(&self) -> f64;
}

/// An energy whose cycle gains nothing.
#[derive(Clone, Copy, Debug)]
pub struct FixedPoint {
    /// At the start of the cycle, J.
    pub kinetic: f64,
    /// d gain/d energy there.
    pub slope: f64,
    /// Error of the slope.
    pub slope_error: f64,
    /// Whether the motion from the first energy approaches it.
    pub approached: bool,
}

/// The periodic motion that a motion from the first energy approaches, or the next faster one if it stops; `step` is the
/// first step in the logarithm of the energy.
///
/// # Errors
/// [`NoCycle`] with the reason.
pub fn fixed_point(map: &mut dyn CycleMap, step: f64) -> Result<FixedPoint, NoCycle> {
    let first = map.first();
    let (low, high, approached) = bracket(map, first, step)?;
    // Close to the root rounding may give another sign: the values that made the bracket stay.
    let known = |kinetic: f64| {
        let mut ends = [low, high].into_iter();
        ends.find(|end| end.kinetic == kinetic).map(|end| end.gain)
    };
    let mut failed = None;
    let kinetic = root::bracketed(
        |kinetic| {
            let gain = known(kinetic).map_or_else(|| map.gain(kinetic), Ok);
            gain.unwrap_or_else(|unserved| {
                failed = Some(unserved);
                f64::NAN
            })
        },
        low.kinetic,
        high.kinetic,
    );
    let kinetic = kinetic.ok_or(failed.unwrap_or(NotApplicable::NotSmooth))?;
    let (slope, slope_error) = slope(map, kinetic)?;
    Ok(FixedPoint {
        kinetic,
        slope,
        slope_error,
        approached,
    })
}

/// A cycle that was looked at.
#[derive(Clone, Copy, Debug)]
struct Looked {
    /// At its start, J.
    kinetic: f64,
    /// J
    gain: f64,
}

/// d gain/d energy, by differences over three distances, and its error.
fn slope(map: &mut dyn CycleMap, kinetic: f64) -> Result<(f64, f64), NotApplicable> {
    let mut slope = Err(NotApplicable::TooSlow);
    for part in [2.5e-3, 1e-5, 1e-7] {
        slope = slope_over(map, kinetic, part);
        if slope.is_ok() {
            break;
        }
    }
    slope
}

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
        largest = largest.max(map.largest());
    }
    // Richardson: the errors go with the second and fourth power of the distance.
    let better = [0, 1].map(|i| (4.0 * slopes[i] - slopes[i + 1]) / 3.0);
    let best = (16.0 * better[0] - better[1]) / 15.0;
    let noise = map.noise() * largest / (part * kinetic);
    Ok((best, (best - better[0]).abs() + noise))
}

/// A cycle; none if the crank does not complete the turn.
fn look(map: &mut dyn CycleMap, kinetic: f64) -> Result<Option<Looked>, NoCycle> {
    match map.gain(kinetic) {
        Ok(gain) => Ok(Some(Looked { kinetic, gain })),
        Err(NotApplicable::TooSlow | NotApplicable::NotSmooth) => Ok(None),
        Err(unserved) => Err(unserved.into()),
    }
}

/// A turn that gains, one above it that loses, and whether the motion from the first energy goes there.
fn bracket(
    map: &mut dyn CycleMap,
    first: f64,
    step: f64,
) -> Result<(Looked, Looked, bool), NoCycle> {
    let at_first = look(map, first)?;
    let gain = at_first.map(|looked| looked.gain);
    if let Some(looked) = at_first.filter(|looked| looked.gain <= 0.0)
        && let Some((low, high)) = below(map, looked, step)?
    {
        return Ok((low, high, true));
    }
    let (low, high) = above(map, at_first, first, step)?;
    Ok((low, high, gain.is_some_and(|gain| gain > 0.0)))
}

/// The nearest such turns below one that loses.
fn below(
    map: &mut dyn CycleMap,
    first: Looked,
    step: f64,
) -> Result<Option<(Looked, Looked)>, NoCycle> {
    let (mut high, mut step) = (first, step);
    if first.gain == 0.0 {
        return Ok(Some((first, first)));
    }
    while (first.kinetic / high.kinetic).ln() < FARTHEST {
        let kinetic = high.kinetic * (-step).exp();
        match look(map, kinetic)? {
            Some(looked) if looked.gain >= 0.0 => return Ok(Some((looked, high))),
            Some(looked) => high = looked,
            None => return near_stop(map, kinetic, high),
        }
        step = (2.0 * step).min(LONGEST_LOG_STEP);
    }
    Ok(None)
}

/// The nearest such turns above.
fn above(
    map: &mut dyn CycleMap,
    at_first: Option<Looked>,
    first: f64,
    step: f64,
) -> Result<(Looked, Looked), NoCycle> {
    let (mut kinetic, mut step) = (first, step);
    let (mut gains, mut stops, mut turned) = (None, None, false);
    let mut looked = at_first;
    while (kinetic / first).ln() < FARTHEST {
        turned |= looked.is_some();
        match looked {
            None => (gains, stops) = (None, Some(kinetic)),
            Some(looked) if looked.gain >= 0.0 => gains = Some(looked),
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
        step = (2.0 * step).min(LONGEST_LOG_STEP);
        looked = look(map, kinetic)?;
    }
    Err(match (gains, turned) {
        (Some(_), _) => NoCycle::Gains,
        (None, true) => NoCycle::Stops,
        // No energy at all was enough: then it is not for want of energy.
        (None, false) => NotApplicable::NotSmooth.into(),
    })
}

/// Fixed point between an energy whose turn is not completed and a turn that loses.
fn near_stop(
    map: &mut dyn CycleMap,
    stops: f64,
    loses: Looked,
) -> Result<Option<(Looked, Looked)>, NoCycle> {
    let (mut stops, mut loses) = (stops, loses);
    for _ in 0..HALVINGS {
        let kinetic = (stops * loses.kinetic).sqrt();
        match look(map, kinetic)? {
            None => stops = kinetic,
            Some(looked) if looked.gain >= 0.0 => return Ok(Some((looked, loses))),
            Some(looked) => loses = looked,
        }
    }
    Ok(None)
}
