//! `/v1/jobs/{id}/deliveries`: the webhooks of a job.

use axum::Extension;
use axum::extract::{Path, Request};
use axum::http::StatusCode;
use axum::response::IntoResponse as _;

use super::answer::json_answer;
use super::lifecycle::{Id, visible};
use super::problem::{Handled, ProblemAnswer};
use super::query;
use super::representation::json_only;
use super::state::{Caller, State};
use crate::wire::{Deliveries, Delivery, ProblemCode};

/// The `{id}` and `{delivery}` of a path.
type Ids = Result<Path<(String, String)>, axum::extract::rejection::PathRejection>;

/// List the webhooks of a job.
///
/// With every try: when, and what the receiver answered.
#[utoipa::path(get, path = "/v1/jobs/{id}/deliveries", operation_id = "list_deliveries", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses((status = 200, description = "The deliveries.", body = Deliveries)))]
pub(super) async fn deliveries(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    json_only(request.headers())?;
    query::none(request.uri())?;
    let id = visible(&state, &caller, id).await?;
    Ok(json_answer(&Deliveries { deliveries: state.jobs.deliveries(id).await? }))
}

/// Send a webhook again.
///
/// Whatever became of it: at once, with the same `webhook-id`. When its tries are used up, this is one more.
#[utoipa::path(post, path = "/v1/jobs/{id}/deliveries/{delivery}/redeliver", operation_id = "redeliver", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job."),
           ("delivery" = String, Path, description = "Id of the delivery.")),
    responses((status = 202, description = "The delivery is due.", body = Delivery)))]
pub(super) async fn redeliver(
    state: State,
    caller: Extension<Caller>,
    ids: Ids,
    request: Request,
) -> Handled {
    json_only(request.headers())?;
    query::none(request.uri())?;
    let unknown = || ProblemAnswer::new(ProblemCode::NotFound, "there is no such delivery");
    let Path((id, delivery)) = ids.map_err(|_| unknown())?;
    let id = visible(&state, &caller, Ok(Path(id))).await?;
    let delivery = state.jobs.redeliver(id, delivery).await?;
    Ok((StatusCode::ACCEPTED, json_answer(&delivery)).into_response())
}
