//! Turning whole parts of a draft.

use super::Draft;
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::triangle_area;
use crate::mesh::{Components, ParityUnionFind};

impl Draft {
    /// Of each set of related parts turns those on the side with less area; at equal areas the first part stays.
    pub(in crate::repair) fn turn_smaller(
        &mut self,
        parts: &Components,
        sides: &mut ParityUnionFind,
        budget: &Budget,
    ) -> Result<u64, Stopped> {
        let side: Vec<(u32, bool)> = (0..parts.count).map(|part| sides.find(part)).collect();
        // Area on the side of the first part, less that on the other.
        let mut balance = vec![0.0; parts.count as usize];
        for t in 0..self.triangles.len() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let (first, is_against) = side[parts.of[t] as usize];
            let area = triangle_area(self.corners(t));
            balance[first as usize] += if is_against { -area } else { area };
        }
        let mut turned = 0;
        for t in 0..self.triangles.len() {
            if t % CHECK_EVERY == 0 {
                budget.check()?;
            }
            let (first, is_against) = side[parts.of[t] as usize];
            if is_against == (balance[first as usize] >= 0.0) {
                self.flip(t);
                turned += 1;
            }
        }
        Ok(turned)
    }
}
