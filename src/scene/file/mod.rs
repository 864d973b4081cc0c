//! Scene files: takes a text, returns a [`Scene`], and scenes with other values.
//!
//! [`read`] turns the text into the values of each table, by the list of all [`keys`]; [`Draft`] replaces values;
//! [`assemble`] builds the scene.

mod assemble;
mod bodies;
mod draft;
mod evenly;
mod key_path;
mod keys;
mod loads;
mod read;
mod render;
mod schema;
mod value;
mod varied;

use std::path::Path;

use super::{Problems, Scene};
use crate::error::Error;

pub(crate) use draft::DUARTE;
pub use draft::{Assigned, Draft};
pub use key_path::NumberKey;
pub(crate) use key_path::did_you_mean;
pub use render::printable;
pub use schema::schema;
pub use varied::{Varied, VariedValue};

impl Scene {
    /// Returns the built-in scene: the Diesel engine of Duarte et al. 2018, table 1, in free spin.
    ///
    /// ```
    /// let scene = slider_crank::scene::Scene::duarte();
    /// assert_eq!(scene.geometry.rod, 0.15583);
    /// ```
    pub fn duarte() -> Scene {
        Draft::duarte()
            .scene()
            .unwrap_or_else(|problems| unreachable!("the built-in scene is right: {problems}"))
    }

    /// Reads a scene from the text of a file; `file` is its name in messages, and the tables it names are relative to
    /// the folder of `file`.
    ///
    /// # Errors
    /// [`Problems`] of the file, with their places.
    ///
    /// ```
    /// use slider_crank::scene::Scene;
    /// let text = r#"
    ///     [geometry]
    ///     crank = "50 mm"
    ///     rod = "150 mm"
    ///
    ///     [motion]
    ///     speed = "300 rpm"
    /// "#;
    /// let scene = Scene::parse("pump.toml".as_ref(), text)?;
    /// assert_eq!(scene.geometry.crank, 0.05);
    ///
    /// let problems = Scene::parse("pump.toml".as_ref(), "[geometry]").unwrap_err();
    /// assert!(problems.to_string().contains("crank"));
    /// # Ok::<(), slider_crank::error::Error>(())
    /// ```
    pub fn parse(file: &Path, text: &str) -> Result<Scene, Problems> {
        Draft::new(file, text).scene()
    }

    /// Reads a scene file; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read, [`Error::Scene`] if it is not a scene.
    pub fn load(file: impl AsRef<Path>) -> Result<Scene, Error> {
        Ok(Draft::load(file.as_ref())?.scene()?)
    }
}
