//! The program as its users meet it: arguments, files, streams, exit codes.

mod arguments;
mod bad_input;
mod commands;
mod files;
mod inverse;
mod kinematics;
mod limits;
mod program;
mod simulate;
mod streams;
mod summary;
