//! The polyhedron read, edited operator by operator, and measured.

use super::choices::{EdgeName, Edit, FaceName, ModellerChoices, RangeName};
use super::report::{
    Blocker, BlockerKind, FaceRange, ModelFace, ModellerRefusal, ModellerReport, ModellerStep, NameFault,
    RangeSide,
};
use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::mesh::polyhedron::{FaceId, HalfEdgeId};
use crate::modeller::{
    self, Applied, EventPolicy, Imported, IntervalSide, Operator, Rational, Solid, TopologyChange,
};
use crate::repair::Draft;
use crate::spatial::coincident_f64;
use std::collections::BTreeSet;

/// The edited polyhedron.
pub(super) struct Edited {
    pub(super) imported: Imported,
    /// Its planes or its topology are not those that were read.
    pub(super) has_changed: bool,
}

/// The polyhedron of the triangles of `draft`, welded and edited; a refusal with the account as far as it went.
type EditResult = (Result<Edited, ModellerRefusal>, Option<ModellerReport>);

/// Reads `draft`, in the unit of the file, as a polyhedron, makes it `factor` times as large, which is the unit of the result,
/// and does what is asked.
pub(super) fn edit(
    draft: &Draft,
    factor: f64,
    choices: &ModellerChoices,
    budget: &Budget,
) -> Result<EditResult, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let welded = |t: &[u32; 3]| t.map(|v| places.group[v as usize]);
    let triangles: Vec<[u32; 3]> = draft.triangles.iter().map(welded).collect();
    let points: Vec<DVec3> = places.first.iter().map(|&v| draft.positions[v as usize]).collect();
    let mut imported = match modeller::import(&points, &triangles, choices.tolerance, budget)? {
        Ok(imported) => imported.scaled(factor),
        Err(refusal) => return Ok((Err(ModellerRefusal::Import(refusal.scaled(factor))), None)),
    };
    let mut report = ModellerReport {
        validity: imported.validity.clone(),
        tolerance: imported.tolerance,
        tolerant_faces: imported.tolerant_faces,
        vertices_moved: imported.moved.0,
        move_max: imported.moved.1,
        steps: Vec::new(),
        ranges: Vec::new(),
        faces: Vec::new(),
        rounded_by: None,
    };
    let original = imported.solid.clone();
    let refusal = run(&mut imported.solid, &choices.operators, &mut report, budget)?;
    let refusal = match refusal {
        None => ranges(&imported.solid, &choices.ranges, &mut report, budget)?,
        refused => refused,
    };
    if choices.lists_faces {
        let solid = &imported.solid;
        report.faces = solid.topology().faces().map(|f| model_face(solid, f)).collect();
    }
    let has_changed = !imported.solid.is_same_as(&original);
    Ok((refusal.map_or(Ok(Edited { imported, has_changed }), Err), Some(report)))
}

/// For each operator, whether a later one takes it back.
fn are_undone(operators: &[Edit]) -> Vec<bool> {
    let mut are_undone = vec![false; operators.len()];
    let mut open = Vec::new();
    for (k, edit) in operators.iter().enumerate() {
        match edit {
            Edit::Undo => {
                if let Some(last) = open.pop() {
                    are_undone[last] = true;
                }
            }
            _ => open.push(k),
        }
    }
    are_undone
}

/// Applies the operators one after the other.
fn run(
    solid: &mut Solid,
    operators: &[Edit],
    report: &mut ModellerReport,
    budget: &Budget,
) -> Result<Option<ModellerRefusal>, Stopped> {
    let are_undone = are_undone(operators);
    // What undoes an operator may hold a copy of the topology: kept only where it is needed.
    let mut kept: Vec<Applied> = Vec::new();
    for (k, asked) in operators.iter().enumerate() {
        let step = if *asked == Edit::Undo {
            match kept.pop() {
                Some(applied) => undone(solid, applied, budget)?,
                None => return Ok(Some(ModellerRefusal::NothingToUndo { operator: k })),
            }
        } else {
            let operator = match operator(solid, asked) {
                Ok(operator) => operator,
                Err(fault) => return Ok(Some(ModellerRefusal::Name { operator: Some(k), fault })),
            };
            match modeller::apply(solid, &operator, budget)? {
                Ok(applied) => {
                    let step = applied_step(solid, asked, &operator, &applied, budget)?;
                    if are_undone[k] {
                        kept.push(applied);
                    }
                    step
                }
                Err(reason) => return Ok(Some(refused(solid, k, reason))),
            }
        };
        report.steps.push(step);
    }
    Ok(None)
}

fn refused(solid: &Solid, operator: usize, reason: modeller::OperatorRefusal) -> ModellerRefusal {
    let (limits, blocking) = match &reason {
        modeller::OperatorRefusal::Limit { limits, blocking } => {
            (limit_distances(solid, limits), blocking.iter().map(|c| Blocker::of(solid, c)).collect())
        }
        modeller::OperatorRefusal::NoSplit { vertex, faces } => {
            (Vec::new(), vec![Blocker::with(solid, BlockerKind::NoSplit, faces, &[*vertex])])
        }
        _ => (Vec::new(), Vec::new()),
    };
    ModellerRefusal::Operator { operator, reason, limits, blocking }
}

fn find_face(solid: &Solid, name: FaceName) -> Result<FaceId, NameFault> {
    match name {
        FaceName::Id(id) if (id as usize) < solid.topology().face_count() => Ok(FaceId::new(id as usize)),
        FaceName::Id(id) => Err(NameFault::NoFace(id)),
        FaceName::Normal { normal, .. } if normal.try_normalize().is_none() => Err(NameFault::NoNormal),
        FaceName::Normal { normal, at } => {
            modeller::face_by_normal(solid, normal, at).ok_or(NameFault::NoFaces)
        }
        FaceName::Ray { direction, .. } if direction == DVec3::ZERO => Err(NameFault::NoDirection),
        FaceName::Ray { from, direction } => {
            modeller::face_on_ray(solid, from, direction).ok_or(NameFault::RayMisses)
        }
    }
}

fn find_edge(solid: &Solid, name: EdgeName) -> Result<HalfEdgeId, NameFault> {
    let [a, b] = name.faces;
    let faces = [find_face(solid, a)?, find_face(solid, b)?];
    let numbers = faces.map(|f| f.index() as u32);
    modeller::edge_between(solid, faces, name.at).ok_or(NameFault::NoEdge(numbers))
}

/// The faces of a shift, each once, and how much their offsets grow.
fn shifted_faces(solid: &Solid, asked: &[(FaceName, f64)]) -> Result<Vec<(FaceId, Rational)>, NameFault> {
    let mut named = BTreeSet::new();
    let growth = |&(name, by): &(FaceName, f64)| {
        let face = find_face(solid, name)?;
        match named.insert(face) {
            true => Ok((face, modeller::offset_growth(solid, face, by))),
            false => Err(NameFault::FaceTwice(face.index() as u32)),
        }
    };
    asked.iter().map(growth).collect()
}

/// The operator that an edit means.
fn operator(solid: &Solid, asked: &Edit) -> Result<Operator, NameFault> {
    let face = |name: FaceName| find_face(solid, name);
    let edge = |name: EdgeName| find_edge(solid, name);
    let growth = |f: FaceId, by: f64| modeller::offset_growth(solid, f, by);
    Ok(match asked {
        Edit::Shift { faces, events } => {
            Operator::Shift { faces: shifted_faces(solid, faces)?, events: *events }
        }
        Edit::Split { at, face: name, by } => {
            let f = face(*name)?;
            let vertex = modeller::vertex_near(solid, *at).ok_or(NameFault::NoVertex)?;
            Operator::Split { vertex, face: f, by: growth(f, *by) }
        }
        Edit::Merge { edge: between, face: name } => {
            Operator::Merge { edge: edge(*between)?, face: face(*name)? }
        }
        Edit::Flip { edge: between, face: name, by } => {
            let f = face(*name)?;
            Operator::Flip { edge: edge(*between)?, face: f, by: by.map(|by| growth(f, by)) }
        }
        Edit::Undo => return Err(NameFault::NoOperator),
    })
}

fn applied_step(
    solid: &Solid,
    asked: &Edit,
    operator: &Operator,
    applied: &Applied,
    budget: &Budget,
) -> Result<ModellerStep, Stopped> {
    // Where the caller said how far, it is that and not what came of rounding it.
    let asked_moves = match (asked, operator) {
        (Edit::Shift { faces: asked, .. }, Operator::Shift { faces, .. }) => {
            Some(faces.iter().zip(asked).map(|((f, _), (_, by))| (f.index() as u32, *by)).collect())
        }
        (Edit::Split { by, .. }, Operator::Split { face, .. }) => Some(vec![(face.index() as u32, *by)]),
        _ => None,
    };
    let inverse = applied.inverse(solid, budget)?;
    let undo = inverse.and_then(|operator| match operator {
        Operator::Shift { faces, events } => {
            let back = match &asked_moves {
                Some(moves) => negative(moves),
                None => distances(solid, &faces),
            };
            Some((back, events == EventPolicy::Pass))
        }
        _ => None,
    });
    let count =
        |is_counted: fn(&TopologyChange) -> bool| applied.changes.iter().filter(|c| is_counted(c)).count();
    Ok(ModellerStep {
        operator: asked.kind(),
        moved: asked_moves.unwrap_or_else(|| distances(solid, &applied.shifts)),
        merged: count(|c| matches!(c, TopologyChange::Merged(_))),
        split: count(|c| matches!(c, TopologyChange::Split(_))),
        validity: modeller::check(solid, budget)?,
        undo,
    })
}

fn undone(solid: &mut Solid, applied: Applied, budget: &Budget) -> Result<ModellerStep, Stopped> {
    let moved = negative(&distances(solid, &applied.shifts));
    let (merged, split) = applied.changes.iter().fold((0, 0), |(merged, split), change| match change {
        TopologyChange::Merged(_) => (merged, split + 1),
        TopologyChange::Split(_) => (merged + 1, split),
    });
    applied.undo(solid);
    let validity = modeller::check(solid, budget)?;
    Ok(ModellerStep { operator: Edit::Undo.kind(), moved, merged, split, validity, undo: None })
}

fn negative(moves: &[(u32, f64)]) -> Vec<(u32, f64)> {
    moves.iter().map(|&(f, by)| (f, -by)).collect()
}

/// How far faces move when their offsets grow so much, rounded.
fn distances(solid: &Solid, growths: &[(FaceId, Rational)]) -> Vec<(u32, f64)> {
    let distance = |f: FaceId, t: &Rational| modeller::to_f64(t) / solid.plane(f).length();
    growths.iter().map(|(f, t)| (f.index() as u32, distance(*f, t))).collect()
}

/// The same, never beyond the true distances.
fn limit_distances(solid: &Solid, growths: &[(FaceId, Rational)]) -> Vec<(u32, f64)> {
    growths.iter().map(|(f, t)| (f.index() as u32, modeller::distance_of_growth(solid, *f, t))).collect()
}

/// Measures the intervals that are asked for.
fn ranges(
    solid: &Solid,
    asked: &[RangeName],
    report: &mut ModellerReport,
    budget: &Budget,
) -> Result<Option<ModellerRefusal>, Stopped> {
    for names in asked {
        let found = |&(name, rate): &(FaceName, f64)| Ok((find_face(solid, name)?, rate));
        let faces = match names.iter().map(found).collect::<Result<Vec<_>, NameFault>>() {
            Ok(faces) => faces,
            Err(fault) => return Ok(Some(ModellerRefusal::Name { operator: None, fault })),
        };
        report.ranges.push(range_of(solid, &faces, budget)?);
    }
    Ok(None)
}

fn range_of(solid: &Solid, faces: &[(FaceId, f64)], budget: &Budget) -> Result<FaceRange, Stopped> {
    let growths: Vec<(FaceId, Rational)> =
        faces.iter().map(|&(f, rate)| (f, modeller::offset_growth(solid, f, rate))).collect();
    let sides = modeller::range(solid, &growths, budget)?;
    let told = |side: IntervalSide| match side {
        IntervalSide::Unbounded => RangeSide { limit: None, blocking: Vec::new() },
        IntervalSide::Blocked { vertex } => {
            let around: Vec<FaceId> = match vertex.index() < solid.topology().vertex_bound() {
                true => solid.topology().faces_around(vertex).collect(),
                false => Vec::new(),
            };
            let blocker = Blocker::with(solid, BlockerKind::NoSplit, &around, &[vertex]);
            RangeSide { limit: Some(0.0), blocking: vec![blocker] }
        }
        IntervalSide::Limit { limits, blocking } => RangeSide {
            limit: multiple(&growths, &limits),
            blocking: blocking.iter().map(|c| Blocker::of(solid, c)).collect(),
        },
    };
    let normal = faces.first().map_or(DVec3::ZERO, |&(f, _)| solid.plane(f).unit_normal());
    let faces = faces.iter().map(|&(f, rate)| (f.index() as u32, rate)).collect();
    Ok(FaceRange { faces, normal, sides: sides.map(told) })
}

/// What multiple of `growths` the limits are, rounded towards zero.
fn multiple(growths: &[(FaceId, Rational)], limits: &[(FaceId, Rational)]) -> Option<f64> {
    let (face, limit) = limits.first()?;
    let all = growths.iter().filter(|(f, _)| f == face).map(|(_, t)| t.clone());
    let near = modeller::to_f64(&(limit / all.reduce(|a, b| a + b)?));
    // Conversions to another unit and back round as well.
    Some(near * (1.0 - 8.0 * f64::EPSILON))
}

fn model_face(solid: &Solid, f: FaceId) -> ModelFace {
    let topology = solid.topology();
    let plane = solid.plane(f);
    let loops = topology.loops(f);
    ModelFace {
        face: f.index() as u32,
        normal: plane.unit_normal(),
        distance: modeller::to_f64(plane.offset()) / plane.length(),
        sides: topology.sides(f).count(),
        interior_loops: loops.interior.len(),
        corner: solid.point(topology.origin(loops.exterior)).rounded(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_undo_takes_back_the_last_operator_that_is_left() {
        let shift = Edit::Shift { faces: vec![(FaceName::Id(0), 1.0)], events: EventPolicy::Refuse };
        let list = [shift.clone(), shift.clone(), Edit::Undo, shift, Edit::Undo, Edit::Undo, Edit::Undo];
        assert_eq!(are_undone(&list), [true, true, false, true, false, false, false]);
    }
}
