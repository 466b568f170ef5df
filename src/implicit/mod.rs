//! A surface through the points around a hole, as the zero set of a sum of radial functions, and its triangles.
//!
//! [`fit`] makes a [`Field`] from a [`Band`] of points with normals (Carr et al. 2001). The method note is
//! `docs/rbf.md`.

mod band;
mod cells;
mod centres;
mod cholesky;
mod clip;
mod cubes;
mod field;
mod fit;
mod kernel;
mod logarithm;
mod march;
mod offsets;
mod options;
mod partition;
mod patch;
mod polynomial;
mod remesh;
mod rim;
mod system;
mod track;
mod unfit;
mod zip;

pub use band::{Band, BandSurroundings};
pub use field::{Field, FitFacts, SolveMethod};
pub use fit::fit;
pub use march::march;
pub use options::{ConstraintValues, DENSE_CENTRES_MAX, Kernel, LAMBDA_SHARE, LambdaFrom, RbfOptions};
pub use patch::{Patch, Unmeshed};
pub use remesh::mesh_surface;
pub use unfit::Unfit;
