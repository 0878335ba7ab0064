//! Content hashes.

use hmac_sha256::Hash;

/// SHA-256 of the concatenated parts, as 64 lower-case hexadecimal digits.
pub fn sha256_hex<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash = Hash::new();
    for part in parts {
        hash.update(part);
    }
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    /// The digest of "abc" that FIPS 180-2 prints.
    #[test]
    fn known_answer() {
        assert_eq!(
            super::sha256_hex([b"a".as_slice(), b"bc"]),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
