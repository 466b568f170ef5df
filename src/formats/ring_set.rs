//! A set of numbers below a bound, of which the next one in a ring is found quickly.

/// Bits in words, and above each word a bit that says whether it has any.
#[derive(Debug, Default)]
pub(super) struct RingSet {
    /// The numbers themselves first.
    levels: Vec<Vec<u64>>,
}

impl RingSet {
    /// Empties it, for numbers below `bound`.
    pub(super) fn reset(&mut self, bound: usize) {
        self.levels.clear();
        let mut words = bound.div_ceil(64).max(1);
        loop {
            self.levels.push(vec![0; words]);
            if words == 1 {
                return;
            }
            words = words.div_ceil(64);
        }
    }

    pub(super) fn insert(&mut self, number: u32) {
        let mut i = number as usize;
        for words in &mut self.levels {
            words[i / 64] |= 1 << (i % 64);
            i /= 64;
        }
    }

    pub(super) fn remove(&mut self, number: u32) {
        let mut i = number as usize;
        for words in &mut self.levels {
            words[i / 64] &= !(1 << (i % 64));
            if words[i / 64] != 0 {
                return;
            }
            i /= 64;
        }
    }

    /// The first from `from` on, or else the first of all.
    pub(super) fn next(&self, from: u32) -> Option<u32> {
        self.at_least(from).or_else(|| self.at_least(0))
    }

    /// The last before `from`, or else the last of all.
    pub(super) fn previous(&self, from: u32) -> Option<u32> {
        let last = self.levels[0].len() as u32 * 64 - 1;
        from.checked_sub(1).and_then(|most| self.at_most(most)).or_else(|| self.at_most(last))
    }

    fn at_least(&self, from: u32) -> Option<u32> {
        let mut i = from as usize;
        for (level, words) in self.levels.iter().enumerate() {
            let rest = words.get(i / 64).map_or(0, |word| word & (u64::MAX << (i % 64)));
            if rest != 0 {
                let mut found = i / 64 * 64 + rest.trailing_zeros() as usize;
                for below in self.levels[..level].iter().rev() {
                    found = found * 64 + below[found].trailing_zeros() as usize;
                }
                return Some(found as u32);
            }
            i = i / 64 + 1;
        }
        None
    }

    fn at_most(&self, from: u32) -> Option<u32> {
        let mut i = from as usize;
        for (level, words) in self.levels.iter().enumerate() {
            let rest = words[i / 64] & (u64::MAX >> (63 - i % 64));
            if rest != 0 {
                let mut found = i / 64 * 64 + rest.ilog2() as usize;
                for below in self.levels[..level].iter().rev() {
                    found = found * 64 + below[found].ilog2() as usize;
                }
                return Some(found as u32);
            }
            i = (i / 64).checked_sub(1)?;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn neighbours_in_the_ring_are_those_of_a_plain_set() {
        let mut state = 1u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        for bound in [1, 63, 64, 65, 4096, 5000, 300_000] {
            let (mut set, mut plain) = (RingSet::default(), BTreeSet::new());
            set.reset(bound as usize);
            for round in 0..3000 {
                let number = random(bound);
                if round % 3 == 2 || (round > 2000 && plain.len() > 2) {
                    let gone = plain.iter().copied().nth(random(plain.len().max(1) as u32) as usize);
                    let gone = gone.unwrap_or(number);
                    set.remove(gone);
                    plain.remove(&gone);
                } else {
                    set.insert(number);
                    plain.insert(number);
                }
                let from = random(bound);
                let next = plain.range(from..).next().or(plain.first()).copied();
                let previous = plain.range(..from).next_back().or(plain.last()).copied();
                assert_eq!((set.next(from), set.previous(from)), (next, previous), "{bound} {round}");
            }
        }
    }
}
