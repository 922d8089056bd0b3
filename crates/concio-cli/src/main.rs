//! The `concio` command.

fn main() -> std::process::ExitCode {
    concio_cli::run()
}
