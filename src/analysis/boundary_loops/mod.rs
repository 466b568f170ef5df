//! Boundary loops: chains of edges with one triangle, the rims of holes and of open sheets, and what each most likely is.

mod classify;
mod gaps;
mod parts;
mod rims;
mod shape;

pub use self::classify::{HoleClass, HoleGuess};
use self::rims::BoundaryEdges;
use self::shape::LoopShape;
use super::best_plane::BestPlane;
use super::{Context, DefectCode, Finding, Witness};
use crate::budget::{CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::triangle_of;

/// How many loops there are of each class.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HoleCounts {
    /// Two rims that nearly coincide.
    pub cracks: u64,
    /// One face is missing.
    pub missing_faces: u64,
    /// Flat holes of more edges.
    pub planar_cuts: u64,
    /// Holes that are not flat.
    pub missing_regions: u64,
    /// Borders of sheets, mouths of vessels and ends of pipes.
    pub intended_openings: u64,
    /// Chains that do not close, because they meet an edge of three triangles or more.
    pub open_chains: u64,
}

/// All loops of a mesh, in the order in which they are told.
#[derive(Debug, Default)]
pub(super) struct BoundaryLoops {
    rims: BoundaryEdges,
    /// The ends through which each loop enters its edges, one loop after the other.
    ends: Vec<u32>,
    /// Where each loop begins in `ends`; one more entry than loops, or none at all.
    starts: Vec<u32>,
    /// What is known of each; `None`: the chain does not close.
    known: Vec<Option<(LoopShape, HoleGuess)>>,
}

/// Bytes for each boundary edge: ends, partners and what comes and goes; and for each loop.
const BYTES_PER_EDGE: u64 = 80;

/// Finds and classifies the loops.
pub(super) fn search(cx: &Context<'_>) -> Result<BoundaryLoops, Stopped> {
    let count = cx.mesh.irregular_where(|triangles| triangles == 1).len();
    let _charge = cx.budget.charge(count as u64 * BYTES_PER_EDGE)?;
    let rims = BoundaryEdges::of(&cx.mesh, cx.budget)?;
    let mut loops = BoundaryLoops { rims, starts: vec![0], ..BoundaryLoops::default() };
    let mut is_seen = vec![false; loops.rims.half_edges.len()];
    for i in 0..is_seen.len() {
        if i % CHECK_EVERY == 0 {
            cx.budget.check()?;
        }
        if is_seen[i] {
            continue;
        }
        let (chain, is_closed) = loops.rims.trace(i as u32, &mut is_seen, cx.budget)?;
        loops.ends.extend(chain);
        loops.starts.push(loops.ends.len() as u32);
        let shape = is_closed.then(|| loops.measure(loops.known.len(), cx));
        // The class needs the measures of all.
        let unknown = HoleGuess { class: HoleClass::MissingRegion, confidence: 0.0 };
        loops.known.push(shape.map(|shape| (shape, unknown)));
    }
    parts::classify_all(&mut loops, cx)?;
    Ok(loops)
}

pub(super) fn find(cx: &Context<'_>) -> Result<Vec<Finding>, Stopped> {
    let loops = &cx.loops;
    let witnesses = (0..loops.len().min(cx.loop_samples)).map(|number| loops.witness(number, cx)).collect();
    Ok(Finding::with(DefectCode::BoundaryLoop, loops.len() as u64, witnesses))
}

impl BoundaryLoops {
    fn len(&self) -> usize {
        self.known.len()
    }

    /// The ends through which loop `number` enters its edges.
    fn chain(&self, number: usize) -> &[u32] {
        &self.ends[self.starts[number] as usize..self.starts[number + 1] as usize]
    }

    /// The measures of loop `number`; `None`: it does not close.
    fn shape(&self, number: usize) -> Option<&LoopShape> {
        self.known[number].as_ref().map(|(shape, _)| shape)
    }

    /// The loop of each boundary edge.
    fn loop_of_edges(&self) -> Vec<u32> {
        let mut loop_of = vec![u32::MAX; self.rims.half_edges.len()];
        for number in 0..self.len() {
            for &end in self.chain(number) {
                loop_of[(end / 2) as usize] = number as u32;
            }
        }
        loop_of
    }

    /// The part that loop `number` belongs to.
    fn part(&self, number: usize, cx: &Context<'_>) -> u32 {
        cx.mesh.components.of[triangle_of(self.rims.half_edge(self.chain(number)[0])) as usize]
    }

    fn points(&self, number: usize, cx: &Context<'_>) -> Vec<DVec3> {
        let place = |&end: &u32| cx.mesh.position(self.rims.vertex(end, &cx.mesh));
        self.chain(number).iter().map(place).collect()
    }

    fn measure(&self, number: usize, cx: &Context<'_>) -> LoopShape {
        let apex = |&end: &u32| cx.mesh.apex(self.rims.half_edge(end));
        let apexes: Vec<DVec3> = self.chain(number).iter().map(apex).collect();
        LoopShape::of(&self.points(number, cx), &apexes)
    }

    /// The half-edges of the soup in loops, each with the number of its loop, ascending.
    pub(super) fn edges(&self, cx: &Context<'_>) -> Vec<[u32; 2]> {
        let of_loop = |number: usize| self.chain(number).iter().map(move |&end| [end, number as u32]);
        let of_soup = |[end, number]: [u32; 2]| {
            let h = self.rims.half_edge(end);
            [3 * cx.mesh.source(triangle_of(h)) + h % 3, number]
        };
        let mut edges: Vec<[u32; 2]> = (0..self.len()).flat_map(of_loop).map(of_soup).collect();
        edges.sort_unstable();
        edges
    }

    /// How many there are of each class.
    pub(super) fn counts(&self) -> HoleCounts {
        let mut counts = HoleCounts::default();
        for known in &self.known {
            let count = match known.map(|(_, guess)| guess.class) {
                Some(HoleClass::Crack) => &mut counts.cracks,
                Some(HoleClass::MissingFace) => &mut counts.missing_faces,
                Some(HoleClass::PlanarCut) => &mut counts.planar_cuts,
                Some(HoleClass::MissingRegion) => &mut counts.missing_regions,
                Some(HoleClass::IntendedOpening) => &mut counts.intended_openings,
                None => &mut counts.open_chains,
            };
            *count += 1;
        }
        counts
    }

    fn witness(&self, number: usize, cx: &Context<'_>) -> Witness {
        let (mesh, chain, known) = (&cx.mesh, self.chain(number), self.known[number]);
        let faces = chain.iter().map(|&end| mesh.face_of(triangle_of(self.rims.half_edge(end))));
        let mut vertices: Vec<u32> = chain.iter().map(|&end| self.rims.vertex(end, mesh)).collect();
        if known.is_none() {
            vertices.extend(chain.last().map(|&end| self.rims.vertex(end ^ 1, mesh)));
        }
        let mut witness = mesh.names().witness(faces, vertices.iter().copied(), mesh.position(vertices[0]));
        witness.figures = match known {
            Some((shape, guess)) => figures(&shape, guess),
            None => figures_of_chain(&vertices.iter().map(|&v| mesh.position(v)).collect::<Vec<_>>()),
        };
        witness.hole = known.map(|(_, guess)| guess);
        let h = self.rims.half_edge(chain[0]);
        witness.anchor = Some(3 * mesh.source(triangle_of(h)) + h % 3);
        witness
    }
}

fn figures(shape: &LoopShape, guess: HoleGuess) -> Vec<(&'static str, f64)> {
    vec![
        ("edges", f64::from(shape.edges)),
        ("length", shape.length),
        ("distance_from_plane", shape.deviation),
        ("area", shape.area),
        ("diameter", shape.diameter),
        ("width", shape.width),
        ("confidence", guess.confidence),
        ("is_closed", 1.0),
    ]
}

fn figures_of_chain(points: &[DVec3]) -> Vec<(&'static str, f64)> {
    let length = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    vec![
        ("edges", points.len() as f64 - 1.0),
        ("length", length),
        ("distance_from_plane", BestPlane::of(points.iter().copied()).deviation),
        ("is_closed", 0.0),
    ]
}

#[cfg(test)]
mod tests;
