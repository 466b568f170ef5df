//! What a request brings, and where the mesh in it comes in.

use super::agreed::{agreed, agreed_member};
use crate::jobs::{Jobs, Tenant, Upload, Uploaded};
use crate::wire::{Format, JobRequest, Labels, Operation, Options, Problem, WebhookRequest};

/// What a request brings.
#[derive(Debug, Default)]
pub(super) struct Intake {
    /// The key under which it may be repeated.
    pub(super) key: Option<String>,
    /// Its key made a job before.
    pub(super) is_repeat: bool,
    /// The mesh, on disk.
    pub(super) upload: Option<Uploaded>,
    /// The MTL file of an OBJ, on disk.
    pub(super) material: Option<Uploaded>,
    /// The name that the client gave the mesh.
    pub(super) file_name: Option<String>,
    /// The format that the mesh's media type names.
    pub(super) named: Option<Format>,
    /// What to do, as the body says.
    pub(super) operation: Option<Operation>,
    /// Whom to tell of the end, as the body says.
    pub(super) webhook: Option<WebhookRequest>,
    /// What to write on the job, as the body says.
    pub(super) labels: Option<Labels>,
    /// How, as the body says.
    pub(super) options: Options,
}

impl Intake {
    /// Takes options from JSON.
    pub(super) fn take_json(&mut self, text: &[u8], operation: Option<Operation>) -> Result<(), Problem> {
        match operation {
            Some(operation) => self.options = JobRequest::params_from_json(text, operation)?,
            None => {
                let request = JobRequest::from_json(text)?;
                self.operation = agreed(self.operation, request.operation)?;
                self.webhook = agreed_member("webhook", self.webhook.take(), request.webhook)?;
                self.labels = agreed_member("labels", self.labels.take(), request.labels)?;
                let said_before = std::mem::take(&mut self.options);
                self.options = said_before.join(request.options).map_err(|error| Problem::from(&error))?;
            }
        }
        Ok(())
    }
}

/// Where the mesh of a request comes in.
pub(super) struct Entrance<'s> {
    pub(super) jobs: &'s Jobs,
    /// Whom it is charged to.
    pub(super) tenant: &'s Tenant,
    /// Its key made a job before: the answer is that job, for which no place in the queue is needed.
    pub(super) is_repeat: bool,
}

impl Entrance<'_> {
    /// Begins the upload; to be called before the body is read, so that a client that asks (`Expect`) does not send in vain
    /// what will be refused.
    pub(super) async fn upload(&self, announced: Option<u64>) -> Result<Upload, Problem> {
        let tenant = self.tenant.clone();
        if self.is_repeat {
            self.jobs.upload_beside(tenant).await
        } else {
            self.jobs.upload_of(tenant, announced).await
        }
    }
}

/// Ends an upload; `None` when nothing came.
pub(super) async fn finish_if_any(upload: Upload) -> Result<Option<Uploaded>, Problem> {
    if upload.bytes() == 0 { Ok(None) } else { upload.finish().await.map(Some) }
}
