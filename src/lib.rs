//! Meshmend repairs triangle meshes for 3D printing and proves what it returns.
//!
//! Bytes are read by [`formats`] into a [`mesh::Soup`] that may be arbitrarily broken, described by [`analysis`],
//! mended by small [`repair`] steps that [`pipeline`] runs, and judged by [`certificate`] on the very bytes that are
//! returned. Everything in these modules is a pure, synchronous function of its arguments. The cargo feature `server`
//! (on by default) adds the service and the command line.

pub mod budget;
pub mod figures;
pub mod geom;
pub mod par;

pub mod mesh;
pub mod spatial;

pub mod distance;
pub mod formats;
pub mod winding;

pub mod analysis;
pub mod arrangement;
pub mod implicit;
pub mod modeller;
pub mod printing;
pub mod render;
pub mod simplify;
pub mod wrap;

pub mod certificate;
pub mod repair;

pub mod pipeline;

#[cfg(feature = "server")]
pub mod wire;

#[cfg(feature = "server")]
pub mod config;
#[cfg(feature = "server")]
pub mod jobs;

#[cfg(feature = "server")]
pub mod cli;
#[cfg(feature = "server")]
pub mod http;
