//! Bodies whose triangles turn as it happened, with walls inside: what they enclose becomes solid, and nothing visible is lost.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::repair::repaired;
use crate::solids::cuboid;
use meshmend::pipeline::Outcome;

const SIDE: f64 = 10.0;

/// A block of `n` cells along each axis with all walls between them, every triangle turned by chance, and a tetrahedron that passes
/// through its top, so that triangles meet.
fn cells(n: usize, seed: u64) -> RawSoup {
    let mut random = Random::new(seed);
    let number = |[x, y, z]: [usize; 3]| ((x * (n + 1) + y) * (n + 1) + z) as u32;
    let mut soup = RawSoup::default();
    for place in 0..(n + 1).pow(3) {
        let at = [place / (n + 1) / (n + 1), place / (n + 1) % (n + 1), place % (n + 1)];
        soup.positions.push(at.map(|k| SIDE * k as f64));
    }
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for wall in 0..(n + 1) * n * n {
            let mut low = [0; 3];
            (low[axis], low[u], low[v]) = (wall / n / n, wall / n % n, wall % n);
            let corner = |along_u: usize, along_v: usize| {
                let mut at = low;
                at[u] += along_u;
                at[v] += along_v;
                number(at)
            };
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            for [p, q, r] in [[a, b, c], [a, c, d]] {
                soup.triangles.push(if random.one_in(2) { [p, q, r] } else { [p, r, q] });
            }
        }
    }
    let first = soup.positions.len() as u32;
    let top = SIDE * n as f64;
    soup.positions.extend([
        [3.0, 3.0, 5.0],
        [9.0, 4.0, top + 6.0],
        [2.0, 9.0, top + 7.0],
        [8.0, 8.0, top + 8.0],
    ]);
    let sides = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    soup.triangles.extend(sides.map(|t: [u32; 3]| t.map(|v| first + v)));
    soup
}

#[test]
fn a_block_of_cells_turned_by_chance_stays_whole() {
    for (n, seed) in [(2, 1), (2, 2), (2, 3), (3, 1), (3, 2)] {
        let report = repaired(&cells(n, seed)).report;
        assert_eq!(report.outcome, Some(Outcome::Repaired), "{n} {seed}: {:?}", report.refusal);
        let losses = report.losses.unwrap();
        assert!(losses.visible_loss < 1e-3 && losses.bodies_lost == 0, "{n} {seed}: {losses:?}");
        let block = (SIDE * n as f64).powi(3);
        let volume = report.after.unwrap().measures.volume.unwrap();
        // The tetrahedron adds less than its own volume.
        assert!(
            volume > block && volume < block + 300.0,
            "{n} {seed}: {volume} instead of {block} and a little"
        );
    }
}

#[test]
fn a_cavity_in_a_block_of_cells_stays() {
    // In one of the cells: nothing connects it with their walls.
    let soup = cells(2, 2).with(&cuboid([4.0; 3]).moved([13.0, 13.0, 3.0]).inside_out());
    let report = repaired(&soup).report;
    let volume = report.after.unwrap().measures.volume.unwrap();
    let expected = (2.0 * SIDE).powi(3) - 64.0;
    assert!(volume > expected && volume < expected + 300.0, "{volume} instead of {expected} and a little");
}
