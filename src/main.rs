//! The `valet` binary: hands the command line to the library and reports once, at the top, what went wrong.

use std::process::ExitCode;

fn main() -> ExitCode {
    valet::cli::main()
}
