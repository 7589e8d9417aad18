//! The `ancf` program: see `ancf --help`.

fn main() -> std::process::ExitCode {
    ancf::cli::main(std::env::args_os()).into()
}
