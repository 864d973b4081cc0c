//! What cannot be simulated, though each value of the scene is possible: the one place that decides it.

mod model;
mod run;
mod start;

pub(super) use model::problems as not_modelled;

use crate::mechanism::Linkage;
use crate::scene::{Problems, Scene};

/// Refuses a scene that has no simulation, whatever the method.
///
/// # Errors
/// [`Problems`] with all that is wrong with its values; if nothing is, with all that keeps its motion from being modelled,
/// begun or ended.
pub fn refuse(scene: &Scene) -> Result<(), Problems> {
    modelled(scene).map(drop)
}

/// The scene without parts that have no strength, unless it is refused.
pub(super) fn modelled(scene: &Scene) -> Result<Scene, Problems> {
    scene.check()?;
    let reduced = scene.reduced();
    let linkage = Linkage::new(&scene.geometry);
    let mut list = model::problems(&reduced, &linkage);
    // Without a model there is no start to be looked at.
    if list.is_empty() {
        start::problems(scene, &reduced, &mut list);
    }
    let starts = list.is_empty();
    run::problems(&reduced, &linkage, starts, &mut list);
    scene.refused(list)?;
    Ok(reduced)
}
