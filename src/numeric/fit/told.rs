//! What samples tell of a motion that is no likely curve.
//!
//! The likely penalty is one for curves with a broad spectrum. A motion of strong slow waves and a weak fast one has none:
//! the penalty of the former bends the latter away, as if it were noise. How well a spline would foretell further samples
//! (Hurvich, Simonoff and Tsai, J. R. Statist. Soc. B 60 (1998) 271) asks for no such curves.

use super::choice::criterion;
use super::condensed::Rows;
use super::likely::{Choice, Left};
use super::penalized::{About, Normal};
use super::pieces::DEGREE;
use super::roughness::ORDER;

/// Most pieces and most rows of a spline that is looked at.
const MOST: usize = 2048;
const FEW: usize = 1 << 15;

/// Gain in the criterion from which on more pieces are asked for beyond doubt: errors of samples are not quite independent.
const SURE: f64 = 20.0;

/// Factor from one penalty that is tried to the next.
const STEP: f64 = 8.0;

/// Penalties that are tried beyond the best one, where that one leaves noise.
const PATIENCE: usize = 4;

/// Differences of the criterion up to which a spline is about as good as another one (Burnham and Anderson, Model Selection
/// and Multimodel Inference, Springer 2002, section 2.6).
const ALIKE: f64 = 2.0;

/// Part of the samples that the parameters may be worth.
const PART: f64 = 1.0 / 3.0;

/// A penalty for rows.
pub(super) struct Told<'a> {
    pub normal: Normal<'a>,
    /// Strength of the most likely penalty, and of the one of the fit.
    pub strengths: [f64; 2],
    /// Coefficients that are near.
    pub near: Vec<f64>,
    /// Criterion of foretelling, the less the better.
    value: f64,
}

impl<'a> Told<'a> {
    /// A likely penalty, and the strength of the one of its fit.
    pub fn likely(normal: Normal<'a>, choice: Choice, strength: f64) -> Told<'a> {
        Told {
            normal,
            strengths: [choice.strength, strength],
            near: choice.coefficients,
            value: f64::INFINITY,
        }
    }

    /// Weaker penalties and more pieces, where rows ask for them.
    pub fn by(rows: &'a Rows<'a>, likely: Told<'a>) -> Told<'a> {
        if likely.normal.grid.pieces > MOST || rows.number() > FEW {
            return likely;
        }
        let Some(told) = likely.foretelling(PATIENCE) else {
            return likely;
        };
        let least = match told.leaves_noise(rows) {
            true => told.value - SURE,
            false => f64::INFINITY,
        };
        likely.finer(rows, least).unwrap_or(told)
    }

    /// With the penalty that foretells best.
    fn foretelling(&self, patience: usize) -> Option<Told<'a>> {
        let [likely, strength] = self.strengths;
        let about = self.normal.about(self.near.clone());
        let (told, value) = foretelling(&about, strength, patience);
        let near = self
            .normal
            .solve_from(told, &self.normal.factor(told)?, about.near);
        Some(Told {
            normal: self.normal.clone(),
            strengths: [likely.min(likely / strength * told), told],
            near,
            value,
        })
    }

    /// With the pieces that foretell best of those that leave noise, if any do with a criterion below this one. More are
    /// taken where they certainly do better.
    fn finer(&self, rows: &'a Rows<'a>, mut least: f64) -> Option<Told<'a>> {
        let most = rows
            .blocks()
            .unwrap_or(rows.count.saturating_sub(DEGREE + 1))
            .min(MOST);
        let numbers = (0..).map(|doublings| self.normal.grid.pieces << doublings);
        let mut found = None;
        for pieces in numbers.take_while(|pieces| *pieces <= most) {
            let told = self.on(rows, pieces);
            if let Some(told) = told.filter(|told| told.value < least && told.leaves_noise(rows)) {
                least = told.value - SURE;
                found = Some(told);
            }
        }
        found
    }

    /// With the penalty that foretells best on so many pieces.
    fn on(&self, rows: &'a Rows<'a>, pieces: usize) -> Option<Told<'a>> {
        let normal = Normal::new(rows, pieces);
        let finer = pieces as f64 / self.normal.grid.pieces as f64;
        // Of the same roughness: it is that of differences over widths. A stronger penalty than the strongest one leaves no
        // digits of the samples.
        let same = finer.powi(2 * ORDER as i32) * normal.mean_pivot() / self.normal.mean_pivot();
        let same = same.min(normal.strongest() / self.strengths[1]);
        let weakest = normal.weakest();
        let started = Told {
            strengths: self.strengths.map(|strength| strength * same),
            near: normal.solve(weakest, &normal.factor(weakest)?),
            normal,
            value: self.value,
        };
        started.foretelling(usize::MAX)
    }

    fn leaves_noise(&self, rows: &Rows<'_>) -> bool {
        let left = Left::of(&self.normal.grid, &self.near, rows);
        left.is_noise(rows) || left.is_computed(rows)
    }
}

/// The strength of a penalty, at most this one, whose spline foretells best, or the weakest one that does about as well;
/// derivatives ask for a weaker one yet. Beside it the criterion.
fn foretelling(about: &About<'_>, strength: f64, patience: usize) -> (f64, f64) {
    let normal = about.normal;
    let (count, floor) = (normal.rows().count as f64, normal.floor());
    let (mut best, mut least) = (strength, f64::INFINITY);
    let (mut tried, mut worse) = (strength, 0);
    while worse < patience && tried >= normal.weakest() {
        let Some(factor) = normal.factor(tried) else {
            tried /= STEP;
            continue;
        };
        let parameters = factor
            .clone()
            .inverse_band()
            .trace_of_product(&normal.matrix);
        if parameters > PART * count {
            break;
        }
        let digits = (count - parameters) * floor * floor;
        let squares = about.squares_under(tried, &factor).max(digits);
        let value = criterion(count, parameters, squares);
        if value < least + ALIKE {
            (best, worse) = (tried, 0);
        } else {
            worse += 1;
        }
        least = least.min(value);
        tried /= STEP;
    }
    if best < strength {
        best = (best / STEP).max(normal.weakest());
    }
    (best, least)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use crate::numeric::fit::{Samples, Size, Spline};

    /// Steady rotation by 60 turns of 25 samples with two harmonics about as large as the noise, whose likely curve is a
    /// straight line.
    #[test]
    fn harmonics_in_noise_are_followed() {
        let mut state = 88_172_645_463_325_252u64;
        let mut random = || {
            // Xorshift.
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let (turns, rows, noise) = (60.0, 1500u32, 0.01);
        let harmonics = [(1.0, 0.02), (3.0, 0.01)];
        let t: Vec<f64> = (0..rows)
            .map(|i| (f64::from(i) + 0.6 * random()) / f64::from(rows))
            .collect();
        let rate = turns * TAU;
        let waves = |t: f64| -> f64 {
            let of = |(k, size): (f64, f64)| size * (k * rate * t).sin();
            harmonics.into_iter().map(of).sum()
        };
        for draw in 0..12 {
            let angle = |t: &f64| {
                let even: f64 = (0..12).map(|_| random()).sum();
                rate * t + waves(*t) + noise * even
            };
            let angles: Vec<f64> = t.iter().map(angle).collect();
            let samples = Samples {
                t: &t,
                target: &angles,
                weight: None,
                floor: 0.0,
            };
            let spline = Spline::fit(&samples, Size::Auto).expect("a spline");
            let squares = t.iter().fold([0.0; 2], |[off, all], t| {
                let waves = waves(*t);
                let found = spline.value(*t) - rate * t;
                [off + (found - waves).powi(2), all + waves.powi(2)]
            });
            let part = (squares[0] / squares[1]).sqrt();
            assert!(part < 0.5, "{draw}: {part}");
        }
    }
}
