//! Values of pixels, where most pixels may be empty.

use super::FragmentList;
use rayon::prelude::*;

/// Pixels of a word.
const BITS: usize = u64::BITS as usize;

/// A value for every pixel that has fragments; an empty one takes a bit and a half.
#[derive(Debug)]
pub struct OfFilled<T> {
    /// A bit a pixel.
    is_filled: Vec<u64>,
    /// Pixels with fragments before each word.
    before: Vec<u64>,
    values: Vec<T>,
}

impl<T: Send> OfFilled<T> {
    /// What `value` gives for each pixel of a list that has fragments, on all cores.
    pub fn of(list: &FragmentList, value: impl Fn(usize) -> T + Send + Sync) -> Self {
        let mut is_filled = vec![0u64; list.pixels().div_ceil(BITS)];
        let mut filled = Vec::new();
        let pixels = list.offsets().windows(2).enumerate();
        for (p, _) in pixels.filter(|(_, ends)| ends[0] < ends[1]) {
            is_filled[p / BITS] |= 1 << (p % BITS);
            filled.push(p);
        }
        let before = is_filled
            .iter()
            .scan(0, |sum, word| {
                Some(std::mem::replace(sum, *sum + u64::from(word.count_ones())))
            })
            .collect();
        let values = filled.into_par_iter().with_min_len(64).map(value).collect();
        Self {
            is_filled,
            before,
            values,
        }
    }

    /// The value of a pixel; none where it has no fragments.
    pub fn get(&self, p: usize) -> Option<&T> {
        let (word, bit) = (self.is_filled[p / BITS], p % BITS);
        if word >> bit & 1 == 0 {
            return None;
        }
        let within = u64::from((word & ((1 << bit) - 1)).count_ones());
        Some(&self.values[(self.before[p / BITS] + within) as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel finds its own value, and empty ones none, whatever the pattern and wherever words end.
    #[test]
    fn pixels_find_their_values() {
        for every in [1, 2, 3, 64, 65, 1000] {
            let pixels = 300;
            let offsets: Vec<u64> = (0..=pixels as u64).map(|p| p.div_ceil(every)).collect();
            let n = *offsets.last().unwrap() as usize;
            let list = FragmentList::new(offsets, vec![1.0; n], vec![0.5; n], None).unwrap();
            let values = OfFilled::of(&list, |p| p);
            for p in 0..pixels {
                let expected = (p as u64).is_multiple_of(every).then_some(p);
                assert_eq!(values.get(p).copied(), expected, "{p} of every {every}");
            }
        }
        let empty = FragmentList::new(vec![0; 65], vec![], vec![], None).unwrap();
        assert!(OfFilled::of(&empty, |p| p).get(63).is_none());
    }
}
