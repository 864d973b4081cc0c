//! Checks samples against each other.

use super::listed::Listed;
use super::{Beside, BesideColumn, Measured, Measurement};
use crate::numeric::median::median;
use crate::scene::number::{apart, computed, counted, show};
use crate::scene::{Problem, Problems};

/// Largest magnitude of a sample, SI; larger ones leave no digits for quantities computed from them.
const LARGEST_SAMPLE: f64 = 1e12;

/// Whether a value is no usable number.
fn is_unusable(value: f64) -> bool {
    value.is_nan() || value.abs() > LARGEST_SAMPLE
}

/// Says what is wrong with this number of samples, if they are too few.
fn too_few(count: usize) -> Option<String> {
    let least = 6;
    let samples = counted(count, "sample");
    (count < least).then(|| format!("{samples} where at least {least} are needed"))
}

impl Measurement {
    /// Checks the samples, and notes gaps between them.
    pub(super) fn check(&mut self) -> Result<(), Problems> {
        let (times, values) = (&self.times, &self.values);
        if times.len() != values.len() {
            let what = format!("{} times but {} values", times.len(), values.len());
            let help = "give one value for each time";
            return Err(Problems::in_code(vec![Problem::new("samples", what, help)]));
        }
        let mut wrong = Listed::default();
        for (column, list) in [times, values].into_iter().enumerate() {
            if let Some(at) = list.iter().position(|value| is_unusable(*value)) {
                let what = format!("{} is not a usable number", show(list[at]));
                let help = format!("give finite values below {LARGEST_SAMPLE:e} in SI units");
                wrong.push(self.problem(at, column, what, help));
            }
        }
        let steps = self.elapsed().windows(2).enumerate();
        let faults = steps.filter(|(_, step)| step[1] <= step[0]);
        wrong.push_alike(faults, |(i, step)| {
            let (now, before) = apart(self.in_column(times[i + 1]), self.in_column(times[i]));
            let what = match step[1] == step[0] {
                true => format!("the time {now} is repeated"),
                false => format!("the time {now} follows {before}"),
            };
            let help = "times must rise strictly; take out or put right the row".to_owned();
            self.problem(i + 1, 0, what, help)
        });
        let text = self.source.as_ref().map_or("", |source| &source.text);
        let refused = wrong
            .refused(text)
            .or_else(|| Some(vec![self.too_short()?]));
        if let Some(list) = refused {
            return Err(self.refused(list));
        }
        self.check_beside()?;
        let spaced = self.space_evenly();
        let notes = [
            self.gaps(),
            self.far_from_zero(),
            self.at_rest(),
            self.broken_counts(),
            spaced,
        ];
        self.notes.extend(notes.into_iter().flatten());
        Ok(())
    }

    pub(super) fn check_beside(&self) -> Result<(), Problems> {
        for column in &self.beside {
            if let Beside::Sensor(other) = column.beside
                && [other, self.measured].contains(&Measured::Omega)
            {
                let what = "a sensor of the speed and one of the position are not taken together";
                let help = "give the position alone";
                return Err(self.refused(vec![Problem::new("columns", what, help)]));
            }
            if let Some(what) = self.fault(column) {
                let help = "give a finite value for each sample; a sensor may lack some of them";
                return Err(self.refused(vec![Problem::new("columns", what, help)]));
            }
        }
        Ok(())
    }

    /// Returns what is wrong with a column beside the motion.
    fn fault(&self, BesideColumn { beside, values }: &BesideColumn) -> Option<String> {
        if values.len() != self.len() {
            let values = counted(values.len(), "value");
            return Some(format!("{values} for {} samples", self.len()));
        }
        let sensor = match beside {
            Beside::Sensor(measured) => Some(measured.name()),
            _ => None,
        };
        let pairs = values.iter().enumerate();
        let mut given = pairs.filter(|(_, value)| sensor.is_none() || !value.is_nan());
        let count = given.clone().count();
        if let Some((at, value)) = given.find(|(_, value)| is_unusable(**value)) {
            let (value, place) = (show(*value), self.place(at));
            return Some(format!("{value} in {place} is not a usable number"));
        }
        sensor.and_then(|sensor| Some(format!("{sensor}: {}", too_few(count)?)))
    }

    /// Returns a time in the unit of its column.
    fn in_column(&self, time: f64) -> f64 {
        time / self.time.factor
    }

    /// Returns a problem for too few samples, or for times so close to each other that their unit must be wrong.
    fn too_short(&self) -> Option<Problem> {
        let times = self.elapsed();
        if let Some(what) = too_few(times.len()) {
            let source = self.source.as_ref();
            let end = source.map(|source| source.text.trim_end().len());
            let problem = Problem::new("samples", what, "give more of the motion");
            return Some(problem.at(end.map(|end| end..end)));
        }
        let length = times.last()? - times.first()?;
        // With a shorter one, s, powers of rates of change leave the range of doubles.
        let shortest = 1e-12;
        (length < shortest).then(|| {
            let what = format!("all samples lie within {} s", show(length));
            let help = format!("give times over more than {shortest:e} s: check their unit");
            self.problem(times.len() - 1, 0, what, help)
        })
    }

    /// Returns a note if all samples are equal.
    fn at_rest(&self) -> Option<String> {
        let first = *self.values.first()?;
        self.values.iter().all(|value| *value == first).then(|| {
            format!(
                "all values of {} are {}: the samples show no motion, and force and torque are those that hold the crank at rest",
                self.measured.name(),
                self.shown(first)
            )
        })
    }

    /// Returns a note if counts of an encoder are not whole numbers.
    fn broken_counts(&self) -> Option<String> {
        let counts = || self.values.iter().map(|value| value / self.resolution);
        let is_broken = |count: f64| (count - count.round()).abs() > 1e-9 * count.abs().max(1.0);
        let first = counts().position(is_broken).filter(|_| self.is_counted())?;
        Some(format!(
            "the counts of the encoder are not whole numbers, the first is {} at {}: a separator of thousands looks like a decimal mark",
            self.shown(self.values[first]),
            self.place(first)
        ))
    }

    /// Returns a note on gaps, time steps far above the median one.
    fn gaps(&self) -> Option<String> {
        let least_ratio = 4.5;
        let times = self.elapsed();
        let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
        if steps.iter().all(|step| *step <= least_ratio * least) {
            return None;
        }
        let usual = median(steps.iter().copied())?;
        let is_gap = |step: &&f64| **step > least_ratio * usual;
        let first = steps.iter().position(|step| is_gap(&step))?;
        Some(format!(
            "{}, the first before {} (time {}), where {} passes without a sample and {} is usual: nothing is known of the motion there but what the fit assumes",
            counted(steps.iter().filter(is_gap).count(), "gap"),
            self.place(first + 1),
            show(self.in_column(self.times[first + 1])),
            show(self.in_column(steps[first])),
            show(self.in_column(usual))
        ))
    }

    /// Returns a note on times that are too far from zero for the resolution of doubles.
    fn far_from_zero(&self) -> Option<String> {
        let known = computed(self.lost()?);
        let times = self.elapsed();
        let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        Some(match self.elapsed {
            Some(_) => format!(
                "times so far from zero are counted from the first row: the coefficients of the fit refer to the time since t = {} s, which as t_s in the rows is rounded to {known} s",
                self.origin()
            ),
            None => format!(
                "so far from zero, times are known to {known} s only, where samples are {} s apart, and forces to as little: let the time begin near 0",
                computed(step)
            ),
        })
    }
}
