//! Scene files: what is read, what is refused, and with which words.

mod bad_scenes;
mod data_files;
mod odd_files;
mod scene_files;
