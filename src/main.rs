//! The `meshmend` binary: assembles the parts and holds no logic.

use meshmend::cli::{self, ServiceHooks};
use meshmend::http;

fn main() -> std::process::ExitCode {
    cli::run(
        std::env::args_os(),
        ServiceHooks {
            serve: http::start,
            check: http::check,
            healthcheck: http::healthcheck,
            migrate: http::migrate,
        },
    )
}
