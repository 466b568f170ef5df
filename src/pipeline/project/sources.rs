//! What the triangles of a new mesh take over of the faces of the old one: its colours, paint and the like.

use crate::budget::{Budget, CHECK_EVERY, Charge, Stopped};
use crate::formats::threemf::{Between, Body, FaceSource, NO_NUMBER};
use crate::geom::{DVec3, closest_point_on_triangle, shares_of_corners};
use crate::mesh::{Soup, Texture};
use crate::repair::NEW;
use crate::spatial::NearestSearch;

/// A corner of a triangle is looked up so far from it towards the middle of the triangle, as a share of the way: where seams meet
/// the corner, what is on the side of the triangle is found.
const INWARD: f64 = 1.0 / 64.0;

/// How far a corner may be from the face of which its triangle is a part, as a share of that face's longest side. Repairs
/// move corners by far less.
const GAP_MAX: f64 = 1.0 / 64.0;

/// What became of the attributes of faces, in triangles of the result.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AttributeCounts {
    /// They are faces of the file and keep all.
    pub kept: u64,
    /// They are parts of such faces, were turned around or moved, and have what the faces have at their places.
    pub from_face: u64,
    /// They are new, and take what is on the nearest face of the file.
    pub from_nearest: u64,
    /// They miss paint that divides the face behind them.
    pub lost: u64,
    /// Share of the area of the result that keeps all, from 0 to 1.
    pub kept_area_share: f64,
    /// Share of the area of the result that misses paint, from 0 to 1.
    pub lost_area_share: f64,
}

/// A new mesh of a body.
pub(super) struct NewMesh<'m> {
    pub(super) soup: &'m Soup,
    /// The triangle of the body behind each of its triangles.
    pub(super) origins: &'m [u32],
    /// Where its triangles are in the picture of the face behind them, as far as that is known.
    pub(super) texture: &'m Texture,
}

/// What is taken over.
pub(super) struct TakenOver<'b> {
    /// For each triangle.
    pub(super) sources: Vec<FaceSource>,
    /// What is between corners of faces.
    pub(super) between: Vec<Between>,
    /// `None` where the file says nothing of the faces of the body.
    pub(super) counts: Option<AttributeCounts>,
    /// For the memory of `sources` and `between`.
    pub(super) charges: Vec<Charge<'b>>,
}

/// What each triangle of `new`, a result of `body`, takes over.
///
/// # Errors
/// When the budget stops the run.
pub(super) fn taken_over<'b>(
    body: &Body,
    new: &NewMesh<'_>,
    budget: &'b Budget,
) -> Result<TakenOver<'b>, Stopped> {
    let attributes = &body.attributes;
    let count = new.soup.triangles.len();
    let mut charges = vec![budget.charge((count * size_of::<FaceSource>()) as u64)?];
    if attributes.properties.is_empty() && attributes.others.is_empty() {
        return Ok(TakenOver {
            sources: vec![FaceSource::Nothing; count],
            between: Vec::new(),
            counts: None,
            charges,
        });
    }
    let mut look = LookUp { body, new, nearest: None, between: Vec::new(), budget };
    let mut sources = Vec::with_capacity(count);
    let mut counts = AttributeCounts::default();
    let (mut area, mut kept_area, mut lost_area) = (0.0, 0.0, 0.0);
    let mut charged = 0;
    for t in 0..count {
        if t % CHECK_EVERY == 0 {
            // Each may add one.
            let room = count.min(look.between.len() + CHECK_EVERY) * size_of::<Between>();
            if room > charged {
                charges.push(budget.charge((room - charged) as u64)?);
                charged = room;
            }
        }
        let size = crate::geom::triangle_area(new.soup.corners(t as u32));
        area += size;
        let (source, fate) = look.source(t)?;
        match fate {
            AttributeFate::Kept => {
                counts.kept += 1;
                kept_area += size;
            }
            AttributeFate::FromFace => counts.from_face += 1,
            AttributeFate::FromNearest => counts.from_nearest += 1,
            AttributeFate::Lost => {
                counts.lost += 1;
                lost_area += size;
            }
            AttributeFate::Nothing => {}
        }
        sources.push(source);
    }
    let share = |part: f64, of_nothing: f64| if area > 0.0 { part / area } else { of_nothing };
    counts.kept_area_share = share(kept_area, 1.0);
    counts.lost_area_share = share(lost_area, 0.0);
    Ok(TakenOver { sources, between: look.between, counts: Some(counts), charges })
}

/// What becomes of the attributes of a triangle.
enum AttributeFate {
    Kept,
    FromFace,
    FromNearest,
    Lost,
    Nothing,
}

struct LookUp<'l> {
    body: &'l Body,
    new: &'l NewMesh<'l>,
    nearest: Option<NearestSearch<'l>>,
    between: Vec<Between>,
    budget: &'l Budget,
}

impl LookUp<'_> {
    fn source(&mut self, t: usize) -> Result<(FaceSource, AttributeFate), Stopped> {
        let (body, new) = (self.body, self.new);
        let corners = new.soup.corners(t as u32);
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        let origin = new.origins.get(t).copied().filter(|&origin| origin != NEW);
        let behind = match origin {
            Some(origin) => Some(origin),
            None => self.find_nearest(middle)?,
        };
        let Some(behind) = behind else { return Ok((FaceSource::Nothing, AttributeFate::Nothing)) };
        let face = body.soup.face_of(behind);
        let was = body.soup.corners(behind);
        let is_divided = has_divided_paint(body, face);
        if let Some(order) = origin.is_some().then(|| whole(was, corners)).flatten() {
            let keeps_all = is_turned(order) || !is_divided;
            let fate = if keeps_all { AttributeFate::Kept } else { AttributeFate::Lost };
            return Ok((FaceSource::Whole { face, corners: order }, fate));
        }
        let fate = match origin {
            _ if is_divided => AttributeFate::Lost,
            Some(_) => AttributeFate::FromFace,
            None => AttributeFate::FromNearest,
        };
        if !body.is_mixed(face) {
            return Ok((FaceSource::Corner { face, corner: nearest_corner(was, middle) }, fate));
        }
        let between = match new.texture.of_triangle(t) {
            // A new triangle has the points of its rim, which may be in another picture than the face nearest to it.
            Some(points)
                if body.is_in_picture(face)
                    && (origin.is_some() || body.has_one_picture())
                    && points.as_flattened().iter().all(|x| x.is_finite()) =>
            {
                Between::Points(points)
            }
            _ => {
                let part_of = origin.map(|_| was);
                let mut at = [(face, [0.0; 3]); 3];
                for (at, corner) in at.iter_mut().zip(corners) {
                    *at = self.place(corner, middle, behind, part_of)?;
                }
                Between::Shares(at)
            }
        };
        self.between.push(between);
        Ok((FaceSource::Between { face, number: self.between.len() as u32 - 1 }, fate))
    }

    /// The face at a corner of a triangle, and the shares of the corners of this face there. `behind` is the triangle of the
    /// body behind the triangle, which may be a part of the one with the corners `part_of`.
    fn place(
        &mut self,
        corner: DVec3,
        middle: DVec3,
        behind: u32,
        part_of: Option<[DVec3; 3]>,
    ) -> Result<(u32, [f64; 3]), Stopped> {
        let old = &self.body.soup;
        let face = old.face_of(behind);
        if let Some(was) = part_of
            && closest_point_on_triangle(corner, was).distance(corner) <= GAP_MAX * longest_side(was)
        {
            return Ok((face, shares_at(corner, was)));
        }
        let found = self.find_nearest(corner.lerp(middle, INWARD))?.unwrap_or(behind);
        let found_face = old.face_of(found);
        match self.body.are_of_one_group(found_face, face) {
            true => Ok((found_face, shares_at(corner, old.corners(found)))),
            false => Ok((face, shares_at(corner, old.corners(behind)))),
        }
    }

    fn find_nearest(&mut self, p: DVec3) -> Result<Option<u32>, Stopped> {
        if self.nearest.is_none() {
            let old = &self.body.soup;
            self.nearest = Some(NearestSearch::build(&old.positions, &old.triangles, self.budget)?);
        }
        let found = match &self.nearest {
            Some(search) => search.find(p, None, self.budget)?,
            None => None,
        };
        Ok(found.map(|found| found.triangle))
    }
}

/// The corner of the old triangle at each corner of the new one, where both have the same.
fn whole(was: [DVec3; 3], corners: [DVec3; 3]) -> Option<[u8; 3]> {
    const ORDERS: [[u8; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    ORDERS.into_iter().find(|order| (0..3).all(|k| corners[k] == was[usize::from(order[k])]))
}

/// True when the corners only begin at another place, and go around the same way.
fn is_turned(order: [u8; 3]) -> bool {
    matches!(order, [0, 1, 2] | [1, 2, 0] | [2, 0, 1])
}

/// True when a face has paint that is stated by its corners.
fn has_divided_paint(body: &Body, face: u32) -> bool {
    let attributes = &body.attributes;
    let number = attributes.others.get(face as usize).copied().filter(|&number| number != NO_NUMBER);
    number.is_some_and(|number| attributes.is_divided(number))
}

/// The shares of the corners of a triangle in its place that is nearest to `p`.
fn shares_at(p: DVec3, corners: [DVec3; 3]) -> [f64; 3] {
    shares_of_corners(closest_point_on_triangle(p, corners), corners).unwrap_or_else(|| {
        let nearest = nearest_corner(corners, p);
        [0, 1, 2].map(|k| if k == nearest { 1.0 } else { 0.0 })
    })
}

fn longest_side([a, b, c]: [DVec3; 3]) -> f64 {
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

fn nearest_corner(was: [DVec3; 3], middle: DVec3) -> u8 {
    let distance = |k: u8| was[usize::from(k)].distance_squared(middle);
    [0, 1, 2].into_iter().min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
