//! The stable codes of problems, and what each means.

use serde::Serialize;
use utoipa::ToSchema;

use super::words::words;

words! {
    /// Stable code of a problem. `/v1/errors` explains each.
    ProblemCode {
        /// A parameter has a value that is not allowed.
        InvalidParameter = "invalid-parameter",
        /// The upload is not where the request takes it to be.
        UploadConflict = "upload-conflict",
        /// Bytes of the upload are still to come.
        UploadUnfinished = "upload-unfinished",
        /// The protocol's version is not spoken here.
        UnsupportedVersion = "unsupported-version",
        /// No presigned URL is given.
        PresignedRefused = "presigned-refused",
        /// The body ends early or is cut into parts wrongly.
        BodyIncomplete = "body-incomplete",
        /// There is no such parameter, or this operation does not take it.
        UnknownParameter = "unknown-parameter",
        /// No valid key.
        Unauthenticated = "unauthenticated",
        /// Not allowed for this caller.
        Forbidden = "forbidden",
        /// There is no such thing.
        NotFound = "not-found",
        /// It was there and is no longer kept.
        Expired = "expired",
        /// The path does not take this method.
        MethodNotAllowed = "method-not-allowed",
        /// None of the accepted media types can be given.
        NotAcceptable = "not-acceptable",
        /// The file has no such bytes.
        RangeNotSatisfiable = "range-not-satisfiable",
        /// What is there is not what the request is about.
        PreconditionFailed = "precondition-failed",
        /// The request's head is over the limit.
        HeadTooLarge = "head-too-large",
        /// The body's media type is not read here.
        UnsupportedMediaType = "unsupported-media-type",
        /// The body did not come in time.
        UploadTimeout = "upload-timeout",
        /// The job is still queued or running.
        JobNotFinished = "job-not-finished",
        /// The plan is not for this mesh.
        PlanMismatch = "plan-mismatch",
        /// The key belongs to another request.
        IdempotencyKeyReused = "idempotency-key-reused",
        /// The body is over the limit.
        BodyTooLarge = "body-too-large",
        /// The mesh is over a limit.
        MeshTooLarge = "mesh-too-large",
        /// The file breaks the rules of its format.
        MeshUnparseable = "mesh-unparseable",
        /// There is no mesh in the file.
        MeshEmpty = "mesh-empty",
        /// A coordinate is NaN or infinite.
        MeshNonFinite = "mesh-non-finite",
        /// The file ends too early.
        MeshTruncated = "mesh-truncated",
        /// The archive breaks a safety rule.
        ArchiveUnsafe = "archive-unsafe",
        /// No result meets what was required.
        NotRepairable = "not-repairable",
        /// The mesh takes more work than a file of its size may.
        OverBudget = "over-budget",
        /// The webhook is not one that the server calls.
        WebhookRefused = "webhook-refused",
        /// Too many requests.
        RateLimited = "rate-limited",
        /// The queue has no room.
        QueueFull = "queue-full",
        /// The job's time is over.
        EngineTimeout = "engine-timeout",
        /// The job needs more memory than it may have.
        EngineOutOfMemory = "engine-out-of-memory",
        /// The engine failed on this job.
        EngineCrashed = "engine-crashed",
        /// The process that ran the job went away.
        WorkerLost = "worker-lost",
        /// The job was cancelled.
        Cancelled = "cancelled",
        /// The server is shutting down.
        Draining = "draining",
        /// The job store does not answer.
        StoreUnavailable = "store-unavailable",
        /// There is no room for more data.
        StorageFull = "storage-full",
        /// A fault of the server.
        Internal = "internal",
    }
}

impl ProblemCode {
    /// HTTP status, title, and what it means and what to do.
    fn facts(self) -> (u16, &'static str, &'static str) {
        match self {
            Self::InvalidParameter => (
                400,
                "Invalid parameter",
                "`parameter` has a value that is not allowed; `allowed` or `detail` says which are.",
            ),
            Self::UnknownParameter => (
                400,
                "Unknown parameter",
                "There is no `parameter` of this name here; `suggestion` is the nearest one there is, `detail` says who takes it.",
            ),
            Self::UploadConflict => (
                409,
                "Upload conflict",
                "The upload goes on at another offset, or another request was quicker. Ask where it stands with `HEAD`, and go \
                 on from there.",
            ),
            Self::UploadUnfinished => (
                409,
                "Upload unfinished",
                "Bytes of the upload are still to come. Send them first; `HEAD` tells where to go on.",
            ),
            Self::UnsupportedVersion => (
                412,
                "Unsupported version",
                "`Tus-Resumable` is missing or names another version of the protocol than `Tus-Version`.",
            ),
            Self::PresignedRefused => (
                422,
                "Presigned refused",
                "The server gives no presigned URLs: its files are not in a bucket, or its operator has not allowed it. Send and \
                 fetch meshes by the other calls.",
            ),
            Self::BodyIncomplete => (
                400,
                "Body incomplete",
                "The body ended early, or its parts are not divided as its `Content-Type` says.",
            ),
            Self::Unauthenticated => {
                (401, "Unauthenticated", "Send a valid key as `Authorization: Bearer KEY`.")
            }
            Self::Forbidden => (403, "Forbidden", "The server does not answer this caller, host or origin."),
            Self::NotFound => (
                404,
                "Not found",
                "There is no such path, job, upload or file. A deleted job is not found either.",
            ),
            Self::Expired => {
                (410, "Expired", "The job's report and result are no longer kept. Send the mesh again.")
            }
            Self::MethodNotAllowed => {
                (405, "Method not allowed", "The path exists; `Allow` lists its methods.")
            }
            Self::NotAcceptable => {
                (406, "Not acceptable", "None of the media types in `Accept` can be given here.")
            }
            Self::RangeNotSatisfiable => (
                416,
                "Range not satisfiable",
                "The file has no bytes in `Range`; `Content-Range` says how long it is.",
            ),
            Self::PreconditionFailed => (
                412,
                "Precondition failed",
                "The job or file has changed: its `ETag` is none of those in `If-Match`. Ask for it again.",
            ),
            Self::HeadTooLarge => {
                (431, "Head too large", "Path, query and header fields are over `limit` bytes.")
            }
            Self::UnsupportedMediaType => (
                415,
                "Unsupported media type",
                "The body's `Content-Type` is not read here; `/v1/formats` lists those of meshes.",
            ),
            Self::UploadTimeout => {
                (408, "Upload timeout", "The body paused for longer than the limit. Send it again.")
            }
            Self::JobNotFinished => {
                (409, "Job not finished", "The job is queued or running. Wait with `?wait=` and ask again.")
            }
            Self::PlanMismatch => (
                409,
                "Plan mismatch",
                "The plan was made for another file, or names a defect, element or remedy that this mesh does not have. \
                 Ask `/v1/plan` for a plan of this mesh.",
            ),
            Self::IdempotencyKeyReused => (
                422,
                "Idempotency key reused",
                "The key was used with another request. Use a new key for each request.",
            ),
            Self::BodyTooLarge => (413, "Body too large", "The upload is over `limit` bytes."),
            Self::MeshTooLarge => {
                (413, "Mesh too large", "A count of the mesh, or the work it takes, is over the named limit.")
            }
            Self::MeshUnparseable => (
                422,
                "Mesh unparseable",
                "The file breaks the rules of its format at `line` or `byte`, where `expected` should stand.",
            ),
            Self::MeshEmpty => (422, "Mesh empty", "The file has no bytes, or no element of a mesh."),
            Self::MeshNonFinite => {
                (422, "Mesh non-finite", "A coordinate is NaN or infinite and cannot be written.")
            }
            Self::MeshTruncated => {
                (422, "Mesh truncated", "The file ends before what it announces. Export it again.")
            }
            Self::ArchiveUnsafe => {
                (422, "Archive unsafe", "The archive breaks a limit on entries, size or ratio.")
            }
            Self::NotRepairable => (
                422,
                "Not repairable",
                "No result meets `require`; `report` names the first violation that remains.",
            ),
            Self::OverBudget => (
                422,
                "Over budget",
                "No answer was found in the work that a file of this size may take: parts of the mesh are so many in one place, or \
                 so far apart in scale, that a decision is too dear. `limit` is the bound in units of work.",
            ),
            Self::WebhookRefused => (
                422,
                "Webhook refused",
                "The server sends no webhooks, or not to this URL, or the secret is missing or malformed; `detail` says \
                 which.",
            ),
            Self::RateLimited => {
                (429, "Rate limited", "Too many requests. Wait as long as `Retry-After` says.")
            }
            Self::QueueFull => (429, "Queue full", "The queue is full. Wait as long as `Retry-After` says."),
            Self::EngineTimeout => (
                504,
                "Engine timeout",
                "The job did not end within its time, given by the caller or the server.",
            ),
            Self::EngineOutOfMemory => {
                (413, "Engine out of memory", "The job needs more memory than `limit` bytes.")
            }
            Self::EngineCrashed => (
                500,
                "Engine crashed",
                "A fault of the engine on this mesh. The server goes on; please report it.",
            ),
            Self::WorkerLost => {
                (503, "Worker lost", "The process that ran the job went away. Send the job again.")
            }
            Self::Cancelled => (409, "Cancelled", "The job was cancelled and has no result."),
            Self::Draining => {
                (503, "Draining", "The server is shutting down. Send the job again, here or elsewhere.")
            }
            Self::StoreUnavailable => (503, "Store unavailable", "The job store does not answer. Try again."),
            Self::StorageFull => (507, "Storage full", "There is no room for more data. Try again later."),
            Self::Internal => (500, "Internal error", "A fault of the server; its log names the request id."),
        }
    }

    /// HTTP status.
    pub fn status(self) -> u16 {
        self.facts().0
    }

    /// A few words for people.
    pub fn title(self) -> &'static str {
        self.facts().1
    }

    /// What it means and what to do.
    pub fn explanation(self) -> &'static str {
        self.facts().2
    }

    /// Reference that tells problems of this code from others.
    pub fn type_uri(self) -> String {
        format!("/v1/errors#{}", self.word())
    }
}

/// One row of `/v1/errors`.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct ErrorInfo {
    /// Stable code.
    pub code: ProblemCode,
    /// Value of `type` in problems.
    #[serde(rename = "type")]
    pub type_uri: String,
    /// HTTP status.
    pub status: u16,
    /// A few words for people.
    pub title: &'static str,
    /// What it means and what to do.
    pub explanation: &'static str,
}

/// Every problem there is: the answer of `/v1/errors`.
pub fn errors() -> Vec<ErrorInfo> {
    let row = |&code: &ProblemCode| ErrorInfo {
        code,
        type_uri: code.type_uri(),
        status: code.status(),
        title: code.title(),
        explanation: code.explanation(),
    };
    ProblemCode::ALL.iter().map(row).collect()
}
