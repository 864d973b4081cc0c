//! The seed of property tests: fixed, so that a run can be repeated, unless a nightly run varies it.

use proptest::test_runner::RngSeed;

/// What the environment adds to every seed.
const VARIED: &str = "PROPTEST_RNG_SEED";

/// This seed, and another one for each value of the environment variable `PROPTEST_RNG_SEED`.
pub fn seed(fixed: u64) -> RngSeed {
    let added = std::env::var(VARIED).map_or(0, |text| {
        let number = text.parse::<u64>();
        number.unwrap_or_else(|_| panic!("{VARIED}: `{text}` is not a whole number"))
    });
    RngSeed::Fixed(fixed.wrapping_add(added))
}
