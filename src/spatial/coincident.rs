//! Points with equal coordinates.
//!
//! Most points of a mesh without indices repeat a point a few triangles before: a small cache of recent points finds
//! those. What is left goes through a radix partition by hash, then one small table for each part: the parts fit the
//! processor's cache and are independent. What is found does not depend on the order in which ranges and parts run.

use crate::budget::{Budget, CHECK_EVERY, Stopped};
use crate::geom::DVec3;
use crate::par;

/// Points grouped by equal coordinates; -0 equals +0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coincident {
    /// Group of each point; groups are numbered by first occurrence.
    pub group: Vec<u32>,
    /// First point of each group.
    pub first: Vec<u32>,
}

/// Groups `points` by equal coordinates. NaN equals itself bit for bit. O(n).
///
/// # Errors
/// When the budget stops the run.
///
/// # Panics
/// With 2^32 points or more.
pub fn coincident_f64(points: &[DVec3], budget: &Budget) -> Result<Coincident, Stopped> {
    let key = |i: usize| points[i].to_array().map(|x| without_sign_of_zero(x.to_bits(), 1 << 63));
    let (mut group, _charge) = budget.vec::<u32>(points.len())?;
    group.resize(points.len(), 0);
    let first = group_by_key(key, &mut group, budget)?;
    Ok(Coincident { group, first })
}

/// As [`coincident_f64`] for float32 points that `point` gives by index: fills in the `group` of each and returns the
/// first point of each group.
///
/// # Errors
/// When the budget stops the run.
///
/// # Panics
/// With 2^32 points or more.
pub fn coincident_f32(
    point: impl Fn(usize) -> [f32; 3] + Sync,
    group: &mut [u32],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let key = |i| {
        let [x, y, z] = point(i);
        let bits = |x: f32| without_sign_of_zero(x.to_bits(), 1 << 31);
        [bits(x), bits(y), bits(z)]
    };
    group_by_key(key, group, budget)
}

fn without_sign_of_zero<T: Copy + PartialEq + Default>(bits: T, negative_zero: T) -> T {
    if bits == negative_zero { T::default() } else { bits }
}

/// Coordinates as bits; equal points have equal keys.
trait CoordinateKey: Copy + Ord + Default + Send + Sync {
    /// Depends on every bit; equal keys have equal hashes.
    fn hash(self) -> u64;

    /// As [`hash`](Self::hash) where collisions do little harm: cheaper, and mixed less well.
    fn quick_hash(self) -> u64;
}

impl CoordinateKey for [u32; 3] {
    fn hash(self) -> u64 {
        let [x, y, z] = self;
        fold(fold(u64::from(x) << 32 | u64::from(y), SEEDS[0]) ^ u64::from(z), SEEDS[1])
    }

    #[inline]
    fn quick_hash(self) -> u64 {
        let [x, y, z] = self.map(u64::from);
        top_bits((x << 32 | y).wrapping_add(z.wrapping_mul(SEEDS[1])))
    }
}

impl CoordinateKey for [u64; 3] {
    fn hash(self) -> u64 {
        let [x, y, z] = self;
        fold(fold(fold(x, SEEDS[0]) ^ y, SEEDS[1]) ^ z, SEEDS[2])
    }

    #[inline]
    fn quick_hash(self) -> u64 {
        let [x, y, z] = self;
        top_bits(x.wrapping_add(y.wrapping_mul(SEEDS[1])).wrapping_add(z.wrapping_mul(SEEDS[2])))
    }
}

/// Digits of pi, as good as any, odd.
const SEEDS: [u64; 3] = [0x243f_6a88_85a3_08d3, 0x1319_8a2e_0370_7345, 0xa409_3822_299f_31d1];

/// The golden ratio's bits.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

/// Both halves of the product, so that high and low bits reach each other.
fn fold(value: u64, seed: u64) -> u64 {
    let product = u128::from(value ^ seed) * u128::from(FACTOR);
    (product as u64) ^ (product >> 64) as u64
}

/// The upper half of a product, which all lower bits of the value reach.
fn top_bits(value: u64) -> u64 {
    value.wrapping_mul(FACTOR) >> 32
}

/// Points that are partitioned together: their entries fit the second-level cache.
const CHUNK: usize = 1 << 16;

/// Points aimed at for a part: its table fits the second-level cache.
const PART_LEN: usize = 1 << 13;

/// Most parts; more would need more places to write to than the first-level cache holds.
const PARTS_MAX: usize = 512;

/// Parts that share a table, one after the other.
const PARTS_AT_A_TIME: usize = 8;

/// Steps through a table at half load after which the hashes are taken for crafted.
const PROBES_MAX: usize = 256;

/// Points that share a cache of recent points.
const RECENT_CHUNK: usize = 1 << 17;

/// Recent points that are remembered: as many as fit the second-level cache.
const RECENT_LEN: usize = 1 << 14;

fn group_by_key<K: CoordinateKey>(
    key: impl Fn(usize) -> K + Sync,
    group: &mut [u32],
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    assert!(u32::try_from(group.len()).is_ok(), "too many points for 32-bit ids");
    let ranges = group.chunks_mut(RECENT_CHUNK).collect();
    let news = par::map_items(ranges, |range, new_of| {
        budget.check()?;
        Ok(points_not_repeated(range * RECENT_CHUNK, &key, new_of))
    });
    let news = news.into_iter().collect::<Result<Vec<_>, Stopped>>()?;
    let begins = news.iter().scan(0, |end, news| Some(std::mem::replace(end, *end + news.len())));
    let begins: Vec<usize> = begins.collect();
    let news = news.concat();
    let of_news = group_by_parts(news.len(), |new| key(news[new] as usize), budget)?;
    par::for_each_chunk_mut(group, RECENT_CHUNK, |begin, groups| {
        let of_news = &of_news.group[begins[begin / RECENT_CHUNK]..];
        for group in groups {
            *group = of_news[*group as usize];
        }
    });
    Ok(of_news.first.into_iter().map(|new| news[new as usize]).collect())
}

/// The points from `begin` on that repeat none of the range which is remembered, among them the first of every group.
/// `new_of` is told for each point of the range which of them has its key.
fn points_not_repeated<K: CoordinateKey>(
    begin: usize,
    key: impl Fn(usize) -> K,
    new_of: &mut [u32],
) -> Vec<u32> {
    // On the heap: a worker's stack may be small.
    let mut slots = Vec::new();
    slots.resize(RECENT_LEN, KeyedPoint { key: K::default(), id: EMPTY });
    let mut news = Vec::with_capacity(new_of.len() / 4);
    for (i, new_of) in (begin..).zip(new_of) {
        let key = key(i);
        let slot = &mut slots[key.quick_hash() as usize % RECENT_LEN];
        if slot.key != key || slot.id == EMPTY {
            *slot = KeyedPoint { key, id: news.len() as u32 };
            news.push(i as u32);
        }
        *new_of = slot.id;
    }
    news
}

fn group_by_parts<K: CoordinateKey>(
    len: usize,
    key: impl Fn(usize) -> K + Sync,
    budget: &Budget,
) -> Result<Coincident, Stopped> {
    let _charge = budget.charge(len as u64 * (size_of::<KeyedPoint<K>>() as u64 + 4 + 4 + 4))?;
    let parts =
        HashPartition { bits: (len / PART_LEN).clamp(1, PARTS_MAX).next_power_of_two().trailing_zeros() };
    let mut chunks = par::try_map_ranges(len, CHUNK, |range| {
        budget.check()?;
        Ok(Chunk::partition(range, &key, parts))
    })?;
    count_earlier(&mut chunks, parts);
    let firsts = par::try_map_ranges(parts.count(), PARTS_AT_A_TIME, |range| {
        let mut table = HashTable::default();
        range.map(|part| first_points(&chunks, part, &mut table, budget)).collect::<Result<Vec<_>, _>>()
    })?;
    let firsts: Vec<Vec<u32>> = firsts.into_iter().flatten().collect();
    let mut first_of = vec![0; len];
    par::for_each_chunk_mut(&mut first_of, CHUNK, |begin, out| {
        collect_firsts(&chunks[begin / CHUNK], &firsts, begin, out);
    });
    drop((chunks, firsts));
    number_by_first(first_of, budget)
}

#[derive(Clone, Copy)]
struct HashPartition {
    bits: u32,
}

impl HashPartition {
    fn count(self) -> usize {
        1 << self.bits
    }

    /// By the highest bits of the hash; the tables use the lowest.
    fn of(self, hash: u64) -> usize {
        (hash >> 32 >> (32 - self.bits)) as usize
    }
}

#[derive(Clone, Copy, Default)]
struct KeyedPoint<K> {
    key: K,
    id: u32,
}

/// A range of points, sorted by part.
struct Chunk<K> {
    entries: Vec<KeyedPoint<K>>,
    /// Where each part begins, and the end.
    starts: Vec<u32>,
    /// How many points of each part earlier ranges have.
    earlier: Vec<u32>,
}

impl<K: CoordinateKey> Chunk<K> {
    fn partition(range: std::ops::Range<usize>, key: impl Fn(usize) -> K, parts: HashPartition) -> Self {
        let entries: Vec<KeyedPoint<K>> = range.map(|i| KeyedPoint { key: key(i), id: i as u32 }).collect();
        let part_of: Vec<u16> = entries.iter().map(|e| parts.of(e.key.hash()) as u16).collect();
        let mut starts = vec![0u32; parts.count() + 1];
        for &part in &part_of {
            starts[part as usize + 1] += 1;
        }
        for part in 0..parts.count() {
            starts[part + 1] += starts[part];
        }
        let mut cursor = starts.clone();
        let mut sorted = vec![KeyedPoint::default(); entries.len()];
        for (entry, &part) in entries.iter().zip(&part_of) {
            let place = &mut cursor[part as usize];
            sorted[*place as usize] = *entry;
            *place += 1;
        }
        Self { entries: sorted, starts, earlier: Vec::new() }
    }

    fn part(&self, part: usize) -> &[KeyedPoint<K>] {
        &self.entries[self.starts[part] as usize..self.starts[part + 1] as usize]
    }
}

fn count_earlier<K: CoordinateKey>(chunks: &mut [Chunk<K>], parts: HashPartition) {
    let mut earlier = vec![0; parts.count()];
    for chunk in chunks {
        chunk.earlier.clone_from(&earlier);
        for (part, count) in earlier.iter_mut().enumerate() {
            *count += chunk.part(part).len() as u32;
        }
    }
}

/// For each point of the part, in order, the first point with the same key.
fn first_points<K: CoordinateKey>(
    chunks: &[Chunk<K>],
    part: usize,
    table: &mut HashTable<K>,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let len = chunks.iter().map(|c| c.part(part).len()).sum();
    table.clear(len);
    let mut firsts = Vec::with_capacity(len);
    for chunk in chunks {
        for entries in chunk.part(part).chunks(CHECK_EVERY) {
            budget.check()?;
            for &entry in entries {
                match table.first_with_key_of(entry) {
                    Some(first) => firsts.push(first),
                    None => return first_points_by_sorting(chunks, part, budget),
                }
            }
        }
    }
    Ok(firsts)
}

/// As [`first_points`] for keys whose hashes collide: O(n log n) whatever the keys.
fn first_points_by_sorting<K: CoordinateKey>(
    chunks: &[Chunk<K>],
    part: usize,
    budget: &Budget,
) -> Result<Vec<u32>, Stopped> {
    let keys = chunks.iter().flat_map(|c| c.part(part)).map(|e| e.key);
    let mut by_key: Vec<(K, u32)> = keys.zip(0..).collect();
    let ids: Vec<u32> = chunks.iter().flat_map(|c| c.part(part)).map(|e| e.id).collect();
    budget.check()?;
    par::sort_unstable(&mut by_key);
    budget.check()?;
    let mut firsts = vec![0; ids.len()];
    for run in by_key.chunk_by(|a, b| a.0 == b.0) {
        for &(_, i) in run {
            firsts[i as usize] = ids[run[0].1 as usize];
        }
    }
    Ok(firsts)
}

/// Open addressing with linear probing, at most half full.
#[derive(Default)]
struct HashTable<K> {
    slots: Vec<KeyedPoint<K>>,
}

const EMPTY: u32 = u32::MAX;

impl<K: CoordinateKey> HashTable<K> {
    /// Empties it, with room for `len` keys.
    fn clear(&mut self, len: usize) {
        self.slots.clear();
        self.slots.resize((len * 2).next_power_of_two(), KeyedPoint { key: K::default(), id: EMPTY });
    }

    /// The id that came first with the entry's key; `None` when the search takes too long.
    fn first_with_key_of(&mut self, entry: KeyedPoint<K>) -> Option<u32> {
        let mask = self.slots.len() - 1;
        let home = entry.key.hash() as usize;
        for step in 0..PROBES_MAX {
            let slot = &mut self.slots[home.wrapping_add(step) & mask];
            if slot.id == EMPTY {
                *slot = entry;
            } else if slot.key != entry.key {
                continue;
            }
            return Some(slot.id);
        }
        None
    }
}

/// Puts what the parts found for the points of a chunk in the order of the points.
fn collect_firsts<K: CoordinateKey>(chunk: &Chunk<K>, firsts: &[Vec<u32>], begin: usize, out: &mut [u32]) {
    for (part, firsts) in firsts.iter().enumerate() {
        let firsts = &firsts[chunk.earlier[part] as usize..];
        for (entry, &first) in chunk.part(part).iter().zip(firsts) {
            out[entry.id as usize - begin] = first;
        }
    }
}

/// Turns the first point of each point's group into the group's number.
fn number_by_first(mut group: Vec<u32>, budget: &Budget) -> Result<Coincident, Stopped> {
    let mut first = Vec::new();
    for begin in (0..group.len()).step_by(CHECK_EVERY) {
        budget.check()?;
        for i in begin..(begin + CHECK_EVERY).min(group.len()) {
            let f = group[i] as usize;
            if f == i {
                group[i] = first.len() as u32;
                first.push(i as u32);
            } else {
                group[i] = group[f];
            }
        }
    }
    Ok(Coincident { group, first })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    fn by_map<K: CoordinateKey + std::hash::Hash>(keys: &[K]) -> Coincident {
        let mut seen = HashMap::new();
        let mut first = Vec::new();
        let group = (0..keys.len() as u32)
            .map(|i| {
                *seen.entry(keys[i as usize]).or_insert_with(|| {
                    first.push(i);
                    first.len() as u32 - 1
                })
            })
            .collect();
        Coincident { group, first }
    }

    fn lattice_points(len: usize, side: u32) -> Vec<DVec3> {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from((state >> 8) % side)
        };
        (0..len).map(|_| DVec3::new(random(), random(), random())).collect()
    }

    #[test]
    fn groups_are_numbered_by_first_occurrence_whatever_the_thread_count() {
        for (len, side) in [(0, 1), (1, 1), (5000, 9), (200_000, 40), (300_000, 1)] {
            let points = lattice_points(len, side);
            let keys: Vec<[u64; 3]> = points.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
            let expected = by_map(&keys);
            for threads in [1, 2, 8] {
                let budget = Budget::unlimited();
                let found = par::with_threads(threads, || {
                    let wide = coincident_f64(&points, &budget).unwrap();
                    let mut group = vec![0; len];
                    let narrow = |i: usize| points[i].to_array().map(|x| x as f32);
                    let first = coincident_f32(narrow, &mut group, &budget).unwrap();
                    (wide, Coincident { group, first })
                });
                assert!(found == (expected.clone(), expected.clone()), "{len} points, {threads} threads");
            }
        }
    }

    #[test]
    fn minus_zero_is_zero_and_nan_equals_itself_bit_for_bit() {
        let other_nan = f64::from_bits(f64::NAN.to_bits() ^ 1);
        let points = [-0.0, f64::NAN, 0.0, other_nan, f64::NAN].map(DVec3::splat);
        let found = coincident_f64(&points, &Budget::unlimited()).unwrap();
        assert_eq!(found.group, [0, 1, 0, 2, 1]);
        assert_eq!(found.first, [0, 1, 3]);
    }

    /// A key with the worst hash there is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
    struct Colliding(u32);

    impl CoordinateKey for Colliding {
        fn hash(self) -> u64 {
            7
        }

        fn quick_hash(self) -> u64 {
            7
        }
    }

    #[test]
    fn colliding_hashes_are_grouped_by_sorting() {
        let keys: Vec<Colliding> = (0..200_000).map(|i| Colliding(i * 7919 % 60_000)).collect();
        let mut group = vec![0; keys.len()];
        let first = group_by_key(|i| keys[i], &mut group, &Budget::unlimited()).unwrap();
        assert_eq!(Coincident { group, first }, by_map(&keys));
    }

    #[test]
    fn a_raised_stop_flag_ends_the_grouping() {
        let stop = crate::budget::StopFlag::default();
        stop.cancel();
        let budget = Budget::new(stop, u64::MAX, u64::MAX);
        assert_eq!(coincident_f64(&lattice_points(10, 2), &budget), Err(Stopped::Cancelled));
    }
}
