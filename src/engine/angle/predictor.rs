//! First guess of the kinetic energy on a panel, by extrapolation of its profiles in the last turns.

use std::collections::VecDeque;

use crate::numeric::chebyshev::Values;

/// Number of profiles kept: one more than the degree of the polynomial through them.
const PROFILES_KEPT: usize = 5;

/// Kinetic energy profiles at the points of a panel.
pub(super) struct Predictor {
    /// Profiles in the last turns, the latest first.
    profiles: VecDeque<Values>,
    /// Profile of an attempt with another panel, until there is a solution.
    attempt: Option<Values>,
}

impl Predictor {
    pub fn new() -> Predictor {
        Predictor {
            profiles: VecDeque::with_capacity(PROFILES_KEPT),
            attempt: None,
        }
    }

    /// Forgets all profiles, and begins with that of an attempt, if any.
    pub fn restart(&mut self, attempt: Option<Values>) {
        self.profiles.clear();
        self.attempt = attempt;
    }

    /// Stores the kinetic energy (J) at the points.
    pub fn remember(&mut self, kinetic: &Values) {
        self.profiles.truncate(PROFILES_KEPT - 1);
        self.profiles.push_front(*kinetic);
    }

    /// Returns the latest profile.
    pub fn last(&self) -> Option<&Values> {
        self.profiles.front()
    }

    /// Computes the profile that starts with a kinetic energy (J), for turns that depend on this energy alone: the
    /// polynomial in it through the last `most` profiles, or through fewer if they are too close together. None without
    /// profiles.
    pub fn carry_on(&self, start: f64, most: usize, kinetic: &mut Values) -> Option<()> {
        let most = self.profiles.len().min(most);
        let Some((count, shares)) = (2..=most)
            .rev()
            .find_map(|count| Some((count, self.shares(start, count)?)))
        else {
            let last = self.last().or(self.attempt.as_ref())?;
            *kinetic = last.map(|kinetic| kinetic + (start - last[0]));
            return Some(());
        };
        *kinetic = self.profiles[0].map(|kinetic| shares[0] * kinetic);
        for (share, profile) in shares.iter().zip(&self.profiles).take(count).skip(1) {
            for (sum, kinetic) in kinetic.iter_mut().zip(profile) {
                *sum += share * kinetic;
            }
        }
        Some(())
    }

    /// Returns the Lagrange weights of the last profiles for a given kinetic energy at the start; none if they are too
    /// large. Under viscous losses alone the energies are quadratic in the speed at the start: the variable is the
    /// speed, or the energy if there are too few profiles for the square.
    fn shares(&self, start: f64, count: usize) -> Option<[f64; PROFILES_KEPT]> {
        let variable = |kinetic: f64| if count > 2 { kinetic.sqrt() } else { kinetic };
        let here = variable(start);
        let mut at = [0.0; PROFILES_KEPT];
        for (at, profile) in at.iter_mut().zip(&self.profiles).take(count) {
            *at = variable(profile[0]);
        }
        let mut shares = [0.0; PROFILES_KEPT];
        let mut size = 0.0;
        for i in 0..count {
            let (mut above, mut below) = (1.0, 1.0);
            for j in (0..count).filter(|j| *j != i) {
                above *= here - at[j];
                below *= at[i] - at[j];
            }
            shares[i] = above / below;
            size += shares[i].abs();
        }
        // Larger weights would amplify the errors of the profiles by more than this factor.
        let most_amplified = 40.0;
        (size <= most_amplified).then_some(shares)
    }
}
