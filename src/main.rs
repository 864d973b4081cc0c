//! Program `slider-crank`: reads its arguments, calls the library, prints errors.

use std::process::ExitCode;

fn main() -> ExitCode {
    slider_crank::cli::main()
}
