//! Chords of a loop that a triangulation may be made of: all of them, or those near the edges of a coarser triangulation.

use crate::budget::{Budget, CHECK_EVERY, Stopped};

/// Chords between corners `i < k` of a loop, the sides and the chord from the first to the last corner among them.
pub(super) trait Chords {
    /// How many numbers chords have.
    fn len(&self) -> usize;
    /// The number of the chord from `i` to `k`, if it is one.
    fn find(&self, i: usize, k: usize) -> Option<usize>;
    /// Each chord after all that it spans.
    ///
    /// # Errors
    /// When the budget stops the run.
    fn shortest_first(&self, budget: &Budget) -> Result<impl Iterator<Item = (usize, usize)>, Stopped>;
    /// Visits each `m` between `i` and `k` with the numbers of the chords from `i` to `m` and from `m` to `k`, in the order
    /// of the corners.
    fn visit_thirds(&self, i: usize, k: usize, visit: impl FnMut(usize, [usize; 2]));
}

/// Every chord of a loop.
pub(super) struct All {
    pub(super) corners: usize,
}

impl Chords for All {
    fn len(&self) -> usize {
        self.corners * self.corners
    }

    fn find(&self, i: usize, k: usize) -> Option<usize> {
        Some(i * self.corners + k)
    }

    fn shortest_first(&self, _: &Budget) -> Result<impl Iterator<Item = (usize, usize)>, Stopped> {
        let n = self.corners;
        Ok((1..n).flat_map(move |span| (0..n - span).map(move |i| (i, i + span))))
    }

    fn visit_thirds(&self, i: usize, k: usize, mut visit: impl FnMut(usize, [usize; 2])) {
        let n = self.corners;
        for m in i + 1..k {
            visit(m, [i * n + m, m * n + k]);
        }
    }
}

/// The chords near given ones.
pub(super) struct Near {
    /// Sorted; the place of a chord is its number.
    chords: Vec<[u32; 2]>,
    /// Where the chords begin that start at each corner.
    starts: Vec<u32>,
    /// For each corner those that chords to it start from, in their order, and where these begin.
    from: Vec<u32>,
    from_starts: Vec<u32>,
}

impl Near {
    /// Of a loop of `corners`, the chords whose ends are at most `reach` corners from those of one of `edges`, or the side
    /// of the loop.
    pub(super) fn new(
        corners: usize,
        edges: &[[usize; 2]],
        reach: usize,
        budget: &Budget,
    ) -> Result<Self, Stopped> {
        let n = corners;
        let steps = 2 * reach + 1;
        let mut near: Vec<[u32; 2]> = Vec::with_capacity(edges.len() * steps * steps + n);
        let mut add = |i: usize, k: usize| {
            if i != k {
                near.push([i.min(k) as u32, i.max(k) as u32]);
            }
        };
        for &[a, b] in edges {
            for s in 0..steps {
                for t in 0..steps {
                    add((a + n + s - reach) % n, (b + n + t - reach) % n);
                }
            }
        }
        for i in 0..n {
            add(i, (i + 1) % n);
        }
        // Twice, so that those that start at one corner are in the order of their ends.
        let by_end = in_order(&near, n, |chord| chord[1], budget)?;
        let mut chords = in_order(&by_end, n, |chord| chord[0], budget)?;
        chords.dedup();
        let starts = starts_of(n, chords.iter().map(|chord| chord[0]));
        let back = in_order(&chords, n, |chord| chord[1], budget)?;
        let from_starts = starts_of(n, back.iter().map(|chord| chord[1]));
        Ok(Self { chords, starts, from: back.into_iter().map(|[i, _]| i).collect(), from_starts })
    }

    /// The chords that start at corner `i`.
    fn starting_at(&self, i: usize) -> std::ops::Range<usize> {
        self.starts[i] as usize..self.starts[i + 1] as usize
    }
}

/// The chords in the order of a number below `n` that each has; those of one number stay in their order.
fn in_order(
    chords: &[[u32; 2]],
    n: usize,
    number: impl Fn(&[u32; 2]) -> u32,
    budget: &Budget,
) -> Result<Vec<[u32; 2]>, Stopped> {
    let mut next = vec![0u32; n + 1];
    for part in chords.chunks(CHECK_EVERY) {
        budget.check()?;
        part.iter().for_each(|chord| next[number(chord) as usize + 1] += 1);
    }
    for i in 0..n {
        next[i + 1] += next[i];
    }
    let mut sorted = vec![[0; 2]; chords.len()];
    for part in chords.chunks(CHECK_EVERY) {
        budget.check()?;
        for chord in part {
            let place = &mut next[number(chord) as usize];
            sorted[*place as usize] = *chord;
            *place += 1;
        }
    }
    Ok(sorted)
}

/// Where the entries of each of `n` corners begin in a sorted list, and its end.
fn starts_of(n: usize, sorted: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut starts = vec![0; n + 1];
    for corner in sorted {
        starts[corner as usize + 1] += 1;
    }
    for i in 0..n {
        starts[i + 1] += starts[i];
    }
    starts
}

impl Chords for Near {
    fn len(&self) -> usize {
        self.chords.len()
    }

    fn find(&self, i: usize, k: usize) -> Option<usize> {
        let own = self.starting_at(i);
        self.chords[own.clone()].binary_search(&[i as u32, k as u32]).ok().map(|at| own.start + at)
    }

    fn shortest_first(&self, budget: &Budget) -> Result<impl Iterator<Item = (usize, usize)>, Stopped> {
        let sorted = in_order(&self.chords, self.starts.len() - 1, |&[i, k]| k - i, budget)?;
        Ok(sorted.into_iter().map(|[i, k]| (i as usize, k as usize)))
    }

    fn visit_thirds(&self, i: usize, k: usize, mut visit: impl FnMut(usize, [usize; 2])) {
        let own = self.starting_at(i);
        let between = &self.chords[own.clone()];
        let between = &between[..between.partition_point(|chord| chord[1] < k as u32)];
        let back = &self.from[self.from_starts[k] as usize..self.from_starts[k + 1] as usize];
        let back = &back[back.partition_point(|&m| m <= i as u32)..];
        // The shorter list is gone through: a corner where many chords meet is not gone through for each of them.
        if between.len() <= back.len() {
            for (at, chord) in between.iter().enumerate() {
                let m = chord[1] as usize;
                if let Some(other) = self.find(m, k) {
                    visit(m, [own.start + at, other]);
                }
            }
        } else {
            for &m in back {
                let m = m as usize;
                if let (Some(one), Some(other)) = (self.find(i, m), self.find(m, k)) {
                    visit(m, [one, other]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thirds(chords: &impl Chords, i: usize, k: usize) -> Vec<(usize, [usize; 2])> {
        let mut found = Vec::new();
        chords.visit_thirds(i, k, |m, numbers| found.push((m, numbers)));
        found
    }

    #[test]
    fn near_chords_are_those_of_the_definition() {
        let (n, edges) = (23, [[0, 7], [7, 15], [3, 22], [0, 15]]);
        for reach in 0..4 {
            let near = Near::new(n, &edges, reach, &Budget::unlimited()).unwrap();
            let apart = |a: usize, b: usize| a.abs_diff(b).min(n - a.abs_diff(b));
            let is_near = |i: usize, k: usize| {
                let is = |[a, b]: [usize; 2]| apart(i, a) <= reach && apart(k, b) <= reach;
                apart(i, k) == 1 || edges.iter().any(|&[a, b]| is([a, b]) || is([b, a]))
            };
            for i in 0..n {
                for k in i + 1..n {
                    assert_eq!(near.find(i, k).is_some(), is_near(i, k), "{i} {k}, reach {reach}");
                    let expected: Vec<_> =
                        (i + 1..k).filter_map(|m| Some((m, [near.find(i, m)?, near.find(m, k)?]))).collect();
                    assert_eq!(thirds(&near, i, k), expected, "{i} {k}, reach {reach}");
                }
            }
            let order: Vec<_> = near.shortest_first(&Budget::unlimited()).unwrap().collect();
            assert_eq!(order.len(), near.len());
            let rank = |&(i, k): &(usize, usize)| (k - i, i);
            assert!(order.windows(2).all(|pair| rank(&pair[0]) < rank(&pair[1])));
        }
    }

    #[test]
    fn all_chords_have_numbers_of_their_own() {
        let all = All { corners: 9 };
        let mut numbers: Vec<_> =
            all.shortest_first(&Budget::unlimited()).unwrap().map(|(i, k)| all.find(i, k).unwrap()).collect();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!((numbers.len(), thirds(&all, 2, 6).len()), (36, 3));
        assert!(numbers.last().unwrap() < &all.len());
    }
}
