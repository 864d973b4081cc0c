//! Equation of motion and its parts, compared with independent derivations.

#[path = "../support/mod.rs"]
mod support;

mod design;
mod diagrams;
mod enclosures;
mod fold;
mod forces;
mod geometry;
mod limits;
mod loads;
mod mechanism;
mod rod_models;
mod sensitivity;
mod statics;
mod turning_place;
