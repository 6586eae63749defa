//! Damaged copies of good files, for the tests of readers.

use std::io;
use std::path::Path;

/// Numbers that break arithmetic: too large, too small, none at all.
const NUMBERS: [&str; 18] = [
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "1e999",
    "NaN",
    "inf",
    "-inf",
    "2147483648",
    "4294967295",
    "9223372036854775807",
    "18446744073709551616",
    "1e6",
    "65536",
    ".",
    "00000000000000000000000000000001",
];

/// Letters that mean something in most texts.
const SIGNS: &[u8] = b"0123456789-.eE[]{}=,:;#\n\t \"'\\/\0\xff";

/// Whole numbers of four bytes at which counts and offsets overflow.
const WORDS: [u32; 10] = [0, 1, 2, 0x7f, 0xff, 0xffff, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, 0xffff_ffff];

/// Greatest length of a copy: one that grows without end tells nothing of the reader.
const LONGEST: usize = 1 << 16;

/// Damaged copies of a file, without end. The same seed gives the same copies, each of one to four faults: bytes, bits and numbers
/// changed, parts cut out, doubled, repeated or put elsewhere, words put in, and the end cut off.
#[derive(Clone, Debug)]
pub struct Mutants<'a> {
    good: &'a [u8],
    words: &'a [&'a str],
    state: u64,
}

impl<'a> Mutants<'a> {
    /// Creates the copies of a file. `words` mean something to its reader.
    pub fn new(good: &'a [u8], words: &'a [&'a str], seed: u64) -> Self {
        Self { good, words, state: seed }
    }

    /// Returns how many copies a test tries: so many, or as many as `COSMORAMA_MUTANTS` says.
    pub fn count(usual: usize) -> usize {
        std::env::var("COSMORAMA_MUTANTS").ok().and_then(|count| count.parse().ok()).unwrap_or(usual)
    }

    /// Returns a number below a bound: SplitMix64.
    fn below(&mut self, bound: usize) -> usize {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) % bound.max(1) as u64) as usize
    }

    /// Returns a part of some bytes: mostly short, sometimes up to all.
    fn part(&mut self, bytes: &[u8]) -> std::ops::Range<usize> {
        let start = self.below(bytes.len());
        let longest = if self.below(4) == 0 { bytes.len() } else { 16 };
        let length = 1 + self.below(longest);
        start..(start + length).min(bytes.len())
    }

    fn damage(&mut self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        let at = self.below(bytes.len());
        match self.below(11) {
            0 => bytes[at] = self.below(256) as u8,
            1 => bytes[at] ^= 1 << self.below(8),
            2 => bytes[at] = SIGNS[self.below(SIGNS.len())],
            3 => drop(bytes.drain(self.part(&bytes.clone()))),
            4 => {
                let part = bytes[self.part(bytes)].to_vec();
                bytes.splice(at..at, part);
            }
            5 => {
                let part = bytes[self.part(bytes)].to_vec();
                let times = 1 + self.below(64);
                bytes.splice(at..at, part.repeat(times));
            }
            6 => {
                let part = bytes[self.part(bytes)].to_vec();
                let end = (at + part.len()).min(bytes.len());
                bytes.splice(at..end, part);
            }
            7 => bytes.truncate(at),
            8 if !self.words.is_empty() => {
                let word = self.words[self.below(self.words.len())];
                bytes.splice(at..at, word.bytes());
            }
            9 => {
                let word = WORDS[self.below(WORDS.len())].to_le_bytes();
                let end = (at + 4).min(bytes.len());
                bytes.splice(at..end, word);
            }
            _ => self.change_number(bytes, at),
        }
        bytes.truncate(LONGEST);
    }

    /// Puts another number in the place of the next one.
    fn change_number(&mut self, bytes: &mut Vec<u8>, from: usize) {
        let Some(start) = bytes[from..].iter().position(u8::is_ascii_digit).map(|at| from + at) else { return };
        let end = bytes[start..].iter().position(|byte| !(byte.is_ascii_digit() || b".eE".contains(byte)));
        let number = NUMBERS[self.below(NUMBERS.len())];
        bytes.splice(start..end.map_or(bytes.len(), |end| start + end), number.bytes());
    }
}

impl Iterator for Mutants<'_> {
    type Item = Vec<u8>;

    fn next(&mut self) -> Option<Vec<u8>> {
        let mut bytes = self.good.to_vec();
        for _ in 0..1 + self.below(4) {
            self.damage(&mut bytes);
        }
        Some(bytes)
    }
}

/// Makes a TIFF with straight alpha say that its colours are premultiplied by it.
///
/// # Errors
/// When it cannot be read or written, or has no straight alpha.
pub fn say_premultiplied(path: &Path) -> io::Result<()> {
    let mut bytes = std::fs::read(path)?;
    // The tag ExtraSamples: one short number, 2 for straight alpha and 1 for premultiplied colours.
    let tag = [0x52, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 0x02];
    let at = bytes.windows(tag.len()).position(|window| window == tag);
    let at = at.ok_or_else(|| io::Error::other("a TIFF without straight alpha"))?;
    bytes[at + tag.len() - 1] = 1;
    std::fs::write(path, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_damaged_bounded_and_repeatable() {
        let good = b"frame,yaw\n1,20\n2,30.5\n".repeat(40);
        let made = |seed| Mutants::new(&good, &["time"], seed).take(3000).collect::<Vec<_>>();
        let copies = made(1);
        assert_eq!(copies, made(1));
        assert_ne!(copies, made(2));
        assert!(copies.iter().all(|copy| copy.len() <= LONGEST));
        assert!(copies.iter().filter(|copy| **copy != good).count() > 2900);
        let some = |found: &dyn Fn(&[u8]) -> bool| copies.iter().any(|copy| found(copy));
        assert!(some(&|copy| copy.windows(5).any(|word| word == b"1e308")));
        assert!(some(&|copy| copy.windows(4).any(|word| word == b"time")));
        assert!(some(&|copy| good.starts_with(copy) && copy.len() < good.len()));
        assert!(some(&|copy| copy.len() > 2 * good.len()) && some(&<[u8]>::is_empty));
    }
}
