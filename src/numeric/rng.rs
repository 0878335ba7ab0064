//! Counter-based random streams: any item of a random sequence can be made alone, in any order, on any thread.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, u32x16};
use rand::TryRng;
use std::convert::Infallible;

/// Words of one block of ChaCha.
const BLOCK: usize = 16;

/// Blocks that are made at once: two chains of four, of which one computes while the other waits for its results.
const BLOCKS: usize = 8;

/// Words that [`Stream::peek`] shows.
const AHEAD: usize = 8;

/// Number of words kept.
const WORDS: usize = AHEAD + BLOCKS * BLOCK;

/// The first four words of every block's state: "expand 32-byte k".
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];

/// The generator behind one stream: ChaCha8 with a 64-bit block counter, in explicit SIMD.
///
/// # Source
/// D. J. Bernstein, *ChaCha, a variant of Salsa20*, 2008, with 8 rounds.
#[derive(Debug, Clone)]
pub struct Stream {
    key: [[u32; 4]; 2],
    nonce: u64,
    /// The next block to be made.
    block: u64,
    /// The last few of the blocks before, then the blocks made last.
    words: [u32; WORDS],
    /// The next of the words; all are used up where it is their number.
    at: usize,
}

/// The stream of item `index` of the sequence that `seed` and `purpose` name.
///
/// ChaCha8 with key = (seed, purpose) and nonce = index: streams of different items never overlap, and
/// `purpose` keeps, say, training and validation pixels of one seed apart.
pub fn stream(seed: u64, purpose: u64, index: u64) -> Stream {
    let words = |x: u64| [x as u32, (x >> 32) as u32];
    let [[s0, s1], [p0, p1]] = [words(seed), words(purpose)];
    Stream {
        key: [[s0, s1, p0, p1], [0; 4]],
        nonce: index,
        block: 0,
        words: [0; WORDS],
        at: WORDS,
    }
}

/// Uniform in [0, 1), a multiple of 2^−52: the upper bits of the number that two words make.
#[inline(always)]
pub fn unit([low, high]: [u32; 2]) -> f64 {
    let mantissa = (u64::from(high) << 32 | u64::from(low)) >> 12;
    f64::from_bits(0x3ff0_0000_0000_0000 | mantissa) - 1.0
}

impl Stream {
    /// The next words, which are not used up.
    #[inline(always)]
    pub fn peek(&mut self) -> &[u32; AHEAD] {
        if self.at > WORDS - AHEAD {
            self.refill();
        }
        self.words[self.at..].first_chunk().expect("as many are left")
    }

    /// All words at hand that follow, eight at least, which are not used up.
    #[inline]
    pub fn words(&mut self) -> &[u32] {
        self.peek();
        &self.words[self.at..]
    }

    /// Uses up words, no more than [`Self::peek`] or [`Self::words`] has shown.
    #[inline(always)]
    pub fn skip(&mut self, words: usize) {
        self.at += words;
    }

    /// The next number of [`unit()`].
    #[inline(always)]
    pub fn unit(&mut self) -> f64 {
        let &[low, high, ..] = self.peek();
        self.skip(2);
        unit([low, high])
    }

    /// As many numbers of [`unit()`] as there is room for.
    pub fn units(&mut self, mut out: &mut [f64]) {
        while !out.is_empty() {
            let pairs = self.words[self.at..].as_chunks::<2>().0;
            if pairs.is_empty() {
                self.peek();
                continue;
            }
            let (now, later) = out.split_at_mut(out.len().min(pairs.len()));
            now.iter_mut().zip(pairs).for_each(|(out, &pair)| *out = unit(pair));
            self.at += 2 * now.len();
            out = later;
        }
    }

    /// Makes the next blocks; what is left of those before stands in front of them.
    #[inline(never)]
    fn refill(&mut self) {
        let left = WORDS - self.at;
        self.words.copy_within(self.at.., AHEAD - left);
        dispatch!(Level::new(), simd => self.refill_with(simd));
        self.at = AHEAD - left;
    }

    #[inline(always)]
    fn refill_with<S: Simd>(&mut self, simd: S) {
        // A chain holds four blocks, each row of their states in one vector.
        let row = |row: [u32; 4]| u32x16::simd_from(simd, std::array::from_fn::<u32, 16, _>(|i| row[i % 4]));
        let last_row = |first: u64| {
            let words = |block: u64| {
                [
                    block as u32,
                    (block >> 32) as u32,
                    self.nonce as u32,
                    (self.nonce >> 32) as u32,
                ]
            };
            let rows: [[u32; 4]; 4] = std::array::from_fn(|i| words(first.wrapping_add(i as u64)));
            u32x16::simd_from(simd, std::array::from_fn::<u32, 16, _>(|i| rows[i / 4][i % 4]))
        };
        let start = |first: u64| [row(CONSTANTS), row(self.key[0]), row(self.key[1]), last_row(first)];
        let starts: [[u32x16<S>; 4]; 2] = [start(self.block), start(self.block.wrapping_add(4))];
        let mut chains = starts;
        for _ in 0..4 {
            for chain in &mut chains {
                quarter_rounds(chain);
            }
            // The diagonals stand below one another once rows 1 to 3 are turned.
            for [_, b, c, d] in &mut chains {
                (*b, *c, *d) = (
                    b.slide_within_blocks::<1>(*b),
                    c.slide_within_blocks::<2>(*c),
                    d.slide_within_blocks::<3>(*d),
                );
            }
            for chain in &mut chains {
                quarter_rounds(chain);
            }
            for [_, b, c, d] in &mut chains {
                (*b, *c, *d) = (
                    b.slide_within_blocks::<3>(*b),
                    c.slide_within_blocks::<2>(*c),
                    d.slide_within_blocks::<1>(*d),
                );
            }
        }
        for ((chain, start), words) in chains
            .iter()
            .zip(&starts)
            .zip(self.words[AHEAD..].chunks_exact_mut(4 * BLOCK))
        {
            for (row, (sum, start)) in chain.iter().zip(start).enumerate() {
                let sum: [u32; 16] = (*sum + *start).into();
                for (block, words) in words.chunks_exact_mut(BLOCK).enumerate() {
                    words[4 * row..4 * row + 4].copy_from_slice(&sum[4 * block..4 * block + 4]);
                }
            }
        }
        self.block = self.block.wrapping_add(BLOCKS as u64);
    }
}

/// The four quarter rounds of a round, on the columns of four states.
#[inline(always)]
fn quarter_rounds<S: Simd>([a, b, c, d]: &mut [u32x16<S>; 4]) {
    #[inline(always)]
    fn turned<S: Simd, const N: u32>(x: u32x16<S>) -> u32x16<S> {
        (x << N) | (x >> (32 - N))
    }
    *a += *b;
    *d = turned::<S, 16>(*d ^ *a);
    *c += *d;
    *b = turned::<S, 12>(*b ^ *c);
    *a += *b;
    *d = turned::<S, 8>(*d ^ *a);
    *c += *d;
    *b = turned::<S, 7>(*b ^ *c);
}

impl TryRng for Stream {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        let word = self.peek()[0];
        self.skip(1);
        Ok(word)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let &[low, high, ..] = self.peek();
        self.skip(2);
        Ok(u64::from(high) << 32 | u64::from(low))
    }

    fn try_fill_bytes(&mut self, out: &mut [u8]) -> Result<(), Infallible> {
        for chunk in out.chunks_mut(4) {
            chunk.copy_from_slice(&self.try_next_u32()?.to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn streams_differ_by_every_coordinate_and_repeat() {
        let first = |s, p, i| stream(s, p, i).next_u64();
        assert_eq!(first(1, 2, 3), first(1, 2, 3));
        assert_ne!(first(1, 2, 3), first(2, 2, 3));
        assert_ne!(first(1, 2, 3), first(1, 3, 3));
        assert_ne!(first(1, 2, 3), first(1, 2, 4));
    }

    fn theirs(seed: u64, purpose: u64, index: u64) -> ChaCha8Rng {
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&purpose.to_le_bytes());
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(index);
        rng
    }

    /// Word for word what an independent ChaCha8 gives, in any mixture of single and double words and bytes. Control:
    /// the neighbouring stream.
    #[test]
    fn words_are_those_of_chacha8() {
        let big = 0x0123_4567_89ab_cdef;
        for (seed, purpose, index) in [
            (0, 0, 0),
            (1, 2, 3),
            (u64::MAX, big, 1 << 63),
            (big, 0x1005, (1 << 40) + 7),
        ] {
            let (mut ours, mut theirs, mut other) = (
                stream(seed, purpose, index),
                theirs(seed, purpose, index),
                theirs(seed, purpose, index ^ 1),
            );
            for i in 0..5000 {
                if i % 3 == 0 || i % 7 == 0 {
                    assert_eq!(ours.next_u32(), theirs.next_u32(), "call {i}");
                } else {
                    let word = ours.next_u64();
                    assert_eq!(word, theirs.next_u64(), "call {i}");
                    assert_ne!(word, other.next_u64());
                }
            }
            let (mut a, mut b) = ([0; 4096], [0; 4096]);
            ours.fill_bytes(&mut a);
            theirs.fill_bytes(&mut b);
            assert_eq!(a, b);
        }
    }

    /// Numbers made many at a time are those made one by one, and multiples of 2^−52 below 1; words shown are words to
    /// come.
    #[test]
    fn units_follow_the_words() {
        let (mut many, mut one) = (stream(1, 2, 4), stream(1, 2, 4));
        for n in [1, 0, 3, 64, 65, 200, 1000, 7].repeat(3) {
            let mut out = vec![f64::NAN; n];
            many.units(&mut out);
            for u in out {
                let expected = (one.next_u64() >> 12) as f64 / (1u64 << 52) as f64;
                assert!(u == expected && (0.0..1.0).contains(&u));
            }
            let shown = *many.peek();
            assert!(many.words().starts_with(&shown));
            assert_eq!(many.next_u32(), one.next_u32());
            many.skip(6);
            assert_eq!(shown[1..7], std::array::from_fn::<u32, 6, _>(|_| one.next_u32()));
            assert_eq!(many.unit(), unit([one.next_u32(), one.next_u32()]));
        }
    }

    /// The same at the least SIMD level, and across the carry of the counter's lower half.
    #[test]
    fn words_depend_on_no_simd_level() {
        let mut theirs = theirs(5, 6, 7);
        theirs.set_word_pos(((1u128 << 32) - 12) * BLOCK as u128);
        let mut ours = stream(5, 6, 7);
        ours.block = (1 << 32) - 12;
        for level in [Level::baseline(), Level::new(), Level::baseline()] {
            dispatch!(level, simd => ours.refill_with(simd));
            assert!(ours.words[AHEAD..].iter().all(|&word| word == theirs.next_u32()));
        }
    }
}
