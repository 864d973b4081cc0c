//! Seed of property tests: fixed for repeatable runs, and varied by the environment for nightly runs.

use proptest::test_runner::RngSeed;

/// Environment variable whose number is added to every seed.
const VARIED: &str = "PROPTEST_RNG_SEED";

/// Returns this seed, or a different one for each value of the environment variable `PROPTEST_RNG_SEED`.
pub fn seed(fixed: u64) -> RngSeed {
    let added = std::env::var(VARIED).map_or(0, |text| {
        let number = text.parse::<u64>();
        number.unwrap_or_else(|_| panic!("{VARIED}: `{text}` is not a whole number"))
    });
    RngSeed::Fixed(fixed.wrapping_add(added))
}
