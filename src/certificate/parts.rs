//! A file of several parts, each of which has to be a solid by itself, in its own coordinates.

use super::verdict::sum_of;
use super::{
    Certificate, CertifyError, Condition, Depth, Examination, Fingerprint, Reading, Violation, judge,
};
use crate::budget::Budget;
use crate::formats::{self, Encoding, Precision, ReadOptions};
use crate::mesh::Soup;

/// What was found about a file and each of its parts.
#[derive(Debug, Clone)]
pub struct PartsExamination {
    /// The certificate of the whole: it holds what every part holds. Faces and shells are numbered through all parts.
    pub certificate: Certificate,
    /// One for each part, in the order of the file.
    pub parts: Vec<Examination>,
}

/// Reads `bytes` and judges every part of them by itself (see [`formats::read_parts`]).
///
/// # Errors
/// Unreadable bytes, or a stopped budget. An invalid mesh is no error.
pub fn certify_parts(
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    depth: Depth,
    budget: &Budget,
) -> Result<Certificate, CertifyError> {
    let soups = formats::read_parts(bytes, encoding, options, budget)?;
    let soups: Vec<&Soup> = soups.iter().collect();
    Ok(examine_parts(&soups, bytes, encoding, options, depth, budget)?.certificate)
}

/// As [`certify_parts`] where the caller has the parts already: `soups` must be what [`formats::read_parts`] gives.
///
/// # Errors
/// As [`certify_parts`].
pub fn examine_parts(
    soups: &[&Soup],
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    depth: Depth,
    budget: &Budget,
) -> Result<PartsExamination, CertifyError> {
    let file = Fingerprint::of(bytes, budget)?;
    let is_exact = soups.iter().all(|soup| soup.is_f32_exact);
    let rounded = match is_exact {
        true => Vec::new(),
        false => {
            let options = ReadOptions { precision: Precision::F32, ..*options };
            formats::read_parts(bytes, encoding, &options, budget)?
        }
    };
    let mut parts = Vec::with_capacity(soups.len());
    for (i, &soup) in soups.iter().enumerate() {
        let judged = judge::judge_read(soup, rounded.get(i), depth, budget)?;
        parts.push(judged.into_examination(file, encoding, soup));
    }
    let faces: Vec<u32> = soups.iter().map(|soup| soup.face_count).collect();
    let certificates: Vec<&Certificate> = parts.iter().map(|part| &part.certificate).collect();
    let certificate = whole(&certificates, &faces, file, encoding, depth);
    Ok(PartsExamination { certificate, parts })
}

/// The certificate of a file with these parts, which have so many `faces`.
fn whole(
    parts: &[&Certificate],
    faces: &[u32],
    file: Fingerprint,
    encoding: Encoding,
    depth: Depth,
) -> Certificate {
    let mut first_face = 0;
    let (mut witnesses, mut readings): (Vec<Violation>, Vec<Reading>) = (Vec::new(), Vec::new());
    let samples = match depth {
        Depth::FirstViolation => 1,
        Depth::Count { samples } => samples,
    };
    for (part, &count) in parts.iter().zip(faces) {
        for violation in &part.witnesses {
            let known = witnesses.iter().filter(|other| other.condition == violation.condition).count();
            if known < samples {
                let faces = violation.faces.iter().map(|face| first_face + face).collect();
                witnesses.push(Violation { faces, ..violation.clone() });
            }
        }
        readings.extend(
            part.readings.iter().filter(|reading| !readings.contains(reading)).copied().collect::<Vec<_>>(),
        );
        first_face += count;
    }
    let p0 = parts.iter().all(|part| part.p0);
    let claims =
        |of: fn(&Certificate) -> Option<bool>| -> Vec<_> { parts.iter().map(|part| of(part)).collect() };
    let mut p2 = all_hold(&claims(|part| part.p2));
    if parts.is_empty() {
        // Nothing is no solid.
        p2 = Some(false);
        let (condition, faces, position) = (Condition::NotEmpty, Vec::new(), None);
        let reading = Reading { is_f32: false, is_fan: false, is_as_indexed: false };
        witnesses.push(Violation { condition, reading, faces, position });
    }
    let sum = |of: fn(&Certificate) -> u64| parts.iter().map(|part| of(part)).sum();
    let is_valid = p0 && parts.iter().all(|part| part.is_printable());
    Certificate {
        sha256: file.sha256,
        bytes: file.bytes,
        encoding,
        parts: Some(parts.len() as u32),
        p0,
        p1: all_hold(&claims(|part| part.p1)),
        p2,
        violations: sum_of(&parts.iter().map(|part| &part.violations).collect::<Vec<_>>()),
        witnesses,
        readings,
        triangles: sum(|part| part.triangles),
        vertices: sum(|part| part.vertices),
        euler_characteristic: parts.iter().map(|part| part.euler_characteristic).sum(),
        shells: match is_valid {
            true => parts.iter().flat_map(|part| part.shells.iter().copied()).collect(),
            false => Vec::new(),
        },
    }
}

/// A claim about all parts: broken where one breaks it, open where one leaves it open.
fn all_hold(claims: &[Option<bool>]) -> Option<bool> {
    if claims.contains(&Some(false)) {
        Some(false)
    } else if claims.contains(&None) {
        None
    } else {
        Some(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_part_that_breaks_a_claim_breaks_it_for_all() {
        assert_eq!(all_hold(&[Some(true), None, Some(false)]), Some(false));
        assert_eq!(all_hold(&[Some(true), None]), None);
        assert_eq!(all_hold(&[Some(true); 3]), Some(true));
    }

    #[test]
    fn a_file_without_a_part_is_no_solid() {
        let depth = Depth::Count { samples: 1 };
        let certificate =
            whole(&[], &[], Fingerprint { sha256: [0; 32], bytes: 0 }, Encoding::ThreeMf, depth);
        assert!(!certificate.is_printable());
        assert_eq!(certificate.witnesses[0].condition, Condition::NotEmpty);
    }
}
