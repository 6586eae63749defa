use super::block::{Block, Cloud};
use crate::lighting::prefilter::lobe::Weight;
use crate::sphere::Direction;

/// Axes that are worked on together.
pub(in crate::lighting::prefilter) const LANES: usize = 8;

/// A number for each axis.
type Lanes = [f32; LANES];

/// Axes of lobes, an axis a lane, with their sums of red, green, blue and opacity.
pub(in crate::lighting::prefilter) struct Packet {
    axes: [Lanes; 3],
    sums: [Lanes; 4],
}

/// Greatest errors that estimates may have.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    /// Part of a block's weight by which its estimated error may differ from that.
    pub(super) part: f32,
    /// Mean radiance of the world. Of blocks that are brighter, the part is less, in proportion: a sun is all of the light.
    pub(super) mean: f32,
    /// Weight below which no weight counts as small.
    pub(super) floor: f32,
}

/// The weights of a cloud of points.
struct CloudWeight {
    /// Mean weight.
    mean: Lanes,
    /// Change of the weight with 1 − cos θ.
    slope: Lanes,
    /// Whether the estimate is near enough in all lanes.
    is_near: bool,
}

impl Packet {
    /// Starts sums about up to [`LANES`] axes.
    pub(in crate::lighting::prefilter) fn of(axes: &[Direction]) -> Self {
        let vector = |lane: usize| axes[lane.min(axes.len() - 1)].vector().to_array();
        let axes = std::array::from_fn(|k| std::array::from_fn(|lane| vector(lane)[k] as f32));
        Self { axes, sums: [[0.0; LANES]; 4] }
    }

    /// Returns the sums of a lane.
    pub(in crate::lighting::prefilter) fn sums(&self, lane: usize) -> [f64; 4] {
        self.sums.map(|sums| f64::from(sums[lane]))
    }

    /// Adds a block as a whole, if the weight bends little enough over it. Returns whether it was added.
    #[inline(always)]
    pub(super) fn add_block<W: Weight>(&mut self, block: &Block, weight: W, tolerance: Tolerance) -> bool {
        let seen = self.cloud(&block.seen, weight, Tolerance { part: tolerance.part * SEEN, ..tolerance });
        if !seen.is_near {
            return false;
        }
        let brightness = block.brightness();
        let bright = if brightness > tolerance.mean { tolerance.mean / brightness } else { 1.0 };
        let lit = self.cloud(&block.lit, weight, Tolerance { part: tolerance.part * bright, ..tolerance });
        if !lit.is_near {
            return false;
        }
        let [x, y, z] = &self.axes;
        for (colour, [mx, my, mz]) in block.moments.iter().enumerate() {
            for lane in 0..LANES {
                let off = x[lane] * mx + y[lane] * my + z[lane] * mz;
                self.sums[colour][lane] += lit.mean[lane] * block.light[colour] - lit.slope[lane] * off;
            }
        }
        for lane in 0..LANES {
            self.sums[3][lane] += seen.mean[lane] * block.shown;
        }
        true
    }

    /// Adds a texel, given by its direction and its light and opacity times solid angle.
    #[inline(always)]
    pub(in crate::lighting::prefilter) fn add_texel<W: Weight>(
        &mut self,
        direction: [f32; 3],
        light: [f32; 4],
        weight: W,
    ) {
        let s = self.off_axis(direction);
        let weights: Lanes = std::array::from_fn(|lane| weight.single(s[lane]));
        for (sums, light) in self.sums.iter_mut().zip(light) {
            for lane in 0..LANES {
                sums[lane] += weights[lane] * light;
            }
        }
    }

    /// Returns 1 − cos θ of a point.
    #[inline(always)]
    fn off_axis(&self, [px, py, pz]: [f32; 3]) -> Lanes {
        let [x, y, z] = &self.axes;
        std::array::from_fn(|lane| (x[lane] - px) * x[lane] + (y[lane] - py) * y[lane] + (z[lane] - pz) * z[lane])
    }

    /// Weighs a cloud of points by Simpson's rule, as if they were spread evenly along the axis, as far as their variance says.
    /// The part behind the horizon has no weight.
    #[inline(always)]
    fn cloud<W: Weight>(&self, cloud: &Cloud, weight: W, tolerance: Tolerance) -> CloudWeight {
        let [x, y, z] = &self.axes;
        let [xx, yy, zz, xy, xz, yz] = cloud.spread;
        let s = self.off_axis(cloud.centre);
        let (mut mean, mut slope, mut excess) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let kink = weight.kink() * UNEVEN;
        for lane in 0..LANES {
            let (x, y, z) = (x[lane], y[lane], z[lane]);
            let variance = x * (x * xx + 2.0 * (y * xy + z * xz)) + y * (y * yy + 2.0 * z * yz) + z * z * zz;
            let s = s[lane].max(0.0);
            // Nothing lies before the axis itself.
            let reach = (3.0 * variance.max(0.0)).sqrt().min(s);
            let width = (2.0 * reach).max(SMALL);
            let (first, last) = (s - reach, (s + reach).min(HORIZON));
            let is_cut = s + reach > HORIZON;
            let part = if is_cut { ((HORIZON - first) / width).max(0.0) } else { 1.0 };
            let middle = if is_cut { 0.5 * (first + HORIZON) } else { s };
            let [near, at, far] = [first, middle, last].map(|s| weight.single(s));
            mean[lane] = part * (near + 4.0 * at + far) * (1.0 / 6.0);
            slope[lane] = (far - near) / width;
            let at_horizon = if (HORIZON - s).abs() < CORNER * reach { kink * reach } else { 0.0 };
            let error = (mean[lane] - part * at).abs() + at_horizon;
            excess[lane] = error - tolerance.part * (mean[lane] + tolerance.floor);
        }
        CloudWeight { mean, slope, is_near: excess.iter().all(|excess| *excess <= 0.0) }
    }
}

/// Part of the tolerance for what is shown, by which all light is divided.
const SEEN: f32 = 0.4;

/// 1 − cos θ at the horizon, behind which weights are zero.
const HORIZON: f32 = 1.0;

/// Error of the mean of |x| over a cloud, by its reach, for what is not spread as evenly as is assumed.
const UNEVEN: f32 = 0.05;

/// Distance from the middle of a square to its corners, in reaches: half the diagonal over half a side.
const CORNER: f32 = 1.4143;

/// Keeps a quotient of two zeros finite.
const SMALL: f32 = 1e-12;
