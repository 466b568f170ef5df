//! Parts that are taken away from what is printed.

use super::models::Models;
use super::scene::{Assembled, PartSelection, assemble};
use crate::budget::Budget;
use crate::formats::{ReadError, ReadOptions};
use crate::geom::Aabb;
use crate::mesh::Soup;

/// The negative parts of a build.
#[derive(Debug, Clone, PartialEq)]
pub struct NegativeParts {
    /// All of them, each at its place, as one mesh.
    pub soup: Soup,
    /// The box of one meets that of another build item, from which it is not taken away.
    pub reach_other_items: bool,
}

/// The negative parts of a 3MF; `None` where it has none.
///
/// # Errors
/// As [`read_project`](super::read_project); more triangles than the limits allow.
pub fn read_negative_parts(
    bytes: &[u8],
    options: &ReadOptions,
    budget: &Budget,
) -> Result<Option<NegativeParts>, ReadError> {
    let models = Models::read(bytes, options, budget)?;
    let negative = assemble(&models, PartSelection::Negative, options, budget)?;
    if negative.soup.triangles.is_empty() {
        return Ok(None);
    }
    let mut material = boxes(&assemble(&models, PartSelection::Material, options, budget)?);
    material.sort_by(|(_, a), (_, b)| a.min.x.total_cmp(&b.min.x));
    let mut reach_other_items = false;
    for (item, bounds) in boxes(&negative) {
        let begun = material.partition_point(|(_, of_other)| of_other.min.x <= bounds.max.x);
        budget.spend(begun as u64)?;
        reach_other_items |=
            material[..begun].iter().any(|&(other, of_other)| item != other && bounds.meets(of_other));
    }
    Ok(Some(NegativeParts { soup: negative.soup, reach_other_items }))
}

/// The boxes of all parts that have points, each with the number of its build item.
fn boxes(Assembled { soup, placed }: &Assembled) -> Vec<(usize, Aabb)> {
    let mut boxes: Vec<(usize, Aabb)> = Vec::new();
    let ends = placed.iter().skip(1).map(|placed| placed.first_vertex as usize).chain([soup.positions.len()]);
    for (of, end) in placed.iter().zip(ends) {
        let points = soup.positions[of.first_vertex as usize..end].iter().copied();
        boxes.push((of.item, Aabb::of(points.filter(|p| p.is_finite()))));
    }
    boxes.retain(|(_, bounds)| !bounds.is_empty());
    boxes
}
