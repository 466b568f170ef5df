//! The only file that starts engine threads.
//!
//! Chunk boundaries are fixed by the caller, never by the number of threads, and results come back in index order, so
//! every result is the same with one thread or many.

use rayon::prelude::*;
use std::ops::Range;

/// Runs `body` with `threads` engine threads (0: one for each core). Nothing inside may depend on the number.
///
/// Falls back to the current pool when the system refuses new threads.
pub fn with_threads<T: Send>(threads: usize, body: impl FnOnce() -> T + Send) -> T {
    Threads::start(threads).run(body)
}

/// Engine threads of their own.
#[derive(Debug)]
pub struct Threads(Option<rayon::ThreadPool>);

impl Threads {
    /// Starts so many; 0, or when the system refuses them: those of the current pool.
    pub fn start(threads: usize) -> Self {
        let start = || rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok();
        Self(if threads == 0 { None } else { start() })
    }

    /// Runs `body` with them.
    pub fn run<T: Send>(&self, body: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(body),
            None => body(),
        }
    }
}

/// Calls `body` with consecutive ranges of at most `chunk` indices that cover `0..len`; results in range order.
pub fn map_ranges<R: Send>(len: usize, chunk: usize, body: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let chunk = chunk.max(1);
    (0..len.div_ceil(chunk)).into_par_iter().map(|i| body(i * chunk..((i + 1) * chunk).min(len))).collect()
}

/// The values of `body` for the indices `0..len`, in their order, `chunk` or more of them by one thread at a time. The list is made once
/// and written in place, so this is for small values.
pub fn map_indices<T: Send>(len: usize, chunk: usize, body: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..len).into_par_iter().with_min_len(chunk.max(1)).map(&body).collect()
}

/// As [`map_ranges`] for bodies that can fail; of several failures the one of the lowest range is returned.
pub fn try_map_ranges<R: Send, E: Send>(
    len: usize,
    chunk: usize,
    body: impl Fn(Range<usize>) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    map_ranges(len, chunk, body).into_iter().collect()
}

/// Calls `body` with the index of each item and the item; results in item order. For a few large items.
pub fn map_items<T: Send, R: Send>(items: Vec<T>, body: impl Fn(usize, T) -> R + Sync) -> Vec<R> {
    items.into_par_iter().enumerate().map(|(i, item)| body(i, item)).collect()
}

/// Calls `body` with consecutive chunks of `items` and the index of their first item.
pub fn for_each_chunk_mut<T: Send>(items: &mut [T], chunk: usize, body: impl Fn(usize, &mut [T]) + Sync) {
    let chunk = chunk.max(1);
    items.par_chunks_mut(chunk).enumerate().for_each(|(i, part)| body(i * chunk, part));
}

/// Runs both, possibly at the same time.
pub fn join<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

/// Sorts by a total order; items that compare equal must be equal.
pub fn sort_unstable<T: Ord + Send>(items: &mut [T]) {
    items.par_sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_cover_every_index_once_in_order_whatever_the_thread_count() {
        for threads in [1, 2, 8] {
            let ranges = with_threads(threads, || map_ranges(10, 4, |r| r));
            assert_eq!(ranges, [0..4, 4..8, 8..10]);
        }
        assert!(map_ranges(0, 4, |r| r).is_empty());
        for threads in [1, 2, 8] {
            let squares = with_threads(threads, || map_indices(100, 7, |i| i * i));
            assert!(squares.into_iter().eq((0..100).map(|i| i * i)));
        }
    }

    #[test]
    fn the_failure_of_the_lowest_range_wins() {
        let result = try_map_ranges(100, 10, |r| if r.start >= 30 { Err(r.start) } else { Ok(()) });
        assert_eq!(result.unwrap_err(), 30);
    }
}
