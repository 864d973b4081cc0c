//! Numerical methods: small tools, each with its source.

pub mod angle;
pub mod chebyshev;
pub mod cholesky;
pub mod covariance_factor;
pub mod difference;
pub mod dip;
pub mod double_double;
pub mod enclosure;
pub mod exact;
pub mod exponential;
pub mod fourier;
pub mod gauss;
pub mod hermite;
pub mod interpolate;
#[cfg(feature = "cli")]
pub mod latin_hypercube;
pub mod line_fit;
pub mod maximum;
pub mod median;
pub mod orthogonal;
pub mod parallel;
pub mod polynomial_fit;
pub mod powers;
pub mod root;
pub mod stop;
pub mod student;
pub mod trigonometry;

/// Standard deviation of an error that is spread evenly over one unit, as that of a rounding: 1/√12.
pub const ROUNDING_DEVIATION: f64 = 0.288_675_134_594_812_9;

/// Number of values computed side by side, and of partial sums that are kept apart.
pub const LANES: usize = 4;
