use super::slope;
use crate::raster::Rgba;

/// One texel's part in an output pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tap {
    /// Index of the texel in the world's buffer.
    pub texel: u32,
    /// Its weight.
    pub weight: f32,
}

/// All the texels of an output pixel with their weights: what a filter makes of a footprint.
///
/// The taps under the pixel come first: anti-ringing clamps the average to what they hold. Where the field of view ends
/// under the pixel, all of them bound it, and a slope may go on beyond the last ([`Taps::under`] is zero then).
#[derive(Clone, Debug, Default)]
pub struct Taps {
    taps: Vec<Tap>,
    under: usize,
}

impl Taps {
    /// Forgets all taps but keeps the memory.
    pub fn clear(&mut self) {
        self.taps.clear();
        self.under = 0;
    }

    /// All taps, those under the pixel first.
    pub fn as_slice(&self) -> &[Tap] {
        &self.taps
    }

    /// How many of the taps lie under the pixel; zero where the field of view ends there.
    pub fn under(&self) -> usize {
        self.under
    }

    /// Whether there is no tap.
    pub fn is_empty(&self) -> bool {
        self.taps.is_empty()
    }

    /// Adds a tap under the pixel; all those around it come after.
    pub(super) fn push_under(&mut self, texel: u32, weight: f32) {
        debug_assert_eq!(self.under, self.taps.len());
        self.taps.push(Tap { texel, weight });
        self.under += 1;
    }

    /// Takes `count` taps, each with whether it is one of the `under` that lie under the pixel.
    pub(super) fn fill(&mut self, taps: impl Iterator<Item = (bool, Tap)>, count: usize, under: usize) {
        self.taps.clear();
        self.taps.resize(count, Tap { texel: 0, weight: 0.0 });
        // Where none lies under the pixel, beyond a view's edge, all of them bound it.
        self.under = if under == 0 { count } else { under };
        // Each tap goes to the end of its own part.
        let mut ends = [under, 0];
        for (is_under, tap) in taps {
            let end = &mut ends[usize::from(is_under)];
            self.taps[*end] = tap;
            *end += 1;
        }
    }

    /// The field of view ends under the pixel.
    pub(super) fn bound_by_slopes(&mut self) {
        self.under = 0;
    }

    /// Scales the weights to a sum of one.
    pub(super) fn normalise(&mut self) {
        let sum: f64 = self.taps.iter().map(|tap| f64::from(tap.weight)).sum();
        for tap in &mut self.taps {
            tap.weight = (f64::from(tap.weight) / sum) as f32;
        }
    }
}

/// Taps that are added up in single precision before the sum goes on in double: a pixel of thousands of texels must not
/// lose digits, and a common one pays nothing.
const BLOCK: usize = 32;

/// The weighted average of taps; `under` of them, at the front, are those under the pixel, zero at the field's edge.
pub(super) fn average(taps: &[Tap], under: usize, texels: &[Rgba], anti_ringing: bool) -> Rgba {
    let mut sum = [0f64; 4];
    let (mut least, mut greatest) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
    let (inner, outer) = taps.split_at(under);
    for block in inner.chunks(BLOCK) {
        let mut part = [0f32; 4];
        for tap in block {
            let texel = texels[tap.texel as usize].0;
            for c in 0..4 {
                part[c] += tap.weight * texel[c];
                least[c] = if texel[c] < least[c] { texel[c] } else { least[c] };
                greatest[c] = if texel[c] > greatest[c] { texel[c] } else { greatest[c] };
            }
        }
        add(&mut sum, part);
    }
    for block in outer.chunks(BLOCK) {
        let mut part = [0f32; 4];
        for tap in block {
            let texel = texels[tap.texel as usize].0;
            for c in 0..4 {
                part[c] += tap.weight * texel[c];
            }
        }
        add(&mut sum, part);
    }
    let average = Rgba(sum.map(|value| value as f32));
    match under {
        _ if !anti_ringing => average,
        0 => slope::clamp(average, taps.iter().map(|tap| texels[tap.texel as usize])),
        _ => Rgba(std::array::from_fn(|c| average.0[c].max(least[c]).min(greatest[c]))),
    }
}

fn add(sum: &mut [f64; 4], part: [f32; 4]) {
    for c in 0..4 {
        sum[c] += f64::from(part[c]);
    }
}
