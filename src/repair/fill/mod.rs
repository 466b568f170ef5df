//! Closes holes: boundary loops, alone or several with one patch between them.
//!
//! Loops that meet in a vertex are joined where that is needed, see `pinched`. Each hole is offered patches in one way after
//! another, see `class`. A patch stays only if it adds no defect and meets
//! nothing (see `accept`); a hole with no such patch stays open, and the report says why each was not taken. A single
//! triangle or a flat sheet cannot be closed, because every patch would be its double or lie on it. No vertex of the mesh
//! moves; new vertices are born on the print lattice. `docs/holes.md` describes the methods.

mod accept;
mod blend;
mod bridge;
mod caps;
mod chords;
mod class;
mod coarsen;
mod creased;
mod ears;
mod facing;
mod fair;
mod large;
mod make;
mod minimal;
mod notches;
mod options;
mod patch;
mod pinched;
mod planar;
mod rbf;
mod refine;
mod regions;
mod report;
mod shape;
mod sheets;
mod span;
mod sparse;
mod surface;
mod turn;

use self::accept::PatchProposal;
use self::creased::HoleDivision;
use self::make::{FairedPatch, HoleInput, MadePatch, PatchInput, Way, make};
pub use self::options::{Extract, FillOptions, HoleChoice, Method};
use self::pinched::Walk;
use self::regions::{Region, regions};
pub use self::report::{FillReport, HoleReport, HoleRim, Rejected, Rejection};
pub use self::span::{span_odd_edges, span_rims};
use self::surface::FillSurface;
pub use self::turn::turn_to_bridge;
use super::{Changes, Draft, Effects, FIRST_BLEND, NEW, Selection};
use crate::budget::{Budget, Stopped};
use crate::geom::{DVec3, triangle_area};
use crate::mesh::{Boundary, Soup, edge_of};
use crate::par;
use crate::spatial::coincident_f64;

/// Closes the holes that can be closed soundly by triangles between vertices of their rims, as a repair does. Looks at
/// places, so vertices need not be welded; triangles must not be degenerate.
///
/// # Errors
/// When the budget stops the run.
pub fn fill_holes(draft: &mut Draft, budget: &Budget) -> Result<Changes, Stopped> {
    let options = FillOptions::plain(Selection::default());
    Ok(fill_loops(draft, None, &options, budget)?.changes)
}

/// As [`fill_holes`], but only holes that the caller chose in `soup`, from which `draft` was made.
///
/// # Errors
/// When the budget stops the run.
pub fn fill_chosen_holes(
    draft: &mut Draft,
    soup: &Soup,
    chosen: &Selection,
    budget: &Budget,
) -> Result<Changes, Stopped> {
    Ok(fill_loops(draft, Some(soup), &FillOptions::plain(chosen.clone()), budget)?.changes)
}

/// Closes holes as `options` say. `draft` was made from `soup`, whose half-edges name the holes.
///
/// # Errors
/// When the budget stops the run.
pub fn fill(
    draft: &mut Draft,
    soup: &Soup,
    options: &FillOptions,
    budget: &Budget,
) -> Result<FillReport, Stopped> {
    fill_loops(draft, Some(soup), options, budget)
}

/// A hole, and the ways that it has not been offered yet.
struct PendingHole {
    region: Region,
    /// How creases divide it; `None` when they do not or it is not to be seen.
    division: Option<HoleDivision>,
    band_rings: u32,
    /// In the reverse of their order.
    ways: Vec<Way>,
    /// The smooth patch that a field was to move.
    faired: Option<FairedPatch>,
    report: HoleReport,
}

/// Holes of which patches are made at the same time.
const HOLES_AT_A_TIME: usize = 8;

fn fill_loops(
    draft: &mut Draft,
    soup: Option<&Soup>,
    options: &FillOptions,
    budget: &Budget,
) -> Result<FillReport, Stopped> {
    let mut surface = surface_of(draft, budget)?;
    let boundary = Boundary::trace(&surface.triangles, surface.positions.len(), &surface.groups, budget)?;
    let is_chosen = |hole: &[u32]| soup.is_none_or(|soup| options.holes.takes(hole, draft, soup));
    let loops: Vec<_> = boundary.loops.into_iter().filter(|hole| is_chosen(hole)).collect();
    if !loops.is_empty() {
        surface.find_first_edges(budget)?;
        if options.looks_around() {
            surface.find_stars(budget)?;
        }
    }
    let ladder = Ladder { draft, soup, options };
    let outward = |h: u32| surface.outward(h);
    let outward: Option<&dyn Fn(u32) -> DVec3> = if options.bridges { Some(&outward) } else { None };
    let walks = pinched::join(loops, &surface, budget)?;
    let sheets = sheets::of_flat_sheets(&walks, &surface, budget)?;
    let regions = regions(walks, &sheets, |h| surface.point(h), outward, budget)?;
    let start = |_, region| ladder.start(region, Vec::new(), &surface, budget);
    let mut open =
        par::map_items(regions, start).into_iter().collect::<Result<Vec<PendingHole>, Stopped>>()?;
    let has_field = open.iter().any(|hole| hole.ways.contains(&Way::Rbf));
    // The surface grows by patches; what a field is halved by is the mesh as it was.
    let positions = if has_field { surface.positions.clone() } else { Vec::new() };
    let triangles = if has_field { surface.triangles.clone() } else { Vec::new() };
    let mesh = if has_field { Some(rbf::FieldMesh::new(&positions, &triangles, budget)?) } else { None };
    let mut effects = Effects::default();
    let mut done = Vec::new();
    let mut patches: Vec<(MadePatch, u32)> = Vec::new();
    while !open.is_empty() {
        let scene = PatchInput { surface: &surface, mesh: mesh.as_ref(), options };
        let offers = offer(&mut open, &scene, budget)?;
        let proposals: Vec<&PatchProposal> =
            offers.iter().flatten().map(|(_, made)| &made.proposal).collect();
        let bvh = mesh.as_ref().map(rbf::FieldMesh::bvh);
        let mut verdicts = surface.accept(&proposals, bvh, budget)?.into_iter();
        let mut left = Vec::new();
        for (mut hole, offered) in open.into_iter().zip(offers) {
            let Some((way, made)) = offered else {
                ladder.give_up(hole, &surface, &mut left, &mut done, budget)?;
                continue;
            };
            match verdicts.next() {
                Some(Ok(first)) => {
                    effects.bridged_rims |= hole.region.is_bridge;
                    hole.report.take(way.method(), &made, &surface, first);
                    patches.push((made, first));
                    done.push(hole.report);
                }
                verdict => {
                    let refused = verdict.and_then(Result::err);
                    let (reason, at) = refused.unwrap_or((Rejection::NoPatch, None));
                    hole.report.rejected.push(Rejected { method: way.method(), reason, at });
                    left.push(hole);
                }
            }
        }
        open = left;
    }
    done.sort_by_key(|report| report.order);
    let first = draft.triangles.len();
    append(draft, soup, &surface, &patches, budget)?;
    let changes = changes(draft, first, &done, boundary.stray_edges).with(effects);
    Ok(FillReport { changes, holes: done })
}

/// What decides how holes are filled.
struct Ladder<'a> {
    draft: &'a Draft,
    soup: Option<&'a Soup>,
    options: &'a FillOptions,
}

impl Ladder<'_> {
    fn start(
        &self,
        region: Region,
        mut rejected: Vec<Rejected>,
        surface: &FillSurface,
        budget: &Budget,
    ) -> Result<PendingHole, Stopped> {
        let choice = self.soup.and_then(|soup| self.options.choice(region.rim(), self.draft, soup));
        let asked = choice.and_then(|choice| choice.method).unwrap_or(self.options.method);
        let band_rings = choice.and_then(|choice| choice.band_rings).unwrap_or(self.options.band_rings);
        let is_own = choice.is_some_and(|choice| choice.method.is_some() || choice.band_rings.is_some());
        let refines = self.options.refines || is_own;
        let (mut ways, division) = match region.is_on_sheet {
            true => (Vec::new(), None),
            false => class::ways(&region, asked, refines, surface, self.options, budget)?,
        };
        ways.reverse();
        if region.is_on_sheet {
            rejected.push(Rejected::alone(asked, Rejection::FlatSheet));
        }
        let rim = |own: &Vec<u32>| {
            let of_soup = |&h: &u32| self.soup.and_then(|soup| options::soup_half_edge(h, self.draft, soup));
            HoleRim { half_edges: own.iter().filter_map(of_soup).collect(), edges: own.len() as u32 }
        };
        let report = HoleReport {
            order: region.rim()[0],
            rims: region.walks.iter().flat_map(Walk::parts).map(rim).collect(),
            loops: region.walks.iter().map(Walk::loop_count).sum::<usize>() as u64,
            borders: region.walks.len() as u64,
            asked,
            rejected,
            ..HoleReport::default()
        };
        Ok(PendingHole { region, division, band_rings, ways, faired: None, report })
    }

    /// A hole that ran out of ways stays open. If it has several loops, or one that joins several, they are tried alone.
    fn give_up(
        &self,
        hole: PendingHole,
        surface: &FillSurface,
        left: &mut Vec<PendingHole>,
        done: &mut Vec<HoleReport>,
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let PendingHole { region, report, .. } = hole;
        for part in region.parts_alone(|h| surface.point(h)) {
            left.push(self.start(part, report.rejected.clone(), surface, budget)?);
        }
        // What is not tried alone stays open.
        if let [only] = &region.walks[..]
            && only.joined().len() < only.parts().len()
        {
            let rims = report.rims[only.joined().len()..].to_vec();
            done.push(HoleReport { rims, loops: 1, ..report });
        }
        Ok(())
    }
}

/// The next patch for each hole that has one, and the way it was made in.
fn offer(
    open: &mut [PendingHole],
    scene: &PatchInput<'_>,
    budget: &Budget,
) -> Result<Vec<Option<(Way, MadePatch)>>, Stopped> {
    let holes: Vec<&mut PendingHole> = open.iter_mut().collect();
    let chunks: Vec<Vec<&mut PendingHole>> = {
        let mut chunks = Vec::new();
        let mut rest = holes.into_iter().peekable();
        while rest.peek().is_some() {
            chunks.push(rest.by_ref().take(HOLES_AT_A_TIME).collect());
        }
        chunks
    };
    let made = par::map_items(chunks, |_, chunk| {
        chunk.into_iter().map(|hole| hole.next(scene, budget)).collect::<Result<Vec<_>, Stopped>>()
    });
    let mut offers = Vec::with_capacity(open.len());
    for chunk in made {
        offers.extend(chunk?);
    }
    Ok(offers)
}

impl PendingHole {
    fn next(&mut self, scene: &PatchInput<'_>, budget: &Budget) -> Result<Option<(Way, MadePatch)>, Stopped> {
        while let Some(way) = self.ways.pop() {
            let mut hole = HoleInput {
                region: &self.region,
                division: self.division.as_ref(),
                rings: self.band_rings,
                is_auto: self.report.asked == Method::Auto,
                faired: &mut self.faired,
            };
            let mut rejected = Vec::new();
            let made = make(&mut hole, way, scene, &mut rejected, budget)?;
            rejected.extend(made.as_ref().err());
            let alone = |reason| Rejected::alone(way.method(), reason);
            self.report.rejected.extend(rejected.into_iter().map(alone));
            if let Ok(made) = made {
                return Ok(Some((way, made)));
            }
        }
        Ok(None)
    }
}

impl HoleReport {
    fn take(&mut self, method: Method, made: &MadePatch, surface: &FillSurface, first: u32) {
        let PatchProposal { rim, points, triangles, .. } = &made.proposal;
        let point = |v: u32| match rim.get(v as usize) {
            Some(&h) => surface.point(h),
            None => surface.positions[(first + v) as usize - rim.len()],
        };
        self.used = Some(method);
        self.field = made.field;
        self.triangles = triangles.len() as u64;
        self.vertices = points.len() as u64;
        self.area = triangles.iter().map(|t| triangle_area(t.map(point))).sum();
    }
}

fn changes(draft: &Draft, first: usize, holes: &[HoleReport], stray_edges: u64) -> Changes {
    let closed = holes.iter().filter(|hole| hole.used.is_some());
    let filled: u64 = closed.clone().map(|hole| hole.loops).sum();
    let added = (draft.triangles.len() - first) as u64;
    let left = holes.iter().map(|hole| hole.loops).sum::<u64>() - filled;
    let vertices: u64 = closed.map(|hole| hole.vertices).sum();
    let counts = [("holes_filled", filled), ("triangles_added", added), ("holes_left", left)];
    // Only where a method was asked for that makes vertices.
    let counts = counts.into_iter().chain((vertices > 0).then_some(("vertices_added", vertices)));
    let patches = share_of_patches(draft, added as usize);
    Changes { reason: reason(patches, left, stray_edges), ..Changes::counted(counts.collect::<Vec<_>>()) }
}

/// In words, how much of the surface is new. Closing a sheet makes a body of it, which this shows.
fn share_of_patches(draft: &Draft, added: usize) -> Option<String> {
    let rim = draft.triangles.len() - added;
    if added == 0 {
        return None;
    }
    let areas = draft.areas();
    let percent = 100.0 * areas[rim..].iter().sum::<f64>() / areas.iter().sum::<f64>();
    (percent.is_finite()).then(|| format!("patches are {percent:.1} % of the surface"))
}

fn reason(patches: Option<String>, left: u64, stray_edges: u64) -> String {
    let stay = if left == 1 { "hole stays" } else { "holes stay" };
    let left = (left > 0).then(|| format!("{left} {stay} open: no patch meets the rest only at its rim"));
    let stray = (stray_edges > 0).then(|| format!("{stray_edges} boundary edges are in no simple loop"));
    patches.into_iter().chain(left).chain(stray).collect::<Vec<_>>().join("; ")
}

/// The draft with one vertex at each place.
fn surface_of(draft: &Draft, budget: &Budget) -> Result<FillSurface, Stopped> {
    let places = coincident_f64(&draft.positions, budget)?;
    let positions = places.first.iter().map(|&v| draft.positions[v as usize]).collect();
    let triangles = draft.triangles.iter().map(|t| t.map(|v| places.group[v as usize])).collect();
    FillSurface::new(positions, triangles, budget)
}

/// Adds patches, in the order in which they were taken.
fn append(
    draft: &mut Draft,
    soup: Option<&Soup>,
    surface: &FillSurface,
    patches: &[(MadePatch, u32)],
    budget: &Budget,
) -> Result<(), Stopped> {
    for (made, first) in patches {
        let PatchProposal { rim, points, triangles, .. } = &made.proposal;
        let base = draft.positions.len() as u32;
        let corner = |h: u32| edge_of(&draft.triangles, h)[1];
        let corners: Vec<u32> =
            rim.iter().map(|&h| corner(h)).chain((0..).map(|i| base + i).take(points.len())).collect();
        let at: Vec<DVec3> = rim.iter().map(|&h| surface.point(h)).collect();
        for (i, shares) in blend::shares(made, &at, budget)?.iter().enumerate() {
            let blend = soup.and_then(|soup| blend::of_soup(shares, rim, draft, soup));
            let origin = match blend {
                Some(blend) => {
                    draft.blends.vertices.push(blend);
                    FIRST_BLEND + draft.blends.vertices.len() as u32 - 1
                }
                // The corner with the largest share stands for all.
                None => draft.vertex_origin[corners[shares[0].0 as usize] as usize],
            };
            draft.positions.push(surface.positions[*first as usize + i]);
            draft.vertex_origin.push(origin);
        }
        if let Some(soup) = soup {
            let of_soup = rim.iter().filter_map(|&h| blend::soup_corner(h, draft, soup));
            let of_soup: Vec<[u32; 2]> = of_soup.collect();
            draft.blends.rims.extend(of_soup);
        }
        for t in triangles {
            draft.triangles.push(t.map(|v| corners[v as usize]));
            draft.triangle_origin.push(NEW);
        }
    }
    draft.blends.rims.sort_unstable();
    draft.blends.rims.dedup_by_key(|rim| rim[0]);
    Ok(())
}
