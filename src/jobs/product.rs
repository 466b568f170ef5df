//! What a run made, in either mode: the report and the meshes that are kept, and what the job's row says of them.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::child::MadeFile;
use super::problems::{internal, workspace_problem};
use super::spool::{Spool, Written};
use super::store::ClaimRef;
use crate::pipeline::{self, Answer};
use crate::wire::{self, Encoding, Fidelity, Outcome, Problem, TimingMs};

/// What a run made; `C` is where the bytes are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct RunProduct<C> {
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
    pub(super) result: Option<MadeMesh<C>>,
    /// The meshes of further targets of a simplification.
    pub(super) levels: Vec<MadeMesh<C>>,
    /// The picture, as PNG or GLB.
    pub(super) picture: Option<C>,
}

/// A mesh that a run made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct MadeMesh<C> {
    /// Its bytes; `None`: those of the upload.
    pub(super) content: Option<C>,
    /// How they are laid out.
    pub(super) encoding: Encoding,
}

/// Bytes that are to be kept.
#[derive(Debug)]
pub(super) enum Content {
    Bytes(Vec<u8>),
    File(MadeFile),
    Kept(Written),
}

impl RunProduct<Vec<u8>> {
    /// What is kept of the engine's answer.
    pub(super) fn of(answer: Answer, timing_ms: TimingMs) -> Result<Self, Problem> {
        let Answer { report, output, levels, picture } = answer;
        let is_refused = report.outcome == Some(pipeline::Outcome::Refused);
        let text =
            serde_json::to_vec(&wire::Report::new(&report, timing_ms)).map_err(|error| internal(&error))?;
        let refused = report.refusal.as_ref().filter(|_| is_refused);
        let made =
            |output: pipeline::Output| MadeMesh { content: output.bytes, encoding: output.encoding.into() };
        Ok(Self {
            outcome: report.outcome.map(Outcome::from),
            fidelity: report.fidelity.as_ref().filter(|_| !is_refused).map(|fidelity| fidelity.word.into()),
            problem: refused.map(|refusal| Problem::of_refusal(refusal, report.input.result_units)),
            timing_ms,
            report: text,
            result: output.map(made),
            levels: levels.into_iter().map(made).collect(),
            picture,
        })
    }
}

impl<C> RunProduct<C> {
    /// The same with its contents elsewhere; report first, then the meshes in their order, then the
    /// picture.
    pub(super) fn try_map<D, E>(self, mut place: impl FnMut(C) -> Result<D, E>) -> Result<RunProduct<D>, E> {
        let report = place(self.report)?;
        let mut moved = |made: MadeMesh<C>| {
            Ok(MadeMesh { content: made.content.map(&mut place).transpose()?, encoding: made.encoding })
        };
        let (result, levels) = (
            self.result.map(&mut moved).transpose()?,
            self.levels.into_iter().map(moved).collect::<Result<_, E>>()?,
        );
        Ok(RunProduct {
            outcome: self.outcome,
            fidelity: self.fidelity,
            problem: self.problem,
            timing_ms: self.timing_ms,
            report,
            result,
            levels,
            picture: self.picture.map(place).transpose()?,
        })
    }
}

impl RunProduct<MadeFile> {
    /// Takes the files over for which there is room now. Blocks.
    pub(super) fn take_over(
        self,
        claim: ClaimRef,
        spool: &Arc<Spool>,
    ) -> Result<RunProduct<Content>, Problem> {
        self.try_map(|file| {
            let room = spool.reserve(file.bytes).filter(|_| !spool.is_disk_short_of(file.bytes));
            let Some(space) = room else { return Ok(Content::File(file)) };
            spool.adopt(claim, &file, space).map(Content::Kept).map_err(|error| workspace_problem(&error))
        })
    }
}
