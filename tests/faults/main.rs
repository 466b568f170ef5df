//! A server whose engine fails in every way there is: what its jobs become, and that it goes on.
//!
//! The tests are a binary with a `main` of their own. As `serve` and `run-job` it is the service with an engine that
//! fails where a mesh asks for it, so that no binary that is shipped knows how to fail.

#[path = "../service/meshes.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod meshes;
#[path = "../service/processes.rs"]
mod processes;
#[path = "../service/server.rs"]
#[allow(dead_code, reason = "each folder uses a part of it")]
mod server;

mod confinement;
mod ends;
mod engine;
mod supervision;

use libtest_mimic::{Arguments, Trial};
use meshmend::{cli, http, jobs};
use std::process::ExitCode;

/// Tests by the names of their functions.
macro_rules! trials {
    ($($module:ident::{$($test:ident),+ $(,)?}),+ $(,)?) => {
        vec![$($(Trial::test(concat!(stringify!($module), "::", stringify!($test)), || {
            $module::$test();
            Ok(())
        })),+),+]
    };
}

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some(jobs::RUN_JOB) => jobs::run_job(engine::run),
        Some("serve") => cli::run(
            std::env::args_os(),
            cli::ServiceHooks {
                serve: http::start,
                check: http::check,
                healthcheck: http::healthcheck,
                migrate: http::migrate,
            },
        ),
        _ => libtest_mimic::run(&Arguments::from_args(), trials()).exit_code(),
    }
}

fn trials() -> Vec<Trial> {
    trials![
        ends::{
            every_end_of_a_process_is_a_problem_of_its_own_and_the_next_job_runs,
            a_signal_from_outside_is_told_from_a_fault_of_the_engine,
            a_file_that_grows_too_large_ends_its_job,
            a_result_that_is_larger_than_what_may_be_kept_is_refused_by_its_limit,
            ends_are_counted_by_kind,
        },
        supervision::{
            a_cancelled_job_leaves_no_process,
            a_deleted_job_leaves_no_process,
            a_process_that_hangs_ends_at_its_deadline,
            a_paused_process_ends_at_its_deadline,
            a_process_that_computes_without_end_ends_at_its_deadline,
            a_server_that_is_killed_leaves_no_process,
            a_process_that_is_killed_while_it_waits_costs_no_job,
            a_job_whose_process_ends_before_it_takes_the_job_goes_to_another_at_no_cost,
            a_job_whose_processes_all_end_before_they_take_it_ends_as_lost,
            a_process_that_is_paused_while_it_waits_ends_at_the_deadline_of_its_job,
            a_task_that_is_longer_than_a_pipe_holds_comes_through_whole,
            a_server_that_ends_in_order_leaves_no_process_and_no_folder,
            a_large_result_does_not_pass_through_the_memory_of_the_server,
            a_job_whose_folder_is_removed_runs_again,
        },
        confinement::{
            a_confined_process_reaches_nothing,
            a_process_inherits_no_descriptor_and_has_no_capability,
            without_a_sandbox_the_limits_still_hold,
            a_sandbox_that_is_required_needs_a_process,
            threads_know_no_process,
        },
    ]
}
