//! What a run made, in either mode: the report and the meshes that are kept, and what the job's row says of them.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::child::Workspace;
use super::retention::on_disk;
use super::service::Service;
use super::spool::{Spool, Written};
use super::store::{BlobRef, ClaimRef, JobRow};
use super::upload::disk_problem;
use crate::pipeline::{self, Answer};
use crate::wire::{self, Encoding, Fidelity, Outcome, Problem, ProblemCode, TimingMs};

/// What a run made; `C` is where the bytes are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Product<C> {
    /// What became of the file.
    pub(super) outcome: Option<Outcome>,
    /// How true the result is to the file.
    pub(super) fidelity: Option<Fidelity>,
    /// Why there is no result that meets what was asked.
    pub(super) problem: Option<Problem>,
    /// Time of each pass, as the report says it.
    pub(super) timing_ms: TimingMs,
    /// The report, as JSON.
    pub(super) report: C,
    /// The mesh.
    pub(super) result: Option<Made<C>>,
    /// The meshes of further targets of a simplification.
    pub(super) levels: Vec<Made<C>>,
}

/// A mesh that a run made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Made<C> {
    /// Its bytes; `None`: those of the upload.
    pub(super) content: Option<C>,
    /// How they are laid out.
    pub(super) encoding: Encoding,
}

/// A file that another process made in a folder of its own.
#[derive(Debug, Clone)]
pub(super) struct MadeFile {
    pub(super) path: PathBuf,
    pub(super) bytes: u64,
    pub(super) sha256: [u8; 32],
    /// The folder, which goes with the last file.
    pub(super) _folder: Arc<Workspace>,
}

/// Bytes that are to be kept.
#[derive(Debug)]
pub(super) enum Content {
    Bytes(Vec<u8>),
    File(MadeFile),
    Kept(Written),
}

impl Product<Vec<u8>> {
    /// What is kept of the engine's answer.
    pub(super) fn of(answer: Answer, timing_ms: TimingMs) -> Result<Self, Problem> {
        let Answer { report, output, levels } = answer;
        let is_refused = report.outcome == Some(pipeline::Outcome::Refused);
        let text = serde_json::to_vec(&wire::Report::new(&report, timing_ms))
            .map_err(|error| Problem::new(ProblemCode::Internal, error.to_string()))?;
        let made =
            |output: pipeline::Output| Made { content: output.bytes, encoding: output.encoding.into() };
        Ok(Self {
            outcome: report.outcome.map(Outcome::from),
            fidelity: report.fidelity.as_ref().filter(|_| !is_refused).map(|fidelity| fidelity.word.into()),
            problem: report.refusal.as_ref().map(Problem::from).filter(|_| is_refused),
            timing_ms,
            report: text,
            result: output.map(made),
            levels: levels.into_iter().map(made).collect(),
        })
    }
}

impl<C> Product<C> {
    /// The same with its contents elsewhere; report first, then the meshes in their order.
    pub(super) fn try_map<D, E>(self, mut place: impl FnMut(C) -> Result<D, E>) -> Result<Product<D>, E> {
        let report = place(self.report)?;
        let mut moved = |made: Made<C>| {
            Ok(Made { content: made.content.map(&mut place).transpose()?, encoding: made.encoding })
        };
        Ok(Product {
            outcome: self.outcome,
            fidelity: self.fidelity,
            problem: self.problem,
            timing_ms: self.timing_ms,
            report,
            result: self.result.map(&mut moved).transpose()?,
            levels: self.levels.into_iter().map(moved).collect::<Result<_, E>>()?,
        })
    }
}

impl Product<MadeFile> {
    /// Takes the files over for which there is room now. Blocks.
    pub(super) fn take_over(self, claim: ClaimRef, spool: &Arc<Spool>) -> Result<Product<Content>, Problem> {
        self.try_map(|file| {
            let room = spool.reserve(file.bytes).filter(|_| !spool.is_disk_short_of(file.bytes));
            let Some(space) = room else { return Ok(Content::File(file)) };
            spool.adopt(claim, &file, space).map(Content::Kept).map_err(|error| disk_problem(&error))
        })
    }
}

impl Service {
    /// Keeps a file of a run, making room for it, and adds it to those that no row names yet.
    pub(super) async fn keep(
        &self,
        row: &JobRow,
        name: String,
        content: Content,
        written: &mut Vec<Written>,
    ) -> Result<BlobRef, Problem> {
        let (spool, claim) = (Arc::clone(&self.spool), row.claim());
        let file = match content {
            Content::Kept(file) => file,
            Content::Bytes(bytes) => {
                let space = self.make_room(&row.tenant, bytes.len() as u64).await?;
                on_disk(move || spool.write(claim, &name, &bytes, space)).await?
            }
            Content::File(file) => {
                let space = self.make_room(&row.tenant, file.bytes).await?;
                on_disk(move || spool.adopt(claim, &file, space)).await?
            }
        };
        let blob = file.blob().cloned();
        written.push(file);
        blob.ok_or_else(|| Problem::new(ProblemCode::Internal, "a file could not be kept"))
    }
}
