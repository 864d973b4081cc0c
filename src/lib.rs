//! slider-crank
pub mod cli;
pub mod engine;
pub mod error;
pub mod mechanism;
pub mod numeric;
pub mod plan;
pub mod report;
pub mod scene;
pub mod study;
pub mod trajectory;
