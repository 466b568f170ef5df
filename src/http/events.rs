//! `GET /v1/jobs/{id}/events`: what happens to a job, as server-sent events.

use std::convert::Infallible;
use std::time::Duration;

use axum::Extension;
use axum::extract::Request;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode};
use axum::response::IntoResponse as _;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures_util::stream;

use super::lifecycle::{Id, visible};
use super::problem::Handled;
use super::query;
use super::representation::one_of;
use super::state::{Caller, State};
use crate::jobs::{EventId, Happened, JobEvent};
use crate::wire::{Phase, Problem, ProblemCode, StageEvent, StateEvent};

/// Media type of events.
const EVENT_STREAM: &str = "text/event-stream";
/// Pause after which a comment tells that the connection lives: shorter than what proxies wait for.
const KEEP_ALIVE: Duration = Duration::from_secs(15);

/// Follow a job.
///
/// Server-sent events: `state` when the job comes into another state, `stage` when a pass of its run begins or ends. The
/// stream ends after the event of a final state. A client that comes back with `Last-Event-ID` hears what it has missed;
/// one that has heard all gets 204 and need not come again.
#[utoipa::path(get, path = "/v1/jobs/{id}/events", operation_id = "get_job_events", tag = "jobs",
    params(("id" = String, Path, description = "Id of the job.")),
    responses((status = 204, description = "The job has ended, and the client has heard it.")))]
pub(super) async fn events(state: State, caller: Extension<Caller>, id: Id, request: Request) -> Handled {
    one_of(request.headers(), &[EVENT_STREAM])?;
    query::none(request.uri())?;
    let last = last_event_id(request.headers())?;
    let id = visible(&state, &caller, id).await?;
    let Some(events) = state.jobs.events(id, last).await? else {
        return Ok(StatusCode::NO_CONTENT.into_response());
    };
    let events = stream::unfold(events, |mut events| async move {
        let event = events.next().await?;
        Some((Ok::<_, Infallible>(sent(&event)), events))
    });
    let mut response = Sse::new(events).keep_alive(KeepAlive::new().interval(KEEP_ALIVE)).into_response();
    // Proxies that gather answers would keep events back.
    response
        .headers_mut()
        .insert(HeaderName::from_static("x-accel-buffering"), HeaderValue::from_static("no"));
    Ok(response)
}

fn sent(event: &JobEvent) -> Event {
    let (name, data) = match event.what {
        Happened::State { state, at } => ("state", serde_json::to_string(&StateEvent { state, at })),
        Happened::Pass { stage, has_ended, fraction } => {
            let phase = if has_ended { Phase::End } else { Phase::Begin };
            ("stage", serde_json::to_string(&StageEvent { stage, phase, fraction }))
        }
    };
    // The wire types have no keys that are not text, so they become JSON.
    Event::default().event(name).id(event.id.to_string()).data(data.unwrap_or_default())
}

/// The place in the stream that `Last-Event-ID` names; its begin without it.
fn last_event_id(headers: &HeaderMap) -> Result<EventId, Problem> {
    let Some(value) = headers.get("last-event-id") else { return Ok(EventId::default()) };
    value.to_str().ok().and_then(|text| text.parse().ok()).ok_or_else(|| Problem {
        parameter: Some("Last-Event-ID".to_owned()),
        ..Problem::new(ProblemCode::InvalidParameter, "`Last-Event-ID` is the id of an event of this job")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last(text: &'static str) -> Result<EventId, ProblemCode> {
        let headers = HeaderMap::from_iter([(
            HeaderName::from_static("last-event-id"),
            HeaderValue::from_static(text),
        )]);
        last_event_id(&headers).map_err(|problem| problem.code)
    }

    #[test]
    fn an_event_is_named_by_one_or_two_numbers() {
        assert_eq!(last("3.14"), Ok(EventId { change: 3, pass: 14 }));
        assert_eq!(last_event_id(&HeaderMap::new()).unwrap(), EventId::default());
        assert_eq!(last("3"), Ok(EventId { change: 3, pass: 0 }));
        for wrong in ["", "3.", ".1", "+3.1", "a.b", "3.1.4", "1234567890.1"] {
            assert_eq!(last(wrong), Err(ProblemCode::InvalidParameter), "{wrong}");
        }
    }
}
