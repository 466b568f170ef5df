//! Parts that are taken away from what is printed.

use super::models::Models;
use super::scene::{Assembled, Extent, assemble};
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
    let negative = assemble(&models, Extent::Negative, options, budget)?;
    if negative.soup.triangles.is_empty() {
        return Ok(None);
    }
    let material = boxes(&assemble(&models, Extent::Material, options, budget)?);
    let meets_other = |&(item, bounds): &(usize, Aabb)| {
        material.iter().any(|&(other, of_other)| item != other && bounds.meets(of_other))
    };
    let reach_other_items = boxes(&negative).iter().any(meets_other);
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
