//! A rebuilt surface without its cavities, where the caller has them filled.

use crate::budget::{Budget, Stopped};
use crate::geom::DVec3;
use crate::repair::Draft;
use crate::repair::nest::{self, NestOptions, NestingPolicy};
use crate::wrap::Wrapped;

/// The outermost shells of a wrap.
pub(super) fn filled(wrapped: Wrapped, budget: &Budget) -> Result<Wrapped, Stopped> {
    let Wrapped { positions, unfitted, triangles, account } = wrapped;
    // What was fitted may meet itself.
    let surest = if unfitted.is_empty() { &positions } else { &unfitted };
    let mut draft = Draft {
        positions: surest.clone(),
        vertex_origin: (0..surest.len() as u32).collect(),
        triangle_origin: (0..triangles.len() as u32).collect(),
        triangles,
        ..Draft::default()
    };
    let fill = NestOptions { policy: NestingPolicy::Fill, is_embedded: true, ..NestOptions::default() };
    nest::nest(&mut draft, &fill, budget)?;
    let kept =
        |of: &[DVec3]| draft.vertex_origin.iter().filter_map(|&v| of.get(v as usize).copied()).collect();
    Ok(Wrapped {
        positions: kept(&positions),
        unfitted: kept(&unfitted),
        triangles: draft.triangles,
        account,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wrap::{WrapOptions, wrap};

    #[test]
    fn the_cavity_of_a_wrap_goes_with_its_vertices() {
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for (low, size, is_cavity) in [(0.0, 10.0, false), (3.0, 4.0, true)] {
            let base = positions.len() as u32;
            let corner = |i: u32| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from));
            positions.extend((0..8).map(|i| corner(i) * size + DVec3::splat(low)));
            let split = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
            let turned = |[a, b, c]: [u32; 3]| if is_cavity { [a, c, b] } else { [a, b, c] };
            triangles.extend(split.map(|t: [u32; 3]| turned(t).map(|v| v + base)));
        }
        let budget = Budget::unlimited();
        let options = WrapOptions { cells: 24, ..WrapOptions::default() };
        let hollow = wrap(&positions, &triangles, &options, &budget).unwrap();
        let volume = |of: &Wrapped| {
            crate::geom::signed_volume(of.triangles.iter().map(|t| t.map(|v| of.positions[v as usize])))
        };
        assert!((volume(&hollow) - 936.0).abs() < 10.0, "{}", volume(&hollow));
        let solid = filled(hollow.clone(), &budget).unwrap();
        assert!((volume(&solid) - 1000.0).abs() < 10.0, "{}", volume(&solid));
        assert_eq!(solid.positions.len(), solid.unfitted.len());
        assert!(solid.positions.len() < hollow.positions.len() && solid.account == hollow.account);
    }
}
