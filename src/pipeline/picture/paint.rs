//! Which triangles have which colour, what is marked, and what the colours mean.

use super::Drawn;
use crate::analysis::{DefectCode, Finding, Severity};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::mesh::{EdgeGroups, Soup, Units, edge_of, triangle_of};
use crate::par;
use crate::pipeline::identical::fingerprint;
use crate::render::{Line, Rgb, Scene, Spot, first_at_position};
use std::cmp::Ordering;

/// Which mesh of a run it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MeshRole {
    /// There is no other.
    Only,
    /// As uploaded.
    Before,
    /// As returned.
    After,
}

/// Colours and marks of one mesh.
#[derive(Debug)]
pub(super) struct Painted {
    pub(super) side: MeshRole,
    paints: Vec<u8>,
    lines: Vec<Line>,
    spots: Vec<Spot>,
    /// Colours that occur, and what they mean.
    pub(super) legend: Vec<(Rgb, String)>,
    /// The size of the mesh, in words.
    pub(super) size: String,
}

const BODY: Rgb = [185, 194, 203];
const NEW: Rgb = [47, 176, 140];
/// Number of the colour of new triangles.
const NEW_PAINT: u8 = 1;
/// Number of the colour of the first class of defects.
const FIRST_CLASS: u8 = 2;
/// Edges of rims up to which they are drawn; more of them would hide the mesh.
const RIM_EDGES_MAX: usize = 20_000;

/// Defects that look alike: their name for people, and their colour.
const CLASSES: [(&str, Rgb); 7] = [
    ("open rims", [242, 115, 28]),
    ("open parts", [242, 165, 28]),
    ("non-manifold", [168, 58, 208]),
    ("wrong side out or nested", [47, 127, 224]),
    ("crossing or touching", [224, 53, 127]),
    ("degenerate faces", [12, 154, 176]),
    ("other defects", [138, 109, 28]),
];
const RIMS: usize = 0;

/// The colours, by their numbers.
const PALETTE: [Rgb; 9] = [
    BODY,
    NEW,
    CLASSES[0].1,
    CLASSES[1].1,
    CLASSES[2].1,
    CLASSES[3].1,
    CLASSES[4].1,
    CLASSES[5].1,
    CLASSES[6].1,
];

/// The class of a defect, as an index of [`CLASSES`].
fn class_of(code: DefectCode) -> usize {
    match code {
        DefectCode::BoundaryLoop => RIMS,
        DefectCode::OpenSheet | DefectCode::IsolatedFace => 1,
        DefectCode::NonManifoldEdge | DefectCode::NonManifoldVertex | DefectCode::NonOrientable => 2,
        DefectCode::OrientationConflict | DefectCode::InvertedShell | DefectCode::MisnestedShell => 3,
        DefectCode::SelfIntersection | DefectCode::Overlap | DefectCode::Touch | DefectCode::Near => 4,
        DefectCode::Needle
        | DefectCode::Cap
        | DefectCode::FoldedEdge
        | DefectCode::CollinearFace
        | DefectCode::CoincidentCorners => 5,
        _ => 6,
    }
}

/// What a colour of triangles, lines and spots stands for.
pub(super) fn meaning(color: Rgb) -> &'static str {
    let class = CLASSES.iter().find(|(_, of_class)| *of_class == color);
    class.map_or(if color == NEW { "new" } else { "surface" }, |(name, _)| name)
}

/// True of a defect that a whole part has.
fn is_of_part(code: DefectCode) -> bool {
    matches!(
        code,
        DefectCode::InvertedShell
            | DefectCode::MisnestedShell
            | DefectCode::ZeroVolumeShell
            | DefectCode::DoubleSkin
            | DefectCode::OpenSheet
            | DefectCode::NoiseShell
            | DefectCode::NonOrientable
    )
}

impl Painted {
    /// The mesh as uploaded, with its defects if they are to be shown; notes, which are no defects, are left out.
    pub(super) fn before(
        drawn: &Drawn<'_>,
        shows_defects: bool,
        has_other: bool,
        units: Units,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let side = if has_other { MeshRole::Before } else { MeshRole::Only };
        let mut painted = Self::plain(drawn.soup, side, units);
        let is_defect = |finding: &&Finding| finding.severity != Severity::Info;
        let findings: Vec<&Finding> =
            drawn.findings.iter().filter(|_| shows_defects).filter(is_defect).collect();
        if findings.is_empty() {
            return Ok(painted);
        }
        painted.paint_parts(drawn, &findings, budget)?;
        painted.paint_faces(drawn.soup, &findings);
        painted.legend = CLASSES
            .iter()
            .enumerate()
            .filter_map(|(class, (name, color))| {
                let of_class = findings.iter().filter(|finding| class_of(finding.code) == class);
                let count: u64 = of_class.map(|finding| finding.count).sum();
                (count > 0).then(|| (*color, format!("{count} {name}")))
            })
            .collect();
        Ok(painted)
    }

    /// The mesh as returned, with the triangles that `before` has not.
    pub(super) fn after(before: &Soup, after: &Soup, units: Units, budget: &Budget) -> Result<Self, Stopped> {
        let mut painted = Self::plain(after, MeshRole::After, units);
        let _memory = budget.charge((before.triangles.len() as u64 + after.triangles.len() as u64) * 16)?;
        let mut known = fingerprints(before, budget)?;
        par::sort_unstable(&mut known);
        let of_after = fingerprints(after, budget)?;
        let paints: Vec<u8> =
            of_after.iter().map(|print| u8::from(known.binary_search(print).is_err()) * NEW_PAINT).collect();
        let new = paints.iter().filter(|&&paint| paint == NEW_PAINT).count();
        if new == paints.len() {
            painted.legend = vec![(BODY, format!("all {new} triangles are new"))];
        } else {
            painted.legend = match new {
                0 => vec![(BODY, "no new triangle".to_owned())],
                new => vec![(NEW, format!("{new} new of {} triangles", paints.len()))],
            };
            painted.paints = paints;
        }
        Ok(painted)
    }

    fn plain(soup: &Soup, side: MeshRole, units: Units) -> Self {
        let bounds =
            Scene { positions: &soup.positions, triangles: &soup.triangles, ..Scene::default() }.bounds();
        let size = if bounds.is_empty() {
            String::new()
        } else {
            let size = (bounds.max - bounds.min) * units.millimetres();
            format!("{} mm", size.to_array().map(length).join(" x "))
        };
        Self { side, paints: Vec::new(), lines: Vec::new(), spots: Vec::new(), legend: Vec::new(), size }
    }

    /// What is drawn of `soup`.
    pub(super) fn scene<'s>(&'s self, soup: &'s Soup) -> Scene<'s> {
        Scene {
            positions: &soup.positions,
            triangles: &soup.triangles,
            paints: &self.paints,
            palette: &PALETTE,
            lines: &self.lines,
            spots: &self.spots,
        }
    }

    /// Draws rims, and paints parts that are defects as a whole.
    fn paint_parts(
        &mut self,
        drawn: &Drawn<'_>,
        findings: &[&Finding],
        budget: &Budget,
    ) -> Result<(), Stopped> {
        let soup = drawn.soup;
        self.paints = vec![0; soup.triangles.len()];
        let has_rims = findings.iter().any(|finding| class_of(finding.code) == RIMS);
        let parts: Vec<(u8, u32)> = findings
            .iter()
            .filter(|finding| is_of_part(finding.code))
            .flat_map(|finding| {
                let paint = FIRST_CLASS + class_of(finding.code) as u8;
                let anchors = finding.witnesses.iter().filter_map(|witness| witness.anchor);
                anchors.map(move |anchor| (paint, triangle_of(anchor)))
            })
            .collect();
        if !has_rims && parts.is_empty() {
            return Ok(());
        }
        let vertices = vertices_of_meshes(drawn, budget)?;
        let welded: Vec<[u32; 3]> =
            soup.triangles.iter().map(|corners| corners.map(|v| vertices[v as usize])).collect();
        let groups = EdgeGroups::build(&welded, soup.positions.len(), budget)?;
        if has_rims {
            let rims = groups.iter().filter(|group| group.len() == 1).map(|group| edge_of(&welded, group[0]));
            let rims: Vec<[u32; 2]> = rims.filter(|[a, b]| a != b).take(RIM_EDGES_MAX + 1).collect();
            if rims.len() <= RIM_EDGES_MAX {
                let at = |v: u32| soup.positions[v as usize];
                let line = |ends: &[u32; 2]| Line { ends: ends.map(at), color: CLASSES[RIMS].1 };
                self.lines = rims.iter().map(line).collect();
            }
        }
        if !parts.is_empty() {
            let components = groups.components(budget)?;
            let mut paint_of = vec![0_u8; components.count as usize];
            for (paint, triangle) in parts {
                if let Some(&component) = components.of.get(triangle as usize) {
                    paint_of[component as usize] = paint;
                }
            }
            for (paint, &component) in self.paints.iter_mut().zip(&components.of) {
                *paint = paint_of[component as usize];
            }
        }
        Ok(())
    }

    /// Paints the faces that show a defect, and marks its place.
    fn paint_faces(&mut self, soup: &Soup, findings: &[&Finding]) {
        let mut of_face = vec![0_u8; soup.face_count as usize];
        for finding in findings {
            let class = class_of(finding.code);
            // A rim is a line, and the first faces of a part say no more than the whole part.
            if class == RIMS || is_of_part(finding.code) {
                continue;
            }
            for witness in &finding.witnesses {
                for face in &witness.faces {
                    if let Some(paint) = of_face.get_mut(face.index as usize) {
                        *paint = FIRST_CLASS + class as u8;
                    }
                }
                self.spots.extend(witness.position.map(|at| Spot { at, color: CLASSES[class].1 }));
            }
        }
        for t in 0..soup.triangles.len() {
            match of_face.get(soup.face_of(t as u32) as usize) {
                Some(&paint) if paint != 0 => self.paints[t] = paint,
                _ => {}
            }
        }
    }
}

/// For each vertex the first one of its mesh at the same position: meshes that touch stay apart, as they were judged.
fn vertices_of_meshes(drawn: &Drawn<'_>, budget: &Budget) -> Result<Vec<u32>, Stopped> {
    let positions = &drawn.soup.positions;
    let starts = if drawn.meshes.is_empty() { &[0][..] } else { drawn.meshes };
    let ends = starts.iter().skip(1).copied().chain([positions.len() as u32]);
    let mut vertices = Vec::with_capacity(positions.len());
    for (&start, end) in starts.iter().zip(ends) {
        let of_mesh = first_at_position(&positions[start as usize..end as usize], budget)?;
        vertices.extend(of_mesh.into_iter().map(|v| start + v));
    }
    Ok(vertices)
}

/// A number for each triangle that is the same for the same coordinates as float32, from whichever corner it starts and whichever
/// way it runs: one that was turned is not new.
fn fingerprints(soup: &Soup, budget: &Budget) -> Result<Vec<u128>, Stopped> {
    let print_of = |t: u32| {
        let mut corners = soup.corners(t).map(|p: DVec3| p.as_vec3().as_dvec3());
        corners.sort_unstable_by(|p, q| p.to_array().partial_cmp(&q.to_array()).unwrap_or(Ordering::Equal));
        fingerprint(corners)
    };
    let parts = par::try_map_ranges(soup.triangles.len(), CHECK_EVERY, |range| {
        budget.spend(range.len() as u64 / 4)?;
        Ok(range.map(|t| print_of(t as u32)).collect::<Vec<_>>())
    })?;
    Ok(parts.concat())
}

/// A length with up to four digits.
fn length(value: f64) -> String {
    match value {
        v if v != 0.0 && !(1e-3..1e6).contains(&v) => format!("{v:.2e}"),
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 1.0 => trimmed(&format!("{v:.2}")),
        v => trimmed(&format!("{v:.4}")),
    }
}

fn trimmed(number: &str) -> String {
    number.trim_end_matches('0').trim_end_matches('.').to_owned()
}
