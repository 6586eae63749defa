use super::slope;
use crate::raster::Rgba;

/// One texel's part in an output pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tap {
    /// Index of the texel in the world's buffer.
    pub(super) texel: u32,
    /// Its weight.
    pub(super) weight: f32,
}

/// What anti-ringing holds the average of taps to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bound {
    /// What those under the pixel hold: the first ones, so many.
    Under(u32),
    /// What all of them hold, and beyond it where a slope goes on: they lie to one side of the pixel's centre, or the field of
    /// view ends under the pixel.
    Slope,
}

/// All the texels of an output pixel with their weights: what a filter makes of a footprint.
#[derive(Clone, Debug, Default)]
pub(crate) struct Taps {
    taps: Vec<Tap>,
    bound: Bound,
}

impl Default for Bound {
    fn default() -> Self {
        Self::Under(0)
    }
}

impl Taps {
    /// Forgets all taps but keeps the memory.
    pub(super) fn clear(&mut self) {
        self.taps.clear();
        self.bound = Bound::default();
    }

    /// All taps, those under the pixel first.
    pub(super) fn as_slice(&self) -> &[Tap] {
        &self.taps
    }

    /// What their average is held to.
    pub(super) fn bound(&self) -> Bound {
        self.bound
    }

    /// Whether there is no tap.
    pub(super) fn is_empty(&self) -> bool {
        self.taps.is_empty()
    }

    /// Adds a tap, all of which lie under the pixel.
    pub(super) fn push_under(&mut self, texel: u32, weight: f32) {
        self.taps.push(Tap { texel, weight });
        self.bound = Bound::Under(self.taps.len() as u32);
    }

    /// Takes `count` taps, each with whether it is one of the `under` that lie under the pixel.
    pub(super) fn fill(&mut self, taps: impl Iterator<Item = (bool, Tap)>, count: usize, under: usize) {
        self.taps.clear();
        self.taps.resize(count, Tap { texel: 0, weight: 0.0 });
        // Where none lies under the pixel, beyond a view's edge, all of them bound it.
        self.bound = Bound::Under(if under == 0 { count } else { under } as u32);
        // Each tap goes to the end of its own part.
        let mut ends = [under, 0];
        for (is_under, tap) in taps {
            let end = &mut ends[usize::from(is_under)];
            self.taps[*end] = tap;
            *end += 1;
        }
    }

    /// All of them lie to one side of the pixel's centre, or the field of view ends under the pixel.
    pub(super) fn bound_by_slope(&mut self) {
        self.bound = Bound::Slope;
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

/// The weighted average of taps, held to their bound if there is to be no ringing. `light` is that of a texel.
pub(super) fn average(taps: &[Tap], bound: Bound, light: impl Fn(u32) -> Rgba, anti_ringing: bool) -> Rgba {
    let mut sum = [0f64; 4];
    let (mut least, mut greatest) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
    let (inner, outer) = match bound {
        Bound::Under(count) => taps.split_at(count as usize),
        Bound::Slope => (&[][..], taps),
    };
    for block in inner.chunks(BLOCK) {
        let mut part = [0f32; 4];
        for tap in block {
            let texel = light(tap.texel).0;
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
            let texel = light(tap.texel).0;
            for c in 0..4 {
                part[c] += tap.weight * texel[c];
            }
        }
        add(&mut sum, part);
    }
    let average = Rgba(sum.map(|value| value as f32));
    match bound {
        _ if !anti_ringing => average,
        // No tap at all.
        Bound::Under(0) => average,
        Bound::Slope => slope::clamp(average, taps.iter().map(|tap| light(tap.texel))),
        Bound::Under(_) => Rgba(std::array::from_fn(|c| average.0[c].max(least[c]).min(greatest[c]))),
    }
}

fn add(sum: &mut [f64; 4], part: [f32; 4]) {
    for c in 0..4 {
        sum[c] += f64::from(part[c]);
    }
}
