//! The `ancf` program: see `ancf --help`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
