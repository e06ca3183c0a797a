//! `torquescope`: parses the command line, runs, prints the error, exits.

use std::process::ExitCode;

fn main() -> ExitCode {
    torquescope::cli::main()
}
