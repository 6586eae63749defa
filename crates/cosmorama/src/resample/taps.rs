use glam::DVec2;

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
/// The taps under the pixel come first: anti-ringing clamps the average to what they hold.
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

    /// How many of the taps lie under the pixel.
    pub fn under(&self) -> usize {
        self.under
    }

    /// Whether there is no tap.
    pub fn is_empty(&self) -> bool {
        self.taps.is_empty()
    }

    /// Adds a tap under the pixel; all those around it come after.
    pub(super) fn push_under(&mut self, texel: u32, weight: f64) {
        debug_assert_eq!(self.under, self.taps.len());
        self.taps.push(Tap { texel, weight: weight as f32 });
        self.under += 1;
    }

    fn push_around(&mut self, texel: u32, weight: f64) {
        self.taps.push(Tap { texel, weight: weight as f32 });
    }

    /// Scales the weights to a sum of one.
    pub(super) fn normalise(&mut self) {
        let sum: f64 = self.taps.iter().map(|tap| f64::from(tap.weight)).sum();
        for tap in &mut self.taps {
            tap.weight = (f64::from(tap.weight) / sum) as f32;
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
            least[c] = if texel[c] < least[c] { texel[c] } else { least[c] };
            greatest[c] = if texel[c] > greatest[c] { texel[c] } else { greatest[c] };
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

/// A texel that a kernel reaches, before the weights are settled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) texel: u32,
    /// Whether it lies under the pixel.
    pub(super) under: bool,
    /// The kernel's weight times the texel's solid angle.
    pub(super) weight: f64,
    /// How much of a correction it may take: positive, falling to nothing at the kernel's edge.
    pub(super) window: f64,
    /// Where it lies, from the pixel's centre, in screen pixels.
    pub(super) offset: DVec2,
}

/// Corrects the weights so that their centroid is the pixel's centre, their sum unchanged.
///
/// A radial kernel on a lattice of texels weighs one side a little more than the other, which shifts the picture by up
/// to a tenth of a pixel. The correction w + window·g·(p − p̄), linear in the offset p, is that of moving least squares
/// (Lancaster & Salkauskas 1981): a world whose colour is linear in the screen's coordinates then comes back exactly.
pub(super) fn centre(candidates: &mut [Candidate]) {
    let (mut window, mut window_p, mut weight_p) = (0.0, DVec2::ZERO, DVec2::ZERO);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for candidate in candidates.iter() {
        let p = candidate.offset;
        let weighted = p * candidate.window;
        window += candidate.window;
        window_p += weighted;
        weight_p += p * candidate.weight;
        xx += weighted.x * p.x;
        xy += weighted.x * p.y;
        yy += weighted.y * p.y;
    }
    let mean = window_p / window;
    let (xx, xy, yy) = (xx - window_p.x * mean.x, xy - window_p.x * mean.y, yy - window_p.y * mean.y);
    let determinant = xx * yy - xy * xy;
    if !(determinant > 1e-6 * xx * yy) {
        // All in one line: nothing to move the centroid with.
        return;
    }
    let gradient = DVec2::new(xy * weight_p.y - yy * weight_p.x, xy * weight_p.x - xx * weight_p.y) / determinant;
    for candidate in candidates {
        candidate.weight += candidate.window * gradient.dot(candidate.offset - mean);
    }
}

/// Turns candidates into taps whose weights add to one; none if their sum would be noise.
pub(super) fn settle(candidates: &[Candidate], taps: &mut Taps) {
    let sum: f64 = candidates.iter().map(|candidate| candidate.weight).sum();
    let size: f64 = candidates.iter().map(|candidate| candidate.weight.abs()).sum();
    // Where only negative lobes reach a texel, beside a missing face, there is no average.
    if sum <= 0.05 * size {
        return;
    }
    for candidate in candidates.iter().filter(|candidate| candidate.under) {
        taps.push_under(candidate.texel, candidate.weight / sum);
    }
    for candidate in candidates.iter().filter(|candidate| !candidate.under) {
        taps.push_around(candidate.texel, candidate.weight / sum);
    }
}
