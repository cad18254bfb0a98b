//! Digests of what is read.

use sha2::{Digest, Sha256};
use std::io::{self, Read};

/// A reader that digests the bytes that it reads.
pub(crate) struct Digesting<R> {
    inner: R,
    all: Sha256,
    /// The digest of the first line alone.
    first: Sha256,
    in_first: bool,
}

impl<R> Digesting<R> {
    pub(crate) fn new(inner: R) -> Self {
        Self {
            inner,
            all: Sha256::new(),
            first: Sha256::new(),
            in_first: true,
        }
    }

    /// Returns the digest of everything that was read, and the digest of its first line.
    pub(crate) fn digests(self) -> ([u8; 32], [u8; 32]) {
        (self.all.finalize().into(), self.first.finalize().into())
    }
}

impl<R: Read> Read for Digesting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        let bytes = &buffer[..count];
        self.all.update(bytes);
        if self.in_first {
            let end = bytes.iter().position(|b| *b == b'\n');
            self.first.update(&bytes[..end.unwrap_or(count)]);
            self.in_first = end.is_none();
        }
        Ok(count)
    }
}

/// Returns a digest of several parts. Parts that are split differently have different digests.
pub(crate) fn of_parts(parts: &[&[u8]]) -> [u8; 32] {
    let mut digest = Sha256::new();
    for part in parts {
        digest.update((part.len() as u64).to_le_bytes());
        digest.update(part);
    }
    digest.finalize().into()
}

/// Returns the first half of a digest, which identifies equal contents.
pub(crate) fn short(digest: [u8; 32]) -> [u8; 16] {
    let mut half = [0; 16];
    half.copy_from_slice(&digest[..16]);
    half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_has_its_own_digest() {
        let digests = |text: &str| {
            let mut reader = Digesting::new(text.as_bytes());
            let mut bytes = Vec::new();
            // Reads in small pieces, so that lines end inside pieces and at their ends.
            while (&mut reader).take(3).read_to_end(&mut bytes).unwrap() > 0 {}
            assert_eq!(bytes, text.as_bytes());
            reader.digests()
        };
        let (complete, first) = digests("header\none\n");
        let (longer, same) = digests("header\none\ntwo\n");
        assert_ne!(complete, longer);
        assert_eq!(first, same);
        assert_eq!(first, <[u8; 32]>::from(Sha256::digest(b"header")));
        assert_eq!(complete, <[u8; 32]>::from(Sha256::digest(b"header\none\n")));
    }

    #[test]
    fn parts_do_not_run_into_each_other() {
        assert_ne!(of_parts(&[b"ab", b"c"]), of_parts(&[b"a", b"bc"]));
    }
}
