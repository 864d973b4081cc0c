//! The program as its users meet it: arguments, files, streams, exit codes.

mod arguments;
mod bad_input;
mod clearance;
mod commands;
mod figure;
mod files;
mod identify;
mod interrupt;
mod inverse;
mod inverse_text;
mod kinematics;
mod limits;
mod one_turn;
mod page;
mod pictures;
mod precision;
mod program;
mod readme;
mod reproduce;
mod samples;
mod simulate;
mod statics;
mod steady;
mod streams;
mod summary;
mod sweep;
