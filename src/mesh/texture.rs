//! Where triangle corners lie in a picture.

/// In the place of the number of a point: the corner has none.
pub const NO_POINT: u32 = u32::MAX;

/// Texture coordinates of triangle corners. Both lists are empty when the file has none.
///
/// Invariants: as many entries in `corners` as there are triangles; of a triangle all corners have a point or none;
/// points that a corner has are finite.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Texture {
    /// Across and up, in widths and heights of the picture.
    pub points: Vec<[f64; 2]>,
    /// For each triangle the points of its corners, by number, or [`NO_POINT`] three times.
    pub corners: Vec<[u32; 3]>,
}

impl Texture {
    /// True when no triangle has points.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The same with only the points that a corner has, in their order; empty when none has one.
    #[must_use]
    pub fn without_unused_points(mut self) -> Self {
        let mut number = vec![NO_POINT; self.points.len()];
        for &i in self.corners.iter().flatten().filter(|&&i| i != NO_POINT) {
            number[i as usize] = i;
        }
        let mut used = 0;
        for number in number.iter_mut().filter(|number| **number != NO_POINT) {
            *number = used;
            used += 1;
        }
        if used == 0 {
            return Self::default();
        }
        let mut is_used = number.iter().map(|&number| number != NO_POINT);
        self.points.retain(|_| is_used.next() == Some(true));
        for i in self.corners.iter_mut().flatten().filter(|i| **i != NO_POINT) {
            *i = number[*i as usize];
        }
        self
    }

    /// The points of triangle `t`, if it has some.
    pub fn of_triangle(&self, t: usize) -> Option<[[f64; 2]; 3]> {
        let corners = self.corners.get(t).filter(|corners| corners[0] != NO_POINT)?;
        Some(corners.map(|i| self.points[i as usize]))
    }
}
