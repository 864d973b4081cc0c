//! The program `slider-crank`: reads its arguments, calls the library, prints what went wrong.

use std::process::ExitCode;

fn main() -> ExitCode {
    slider_crank::cli::main()
}
