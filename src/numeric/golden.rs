//! The largest value of a function of one variable.

/// 1 / golden ratio
const GOLDEN_SHARE: f64 = 0.618_033_988_749_894_9;
/// Sections; beyond them values differ by less than rounding.
const SECTIONS: u32 = 45;

/// Where between a and b a function with one top is largest, by golden section, and its value there.
pub fn largest(mut f: impl FnMut(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (mut a, mut b) = (a, b);
    let (mut c, mut d) = (b - GOLDEN_SHARE * (b - a), a + GOLDEN_SHARE * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    for _ in 0..SECTIONS {
        if at_c > at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - GOLDEN_SHARE * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + GOLDEN_SHARE * (b - a);
            at_d = f(d);
        }
    }
    if at_c > at_d { (c, at_c) } else { (d, at_d) }
}
