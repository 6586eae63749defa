use std::ops::Range;

use cosmorama::raster::{Depth, EncodedImage};
use half::f16;

use crate::metadata::SampleKind;

/// Samples of one named channel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Name with its layer, such as `diffuse.R`.
    pub name: String,
    /// Samples.
    pub samples: PlaneSamples,
}

/// A picture with named channels beside it, all of one size.
#[derive(Clone, Debug)]
pub struct LayeredImage<'a> {
    /// Columns and rows.
    pub size: (usize, usize),
    /// Picture; `None` for channels alone.
    pub picture: Option<&'a EncodedImage>,
    /// Names of the picture's channels, in the order of its samples; plain R, G, B, Y and A, unless given.
    pub names: Vec<String>,
    /// Further channels. One with the name of a picture's channel is left out.
    pub planes: Vec<Plane>,
}

/// Samples of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaneSamples {
    /// Floats of 16 bits.
    Half(Vec<f16>),
    /// Floats of 32 bits.
    Float(Vec<f32>),
    /// Integers of 32 bits.
    Uint(Vec<u32>),
}

impl PlaneSamples {
    /// Creates zeros.
    pub fn zeros(kind: SampleKind, count: usize) -> Self {
        match kind {
            SampleKind::Half => Self::Half(vec![f16::ZERO; count]),
            SampleKind::Float => Self::Float(vec![0.0; count]),
            SampleKind::Uint => Self::Uint(vec![0; count]),
        }
    }

    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::Half(samples) => samples.len(),
            Self::Float(samples) => samples.len(),
            Self::Uint(samples) => samples.len(),
        }
    }

    /// Returns whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the samples of a range.
    ///
    /// # Panics
    /// When there are not as many.
    #[must_use]
    pub fn part(self, range: Range<usize>) -> Self {
        fn of<S>(mut samples: Vec<S>, Range { start, end }: Range<usize>) -> Vec<S> {
            samples.drain(end..);
            samples.drain(..start);
            samples
        }
        match self {
            Self::Half(samples) => Self::Half(of(samples, range)),
            Self::Float(samples) => Self::Float(of(samples, range)),
            Self::Uint(samples) => Self::Uint(of(samples, range)),
        }
    }

    /// Returns the sample type.
    pub fn kind(&self) -> SampleKind {
        match self {
            Self::Half(_) => SampleKind::Half,
            Self::Float(_) => SampleKind::Float,
            Self::Uint(_) => SampleKind::Uint,
        }
    }

    /// Returns a sample as a number. Integers beyond 2²⁴ are rounded.
    pub fn number(&self, index: usize) -> f32 {
        match self {
            Self::Half(samples) => samples[index].to_f32(),
            Self::Float(samples) => samples[index],
            Self::Uint(samples) => samples[index] as f32,
        }
    }

    /// Returns the bits of a sample, which distinguish any two values.
    pub fn bits(&self, index: usize) -> u32 {
        match self {
            Self::Half(samples) => samples[index].to_bits().into(),
            Self::Float(samples) => samples[index].to_bits(),
            Self::Uint(samples) => samples[index],
        }
    }

    /// Sets a sample from a number.
    pub fn set_number(&mut self, index: usize, number: f32) {
        match self {
            Self::Half(samples) => samples[index] = f16::from_f32(number),
            Self::Float(samples) => samples[index] = number,
            Self::Uint(samples) => samples[index] = number.round() as u32,
        }
    }

    /// Sets a sample from the bits of one of the same type.
    pub fn set_bits(&mut self, index: usize, bits: u32) {
        match self {
            Self::Half(samples) => samples[index] = f16::from_bits(bits as u16),
            Self::Float(samples) => samples[index] = f32::from_bits(bits),
            Self::Uint(samples) => samples[index] = bits,
        }
    }
}

impl From<Depth> for SampleKind {
    fn from(depth: Depth) -> Self {
        if depth == Depth::Half { Self::Half } else { Self::Float }
    }
}
