//! A mesh described, with what only its certificate can know.

use crate::analysis::{self, Analysis, AnalyzeOptions, DefectCode, Finding, Witness};
use crate::budget::{Budget, Stage, Stopped};
use crate::certificate::{Certificate, Examination, Violation};
use crate::mesh::Soup;

/// Describes `soup`, which `examination` has judged. A file that is not printable always has a finding that is an error.
pub(super) fn describe(
    soup: &Soup,
    examination: &Examination,
    options: &AnalyzeOptions,
    budget: &Budget,
) -> Result<Analysis, Stopped> {
    let contacts = examination.contacts.as_ref();
    let mut analysis = budget.stage(Stage::Analyze, || analysis::analyze(soup, contacts, options, budget))?;
    let certificate = &examination.certificate;
    if !certificate.is_printable() && !analysis.has_errors() {
        // The analysis describes one reading; the certificate asks of every reading that it be valid.
        analysis.findings.push(unsound_reading(soup, certificate, options.samples));
    }
    Ok(analysis)
}

fn unsound_reading(soup: &Soup, certificate: &Certificate, samples: usize) -> Finding {
    let code = DefectCode::UnsoundReading;
    let witnesses =
        certificate.witnesses.iter().take(samples).map(|violation| witness(soup, violation)).collect();
    let count = certificate.violations.total().max(1);
    let is_at_least = certificate.violations.contacts_are_at_least;
    Finding { code, severity: code.severity(), count, is_at_least, witnesses }
}

fn witness(soup: &Soup, violation: &Violation) -> Witness {
    let reading = violation.reading;
    let figures =
        [("is_f32", reading.is_f32), ("is_fan", reading.is_fan), ("is_as_indexed", reading.is_as_indexed)];
    Witness {
        position: violation.position,
        figures: figures.map(|(name, is_so)| (name, f64::from(u8::from(is_so)))).to_vec(),
        ..Witness::of_faces(soup, &violation.faces)
    }
}
