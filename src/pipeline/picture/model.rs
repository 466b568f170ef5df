//! The picture as a mesh (GLB) that any viewer turns: colours as materials, rims as thin rods, places of defects as small octahedra.

use super::paint::{MeshRole, Painted, meaning};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::formats::{self, Encoding, WriteError};
use crate::geom::{Aabb, DVec3};
use crate::mesh::{Soup, Units};
use crate::pipeline::Failure;
use crate::render::{Line, Rgb, Spot};
use rustc_hash::FxHashMap;

/// Half the width of a rod over the largest side of the box of all meshes.
const ROD: f64 = 1.0 / 800.0;
/// Radius of the mark of a place over the same.
const MARK: f64 = 1.0 / 150.0;
/// Room between two meshes over the same.
const ROOM: f64 = 0.1;

/// All meshes in one file, in metres, one beside the other along x.
pub(super) fn model(sides: &[(&Soup, Painted)], units: Units, budget: &Budget) -> Result<Vec<u8>, Failure> {
    let boxes: Vec<Aabb> = sides.iter().map(|(soup, painted)| painted.scene(soup).bounds()).collect();
    let size =
        boxes.iter().filter(|b| !b.is_empty()).map(|b| (b.max - b.min).max_element()).fold(0.0, f64::max);
    let triangles: usize = sides.iter().map(|(soup, painted)| triangles_of(soup, painted)).sum();
    let vertices: usize = sides.iter().map(|(soup, _)| soup.positions.len()).sum();
    let _memory = budget.charge(vertices as u64 * 24 + triangles as u64 * (12 + 4 + 8 + 24))?;
    let mut made = ModelBuilder { size, metres: units.millimetres() / 1000.0, ..ModelBuilder::default() };
    for ((soup, painted), bounds) in sides.iter().zip(&boxes) {
        // The second one begins where the first one ends.
        let shift = match (painted.side, boxes.first()) {
            (MeshRole::After, Some(first)) if !first.is_empty() && !bounds.is_empty() => {
                first.max.x + ROOM * size - bounds.min.x
            }
            _ => 0.0,
        };
        made.put(soup, painted, DVec3::new(shift, 0.0, 0.0), budget)?;
    }
    formats::write(&made.soup(), Encoding::Glb, budget).map_err(|error| match error {
        WriteError::Stopped(stopped) => Failure::Stopped(stopped),
        error => Failure::NotApplicable {
            option: "picture_format",
            reason: format!("no GLB can be made: {error}"),
        },
    })
}

fn triangles_of(soup: &Soup, painted: &Painted) -> usize {
    let scene = painted.scene(soup);
    scene.triangles.len() + 6 * scene.lines.len() + 8 * scene.spots.len()
}

/// The triangles of a rod, which has three sides, with [`corners_of_rod`].
const ROD_TRIANGLES: [[u32; 3]; 6] = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];

/// The three corners at either end of a rod; `None`: it has no length.
fn corners_of_rod(ends: [DVec3; 2], radius: f64) -> Option<[DVec3; 6]> {
    let along = (ends[1] - ends[0]).try_normalize()?;
    let (across, up) = along.any_orthonormal_pair();
    let half_sqrt_3 = 0.75_f64.sqrt();
    let corners = [across, -0.5 * across + half_sqrt_3 * up, -0.5 * across - half_sqrt_3 * up];
    Some([0, 1, 2, 3, 4, 5].map(|k| ends[k / 3] + radius * corners[k % 3]))
}

/// The triangles of a rod between `ends`.
#[cfg(test)]
pub(super) fn rod_of_tests(ends: [DVec3; 2]) -> [[DVec3; 3]; 6] {
    let corners = corners_of_rod(ends, 0.01).unwrap();
    ROD_TRIANGLES.map(|triangle| triangle.map(|v| corners[v as usize]))
}

/// The file on its way.
#[derive(Default)]
struct ModelBuilder {
    /// Largest side of the boxes of all meshes.
    size: f64,
    /// Length of the unit of the meshes.
    metres: f64,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Of each triangle.
    material_of: Vec<u32>,
    /// Name and colour of each.
    materials: Vec<(String, Rgb)>,
    /// Their numbers, by the side and the colour.
    numbers: FxHashMap<(&'static str, Rgb), u32>,
}

impl ModelBuilder {
    fn put(&mut self, soup: &Soup, painted: &Painted, shift: DVec3, budget: &Budget) -> Result<(), Stopped> {
        let scene = painted.scene(soup);
        let first = self.positions.len() as u32;
        let place = |p: DVec3| if p.is_finite() { p + shift } else { DVec3::ZERO };
        self.positions.extend(scene.positions.iter().map(|&p| place(p)));
        let side = match painted.side {
            MeshRole::Only => "",
            MeshRole::Before => "before: ",
            MeshRole::After => "after: ",
        };
        for (t, corners) in scene.triangles.iter().enumerate() {
            if t.is_multiple_of(CHECK_EVERY) {
                budget.spend(CHECK_EVERY as u64 / 16)?;
            }
            let color = scene.palette[scene.paints.get(t).map_or(0, |&paint| usize::from(paint))];
            self.add(corners.map(|v| first + v), side, color);
        }
        for Line { ends, color } in scene.lines.iter().filter(|line| line.ends.iter().all(|p| p.is_finite()))
        {
            self.put_rod(ends.map(|end| end + shift), side, *color);
        }
        for Spot { at, color } in scene.spots.iter().filter(|spot| spot.at.is_finite()) {
            self.put_mark(*at + shift, side, *color);
        }
        Ok(())
    }

    fn add(&mut self, corners: [u32; 3], side: &'static str, color: Rgb) {
        let next = self.materials.len() as u32;
        let number = *self.numbers.entry((side, color)).or_insert(next);
        if number == next {
            self.materials.push((format!("{side}{}", meaning(color)), color));
        }
        self.triangles.push(corners);
        self.material_of.push(number);
    }

    fn put_rod(&mut self, ends: [DVec3; 2], side: &'static str, color: Rgb) {
        let first = self.positions.len() as u32;
        let Some(corners) = corners_of_rod(ends, ROD * self.size) else { return };
        self.positions.extend(corners);
        for triangle in ROD_TRIANGLES {
            self.add(triangle.map(|v| first + v), side, color);
        }
    }

    /// An octahedron.
    fn put_mark(&mut self, at: DVec3, side: &'static str, color: Rgb) {
        let first = self.positions.len() as u32;
        let radius = MARK * self.size;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            self.positions.extend([at + radius * axis, at - radius * axis]);
        }
        for octant in 0..8_u32 {
            let [x, y, z] = [0, 1, 2].map(|axis| first + 2 * axis + (octant >> axis & 1));
            let is_turned = octant.count_ones() % 2 == 1;
            self.add(if is_turned { [x, z, y] } else { [x, y, z] }, side, color);
        }
    }

    /// In metres, and within what a float32 holds.
    fn soup(self) -> Soup {
        let most = DVec3::splat(f64::from(f32::MAX));
        Soup {
            positions: self.positions.into_iter().map(|p| (p * self.metres).clamp(-most, most)).collect(),
            face_count: self.triangles.len() as u32,
            triangles: self.triangles,
            materials: formats::two_sided_materials(self.materials, self.material_of),
            units: Some(Units::Metre),
            ..Soup::default()
        }
    }
}
