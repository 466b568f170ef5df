//! Nesting of shells against a comparison of all pairs of boxes.

use crate::oracle::RawSoup;
use crate::random::Random;
use crate::solids::{cuboid, tetrahedron};
use crate::support::cases;
use meshmend::budget::Budget;
use meshmend::geom::DVec3;
use meshmend::par::with_threads;
use meshmend::spatial::{Bvh, ShellNesting, nest};

/// Whole numbers: the low and the high corner of a box.
type Box = [[i64; 3]; 2];

/// Boxes, none of which meets another, made by dividing boxes and leaving gaps of at least one.
fn random_boxes(random: &mut Random, count_max: usize) -> Vec<Box> {
    let mut room = vec![[[0; 3], [1 << 20; 3]]];
    let mut boxes = Vec::new();
    while let (Some([low, high]), true) = (room.pop(), boxes.len() < count_max) {
        let axis = random.below(3);
        let shrink = |random: &mut Random, at: i64| at + 1 + random.below(3) as i64;
        if (0..3).any(|k| high[k] - low[k] < 16) {
            continue;
        }
        if random.one_in(2) {
            let inner = [low.map(|x| shrink(random, x)), high.map(|x| -shrink(random, -x))];
            boxes.push(inner);
            room.push(inner);
        } else {
            let cut = (low[axis] + high[axis]) / 2 + random.below(3) as i64;
            let (mut left, mut right) = ([low, high], [low, high]);
            left[1][axis] = cut;
            right[0][axis] = cut;
            room.extend([left, right]);
            let last = room.len() - 1;
            room.swap(random.below(last + 1), last);
        }
    }
    boxes
}

fn contains([a_low, a_high]: &Box, [b_low, b_high]: &Box) -> bool {
    (0..3).all(|k| a_low[k] < b_low[k] && b_high[k] < a_high[k])
}

/// What the boxes say, by comparing all pairs.
fn expected(boxes: &[Box], is_outward: Vec<bool>) -> ShellNesting {
    let around = |inner: &Box| (0..boxes.len()).filter(|&o| contains(&boxes[o], inner)).collect::<Vec<_>>();
    let depth: Vec<u32> = boxes.iter().map(|b| around(b).len() as u32).collect();
    let innermost = |b: &Box| around(b).into_iter().max_by_key(|&o| depth[o]).map(|o| o as u32);
    ShellNesting { is_outward, parent: boxes.iter().map(innermost).collect(), depth }
}

fn nesting_of(soups: &[RawSoup]) -> ShellNesting {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut shell_of = Vec::new();
    for (s, soup) in soups.iter().enumerate() {
        let first = positions.len() as u32;
        positions.extend(soup.positions.iter().map(|&p| DVec3::from_array(p)));
        triangles.extend(soup.triangles.iter().map(|t| t.map(|v| v + first)));
        shell_of.extend(vec![s as u32; soup.triangles.len()]);
    }
    let budget = Budget::unlimited();
    let bvh = Bvh::build(&positions, &triangles, None, &budget).unwrap();
    let [nested, without_tree] = [Some(&bvh), None]
        .map(|bvh| nest(&positions, &triangles, &shell_of, soups.len() as u32, bvh, &budget).unwrap());
    assert_eq!(nested, without_tree);
    nested
}

/// A box as a shell, in half of the cases inside out.
fn shell([low, high]: &Box, is_outward: bool) -> RawSoup {
    let soup = cuboid(std::array::from_fn(|k| (high[k] - low[k]) as f64)).moved(low.map(|x| x as f64));
    if is_outward { soup } else { soup.inside_out() }
}

fn assert_nested(boxes: &[Box], random: &mut Random) {
    let is_outward: Vec<bool> = boxes.iter().map(|_| random.one_in(2)).collect();
    let soups: Vec<RawSoup> = boxes.iter().zip(&is_outward).map(|(b, &o)| shell(b, o)).collect();
    let want = expected(boxes, is_outward);
    for threads in [1, 8] {
        let got = with_threads(threads, || nesting_of(&soups));
        assert!(got == want, "{threads} threads: {boxes:?}\n{got:?}\n{want:?}");
    }
}

#[test]
fn certificate_nesting_equals_that_of_all_pairs_of_boxes() {
    let rounds = cases(200, 2_000);
    let mut depth_max = 0;
    for round in 0..rounds {
        let mut random = Random::new(round as u64);
        let boxes = random_boxes(&mut random, 1 + round % 60);
        depth_max = depth_max.max(expected(&boxes, Vec::new()).depth.into_iter().max().unwrap_or(0));
        assert_nested(&boxes, &mut random);
    }
    println!("| random nested boxes | {rounds} | all agree, depth up to {depth_max} |");
    assert!(depth_max > 5, "too shallow: {depth_max}");
}

#[test]
fn certificate_nesting_of_thousands_of_boxes_equals_that_of_all_pairs() {
    let mut random = Random::new(1);
    let boxes = random_boxes(&mut random, 3_000);
    assert_eq!(boxes.len(), 3_000);
    assert_nested(&boxes, &mut random);
}

#[test]
fn certificate_nesting_of_a_thousand_shells_in_each_other_is_their_order() {
    let boxes: Vec<Box> = (0..1_000).map(|i| [[i; 3], [4_000 - i; 3]]).rev().collect();
    assert_nested(&boxes, &mut Random::new(2));
}

#[test]
fn certificate_nesting_of_ten_thousand_shells_above_each_other_is_flat() {
    let soups: Vec<RawSoup> =
        (0..10_000).map(|i| tetrahedron().moved([0.0, 0.0, 2.0 * f64::from(i)])).collect();
    let nesting = nesting_of(&soups);
    assert!(nesting.depth.iter().all(|&d| d == 0) && nesting.is_outward.iter().all(|&o| o));
}
