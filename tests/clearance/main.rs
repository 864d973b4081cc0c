//! Clearance in a joint: impacts, contact forces, reactions.

#[path = "../support/mod.rs"]
mod support;

mod clearance;
mod clearance_friction;
mod clearance_reactions;
mod narrow_loads;
