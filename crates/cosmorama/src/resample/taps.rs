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
/// The taps under the pixel (r < 1) are kept apart: anti-ringing clamps the average to what they hold.
#[derive(Clone, Debug, Default)]
pub struct Taps {
    pub(super) under: Vec<Tap>,
    pub(super) around: Vec<Tap>,
}

impl Taps {
    /// Forgets all taps but keeps the memory.
    pub fn clear(&mut self) {
        self.under.clear();
        self.around.clear();
    }

    /// Whether there is no tap.
    pub fn is_empty(&self) -> bool {
        self.under.is_empty() && self.around.is_empty()
    }

    /// How many taps there are.
    pub fn len(&self) -> usize {
        self.under.len() + self.around.len()
    }

    /// All taps, those under the pixel first.
    pub fn iter(&self) -> impl Iterator<Item = &Tap> {
        self.under.iter().chain(&self.around)
    }

    pub(super) fn push_under(&mut self, texel: u32, weight: f64) {
        self.under.push(Tap { texel, weight: weight as f32 });
    }

    /// Scales the weights to a sum of one. Without any positive sum nothing is left.
    pub(super) fn normalise(&mut self) {
        let sum: f64 = self.iter().map(|tap| f64::from(tap.weight)).sum();
        let size: f64 = self.iter().map(|tap| f64::from(tap.weight.abs())).sum();
        // Where only negative lobes reach a texel (beside a missing face) the average would be noise.
        if sum < 0.05 * size || size == 0.0 {
            self.clear();
            return;
        }
        let factor = sum.recip() as f32;
        for tap in self.under.iter_mut().chain(&mut self.around) {
            tap.weight *= factor;
        }
    }
}

/// The weighted average of taps; `under` of them, at the front, are those under the pixel.
pub(super) fn average(taps: &[Tap], under: usize, texels: &[Rgba], anti_ringing: bool) -> Rgba {
    let mut sum = [0f32; 4];
    let (mut least, mut greatest) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
    let (inner, outer) = taps.split_at(under);
    for tap in inner {
        let texel = texels[tap.texel as usize].0;
        for c in 0..4 {
            sum[c] += tap.weight * texel[c];
            least[c] = least[c].min(texel[c]);
            greatest[c] = greatest[c].max(texel[c]);
        }
    }
    for tap in outer {
        let texel = texels[tap.texel as usize].0;
        for c in 0..4 {
            sum[c] += tap.weight * texel[c];
        }
    }
    if anti_ringing && under > 0 {
        for c in 0..4 {
            sum[c] = sum[c].max(least[c]).min(greatest[c]);
        }
    }
    Rgba(sum)
}
