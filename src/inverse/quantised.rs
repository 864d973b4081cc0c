//! Codes of an encoder where several samples lie in one step: the times of going from code to code tell more than the codes.

/// Samples that stand for others.
#[derive(Clone, Debug, Default)]
pub(super) struct Transitions {
    /// s, rising.
    pub times: Vec<f64>,
    /// rad
    pub values: Vec<f64>,
    /// Weight beside a sample whose error is spread over a step.
    pub weights: Vec<f64>,
    /// Where each original sample is among these.
    pub rows: Vec<usize>,
    /// The step, rad.
    pub step: f64,
}

/// Part of the samples that are equal to the one before from which on codes are told by their transitions.
const DWELLING: f64 = 0.15;

/// Part of a step to which differences are multiples of it.
const MULTIPLE: f64 = 0.05;

/// The step of which all differences are multiples, if there is one.
fn common_step(values: &[f64]) -> Option<f64> {
    let differences = values.windows(2).map(|w| (w[1] - w[0]).abs());
    let step = differences
        .clone()
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, f64::min);
    let off = |d: f64| (d / step - (d / step).round()).abs();
    let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    // What the digits leave of large multiples.
    let is_multiple = |d: f64| d < 20.0 * step && off(d) < MULTIPLE || d >= 20.0 * step;
    (step.is_finite() && step > 1e-12 * largest && differences.clone().all(is_multiple))
        .then_some(step)
}

/// The transitions of codes, if most samples dwell on them.
///
/// A transition by one step lies between two samples, at a time with the variance h²/12 for the time h between them; as an angle
/// that is (step/len)²/12 for a code that stays for len samples, the shorter stay on both sides. The samples of one stay have
/// one error together, of the variance step²/12: each has its share of that weight.
pub(super) fn transitions(times: &[f64], values: &[f64]) -> Option<Transitions> {
    let equal = values.windows(2).filter(|w| w[0] == w[1]).count();
    if (equal as f64) < DWELLING * values.len() as f64 {
        return None;
    }
    let mut found = Transitions {
        step: common_step(values)?,
        ..Transitions::default()
    };
    let mut first = 0;
    let mut before: Option<(usize, usize)> = None;
    while first < values.len() {
        let length = values[first..]
            .iter()
            .take_while(|v| **v == values[first])
            .count();
        if let Some((last, stayed)) = before {
            let is_one = (values[first] - values[last]).abs() < 1.5 * found.step;
            if is_one && stayed.max(length) > 1 {
                let stay = stayed.min(length) as f64;
                found.times.push(0.5 * (times[last] + times[first]));
                found.values.push(0.5 * (values[last] + values[first]));
                found.weights.push(stay * stay);
            }
        }
        for i in first..first + length {
            found.rows.push(found.times.len());
            found.times.push(times[i]);
            found.values.push(values[i]);
            found.weights.push(1.0 / length as f64);
        }
        before = Some((first + length - 1, length));
        first += length;
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::transitions;

    #[test]
    fn transitions_lie_between_codes() {
        let times: Vec<f64> = (0..12).map(|i| 0.1 * f64::from(i)).collect();
        let codes = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 4.0];
        let values: Vec<f64> = codes.iter().map(|c| 0.25 * c).collect();
        let found = transitions(&times, &values).expect("codes");
        assert_eq!(found.step, 0.25);
        let rows: Vec<f64> = found.rows.iter().map(|row| found.times[*row]).collect();
        assert_eq!(rows, times);
        let told: Vec<_> = (0..found.times.len())
            .filter(|i| found.weights[*i] > 1.0)
            .collect();
        // Two steps at once tell no transition.
        assert_eq!(told.len(), 2);
        assert!((found.times[told[0]] - 0.35).abs() < 1e-12 && found.values[told[0]] == 0.125);
        assert_eq!((found.weights[0], found.weights[told[0]]), (0.25, 16.0));
    }

    #[test]
    fn noise_has_no_codes() {
        let times: Vec<f64> = (0..50).map(f64::from).collect();
        let values: Vec<f64> = times.iter().map(|t| (t * t).sin()).collect();
        assert!(transitions(&times, &values).is_none());
    }
}
