//! The uploaded file: read, judged and described once for every operation.

use super::describe::describe;
use super::remedies::proposals;
use super::{
    Answer, ChosenPlan, ELEMENTS_MAX, Failure, FidelityVerdict, InputFacts, Operation, Options, Outcome,
    Output, Plan, Refusal, Report, Step, Units,
};
use crate::analysis::{Analysis, AnalyzeOptions, NearSearch};
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::{self, CertifyError, Depth, Examination, Fingerprint};
use crate::formats::{self, Encoding, Place, ReadError, ReadErrorKind};
use crate::geom::DVec3;
use crate::mesh::{Regions, Soup, Texture};
use std::borrow::Cow;

/// Witnesses to keep of each defect when the caller does not say.
const SAMPLES_DEFAULT: usize = 16;

/// Triangles up to which `analyze` searches what is near and estimates volumes without being asked: the search takes three
/// to four times as long as the rest of the description, see `docs/defects.md`.
const IN_FULL_MAX: usize = 100_000;

pub(super) struct Input {
    pub(super) facts: InputFacts,
    pub(super) soup: Soup,
    pub(super) examination: Examination,
    pub(super) samples: usize,
    /// The regions of a part of a project, which keeps what is said of faces, where the run simplifies it; `None`: the mesh is no
    /// part of one.
    pub(super) regions: Option<Regions>,
    /// The coordinates of the file, where the mesh has another unit by now and the operation needs both.
    pub(super) of_file: Option<FileCoordinates>,
    /// What is near, where the caller said so.
    near: Option<f64>,
}

/// The coordinates as the file has them.
pub(super) struct FileCoordinates {
    /// The positions, one for each of the mesh.
    pub(super) positions: Vec<DVec3>,
    /// How many times as large the mesh is by now.
    pub(super) factor: f64,
}

impl Input {
    /// Reads and judges `bytes`.
    pub(super) fn read(
        bytes: &[u8],
        encoding: Encoding,
        options: &Options,
        budget: &Budget,
    ) -> Result<Self, Failure> {
        let soup = Self::read_soup(bytes, encoding, options, budget)?;
        Self::examined(soup, bytes.into(), encoding, options, budget)
    }

    /// Reads `bytes`.
    pub(super) fn read_soup(
        bytes: &[u8],
        encoding: Encoding,
        options: &Options,
        budget: &Budget,
    ) -> Result<Soup, Failure> {
        let soup = budget.stage(Stage::Read, || {
            let mut soup = formats::read(bytes, encoding, &options.read, budget)?;
            if let (Encoding::Obj, Some(material)) = (encoding, &options.material) {
                formats::color_faces(&mut soup, bytes, material, budget)?;
            }
            Ok::<_, ReadError>(soup)
        })?;
        Ok(soup)
    }

    /// Judges `bytes`, which were read as `soup`. Those that are owned are released as soon as they are hashed, where no other reading
    /// needs them: of most files they are as large as everything else that the judge has.
    pub(super) fn examined(
        soup: Soup,
        bytes: Cow<'_, [u8]>,
        encoding: Encoding,
        options: &Options,
        budget: &Budget,
    ) -> Result<Self, Failure> {
        let depth = Depth::Count { samples: samples_of(options) };
        let examination = budget.stage(Stage::Certify, || match bytes {
            Cow::Owned(bytes) if soup.is_f32_exact => {
                let file = move || Fingerprint::of(&bytes, budget);
                Ok(certificate::examine_read(&soup, file, encoding, depth, budget)?)
            }
            bytes => certificate::examine(&soup, &bytes, encoding, &options.read, depth, budget),
        })?;
        Self::of(soup, examination, options)
    }

    /// A mesh that was read and judged.
    ///
    /// # Errors
    /// A unit that is not the one the caller states.
    pub(super) fn of(soup: Soup, examination: Examination, options: &Options) -> Result<Self, Failure> {
        let certificate = &examination.certificate;
        // glTF is in metres by its rules, but many programs write other units, so that the caller's word counts.
        let of_format = certificate.encoding.format().is_in_metres().then_some(Units::Metre);
        let units = units_of_file(soup.units, options)?.or(of_format);
        let facts = InputFacts {
            encoding: certificate.encoding,
            bytes: certificate.bytes,
            sha256: certificate.sha256,
            units: units.unwrap_or_default(),
            units_are_stated: units.is_some(),
            result_units: units.unwrap_or_default(),
        };
        let (samples, near) = (samples_of(options), options.near);
        Ok(Self { facts, soup, examination, samples, regions: None, of_file: None, near })
    }

    /// Takes the length of what is near in another unit.
    pub(super) fn scale_near(&mut self, factor: f64) {
        self.near = self.near.map(|length| length * factor);
    }

    /// True when a result laid out as `encoding` may be the very bytes that were uploaded.
    pub(super) fn may_come_back_as(&self, encoding: Encoding) -> bool {
        encoding == self.facts.encoding && self.facts.result_units == self.facts.units
    }

    /// What to find out of a mesh of this run.
    pub(super) fn analyze_options(&self) -> AnalyzeOptions {
        let near = self.near.map_or(NearSearch::Off, NearSearch::Within);
        AnalyzeOptions { samples: self.samples, near, ..AnalyzeOptions::default() }
    }

    /// Describes the mesh as uploaded; in full when that is all that is asked for and it is small.
    fn analyze(&self, operation: Operation, budget: &Budget) -> Result<Analysis, Stopped> {
        let mut options = self.analyze_options();
        if operation == Operation::FillHoles {
            options.loop_samples = ELEMENTS_MAX;
        }
        options.loop_edges = matches!(operation, Operation::FillHoles | Operation::Repair);
        if matches!(operation, Operation::Analyze | Operation::Plan) {
            let is_small = self.soup.triangles.len() <= IN_FULL_MAX;
            options.volume_interval = is_small || self.near.is_some();
            if is_small && self.near.is_none() {
                options.near = NearSearch::ByDiagonal;
            }
        }
        describe(&self.soup, &self.examination, &options, budget)
    }

    /// The account of a run that has judged the input and done nothing else.
    pub(super) fn verification(&self) -> Report {
        Report {
            operation: Operation::Verify,
            input: self.facts.clone(),
            before: None,
            input_certificate: self.examination.certificate.clone(),
            further_inputs: Vec::new(),
            plan: None,
            tried: Vec::new(),
            actions: Vec::new(),
            levels: Vec::new(),
            after: None,
            certificate: None,
            identical_triangle_share: None,
            distance: None,
            losses: None,
            fidelity: None,
            filling: None,
            modeller: None,
            outcome: None,
            refusal: None,
            printing: None,
            parts: Vec::new(),
            remarks: Vec::new(),
            work_used: 0,
            bytes_peak: 0,
        }
    }

    /// The account of `operation` as far as the input is concerned.
    pub(super) fn report(&self, operation: Operation, budget: &Budget) -> Result<Report, Stopped> {
        Ok(Report { operation, before: Some(self.analyze(operation, budget)?), ..self.verification() })
    }

    /// The same with what is proposed for each defect.
    pub(super) fn planned(&self, operation: Operation, budget: &Budget) -> Result<Report, Stopped> {
        let report = self.report(operation, budget)?;
        let plan = Plan {
            input_sha256: self.facts.sha256,
            findings: report.before.as_ref().map(proposals).unwrap_or_default(),
            steps: None,
        };
        Ok(Report { plan: Some(plan), ..report })
    }

    /// The encoding of the output: the input's own unless another format is asked.
    pub(super) fn output_encoding(&self, options: &Options) -> Encoding {
        match options.output_format {
            Some(format) if format != self.facts.encoding.format() => format.default_encoding(),
            _ => self.facts.encoding,
        }
    }

    /// The input's own bytes as the answer.
    pub(super) fn returned_as_it_is(&self, report: Report, outcome: Outcome) -> Answer {
        Answer {
            report: Report {
                certificate: Some(self.examination.certificate.clone()),
                identical_triangle_share: Some(1.0),
                fidelity: Some(FidelityVerdict::EXACT),
                outcome: Some(outcome),
                ..report
            },
            output: Some(Output {
                bytes: None,
                encoding: self.facts.encoding,
                origins: Vec::new(),
                texture: Texture::default(),
            }),
            levels: Vec::new(),
            picture: None,
        }
    }
}

/// Witnesses to keep of each defect.
pub(super) fn samples_of(options: &Options) -> usize {
    let of_plan = options.plan.as_ref().map_or(0, ChosenPlan::samples_min);
    options.samples.unwrap_or(SAMPLES_DEFAULT).max(of_plan)
}

/// The unit of a file that states `of_file`, or else of the caller.
///
/// # Errors
/// They contradict each other.
pub(super) fn units_of_file(of_file: Option<Units>, options: &Options) -> Result<Option<Units>, Failure> {
    match (of_file, options.units) {
        (Some(stated), Some(asked)) if stated != asked => {
            let kind =
                ReadErrorKind::Unparseable { found: format!("the unit {} in the file", stated.name()) };
            let expected =
                format!("{}, as the request says; leave `units` out to take the file's word", asked.name());
            Err(Failure::Unreadable(ReadError { kind, place: Place::Whole, expected }))
        }
        (stated, asked) => Ok(stated.or(asked)),
    }
}

impl Report {
    /// With the steps that made the result.
    pub(super) fn made_by(mut self, steps: Vec<Step>) -> Self {
        if let Some(plan) = &mut self.plan {
            plan.steps = Some(steps);
        }
        self
    }

    /// An answer without a file.
    pub(super) fn into_answer(self) -> Answer {
        Answer { report: self, output: None, levels: Vec::new(), picture: None }
    }

    /// An answer that refuses a file.
    pub(super) fn refused(self, refusal: Refusal) -> Answer {
        Self { outcome: Some(Outcome::Refused), refusal: Some(refusal), ..self }.into_answer()
    }
}

impl From<CertifyError> for Failure {
    fn from(error: CertifyError) -> Self {
        match error {
            CertifyError::Unreadable(error) => error.into(),
            CertifyError::Stopped(stopped) => Self::Stopped(stopped),
        }
    }
}
