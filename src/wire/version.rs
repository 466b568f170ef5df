//! Who speaks: name, version and schema.

use serde::Serialize;
use utoipa::ToSchema;

/// Name of the engine in reports and headers.
pub const ENGINE_NAME: &str = env!("CARGO_PKG_NAME");
/// Version of the engine. Same bytes, same options and same version give the same output bytes.
pub const ENGINE_VERSION: &str = env!("CARGO_PKG_VERSION");
/// Name of the report's schema.
pub const REPORT_SCHEMA: &str = "meshmend.report/1";

/// Answer of `/v1/version`.
#[derive(Debug, Clone, Serialize, ToSchema)]
pub struct Version {
    /// Name of the engine.
    pub name: &'static str,
    /// Version of the engine.
    pub version: &'static str,
    /// Schema of the reports.
    pub report_schema: &'static str,
}

impl Version {
    /// The version that runs.
    pub fn current() -> Self {
        Self { name: ENGINE_NAME, version: ENGINE_VERSION, report_schema: REPORT_SCHEMA }
    }
}
