//! `GET /v1/jobs`: the caller's jobs, page by page.

use axum::Extension;
use axum::extract::Request;

use super::problem::Handled;
use super::representation::json_only;
use super::sizes::PAGE_MAX;
use super::state::{Caller, State};
use super::{answer, query};
use crate::jobs::ListQuery;
use crate::wire::{JobList, JobState};

/// Jobs of a page when the client does not say.
const PAGE_DEFAULT: usize = 50;

/// List jobs.
///
/// The caller's own, the latest first, page by page. A job that comes in meanwhile is on no later page.
#[utoipa::path(get, path = "/v1/jobs", tag = "jobs",
    params(("cursor" = Option<String>, Query, pattern = "^[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}$",
            description = "`next` of the page before. Default: the first page."),
           ("limit" = Option<usize>, Query, minimum = 1, maximum = 200, description = "Most jobs of the page. Default: 50."),
           ("state" = Option<JobState>, Query, description = "Only jobs in this state.")),
    responses((status = 200, description = "A page of jobs.", body = JobList)))]
pub(super) async fn list_jobs(state: State, caller: Extension<Caller>, request: Request) -> Handled {
    json_only(request.headers())?;
    let page = query::page(request.uri(), PAGE_MAX)?;
    let limit = page.limit.unwrap_or(PAGE_DEFAULT);
    let query = ListQuery {
        owner: caller.owner.clone(),
        state: page.state,
        labels: page.labels,
        before: page.cursor,
        // One more tells whether there is another page.
        limit: limit + 1,
    };
    let mut jobs = state.jobs.list(query).await?;
    let has_more = jobs.len() > limit;
    jobs.truncate(limit);
    let next = jobs.last().filter(|_| has_more).map(|job| job.id.clone());
    Ok(answer::json_answer(&JobList { jobs, next }))
}
