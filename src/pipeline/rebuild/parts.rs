//! Which parts of a mesh must be rebuilt, and which keep their bits.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::{Aabb, DVec3, are_collinear};
use crate::mesh::{Components, EdgeGroups, UnionFind, edge_of, singular_vertices, triangle_of, twins};
use crate::repair::Draft;
use crate::spatial::{self, Bvh, Search};

/// Room around a part that is rebuilt, as a share of the longest side of all that is: more than the cells by which a
/// surface can grow at the coarsest usual resolution.
const ROOM: f64 = 1.0 / 16.0;

/// Parts beyond which all are rebuilt together: comparing boxes takes the square of it.
const PARTS_MAX: usize = 4096;

/// Contacts to look at.
const CONTACTS: usize = 1 << 20;

/// A mesh in two.
pub(super) struct SplitMesh {
    /// Sound parts, away from the others.
    pub(super) kept: Draft,
    /// The rest.
    pub(super) broken: Draft,
}

/// Takes the parts apart that can keep their bits: closed, oriented, embedded, and with a box that none of a rebuilt part
/// comes near, so that neither can contain or meet the other. `None` when there is no such part, or no other. The
/// draft must be welded.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn split(draft: &Draft, budget: &Budget) -> Result<Option<SplitMesh>, Stopped> {
    let parts = parts(draft, budget)?;
    if parts.count < 2 || parts.count as usize > PARTS_MAX {
        return Ok(None);
    }
    let mut is_broken = broken_parts(draft, &parts, budget)?;
    let mut boxes = vec![Aabb::EMPTY; parts.count as usize];
    for (t, &part) in parts.of.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        boxes[part as usize] = boxes[part as usize].union(Aabb::of(draft.corners(t)));
    }
    join_near(&boxes, &mut is_broken, budget)?;
    let kept_count = is_broken.iter().filter(|&&is_broken| !is_broken).count();
    if kept_count == 0 || kept_count == is_broken.len() {
        return Ok(None);
    }
    let side = |broken: bool| {
        let marks: Vec<bool> = parts.of.iter().map(|&p| is_broken[p as usize] == broken).collect();
        let mut side = draft.clone();
        side.retain_triangles(&marks);
        side.drop_unused_vertices();
        side
    };
    Ok(Some(SplitMesh { kept: side(false), broken: side(true) }))
}

/// Triangles connected by vertices.
fn parts(draft: &Draft, budget: &Budget) -> Result<Components, Stopped> {
    let mut sets = UnionFind::new(draft.positions.len());
    for block in draft.triangles.chunks(CHECK_EVERY) {
        budget.check()?;
        for &[a, b, c] in block {
            sets.unite(a, b);
            sets.unite(b, c);
        }
    }
    let vertices = sets.into_components();
    let of = draft.triangles.iter().map(|t| vertices.of[t[0] as usize]).collect();
    Ok(Components { of, count: vertices.count })
}

/// Parts with an edge, a vertex, a triangle or a contact that no valid solid has.
fn broken_parts(draft: &Draft, parts: &Components, budget: &Budget) -> Result<Vec<bool>, Stopped> {
    let mut is_broken = vec![false; parts.count as usize];
    let triangles = &draft.triangles;
    let mut sound = Vec::with_capacity(triangles.len());
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        if t % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let [p, q, r] = draft.corners(t);
        if a == b || b == c || c == a || are_collinear(p, q, r) {
            is_broken[parts.of[t] as usize] = true;
        } else {
            sound.push(t as u32);
        }
    }
    let groups = EdgeGroups::build(triangles, draft.positions.len(), budget)?;
    for (e, group) in groups.iter().enumerate() {
        if e % CHECK_EVERY == 0 {
            budget.check()?;
        }
        let is_sound = matches!(*group, [g, h] if edge_of(triangles, g)[0] != edge_of(triangles, h)[0]);
        is_broken[parts.of[triangle_of(group[0]) as usize] as usize] |= !is_sound;
    }
    if sound.len() == triangles.len() {
        let twins = twins(&groups, triangles.len(), budget)?;
        let singular = singular_vertices(triangles, draft.positions.len(), &twins, budget)?;
        let mut is_singular = vec![false; draft.positions.len()];
        singular.into_iter().for_each(|v| is_singular[v as usize] = true);
        for (t, corners) in triangles.iter().enumerate() {
            is_broken[parts.of[t] as usize] |= corners.iter().any(|&v| is_singular[v as usize]);
        }
    }
    let bvh = Bvh::build(&draft.positions, triangles, Some(&sound), budget)?;
    let contacts = spatial::self_contacts(
        &draft.positions,
        triangles,
        &bvh,
        None,
        Search::All { keep: CONTACTS },
        budget,
    )?;
    for contact in &contacts.list {
        is_broken[parts.of[contact.a as usize] as usize] = true;
        is_broken[parts.of[contact.b as usize] as usize] = true;
    }
    if contacts.count > contacts.list.len() as u64 {
        is_broken.fill(true);
    }
    Ok(is_broken)
}

/// Parts whose box comes near that of a broken one are rebuilt with it, until none does.
fn join_near(boxes: &[Aabb], is_broken: &mut [bool], budget: &Budget) -> Result<(), Stopped> {
    loop {
        let broken =
            || boxes.iter().zip(is_broken.iter()).filter(|&(_, &is_broken)| is_broken).map(|(b, _)| *b);
        let all = broken().fold(Aabb::EMPTY, Aabb::union);
        if all.is_empty() {
            return Ok(());
        }
        let room = DVec3::splat((all.max - all.min).max_element() * ROOM);
        let mut joined = Vec::new();
        for (part, bounds) in boxes.iter().enumerate().filter(|&(part, _)| !is_broken[part]) {
            budget.spend(boxes.len() as u64 / 64)?;
            let is_near =
                |b: Aabb| (b.min - room).cmple(bounds.max).all() && (b.max + room).cmpge(bounds.min).all();
            if broken().any(is_near) {
                joined.push(part);
            }
        }
        if joined.is_empty() {
            return Ok(());
        }
        joined.into_iter().for_each(|part| is_broken[part] = true);
    }
}
