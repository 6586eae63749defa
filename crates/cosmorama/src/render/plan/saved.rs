//! Plans as bytes, and back: nothing that is read is believed before it is checked.

use rayon::prelude::*;
use thiserror::Error;
use twox_hash::XxHash3_128;

use super::band::{Band, Room};
use super::key::PlanKey;
use super::stored::{Stored, stored};
use super::symmetry::Mirrors;
use super::weights::Weights;
use super::{BAND, Compiled};
use crate::render::Resampler;

/// What the bytes begin with.
const MARK: [u8; 16] = *b"cosmorama plan\r\n";

/// The version of what follows, of how plans are computed, and of where in light texels lie: taps tell them by their index.
pub(crate) const FORMAT: u32 = 9;

/// Why bytes are not the plan of a conversion. Another one can always be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlanError {
    /// They are something else.
    #[error("not a plan")]
    NotAPlan,
    /// They are of another version of this library.
    #[error("a plan of version {found}, but this is version {FORMAT}")]
    Version {
        /// Theirs.
        found: u32,
    },
    /// They belong to another conversion.
    #[error("the plan of another conversion")]
    OtherConversion,
    /// Some are missing or not as they were written.
    #[error("damaged or truncated")]
    Damaged,
    /// They are as they were written, but tell of pixels, texels or weights that there are not.
    #[error("a plan of what is not there")]
    Unsound,
}

/// What stands before the bands.
struct Head {
    mark: [u8; 16],
    format: u32,
    key: u128,
    /// Of all that follows.
    checksum: u128,
}

stored!(Head { mark: [u8; 16], format: u32, key: u128, checksum: u128 });

impl<W: Weights> Compiled<W> {
    /// That of the conversion which has this key.
    pub(crate) fn to_bytes(&self, key: PlanKey) -> Vec<u8> {
        // What a plan holds takes in memory what it takes as bytes, or more: with room for all there is no second copy.
        let of_bands = (u64::LEAST + Band::<W>::LEAST) * self.bands.len();
        let mut bytes = Vec::with_capacity(Head::LEAST + u64::LEAST + of_bands + self.bytes());
        let room = bytes.capacity();
        bytes.resize(Head::LEAST, 0);
        let lengths = bytes.len();
        vec![0u64; self.bands.len()].store(&mut bytes);
        for (index, band) in self.bands.iter().enumerate() {
            let first = bytes.len();
            band.store(&mut bytes);
            let length = ((bytes.len() - first) as u64).to_le_bytes();
            // Behind how many there are.
            bytes[lengths + u64::LEAST * (1 + index)..][..u64::LEAST].copy_from_slice(&length);
        }
        let checksum = XxHash3_128::oneshot(&bytes[Head::LEAST..]);
        let mut head = Vec::with_capacity(Head::LEAST);
        Head { mark: MARK, format: FORMAT, key: key.0, checksum }.store(&mut head);
        bytes[..Head::LEAST].copy_from_slice(&head);
        debug_assert_eq!(bytes.capacity(), room, "no second copy");
        bytes
    }

    /// The plan of a conversion that has this key.
    pub(crate) fn from_bytes(mut bytes: &[u8], key: PlanKey, resampler: &Resampler) -> Result<Self, PlanError> {
        let Some(head) = Head::load(&mut bytes).filter(|head| head.mark == MARK) else {
            return Err(PlanError::NotAPlan);
        };
        if head.format != FORMAT {
            return Err(PlanError::Version { found: head.format });
        }
        if head.key != key.0 {
            return Err(PlanError::OtherConversion);
        }
        if head.checksum != XxHash3_128::oneshot(bytes) {
            return Err(PlanError::Damaged);
        }
        let mirrors = Mirrors::of::<W>(resampler);
        let parts = parts(&mut bytes).filter(|parts| parts.len() == mirrors.rows.div_ceil(BAND));
        let parts = parts.ok_or(PlanError::Unsound)?;
        let band = |(index, mut bytes): (usize, &[u8])| {
            let rows = mirrors.band(index);
            let room = Room { world: resampler.world, mirrors: &mirrors, first_row: rows.start, rows: rows.len() };
            let band = Band::<W>::load(&mut bytes).filter(|band| bytes.is_empty() && band.is_sound(&room));
            band.ok_or(PlanError::Unsound)
        };
        let bands = parts.into_par_iter().enumerate().map(band).collect::<Result<_, _>>()?;
        let (width, height) = (resampler.target.width(), resampler.target.height());
        Ok(Self { width, height, anti_ringing: resampler.filter.anti_ringing, mirrors, bands })
    }
}

/// The bytes of each band.
fn parts<'a>(bytes: &mut &'a [u8]) -> Option<Vec<&'a [u8]>> {
    let lengths = Vec::<u64>::load(bytes)?;
    let mut parts = Vec::with_capacity(lengths.len());
    for length in lengths {
        let (part, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
        parts.push(part);
        *bytes = rest;
    }
    bytes.is_empty().then_some(parts)
}
