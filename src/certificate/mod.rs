//! The judge: final bytes in, claims with witnesses out.
//!
//! Decides P0 (topology), P1 (embedding) and P2 (solid) of the contract exactly, on the bytes that are sent. Imports no
//! code that changes a mesh: only predicates, search structures, the soup and the readers.

mod claims;
mod judge;
mod parts;
mod solid;
mod surface;
mod topology;
mod verdict;

pub use claims::{Certificate, Condition, Reading, Shell, Violation, ViolationCounts};
pub use parts::{PartsExamination, certify_parts, examine_parts};

use crate::budget::{Budget, Stopped};
use crate::formats::{self, Encoding, ReadError, ReadErrorKind, ReadOptions};
use crate::mesh::Soup;
use crate::par;
use crate::spatial::Contacts;
use sha2::{Digest, Sha256};

/// How much to find out about an invalid file. A valid one costs the same either way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// End at the first violation, keep it as the only witness. P0 is cheap and always counted in full.
    FirstViolation,
    /// Count every violation and keep up to this many witnesses of each condition.
    Count {
        /// Witnesses to keep of each condition.
        samples: usize,
    },
}

/// A file that could not be judged.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CertifyError {
    /// It could not be read.
    #[error("{0}")]
    Unreadable(ReadError),
    /// The run was stopped.
    #[error("{0}")]
    Stopped(#[from] Stopped),
}

impl From<ReadError> for CertifyError {
    fn from(error: ReadError) -> Self {
        match error.kind {
            ReadErrorKind::Stopped(stopped) => Self::Stopped(stopped),
            _ => Self::Unreadable(error),
        }
    }
}

/// A certificate with what the check found on the way, so that a report need not find it again.
#[derive(Debug, Clone)]
pub struct Examination {
    /// What was proved.
    pub certificate: Certificate,
    /// Contacts of the welded f64 reading in our own triangulation, between triangles of the soup; degenerate ones and
    /// duplicates are left out. `None` when not evaluated.
    pub contacts: Option<Contacts>,
}

/// Reads `bytes` and judges them.
///
/// ```
/// use meshmend::budget::Budget;
/// use meshmend::certificate::{Depth, certify};
/// use meshmend::formats::{ReadOptions, sniff};
///
/// let file = b"OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
/// let encoding = sniff(file, None)?;
/// let certificate =
///     certify(file, encoding, &ReadOptions::default(), Depth::FirstViolation, &Budget::unlimited())?;
/// assert!(certificate.is_printable());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Unreadable bytes, or a stopped budget. An invalid mesh is no error.
pub fn certify(
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    depth: Depth,
    budget: &Budget,
) -> Result<Certificate, CertifyError> {
    let soup = formats::read(bytes, encoding, options, budget)?;
    Ok(examine(&soup, bytes, encoding, options, depth, budget)?.certificate)
}

/// As [`certify`] where the caller has the f64 reading of `bytes` already: `soup` must be what
/// [`formats::read`] gives for them.
///
/// # Errors
/// As [`certify`].
pub fn examine(
    soup: &Soup,
    bytes: &[u8],
    encoding: Encoding,
    options: &ReadOptions,
    depth: Depth,
    budget: &Budget,
) -> Result<Examination, CertifyError> {
    let judge = || judge::judge(soup, bytes, encoding, options, depth, budget);
    let (file, judged) = par::join(|| Fingerprint::of(bytes, budget), judge);
    Ok(judged?.into_examination(file?, encoding, soup))
}

/// As [`examine`] where the bytes of the file go once `file` has told them from others, beside the judgement. `soup` must be their f64
/// reading. Where the f32 reading is another one ([`Soup::is_f32_exact`]) no condition is decided.
///
/// # Errors
/// When the budget stops the run.
pub(crate) fn examine_read(
    soup: &Soup,
    file: impl FnOnce() -> Result<Fingerprint, Stopped> + Send,
    encoding: Encoding,
    depth: Depth,
    budget: &Budget,
) -> Result<Examination, Stopped> {
    let (file, judged) = par::join(file, || judge::judge_read(soup, None, depth, budget));
    Ok(judged?.into_examination(file?, encoding, soup))
}

impl judge::Judged {
    /// As what is told of the file, or the part of one, that was read as `soup`.
    fn into_examination(self, file: Fingerprint, encoding: Encoding, soup: &Soup) -> Examination {
        let Self { census, verdict, contacts, shells } = self;
        let Fingerprint { sha256, bytes } = file;
        let certificate = Certificate {
            sha256,
            bytes,
            encoding,
            parts: None,
            p0: verdict.p0(),
            p1: verdict.p1(),
            p2: verdict.p2(),
            violations: verdict.counts(),
            triangles: soup.triangles.len() as u64,
            vertices: census.vertices,
            euler_characteristic: census.euler_characteristic(),
            shells: if verdict.is_valid() { shells } else { Vec::new() },
            witnesses: verdict.witnesses,
            readings: verdict.readings,
        };
        Examination { certificate, contacts }
    }
}

/// Bytes hashed between two looks at the budget: about a millisecond.
const HASH_BLOCK_BYTES: usize = 1 << 18;

/// What tells a file from all others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint {
    /// SHA-256 of its bytes.
    pub sha256: [u8; 32],
    /// Number of its bytes.
    pub bytes: u64,
}

impl Fingerprint {
    /// That of `bytes`.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn of(bytes: &[u8], budget: &Budget) -> Result<Self, Stopped> {
        let mut hasher = Sha256::new();
        for block in bytes.chunks(HASH_BLOCK_BYTES) {
            budget.check()?;
            hasher.update(block);
        }
        Ok(Self { sha256: hasher.finalize().into(), bytes: bytes.len() as u64 })
    }
}
