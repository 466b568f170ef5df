//! What surrounds a vertex of the lattice: its 14 neighbours, which span a sphere of 24 triangles.
//!
//! The tetrahedra around a vertex end in triangles between its neighbours. On that sphere the vertices inside and those
//! outside fall into pieces, and they alone tell how the solid changes where the vertex changes its side: with one piece
//! of each nothing happens but a move of the surface. With one piece inside and two outside the vertex is in a
//! tunnel, with two inside and one outside it is in a bridge.

/// Number of neighbours.
pub(super) const COUNT: usize = 14;

/// The steps to the neighbours: along the edges of the tetrahedra, forward and then backward.
pub(super) const STEPS: [[isize; 3]; COUNT] = {
    let mut steps = [[0; 3]; COUNT];
    let mut n = 0;
    while n < 7 {
        let bits = n as isize + 1;
        let step = [bits & 1, bits >> 1 & 1, bits >> 2 & 1];
        steps[n] = step;
        steps[n + 7] = [-step[0], -step[1], -step[2]];
        n += 1;
    }
    steps
};

/// Of each neighbour the set of those that it shares an edge with.
const BESIDE: [u16; COUNT] = {
    let mut beside = [0; COUNT];
    let (mut a, mut b) = (0, 0);
    while a < COUNT {
        if is_edge(STEPS[a], STEPS[b]) {
            beside[a] |= 1 << b;
        }
        b += 1;
        if b == COUNT {
            (a, b) = (a + 1, 0);
        }
    }
    beside
};

const fn is_edge(a: [isize; 3], b: [isize; 3]) -> bool {
    let (x, y, z) = (a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    let (is_up, is_down) = (x >= 0 && y >= 0 && z >= 0, x <= 0 && y <= 0 && z <= 0);
    let is_short = x <= 1 && y <= 1 && z <= 1 && x >= -1 && y >= -1 && z >= -1;
    is_short && is_up != is_down
}

/// All neighbours.
pub(super) const ALL: u16 = (1 << COUNT) - 1;

/// The pieces that a set of neighbours, as bits, falls into.
pub(super) fn pieces(mut set: u16) -> impl Iterator<Item = u16> {
    std::iter::from_fn(move || {
        if set == 0 {
            return None;
        }
        let (mut piece, mut ends) = (0, set & set.wrapping_neg());
        while ends != 0 {
            piece |= ends;
            let mut reached = 0;
            while ends != 0 {
                reached |= BESIDE[ends.trailing_zeros() as usize];
                ends &= ends - 1;
            }
            ends = reached & set & !piece;
        }
        set &= !piece;
        Some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_neighbours_span_a_sphere() {
        let edges = BESIDE.iter().map(|set| set.count_ones()).sum::<u32>() / 2;
        let mut triangles = 0;
        for (a, &of_a) in BESIDE.iter().enumerate() {
            for (b, of_b) in BESIDE.iter().enumerate().skip(a + 1).filter(|(b, _)| of_a >> b & 1 == 1) {
                triangles += (of_a & of_b & ALL << (b + 1)).count_ones();
            }
        }
        assert_eq!((edges, triangles), (36, 24));
        assert_eq!(pieces(ALL).count(), 1);
    }

    #[test]
    fn pieces_of_a_set_and_of_the_rest_fit_eulers_formula_on_the_sphere() {
        let of = |set: u16| (0..COUNT).filter(move |n| set >> n & 1 == 1);
        for set in 1..ALL {
            let edges = of(set).map(|n| (BESIDE[n] & set).count_ones());
            let beside = |a: usize| BESIDE[a] & set & ALL << (a + 1);
            let in_pair = |a: usize, b: usize| (BESIDE[a] & beside(b)).count_ones() as i32;
            let triangles: i32 =
                of(set).flat_map(|a| of(beside(a)).map(move |b| (a, b))).map(|(a, b)| in_pair(a, b)).sum();
            let euler = set.count_ones() as i32 - edges.sum::<u32>() as i32 / 2 + triangles;
            let holes = pieces(!set & ALL).count() as i32 - 1;
            assert_eq!(euler, pieces(set).count() as i32 - holes, "{set:b}");
            assert_eq!(pieces(set).fold(0, |all, piece| all | piece), set);
        }
    }
}
