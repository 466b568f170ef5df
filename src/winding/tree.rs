//! Generalized winding numbers of open surfaces: near triangles exactly, far ones together (Barill, Dickson, Schmidt,
//! Levin and Jacobson 2018, "Fast winding numbers for soups and clouds", with their first two terms).

use super::angles::{AngleSum, BLOCK, Block};
use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;

/// Triangles from which on the two halves of a group are divided at the same time.
const APART_FROM: usize = 1 << 14;

/// A group is far when its distance exceeds its radius by this factor. The share of the winding number that the third
/// term would add falls with its cube.
const FAR: f64 = 3.5;

/// How much farther for places whose winding number is close to the threshold.
const FAR_IN_DOUBT: f64 = 8.0;

/// How near groups may be for places whose winding number is far from the threshold.
const FAR_AT_FIRST: f64 = 2.0;

/// Closer to 1/2 than this is in doubt.
const DOUBT: f64 = 0.05;

/// And this when groups were near.
const DOUBT_AT_FIRST: f64 = 0.2;

/// Groups and triangles that are looked at for one place, at most. Surfaces whose triangles are small for their size take
/// hundreds to a few thousand; long triangles all through each other are near everywhere.
const VISITS_MAX: u64 = 1 << 16;

/// Where it is still too much with less than this, every group is far.
const FAR_LEAST: f64 = 1.0 / 64.0;

/// What a group of triangles is from afar.
#[derive(Debug, Clone, Copy, Default)]
struct DipoleNode {
    center: DVec3,
    radius: f64,
    /// Sum of the area vectors.
    dipole: DVec3,
    /// Sum of (centre of triangle - `center`) times area vector: columns by component of the area vector.
    moment: [DVec3; 3],
    first: u32,
    len: u32,
    /// Node after this one's subtree; the first child is the next node.
    skip: u32,
}

/// Triangles prepared for questions about how often they wind around a point.
#[derive(Debug, Default)]
pub struct WindingTree {
    nodes: Vec<DipoleNode>,
    /// The triangles, a block for each leaf, in the order of the leaves.
    blocks: Vec<Block>,
}

impl WindingTree {
    /// Prepares `triangles`. O(n log n).
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn build(mut triangles: Vec<[DVec3; 3]>, budget: &Budget) -> Result<Self, Stopped> {
        if triangles.is_empty() {
            return Ok(Self::default());
        }
        let mut nodes = vec![DipoleNode::default(); node_count(triangles.len())];
        set_nodes(&mut nodes, &mut triangles, 0, 0, budget)?;
        budget.spend(triangles.len() as u64)?;
        let blocks = triangles.chunks(BLOCK).map(Block::of).collect();
        Ok(Self { nodes, blocks })
    }

    /// True when there is no triangle: nothing winds around anything.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The winding number at `p` plus `more`, evaluated more closely where that sum is near 1/2.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn at(&self, p: DVec3, more: f64, budget: &Budget) -> Result<f64, Stopped> {
        let first = self.evaluate(p, FAR, budget)? + more;
        let is_doubtful = (first - 0.5).abs() < DOUBT;
        Ok(if is_doubtful { self.evaluate(p, FAR_IN_DOUBT, budget)? + more } else { first })
    }

    /// Whether the winding number at `p` plus `more` is at least 1/2, with no more care than that takes.
    ///
    /// # Errors
    /// When the budget stops the run.
    pub fn is_inside(&self, p: DVec3, more: f64, budget: &Budget) -> Result<bool, Stopped> {
        if self.is_empty() {
            return Ok(more >= 0.5);
        }
        let first = self.evaluate(p, FAR_AT_FIRST, budget)? + more;
        let is_clear = (first - 0.5).abs() >= DOUBT_AT_FIRST;
        Ok((if is_clear { first } else { self.at(p, more, budget)? }) >= 0.5)
    }

    /// The winding number; where groups are so large that too many are near, nearer ones are taken together too.
    fn evaluate(&self, p: DVec3, far: f64, budget: &Budget) -> Result<f64, Stopped> {
        let mut far = far;
        loop {
            let (found, visits) = self.evaluate_within(p, far);
            budget.spend(visits)?;
            match found {
                Some(number) => return Ok(number),
                None => far = if far > FAR_LEAST { far / 2.0 } else { 0.0 },
            }
        }
    }

    /// The same unless it takes more than [`VISITS_MAX`] of groups and triangles; and how many it took.
    fn evaluate_within(&self, p: DVec3, far: f64) -> (Option<f64>, u64) {
        let (mut dipoles, mut angles) = (0.0, AngleSum::default());
        let (mut n, mut visits) = (0, 0);
        while let Some(node) = self.nodes.get(n) {
            visits += 1;
            if visits > VISITS_MAX {
                return (None, visits);
            }
            let r = node.center - p;
            let square = r.length_squared();
            let reach = node.radius * far;
            if square > reach * reach {
                dipoles += node.seen_from(r, square);
                n = node.skip as usize;
                continue;
            }
            if far == 0.0 {
                // The place is the very middle of a group: from there it winds as much one way as the other.
                n = node.skip as usize;
                continue;
            }
            if node.len as usize <= BLOCK {
                visits += u64::from(node.len);
                angles.add_halves(&self.blocks[node.first as usize / BLOCK], p);
            }
            n += 1;
        }
        let number = dipoles / (4.0 * std::f64::consts::PI) + angles.total() / (2.0 * std::f64::consts::PI);
        (Some(number), visits)
    }
}

impl DipoleNode {
    /// Solid angle of the group's first two terms; `r` goes from the place to the centre.
    fn seen_from(&self, r: DVec3, square: f64) -> f64 {
        let by_square = 1.0 / square;
        let by_cube = by_square / square.sqrt();
        let [x, y, z] = self.moment;
        let trace = x.x + y.y + z.z;
        // r^T M r
        let twice = r.dot(x) * r.x + r.dot(y) * r.y + r.dot(z) * r.z;
        by_cube * (r.dot(self.dipole) + trace - 3.0 * twice * by_square)
    }
}

/// Triangles in the first part of a group of so many: about half, and whole blocks, so that all leaves but the last are full.
fn half_of(len: usize) -> usize {
    (len / 2).next_multiple_of(BLOCK)
}

/// Nodes of a group of so many triangles.
fn node_count(len: usize) -> usize {
    if len <= BLOCK { 1 } else { 1 + node_count(half_of(len)) + node_count(len - half_of(len)) }
}

/// Sets the `nodes` of a group of triangles and sorts these; `first` and `begin` are the numbers of the first triangle and the
/// first node.
fn set_nodes(
    nodes: &mut [DipoleNode],
    triangles: &mut [[DVec3; 3]],
    first: usize,
    begin: usize,
    budget: &Budget,
) -> Result<(), Stopped> {
    if triangles.len() < APART_FROM {
        let own = nodes_in_turn(triangles, first, budget)?;
        for (node, own) in nodes.iter_mut().zip(own) {
            *node = DipoleNode { skip: own.skip + begin as u32, ..own };
        }
        return Ok(());
    }
    budget.check()?;
    let end = begin + nodes.len();
    let Some((top, below)) = nodes.split_first_mut() else { return Ok(()) };
    *top = DipoleNode { skip: end as u32, ..summary(triangles, first) };
    split(triangles);
    let half = half_of(triangles.len());
    let (near, far) = triangles.split_at_mut(half);
    let count = node_count(half);
    let (near_nodes, far_nodes) = below.split_at_mut(count);
    let (near, far) = par::join(
        || set_nodes(near_nodes, near, first, begin + 1, budget),
        || set_nodes(far_nodes, far, first + half, begin + 1 + count, budget),
    );
    near.and(far)
}

/// The nodes of a group of triangles one after the other, numbered from 0; `from` is the number of the first triangle.
fn nodes_in_turn(
    triangles: &mut [[DVec3; 3]],
    from: usize,
    budget: &Budget,
) -> Result<Vec<DipoleNode>, Stopped> {
    let mut nodes = Vec::new();
    // Ranges still to be split, each with the nodes whose subtree ends with it.
    let mut open = vec![(0, triangles.len(), Vec::new())];
    let mut done = 0usize;
    while let Some((first, len, mut ends)) = open.pop() {
        if done.is_multiple_of(CHECK_EVERY / 64) {
            budget.check()?;
        }
        done += 1;
        let range = &mut triangles[first..first + len];
        ends.push(nodes.len());
        nodes.push(summary(range, from + first));
        if len <= BLOCK {
            for &n in &ends {
                nodes[n].skip = nodes.len() as u32;
            }
            continue;
        }
        split(range);
        let half = half_of(len);
        open.push((first + half, len - half, ends));
        open.push((first, half, Vec::new()));
    }
    Ok(nodes)
}

/// The same triangles the other way around.
pub fn turned(triangles: &[[DVec3; 3]]) -> Vec<[DVec3; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a) * 0.5
}

fn middle([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}

fn summary(triangles: &[[DVec3; 3]], first: usize) -> DipoleNode {
    let (mut weighted, mut weight) = (DVec3::ZERO, 0.0);
    for &t in triangles {
        let area = area_vector(t).length() + f64::MIN_POSITIVE;
        weighted += middle(t) * area;
        weight += area;
    }
    let center = weighted / weight;
    let (mut dipole, mut moment, mut square) = (DVec3::ZERO, [DVec3::ZERO; 3], 0.0f64);
    for &t in triangles {
        let (area, offset) = (area_vector(t), middle(t) - center);
        dipole += area;
        for (column, share) in moment.iter_mut().zip(area.to_array()) {
            *column += offset * share;
        }
        square = t.into_iter().fold(square, |most, p| most.max(p.distance_squared(center)));
    }
    DipoleNode {
        center,
        radius: square.sqrt(),
        dipole,
        moment,
        first: first as u32,
        len: triangles.len() as u32,
        skip: 0,
    }
}

/// Puts the part with the smaller centres along the longest extent first.
fn split(triangles: &mut [[DVec3; 3]]) {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &t in triangles.iter() {
        (min, max) = (min.min(middle(t)), max.max(middle(t)));
    }
    let extent = max - min;
    let axis = if extent.x >= extent.y.max(extent.z) { 0 } else { usize::from(extent.y < extent.z) + 1 };
    let half = half_of(triangles.len());
    // That of the middle, for this axis alone.
    let key = |t: &[DVec3; 3]| (t[0][axis] + t[1][axis] + t[2][axis]) / 3.0;
    triangles.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)));
}

#[cfg(test)]
mod tests {
    use super::super::angles::tests::half_solid_angle;
    use super::*;

    /// A sphere of quarter degrees with the cap above `height` open.
    fn bowl(rings: usize, height: f64) -> Vec<[DVec3; 3]> {
        let at = |i: usize, j: usize| {
            let (u, v) = (
                i as f64 / rings as f64 * std::f64::consts::PI,
                j as f64 / rings as f64 * std::f64::consts::TAU,
            );
            DVec3::new(libm::sin(u) * libm::cos(v), libm::sin(u) * libm::sin(v), -libm::cos(u)) * 10.0
        };
        let mut all = Vec::new();
        for i in 0..rings {
            for j in 0..rings {
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                all.extend([[a, c, b], [a, d, c]]);
            }
        }
        all.retain(|t| t.iter().all(|p| p.z <= height) && area_vector(*t).length() > 0.0);
        for t in &mut all {
            if area_vector(*t).dot(middle(*t)) < 0.0 {
                t.swap(1, 2);
            }
        }
        all
    }

    #[test]
    fn groups_seen_from_afar_give_what_their_triangles_give() {
        let triangles = bowl(60, 5.0);
        let tree = WindingTree::build(triangles.clone(), &Budget::unlimited()).unwrap();
        let mut worst = 0.0f64;
        for i in 0..1000 {
            let p = DVec3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64) * 3.1 - 14.0;
            let exact =
                triangles.iter().map(|&t| half_solid_angle(p, t)).sum::<f64>() / std::f64::consts::TAU;
            worst = worst.max((tree.at(p, 0.0, &Budget::unlimited()).unwrap() - exact).abs());
        }
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn inside_is_where_the_winding_number_is_at_least_a_half() {
        let tree = WindingTree::build(bowl(60, 5.0), &Budget::unlimited()).unwrap();
        let (mut inside, unlimited) = (0, Budget::unlimited());
        for i in 0..8000 {
            let p = DVec3::new((i % 20) as f64, (i / 20 % 20) as f64, (i / 400) as f64) * 1.3 - 12.7;
            let w = tree.at(p, 0.0, &unlimited).unwrap();
            if (w - 0.5).abs() > 1e-3 {
                assert_eq!(tree.is_inside(p, 0.0, &unlimited).unwrap(), w >= 0.5, "{p} {w}");
            }
            inside += usize::from(w >= 0.5);
        }
        assert!(inside > 800, "{inside}");
    }

    #[test]
    fn a_closed_surface_winds_once_around_what_is_inside() {
        let tree = WindingTree::build(bowl(40, 11.0), &Budget::unlimited()).unwrap();
        let at = |tree: &WindingTree, p| tree.at(p, 0.0, &Budget::unlimited()).unwrap();
        assert!((at(&tree, DVec3::new(1.0, 2.0, 3.0)) - 1.0).abs() < 0.03);
        assert!(at(&tree, DVec3::new(1.0, 12.0, 3.0)).abs() < 0.03);
        assert_eq!(at(&WindingTree::default(), DVec3::ZERO), 0.0);
    }

    #[test]
    fn groups_that_are_divided_at_the_same_time_are_those_that_are_divided_in_turn() {
        let mut triangles = bowl(110, 9.0);
        assert!(triangles.len() > APART_FROM);
        let mut again = triangles.clone();
        let mut nodes = vec![DipoleNode::default(); node_count(triangles.len())];
        set_nodes(&mut nodes, &mut triangles, 0, 0, &Budget::unlimited()).unwrap();
        let in_turn = nodes_in_turn(&mut again, 0, &Budget::unlimited()).unwrap();
        assert_eq!(format!("{nodes:?}"), format!("{in_turn:?}"));
        assert_eq!(triangles, again);
    }

    #[test]
    fn no_place_takes_more_than_a_bounded_number_of_visits() {
        // Long triangles through the middle of a ball: each is near every place in it.
        let mut state = 3u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut point = || DVec3::new(random(), random(), random());
        let triangles = (0..100_000).map(|_| [point(), point(), point()]).collect();
        let budget = Budget::unlimited();
        let tree = WindingTree::build(triangles, &budget).unwrap();
        let before = budget.work_used();
        tree.at(DVec3::splat(0.1), 0.0, &budget).unwrap();
        // Each try halves how far is near, down to none.
        assert!(budget.work_used() - before < 40 * (VISITS_MAX + 9));
        // The middle of them all is near every group at any distance.
        let copies =
            vec![
                [DVec3::new(2.0, -1.0, -1.0), DVec3::new(-1.0, 2.0, -1.0), DVec3::new(-1.0, -1.0, 2.0)];
                100_000
            ];
        let tree = WindingTree::build(copies, &budget).unwrap();
        let before = budget.work_used();
        assert_eq!(tree.at(DVec3::ZERO, 0.0, &budget).unwrap(), 0.0);
        assert!(budget.work_used() - before < 40 * (VISITS_MAX + 9));
    }
}
