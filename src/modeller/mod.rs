//! Editing closed polyhedra by their planes.
mod cone;
mod contact;
mod dual;
mod events;
mod exact;
mod export;
mod import;
mod index;
mod journal;
mod motion;
mod nesting;
mod operator;
mod pick;
mod plane;
mod point;
mod resolve;
mod solid;
mod validity;
pub use dual::{Dual, DualRefusal, Embedding, dual, dual_faces};
pub use events::Contact;
pub use exact::{Rational, rational, to_f64};
pub use export::{ExportRefusal, Exported, export};
pub use import::{ImportRefusal, Imported, PolygonFault, default_tolerance, from_polygons, import};
pub use operator::{
    Applied, Change, Events, Operator, Refusal, Side, apply, distance_of_growth, offset_growth, range,
};
pub use pick::{edge_between, face_by_normal, face_on_ray, vertex_near};
pub use plane::Plane;
pub use point::Point;
pub use solid::Solid;
pub use validity::{Fault, Rule, Validity, check};
