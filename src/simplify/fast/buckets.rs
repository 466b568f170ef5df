//! Half-edges in the order of their costs, as far as a fixed number of classes tells them apart.

/// Classes to a doubling of the cost: a cost is told from one a quarter larger.
const CLASSES_TO_DOUBLE_LOG2: u32 = 2;

/// Number of classes.
pub(super) const CLASSES: usize = 1024;

/// The largest cost with a class of its own. A working copy is about a thousand units large, so areas times squared
/// distances are far below, and the smallest class is for costs of about 2^-176.
const LARGEST: f64 = (1u128 << 80) as f64;

const fn steps(cost: f64) -> i64 {
    (cost.to_bits() >> (52 - CLASSES_TO_DOUBLE_LOG2)) as i64
}

/// The class of a cost; none when it is not a finite number. A negative cost is rounding about zero.
#[inline]
pub(super) fn class_of(cost: f64) -> Option<usize> {
    const OFFSET: i64 = steps(LARGEST) - (CLASSES as i64 - 1);
    cost.is_finite().then(|| (steps(cost.max(0.0)) - OFFSET).clamp(0, CLASSES as i64 - 1) as usize)
}

/// In the place of the next half-edge: not in the queue.
const ABSENT: u32 = u32::MAX;
/// Not in the queue, but to be put back when its surroundings change.
const ASIDE: u32 = u32::MAX - 1;
/// In the queue, the last of its class.
const END: u32 = u32::MAX - 2;

/// A queue of half-edges: a list for each class, threaded through one array. Adding and taking is O(1).
#[derive(Debug)]
pub(super) struct Buckets {
    first: Vec<u32>,
    next: Vec<u32>,
    /// No smaller class has a half-edge.
    lowest: usize,
}

impl Buckets {
    /// An empty queue for half-edges below `bound`.
    pub(super) fn new(bound: usize) -> Self {
        Self { first: vec![END; CLASSES], next: vec![ABSENT; bound], lowest: CLASSES }
    }

    /// Adds `h`, which must not be in the queue.
    #[inline]
    pub(super) fn push(&mut self, h: u32, class: usize) {
        self.next[h as usize] = self.first[class];
        self.first[class] = h;
        self.lowest = self.lowest.min(class);
    }

    /// Takes a half-edge of the smallest class, if that is at most `class_max`.
    #[inline]
    pub(super) fn pop(&mut self, class_max: usize) -> Option<(u32, usize)> {
        while self.lowest <= class_max && self.lowest < CLASSES {
            let h = self.first[self.lowest];
            if h != END {
                self.first[self.lowest] = self.next[h as usize];
                self.next[h as usize] = ABSENT;
                return Some((h, self.lowest));
            }
            self.lowest += 1;
        }
        None
    }

    /// The smallest class that may have a half-edge; [`CLASSES`] when there is none.
    pub(super) fn lowest(&self) -> usize {
        self.lowest
    }

    #[inline]
    pub(super) fn is_queued(&self, h: u32) -> bool {
        self.next[h as usize] < ASIDE
    }

    /// Puts `h`, which is not in the queue, aside.
    #[inline]
    pub(super) fn set_aside(&mut self, h: u32) {
        self.next[h as usize] = ASIDE;
    }

    /// Puts those that are set aside back into the queue.
    #[inline]
    pub(super) fn put_back(&mut self, half_edges: [u32; 2], class: usize) {
        for h in half_edges {
            if self.is_aside(h) {
                self.push(h, class);
            }
        }
    }

    #[inline]
    pub(super) fn is_aside(&self, h: u32) -> bool {
        self.next[h as usize] == ASIDE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_costs_have_no_larger_classes_and_a_quarter_more_is_seen() {
        let of: Vec<usize> = (0..700).filter_map(|i| class_of(1e20 * 1.26f64.powi(-i))).collect();
        assert!(of.is_sorted_by(|a, b| a >= b), "{of:?}");
        assert!(of[..500].windows(2).all(|w| w[0] > w[1]), "{of:?}");
        assert_eq!((class_of(0.0), class_of(-1e-9), class_of(1e300)), (Some(0), Some(0), Some(CLASSES - 1)));
        assert_eq!((class_of(f64::NAN), class_of(f64::INFINITY)), (None, None));
    }

    #[test]
    fn half_edges_come_out_by_class_and_only_up_to_the_limit() {
        let mut queue = Buckets::new(10);
        for (h, class) in [(3, 7), (4, 2), (5, 7), (6, 9)] {
            queue.push(h, class);
        }
        queue.set_aside(8);
        assert!(queue.is_aside(8) && !queue.is_queued(8) && queue.is_queued(6) && !queue.is_aside(6));
        let mut taken: Vec<_> = std::iter::from_fn(|| queue.pop(8)).collect();
        taken.sort_unstable();
        assert_eq!(taken, [(3, 7), (4, 2), (5, 7)]);
        queue.push(3, 0);
        assert_eq!(
            (queue.pop(CLASSES), queue.pop(CLASSES), queue.pop(CLASSES)),
            (Some((3, 0)), Some((6, 9)), None)
        );
        assert!(!queue.is_queued(6));
    }
}
