//! The `toile` program: all of it lives in the library.

fn main() -> std::process::ExitCode {
    toile::cli::main(std::env::args_os())
}
