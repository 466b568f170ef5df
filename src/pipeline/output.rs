//! A mesh on its way out: written, read back, judged on its bytes and compared with the input.

use super::describe::describe;
use super::identical::identical_triangle_share;
use super::input::Input;
use super::left_out::{left_out, taken_over};
use super::{Action, Answer, Failure, Options, Outcome, Output, Refusal, Report, Require, faithful};
use crate::budget::{AsStopped, Budget, Stage, Stopped};
use crate::certificate::{self, Certificate, Depth, Examination};
use crate::formats::{self, Encoding, ReadLimits, ReadOptions, WriteError};
use crate::mesh::{Soup, Texture};
use crate::repair::NEW;
use std::borrow::Cow;

/// Why a mesh with this certificate is not returned: the caller demands a valid solid.
pub(super) fn refusal(options: &Options, certificate: &Certificate) -> Option<Refusal> {
    let is_refused = options.require.is_some_and(Require::is_of_a_solid) && !certificate.is_printable();
    is_refused.then(|| Refusal::NotRepairable { witness: certificate.witnesses.first().cloned() })
}

/// The file as it is, as the answer of an operation that is no repair; `otherwise` is the outcome where it is no valid solid.
pub(super) fn unchanged(input: &Input, options: &Options, report: Report, otherwise: Outcome) -> Answer {
    let certificate = &input.examination.certificate;
    let outcome = if certificate.is_printable() { Outcome::Identical } else { otherwise };
    match refusal(options, certificate) {
        Some(refusal) => report.refused(refusal),
        None => input.returned_as_it_is(report, outcome),
    }
}

/// A mesh that an operation has made which is no repair.
pub(super) struct OperationMesh<'m> {
    pub(super) soup: Soup,
    /// The input's triangle behind each triangle ([`NEW`]: none).
    pub(super) origins: &'m [u32],
    /// The outcome, by whether it is a valid solid.
    pub(super) outcome: fn(bool) -> Outcome,
}

impl OperationMesh<'_> {
    /// Written and judged, as the answer.
    pub(super) fn returned(
        self,
        input: &Input,
        options: &Options,
        report: Report,
        budget: &Budget,
    ) -> Result<Answer, Failure> {
        if self.soup.triangles.is_empty() {
            return Ok(report.refused(Refusal::NothingToRepair));
        }
        let depth = Depth::Count { samples: input.samples };
        let encoding = input.output_encoding(options);
        let candidate = match Candidate::write(self.soup, input, encoding, depth, budget) {
            Ok(candidate) => candidate,
            Err(reason) => return Ok(report.refused(reason.refusal()?)),
        };
        if let Some(refusal) = refusal(options, candidate.certificate()) {
            return Ok(report.refused(refusal));
        }
        let outcome = (self.outcome)(candidate.certificate().is_printable());
        Ok(candidate.returned(input, self.origins, report, outcome, budget)?)
    }
}

/// Bytes that may be returned, with the judgement on them.
pub(super) struct Candidate {
    pub(super) bytes: Vec<u8>,
    pub(super) encoding: Encoding,
    /// The bytes, read back.
    soup: Soup,
    examination: Examination,
    /// For each of its triangles the one of the soup that was written; `None`: the same.
    order: Option<Vec<u32>>,
    /// What was lost on the way to the soup that was written.
    left_out: Vec<(&'static str, u64)>,
}

/// Why there is no candidate.
pub(super) enum NoCandidate {
    Refused(Refusal),
    Failed(Failure),
}

impl NoCandidate {
    /// Why it is refused.
    ///
    /// # Errors
    /// The failure, where it is one.
    pub(super) fn refusal(self) -> Result<Refusal, Failure> {
        match self {
            Self::Refused(refusal) => Ok(refusal),
            Self::Failed(failure) => Err(failure),
        }
    }
}

impl AsStopped for NoCandidate {
    fn as_stopped(&self) -> Option<Stopped> {
        match self {
            Self::Failed(failure) => failure.as_stopped(),
            Self::Refused(_) => None,
        }
    }
}

impl<E: Into<Failure>> From<E> for NoCandidate {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

impl Candidate {
    /// Writes `soup`, which is a result of `input`, and judges the bytes. The soup is gone by then: the largest buffers never
    /// live at the same time.
    pub(super) fn write(
        mut soup: Soup,
        input: &Input,
        encoding: Encoding,
        depth: Depth,
        budget: &Budget,
    ) -> Result<Self, NoCandidate> {
        soup.units = Some(input.facts.result_units);
        let bytes = match budget.stage(Stage::Write, || formats::write(&soup, encoding, budget)) {
            Ok(bytes) => bytes,
            Err(WriteError::Stopped(stopped)) => return Err(stopped.into()),
            Err(reason) => return Err(NoCandidate::Refused(Refusal::NotRepresentable { reason })),
        };
        let order = formats::stored_order(&soup, encoding);
        let left_out = std::mem::take(&mut soup.left_out);
        // The file of a part by itself has no picture; its project has.
        let is_part = input.regions.is_some() && encoding == Encoding::ThreeMf;
        let texture = if is_part { std::mem::take(&mut soup.texture) } else { Texture::default() };
        drop(soup);
        // What we write may be larger than what we would take in.
        let limits =
            ReadLimits { triangles_max: u32::MAX, vertices_max: u32::MAX, polygon_corners_max: u32::MAX };
        let options = ReadOptions { limits, ..ReadOptions::default() };
        budget.stage(Stage::Certify, || {
            let mut soup = formats::read(&bytes, encoding, &options, budget).map_err(Failure::from)?;
            let examination = certificate::examine(&soup, &bytes, encoding, &options, depth, budget)?;
            if is_part && texture.corners.len() == soup.triangles.len() {
                soup.texture = texture;
            }
            Ok(Self { bytes, encoding, soup, examination, order, left_out })
        })
    }

    /// Its texture, where its project holds it.
    fn texture_of_part(&self) -> Texture {
        if self.encoding == Encoding::ThreeMf { self.soup.texture.clone() } else { Texture::default() }
    }

    /// The file, of whose triangles `origins` are those of the input behind them.
    pub(super) fn into_output(self, origins: Vec<u32>) -> Output {
        let texture = self.texture_of_part();
        Output { bytes: Some(self.bytes), encoding: self.encoding, origins, texture }
    }

    /// The bytes, read back.
    pub(super) fn soup(&self) -> &Soup {
        &self.soup
    }

    /// The origins of the triangles of the bytes, of which `origins` are those of the soup that was written.
    pub(super) fn origins<'o>(&self, origins: &'o [u32]) -> Cow<'o, [u32]> {
        match &self.order {
            Some(order) => Cow::Owned(order.iter().map(|&t| origins[t as usize]).collect()),
            None => Cow::Borrowed(origins),
        }
    }

    pub(super) fn certificate(&self) -> &Certificate {
        &self.examination.certificate
    }

    /// What is said of texture coordinates that the file has and the result has not: where a triangle of the file had some
    /// and its like in the result has none, and where a triangle is new. `origins` as for [`Self::returned`].
    fn lost_texture(&self, input: &Input, origins: &[u32]) -> Option<Action> {
        let (before, after) = (&input.soup.texture, &self.soup.texture);
        // A project tells what became of all that it says of faces.
        if before.is_empty() || input.regions.is_some() {
            return None;
        }
        let has_lost = |(t, &origin): (usize, &u32)| {
            after.of_triangle(t).is_none() && (origin == NEW || before.of_triangle(origin as usize).is_some())
        };
        let lost =
            origins.iter().enumerate().take(self.soup.triangles.len()).filter(|&at| has_lost(at)).count();
        if lost == 0 {
            return None;
        }
        let kept = (0..self.soup.triangles.len()).filter(|&t| after.of_triangle(t).is_some()).count();
        let reason = match kept {
            0 => "the texture coordinates of the file are lost: the output has none",
            _ => {
                "texture coordinates stay where a triangle kept its corners, parts of one have those between them, and new \
                 triangles those of their rim or of the nearest faces; other triangles have none"
            }
        };
        let changes =
            vec![("triangles_with_texture", kept as u64), ("triangles_without_texture", lost as u64)];
        let (step, causes) = ("texture", Vec::new());
        Some(Action { step, causes, changes, move_max: 0.0, reason: reason.to_owned(), stitches: None })
    }

    /// What is said of materials of faces, in the same way.
    fn lost_materials(&self, input: &Input, origins: &[u32]) -> Option<Action> {
        let (before, after) = (&input.soup, &self.soup);
        let has_lost = |(t, &origin): (usize, &u32)| {
            after.materials.of(after.face_of(t as u32)).is_none()
                && (origin == NEW || before.materials.of(before.face_of(origin)).is_some())
        };
        let lost = origins.iter().enumerate().take(after.triangles.len()).filter(|&at| has_lost(at)).count();
        if before.materials.is_empty() || lost == 0 {
            return None;
        }
        let kept = after.triangles.len() - lost;
        let reason = match after.materials.is_empty() {
            true => "the materials of the file are lost: the output has none",
            false => {
                "materials stay where a triangle comes from the file, and new ones have those of the nearest; other \
                 triangles have none"
            }
        };
        let changes =
            vec![("triangles_with_material", kept as u64), ("triangles_without_material", lost as u64)];
        let (step, causes) = ("materials", Vec::new());
        Some(Action { step, causes, changes, move_max: 0.0, reason: reason.to_owned(), stitches: None })
    }

    /// The candidate as the answer. `origins` name the input's triangle behind each of its triangles ([`NEW`]: none).
    pub(super) fn returned(
        self,
        input: &Input,
        origins: &[u32],
        mut report: Report,
        outcome: Outcome,
        budget: &Budget,
    ) -> Result<Answer, Stopped> {
        let origins = &*self.origins(origins);
        let fidelity = match report.fidelity.take() {
            Some(fidelity) => fidelity,
            None => faithful::judge(&input.soup, &self.soup, origins, &mut report, budget)?,
        };
        let after = describe(&self.soup, &self.examination, &input.analyze_options(), budget)?;
        let share = identical_triangle_share(&input.soup, &self.soup, origins, budget)?;
        let texture = self.texture_of_part();
        let lost = [
            self.lost_texture(input, origins),
            self.lost_materials(input, origins),
            taken_over(&input.soup, &self.soup, origins),
            left_out(&input.soup, &self.left_out, &self.soup, self.encoding),
        ];
        let actions = report.actions.into_iter().chain(lost.into_iter().flatten()).collect();
        let report = Report {
            actions,
            after: Some(after),
            certificate: Some(self.examination.certificate),
            identical_triangle_share: Some(share),
            fidelity: Some(fidelity),
            outcome: Some(outcome),
            ..report
        };
        let output =
            Output { bytes: Some(self.bytes), encoding: self.encoding, origins: origins.to_vec(), texture };
        Ok(Answer { report, output: Some(output), levels: Vec::new(), picture: None })
    }
}
