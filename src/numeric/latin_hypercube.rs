//! Latin hypercube samples: each variable falls once into every one of `count` equal parts of its range (McKay, Beckman
//! and Conover, Technometrics 21 (1979) 239). Each sample is computed without the samples before it.

/// Latin hypercube design of a number of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatinHypercube {
    /// Number of samples, at least 1.
    pub count: u64,
    /// Seed, which selects the hypercube.
    pub seed: u64,
}

impl LatinHypercube {
    /// Returns a variable, from 0, of a sample, from 0: strictly between 0 and 1.
    pub fn at(&self, variable: u64, sample: u64) -> f64 {
        let key = mixed(self.seed ^ mixed(variable));
        let part = self.permuted(key, sample);
        // 53 random bits, centred between two neighbouring values.
        let within = ((mixed(key ^ mixed(!sample)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
        ((part as f64 + within) / self.count as f64).min(1.0 - f64::EPSILON / 2.0)
    }

    /// Permutes the samples: a Feistel network over the least power of four that holds them, walked along its cycle
    /// until the result is one of them (Black and Rogaway, CT-RSA 2002).
    fn permuted(&self, key: u64, sample: u64) -> u64 {
        let half = (u64::BITS - (self.count - 1).leading_zeros()).div_ceil(2);
        let low = (1u64 << half) - 1;
        let mut at = sample;
        loop {
            // A network of four or more rounds is a pseudo-random permutation (Luby and Rackoff).
            for round in 0..4 {
                let (left, right) = (at >> half, at & low);
                at = right << half | (left ^ mixed(key ^ mixed(right << 2 | round))) & low;
            }
            if at < self.count {
                return at;
            }
        }
    }
}

/// Mixes the bits by the finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
fn mixed(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
