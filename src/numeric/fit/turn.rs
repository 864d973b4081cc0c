//! Harmonics over a turn by their Taylor series in narrow sectors of it: what very many rows take does not grow with the
//! number of harmonics.

use std::array;
use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use crate::numeric::parallel;

/// Sectors for each period of the last harmonic.
const NARROW: usize = 8;

/// Terms of a series: what is left out of the last harmonic is below (π/8)^14/14!, 3e-17 of it.
const TERMS: usize = 14;

/// Arguments for each sector from which on series pay.
const PAYS: usize = 4;

/// Added to a number of moderate size, it leaves the nearest whole number in the last bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Even parts of a turn, the first one about angle 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sectors {
    /// A power of two.
    count: usize,
    per_radian: f64,
}

impl Sectors {
    /// So narrow that series follow harmonics up to this one.
    pub fn of(last: usize) -> Sectors {
        let count = (NARROW * last.max(1)).next_power_of_two();
        Sectors {
            count,
            per_radian: count as f64 / TAU,
        }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// The sector of an angle (rad), and the place in it from −1 to 1.
    #[inline(always)]
    pub fn place(&self, angle: f64) -> (usize, f64) {
        let at = angle * self.per_radian;
        let shifted = at + ROUND;
        let sector = shifted.to_bits() as usize & (self.count - 1);
        // The place of an angle beyond all digits is no place.
        let place = 2.0 * (at - (shifted - ROUND));
        (sector, place.clamp(-1.0, 1.0))
    }

    /// Sine and cosine at the middles of the sectors.
    fn circle(&self) -> Vec<[f64; 2]> {
        let angle = |sector: usize| 2.0 * self.half() * sector as f64;
        let pair = |(sin, cos): (f64, f64)| [sin, cos];
        (0..self.count).map(|i| pair(angle(i).sin_cos())).collect()
    }

    /// Half the width of a sector, rad.
    fn half(&self) -> f64 {
        PI / self.count as f64
    }

    /// Sums over rows of cos kφ and sin kφ, k from 0 to `last`, each times a number of the row, from the sums of these numbers
    /// times an even number of powers of u, 1, u, u², ..., where u is the place in the sector.
    pub fn waves<'m, const N: usize>(
        &self,
        powers: impl Iterator<Item = &'m [f64; N]> + Clone,
        last: usize,
    ) -> Vec<[f64; 2]> {
        let circle = self.circle();
        let one = |k: usize| {
            let terms: [f64; N] = taylor(k as f64 * self.half());
            let mut sums = [0.0; 2];
            for (sector, powers) in powers.clone().enumerate() {
                let [mut even, mut odd] = [0.0; 2];
                for power in (0..N).step_by(2) {
                    even += terms[power] * powers[power];
                    odd += terms[power + 1] * powers[power + 1];
                }
                let [sin, cos] = circle[k * sector % self.count];
                sums[0] += cos * even - sin * odd;
                sums[1] += sin * even + cos * odd;
            }
            sums
        };
        (0..=last).map(one).collect()
    }
}

/// Terms of the series of cos zu for even powers of u, and of sin zu for odd ones.
fn taylor<const N: usize>(z: f64) -> [f64; N] {
    let mut term = 1.0;
    array::from_fn(|power| {
        if power > 0 {
            term *= z / power as f64;
        }
        if power % 4 < 2 { term } else { -term }
    })
}

/// Periodic functions of an angle: factors of cos kφ and sin kφ, k = 0, 1, 2, ...
pub(super) type Waves<const N: usize> = Vec<[[f64; N]; 2]>;

/// Sine and cosine of an angle, of twice the angle and so on, by the theorem of addition: each is as exact as the rounded angle lets
/// it be.
pub(super) fn harmonics(angle: f64) -> impl Iterator<Item = (f64, f64)> {
    let (sin, cos) = angle.sin_cos();
    let turned = move |(s, c): &(f64, f64)| Some((s * cos + c * sin, c * cos - s * sin));
    std::iter::successors(Some((sin, cos)), turned)
}

/// The functions at an angle, rad.
fn sum<const N: usize>(waves: &[[[f64; N]; 2]], angle: f64) -> [f64; N] {
    let mut sum = waves[0][0];
    for ([cosine, sine], (sin, cos)) in waves[1..].iter().zip(harmonics(angle)) {
        for (sum, (cosine, sine)) in sum.iter_mut().zip(cosine.iter().zip(sine)) {
            *sum += cos * cosine + sin * sine;
        }
    }
    sum
}

/// Periodic functions of an angle, each by its series in each sector.
#[derive(Clone, Debug)]
pub(super) struct Turn<const N: usize> {
    pub sectors: Sectors,
    terms: Vec<[[f64; N]; TERMS]>,
}

impl<const N: usize> Turn<N> {
    /// Of functions without harmonics that the sectors are too wide for.
    pub fn new(sectors: Sectors, waves: &[[[f64; N]; 2]]) -> Turn<N> {
        let circle = sectors.circle();
        let series: Vec<[f64; TERMS]> = (0..waves.len())
            .map(|k| taylor(k as f64 * sectors.half()))
            .collect();
        let terms = parallel::map(0..sectors.count, |sector| {
            let mut terms = [[0.0; N]; TERMS];
            for (k, ([cosine, sine], series)) in waves.iter().zip(&series).enumerate() {
                let [sin, cos] = circle[k * sector % sectors.count];
                let parts: [[f64; N]; 2] = [
                    array::from_fn(|n| cos * cosine[n] + sin * sine[n]),
                    array::from_fn(|n| cos * sine[n] - sin * cosine[n]),
                ];
                for (power, (terms, factor)) in terms.iter_mut().zip(series).enumerate() {
                    for (term, part) in terms.iter_mut().zip(&parts[power % 2]) {
                        *term += factor * part;
                    }
                }
            }
            Some(terms)
        });
        let terms = terms.into_iter().flatten().collect();
        Turn { sectors, terms }
    }

    /// The functions at a place of a sector.
    #[inline(always)]
    pub fn at(&self, (sector, place): (usize, f64)) -> [f64; N] {
        let mut sum = [0.0; N];
        for terms in self.terms[sector].iter().rev() {
            for (sum, term) in sum.iter_mut().zip(terms) {
                *sum = *sum * place + term;
            }
        }
        sum
    }
}

/// Periodic functions of an angle for any number of arguments.
#[derive(Clone, Debug)]
pub(super) struct Periodic<const N: usize> {
    waves: Waves<N>,
    /// None for few arguments.
    sectors: Option<Sectors>,
    turn: OnceLock<Turn<N>>,
}

impl<const N: usize> Periodic<N> {
    /// For about so many arguments.
    pub fn new(waves: Waves<N>, arguments: usize) -> Periodic<N> {
        let sectors = Sectors::of(waves.len() - 1);
        Periodic {
            waves,
            sectors: (arguments > PAYS * sectors.count).then_some(sectors),
            turn: OnceLock::new(),
        }
    }

    /// The functions at an angle, rad.
    #[inline(always)]
    pub fn at(&self, angle: f64) -> [f64; N] {
        let Some(sectors) = self.sectors else {
            return sum(&self.waves, angle);
        };
        let turn = self.turn.get_or_init(|| Turn::new(sectors, &self.waves));
        turn.at(sectors.place(angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_the_harmonics() {
        for last in [1, 5, 64] {
            let waves: Waves<2> = (0..=last)
                .map(|k| [[0, 2], [1, 3]].map(|of| of.map(|i| f64::from(7 * k + i).sin())))
                .collect();
            // An angle is known to rounding, and each of its multiples to so much more.
            let multiples: i32 = (1..=last).sum();
            let known = 4.0 * f64::EPSILON * f64::from(multiples);
            let sectors = Sectors::of(last as usize);
            let turn = Turn::new(sectors, &waves);
            for i in 0..1000 {
                let angle = -40.0 + 0.0803 * f64::from(i);
                let found = turn.at(sectors.place(angle));
                for n in 0..2 {
                    let waves = waves.iter().zip(0..);
                    let wanted: f64 = waves
                        .map(|([cosine, sine], k)| {
                            let angle = f64::from(k) * angle;
                            cosine[n] * angle.cos() + sine[n] * angle.sin()
                        })
                        .sum();
                    let off = (found[n] - wanted).abs();
                    assert!(off < known * (1.0 + angle.abs()), "{last}, {angle}: {off}");
                }
            }
        }
    }

    #[test]
    fn angles_beyond_all_digits_have_a_sector() {
        let sectors = Sectors::of(3);
        for angle in [1e17, -1e300, f64::INFINITY, f64::NAN] {
            let (sector, place) = sectors.place(angle);
            assert!(sector < sectors.count() && (place.is_nan() || place.abs() <= 1.0));
        }
    }
}
