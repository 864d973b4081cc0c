//! Scene files: takes a text, returns a [`Scene`](super::Scene), and scenes with other values.
//!
//! [`read`] turns the text into the values of each table, by the list of all [`keys`]; [`Draft`] replaces values;
//! [`assemble`] builds the scene.

mod assemble;
mod bodies;
mod draft;
mod key_path;
mod keys;
mod loads;
mod part;
mod read;
mod render;
mod scene;
mod schema;
mod spread;
mod value;
mod varied;

pub(crate) use draft::DUARTE;
pub use draft::{Assigned, Draft};
pub use key_path::NumberKey;
pub(crate) use keys::nearest;
pub use render::printable;
pub use schema::schema;
pub use varied::{Varied, VariedValue};
