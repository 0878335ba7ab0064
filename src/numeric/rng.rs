//! Counter-based random streams: any item of a random sequence can be made alone, in any order, on any thread.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The generator behind one stream.
pub type Stream = ChaCha8Rng;

/// The stream of item `index` of the sequence that `seed` and `purpose` name.
///
/// ChaCha8 with key = (seed, purpose) and nonce = index: streams of different items never overlap, and
/// `purpose` keeps, say, training and validation pixels of one seed apart.
pub fn stream(seed: u64, purpose: u64, index: u64) -> Stream {
    let mut key = [0u8; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&purpose.to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(key);
    rng.set_stream(index);
    rng
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    #[test]
    fn streams_differ_by_every_coordinate_and_repeat() {
        let first = |s, p, i| stream(s, p, i).next_u64();
        assert_eq!(first(1, 2, 3), first(1, 2, 3));
        assert_ne!(first(1, 2, 3), first(2, 2, 3));
        assert_ne!(first(1, 2, 3), first(1, 3, 3));
        assert_ne!(first(1, 2, 3), first(1, 2, 4));
    }
}
