//! The `toile` program: all of it lives in the library. Here its two faces meet, which must not know each other.

use toile::{cli, tui};

fn main() -> std::process::ExitCode {
    cli::main(std::env::args_os(), |workbench| {
        let images = workbench.images.parse()?;
        tui::run(tui::Options {
            database: workbench.database,
            is_database_named: workbench.is_database_named,
            readonly: workbench.readonly,
            no_color: workbench.no_color,
            images,
            quickstart: workbench.quickstart,
        })?;
        Ok(())
    })
}
