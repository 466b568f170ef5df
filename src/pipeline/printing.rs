//! What is returned, or else what was uploaded, measured for printing.

use super::input::Input;
use super::{Answer, Failure};
use crate::budget::{Budget, Stage};
use crate::formats::{self, Encoding, ReadError, ReadLimits, ReadOptions};
use crate::mesh::Soup;
use crate::printing::{self, PrintingPolicy};

/// Figures of a mesh and how they stand to a policy.
#[derive(Debug, Clone, PartialEq)]
pub struct PrintingReport {
    /// True when the mesh is the one that is returned, false when it is the uploaded one.
    pub is_about_result: bool,
    /// What was measured, and the checks.
    pub printing: printing::Printing,
    /// The file's face behind each triangle that a witness names, as pairs in ascending order.
    faces: Vec<(u32, u32)>,
}

impl PrintingReport {
    /// The face of a triangle that a witness names.
    pub fn face_of(&self, triangle: u32) -> u32 {
        let found = self.faces.binary_search_by_key(&triangle, |&(triangle, _)| triangle);
        found.map_or(triangle, |place| self.faces[place].1)
    }

    fn new(soup: &Soup, printing: printing::Printing, is_about_result: bool) -> Self {
        let witnesses = printing.checks.iter().flat_map(|check| &check.witnesses);
        let mut faces: Vec<(u32, u32)> = witnesses.map(|w| (w.triangle, soup.face_of(w.triangle))).collect();
        faces.sort_unstable();
        faces.dedup();
        Self { is_about_result, printing, faces }
    }
}

/// Measures what `answer` returns, read from its bytes, or the input where it returns nothing. `None`: there is nothing to
/// measure.
pub(super) fn measure(
    input: &Input,
    answer: &Answer,
    policy: &PrintingPolicy,
    budget: &Budget,
) -> Result<Option<PrintingReport>, Failure> {
    let judged = answer.report.certificate.as_ref().unwrap_or(&answer.report.input_certificate);
    let is_solid = judged.is_printable();
    let written = answer.output.as_ref().and_then(|output| Some((output.bytes.as_ref()?, output.encoding)));
    let result = match written {
        Some((bytes, encoding)) => Some(budget.stage(Stage::Read, || read_back(bytes, encoding, budget))?),
        None => None,
    };
    let soup = result.as_ref().unwrap_or(&input.soup);
    let printing =
        budget.stage(Stage::Measure, || printing::measure(soup, policy, is_solid, input.samples, budget))?;
    Ok(printing.map(|printing| PrintingReport::new(soup, printing, answer.output.is_some())))
}

fn read_back(bytes: &[u8], encoding: Encoding, budget: &Budget) -> Result<Soup, ReadError> {
    // What we write may be larger than what we would take in.
    let limits =
        ReadLimits { triangles_max: u32::MAX, vertices_max: u32::MAX, polygon_corners_max: u32::MAX };
    formats::read(bytes, encoding, &ReadOptions { limits, ..ReadOptions::default() }, budget)
}
