//! Fewer triangles, the same shape: edge collapses in the order of the error that they make.
//!
//! Every collapse passes the link condition, so what comes out has the topology of what went in: the same components,
//! boundary loops and Euler characteristic, and it is a manifold. Three modes: [`simplify_strict`] takes the cheapest
//! collapse each time, [`simplify_fast`] cheap ones in many places at the same time, [`simplify_guarded`] sees to it that
//! surfaces do not meet.

mod blend;
mod criterion;
mod fast;
mod guard;
mod key;
mod layout;
mod length;
mod lines;
mod marks;
mod memoryless;
mod merge;
mod mode;
mod options;
mod order;
mod priority;
mod quadric;
mod quadric_error;
mod queue;
mod report;
mod result;
mod strict;
mod surface;
mod wedges;

pub use fast::{simplify_fast, simplify_guarded};
pub use mode::{Mode, simplify};
pub use options::{Borders, CriterionKind, Envelope, Guards, Placement, SimplifyOptions, Target};
pub use quadric::{Minimum, Quadric};
pub use report::{Refusals, SimplifyRefusal, TargetReport};
pub use result::{Simplified, SimplifyError, SimplifyInput};
pub use strict::simplify_strict;
pub use surface::NEW;
pub use wedges::NO_TEXTURE;
