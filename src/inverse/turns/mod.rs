//! Turns and branch of the crank that a record shows.

pub(super) mod alignment;
pub(super) mod branch_choice;
pub(super) mod branch_tracking;
pub(super) mod hypotheses;
pub(super) mod hypothesis;
pub(super) mod mirror_image;
pub(super) mod unwrap;
pub(super) mod window;
