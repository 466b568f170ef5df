//! An earlier job whose upload is used again.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// An earlier job whose upload is used again.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct InputRef {
    /// Id of the job.
    pub job: String,
}
