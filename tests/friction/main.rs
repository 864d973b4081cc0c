//! Coulomb friction at the guide: law, reversals, stick-slip, estimates.

#[path = "../support/mod.rs"]
mod support;

mod dry_loads;
mod friction_dips;
mod friction_law;
mod friction_motion;
mod friction_turning;
mod rubbing_estimates;
mod rubbing_properties;
