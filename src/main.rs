//! The `toile` program: all of it lives in the library. Here its two faces meet, which must not know each other.

use toile::{cli, tui};

fn main() -> std::process::ExitCode {
    cli::main(std::env::args_os(), |workbench| {
        let images = workbench.images.parse()?;
        let left = tui::run(tui::Options {
            database: workbench.database,
            is_database_named: workbench.is_database_named,
            readonly: workbench.readonly,
            no_color: workbench.no_color,
            images,
            encoders: &cli::ENCODERS,
            quickstart: workbench.quickstart,
        })?;
        Ok(match left {
            tui::Left::Nothing => None,
            tui::Left::Run(study) => Some(study),
        })
    })
}
