//! Means of samples in their place: what moves by less than its noise in the time of a mean is told by means as well.

use std::ops::Range;

use super::grid::{Course, LONG, NODE_ROTATION};
use super::record::Record;
use super::scales::root_mean_square;
use crate::numeric::parallel;

/// Blocks of samples, of a time and a rotation at most.
#[derive(Debug)]
pub(super) struct Blocks {
    /// The first sample of each block, then the number of samples.
    pub first: Vec<usize>,
    /// The most samples of a block, in the mean.
    most: usize,
    /// Their time, s.
    pub time: f64,
}

/// Samples that have means in their place, one for each block.
#[derive(Debug)]
pub(super) struct Condensed<'a> {
    pub record: Record<'a>,
    pub blocks: Blocks,
}

impl Blocks {
    /// Places samples at crank angles, rad, in blocks of so many, or of fewer where nodes may not be as far apart; none where each
    /// would have its own. Samples of codes and of several sensors stand for themselves, as do computed ones that are not many:
    /// they have no noise.
    pub fn new(record: &Record<'_>, theta: &[f64], most: usize) -> Option<Blocks> {
        let (times, last) = (&record.times, theta.len() - 1);
        let most = match record.is_computed() {
            true => most.min(times.len() / LONG),
            false => most,
        };
        if most < 2 || !record.intervals.is_empty() || !record.beside.is_empty() {
            return None;
        }
        // A half less, as times are rounded.
        let time = (most as f64 - 0.5) * (times[last] - times[0]) / last as f64;
        // Noise from sample to sample is no motion.
        let apart = last.div_ceil(1000);
        let longest = |sample: usize| {
            let from = sample.min(last - apart);
            let speed = (theta[from + apart] - theta[from]) / (times[from + apart] - times[from]);
            time.min(NODE_ROTATION[0] / speed.abs())
        };
        // Samples at the ends have no others beside them: nothing is extrapolated.
        let mut first = vec![0, 1];
        let mut sample = 1;
        while sample < last {
            let end = times[sample] + longest(sample);
            sample += times[sample..last].partition_point(|t| *t < end).max(1);
            first.push(sample);
        }
        first.push(last + 1);
        (first.len() <= last).then_some(Blocks { first, most, time })
    }

    fn ranges(&self) -> impl ExactSizeIterator<Item = Range<usize>> {
        self.first.windows(2).map(|ends| ends[0]..ends[1])
    }

    /// Returns the mean of each block.
    pub fn means(&self, values: &[f64]) -> Vec<f64> {
        let mean = |block: Range<usize>| {
            let of_block = &values[block];
            of_block.iter().sum::<f64>() / of_block.len() as f64
        };
        self.ranges().map(mean).collect()
    }

    /// Returns the most samples of a block for a part of the time or of the rotation of these.
    pub fn shorter(&self, of_time: f64, of_angle: f64) -> usize {
        let length = self.first[self.first.len() - 1] as f64 / self.ranges().len() as f64;
        let most = f64::min(of_time * self.most as f64, of_angle * length);
        self.most.min(most as usize + 1) - 1
    }
}

impl<'a> Condensed<'a> {
    /// Returns the means: of the deviations from a motion, beside what that shows.
    pub fn about(&self, path: &Course<'_>) -> Record<'a> {
        let own = &self.record;
        let means = self.blocks.means(&own.times);
        let blocks: Vec<Range<usize>> = self.blocks.ranges().collect();
        let spreads = blocks.iter().zip(&means).map(|(block, mean)| {
            root_mean_square(own.times[block.clone()].iter().map(|t| t - mean))
        });
        let mut record = Record {
            spreads: spreads.collect(),
            times: means.into(),
            values: Vec::new(),
            weights: Vec::new(),
            repeated: vec![false; blocks.len()],
            tones: own.tones.clone(),
            intervals: Vec::new(),
            shown: Vec::new(),
            beside: Vec::new(),
            ..*own
        };
        (record.values, record.weights) = parallel::pairs(blocks.len(), |k| {
            let (mut weight, mut sum) = (0.0, 0.0);
            for i in blocks[k].clone() {
                let (residual, _) = own.sensor.residual(own.values[i], path.at(own.times[i]));
                if own.weights[i] > 0.0 && residual.is_finite() {
                    weight += own.weights[i];
                    sum += own.weights[i] * residual;
                }
            }
            let shown = |t: f64| own.sensor.shown(path.at(t)).value;
            let [a, b] = record.times_of(k).map(shown);
            let off = if weight > 0.0 { sum / weight } else { 0.0 };
            (0.5 * (a + b) + off, weight)
        });
        record
    }
}
