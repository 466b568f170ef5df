//! A priority queue of numbered items whose keys change.
//!
//! The order is total and exact: by key, then by item. Only the items whose turn is near are in order; the others lie
//! unsorted in buckets by the leading bits of their keys. When the turn of a bucket comes it is sorted, and only what comes
//! to it later is in a heap. A list by item says which key is the valid one, so that a changed key costs one more entry
//! and old entries are dropped when they are met. The usual indexed heap holds millions of entries, and each of its steps
//! writes to another cache line of the index (`docs/decisions/0012-bucketed-queue.md`).

use super::key::CostKey;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Not in the queue, and not set aside. Keys of finite costs are below it, as the bits of floats.
const OUT: u32 = u32::MAX;
/// Not in the queue until it is put back.
const ASIDE: u32 = u32::MAX - 1;
/// A key's leading bits: the exponent and six bits of the mantissa.
const BUCKET_SHIFT: u32 = 17;
/// One more than the bucket of the largest finite key.
const BUCKETS: usize = 0x7f80_0000 >> BUCKET_SHIFT;

/// Entries that are named ahead of their turn, together.
pub(super) const AHEAD: usize = 32;

/// Items `0..bound` with keys, the smallest first; among equal keys the smallest item.
#[derive(Debug, Clone)]
pub(super) struct Queue {
    /// The valid key of each item, or [`OUT`] or [`ASIDE`].
    keys: Vec<u32>,
    /// Items in buckets from `next_bucket` on; those whose valid key belongs to another bucket are not in this one.
    buckets: Vec<Vec<u32>>,
    next_bucket: usize,
    /// What was in the bucket before, descending; entries whose key is not the item's valid one do not count.
    sorted: Vec<QueueEntry>,
    /// The first so many of `sorted` have not been named ahead.
    unnamed: usize,
    /// What came to earlier buckets when their turn had come; entries whose key is not the item's valid one do not count.
    near: BinaryHeap<Reverse<QueueEntry>>,
}

/// A key and, in the lower half, its item.
type QueueEntry = u64;

fn entry(key: u32, item: u32) -> QueueEntry {
    u64::from(key) << 32 | u64::from(item)
}

fn bucket_of(key: u32) -> usize {
    (key >> BUCKET_SHIFT) as usize
}

impl Queue {
    /// A queue of `items`, each at most once and below `bound`. O(n).
    pub(super) fn new(items: &[(u32, CostKey)], bound: usize) -> Self {
        let mut sizes = vec![0usize; BUCKETS];
        items.iter().for_each(|&(_, key)| sizes[bucket_of(key.bits())] += 1);
        let mut queue = Self {
            keys: vec![OUT; bound],
            buckets: sizes.into_iter().map(Vec::with_capacity).collect(),
            next_bucket: 0,
            sorted: Vec::new(),
            unnamed: 0,
            near: BinaryHeap::new(),
        };
        for &(item, key) in items {
            queue.keys[item as usize] = key.bits();
            queue.buckets[bucket_of(key.bits())].push(item);
        }
        queue
    }

    /// Takes the smallest entry out; nothing when the queue is empty.
    #[inline]
    pub(super) fn pop(&mut self) -> Option<(u32, CostKey)> {
        loop {
            let first = match (self.sorted.last(), self.near.peek()) {
                (None, None) => {
                    self.next_bucket()?;
                    continue;
                }
                (Some(sorted), Some(Reverse(near))) if sorted < near => self.sorted.pop(),
                (Some(_), None) => self.sorted.pop(),
                _ => self.near.pop().map(|Reverse(first)| first),
            }?;
            let (key, item) = ((first >> 32) as u32, first as u32);
            let valid = &mut self.keys[item as usize];
            if *valid == key {
                *valid = OUT;
                return Some((item, CostKey::from_bits(key)));
            }
        }
    }

    /// Sorts the first bucket that has items; nothing when there is none.
    fn next_bucket(&mut self) -> Option<()> {
        while self.sorted.is_empty() {
            let bucket = self.next_bucket;
            let items = std::mem::take(self.buckets.get_mut(bucket)?);
            self.next_bucket += 1;
            let with_key = |item: u32| (self.keys[item as usize], item);
            let is_here = |&(key, _): &(u32, u32)| key < ASIDE && bucket_of(key) == bucket;
            let entries = items.into_iter().map(with_key).filter(is_here);
            self.sorted.extend(entries.map(|(key, item)| entry(key, item)));
        }
        self.sorted.sort_unstable_by(|a, b| b.cmp(a));
        self.unnamed = self.sorted.len();
        Some(())
    }

    /// Items whose turn is near, unless they have been named before: their owner may read what it will need of all of
    /// them at once. None of them when nothing is new.
    #[inline]
    pub(super) fn ahead(&mut self) -> impl Iterator<Item = u32> {
        let end = self.unnamed;
        if self.sorted.len() <= end {
            self.unnamed = end.saturating_sub(AHEAD);
        }
        let named = self.unnamed.min(self.sorted.len())..end.min(self.sorted.len());
        let keys = &self.keys;
        self.sorted[named].iter().filter_map(|&entry| {
            let (key, item) = ((entry >> 32) as u32, entry as u32);
            (keys[item as usize] == key).then_some(item)
        })
    }

    /// The key of an item, if it is in the queue.
    #[inline]
    pub(super) fn key(&self, item: u32) -> Option<CostKey> {
        Some(self.keys[item as usize]).filter(|&key| key < ASIDE).map(CostKey::from_bits)
    }

    /// Puts an item in, or gives it another key.
    #[inline]
    pub(super) fn set(&mut self, item: u32, key: CostKey) {
        let new = key.bits();
        if std::mem::replace(&mut self.keys[item as usize], new) == new {
            return;
        }
        let bucket = bucket_of(new);
        if bucket < self.next_bucket {
            self.near.push(Reverse(entry(new, item)));
        } else {
            self.buckets[bucket].push(item);
        }
    }

    /// Takes an item out, wherever it is.
    #[inline]
    pub(super) fn take_out(&mut self, item: u32) {
        self.keys[item as usize] = OUT;
    }

    /// Takes an item out and marks it as set aside.
    #[inline]
    pub(super) fn set_aside(&mut self, item: u32) {
        self.keys[item as usize] = ASIDE;
    }

    /// True for an item that is set aside.
    #[inline]
    pub(super) fn is_aside(&self, item: u32) -> bool {
        self.keys[item as usize] == ASIDE
    }

    /// The items that are set aside, ascending.
    pub(super) fn aside(&self) -> Vec<u32> {
        (0..self.keys.len() as u32).filter(|&item| self.is_aside(item)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn key(x: f64) -> CostKey {
        CostKey::of(x).unwrap()
    }

    fn smallest(model: &BTreeMap<u32, CostKey>) -> Option<(u32, CostKey)> {
        model.iter().map(|(&item, &key)| (item, key)).min_by_key(|&(item, key)| (key, item))
    }

    #[test]
    fn random_changes_give_what_an_ordered_map_gives() {
        let mut state = 5u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for round in 0..400 {
            let bound = 1 + random(60);
            // Few different keys, near to one another or in different buckets.
            let step = [0.001, 1.0, 1e5][round % 3];
            let mut items = Vec::new();
            for item in 0..bound {
                if random(2) == 0 {
                    items.push((item, key(1.0 + step * f64::from(random(9)))));
                }
            }
            let mut model: BTreeMap<u32, CostKey> = items.iter().copied().collect();
            let mut queue = Queue::new(&items, bound as usize);
            for _ in 0..300 {
                let item = random(bound);
                match random(5) {
                    0 | 1 => {
                        let first = smallest(&model);
                        assert_eq!(queue.pop(), first, "round {round}");
                        first.map(|(item, _)| model.remove(&item));
                    }
                    2 => {
                        queue.take_out(item);
                        model.remove(&item);
                    }
                    _ => {
                        let key = key(1.0 + step * f64::from(random(9)));
                        queue.set(item, key);
                        model.insert(item, key);
                    }
                }
                assert_eq!(queue.key(item), model.get(&item).copied());
            }
        }
    }

    #[test]
    fn what_is_set_aside_is_not_in_the_queue_until_it_is_put_back() {
        let mut queue = Queue::new(&[(0, key(1.0)), (1, key(2.0))], 3);
        assert_eq!(queue.pop(), Some((0, key(1.0))));
        queue.set_aside(0);
        assert_eq!((queue.aside(), queue.key(0)), (vec![0], None));
        queue.set(0, key(5.0));
        assert!(!queue.is_aside(0));
        assert_eq!(queue.pop(), Some((1, key(2.0))));
        assert_eq!(queue.pop(), Some((0, key(5.0))));
        assert_eq!(queue.pop(), None);
    }
}
