use super::band::Run;
use super::spread::GROUP;
use super::stored::Stored;
use super::weights::Weights;
use crate::resample::patch::SIDE;
use crate::resample::window::Windows;

/// The weights of windows as integers, pixel by pixel and row by row. Before each group of a row's weights stands which of its
/// texels lie under the pixel, a bit for each; before those of a run, by how many bits they are scaled.
#[derive(Clone, Debug, Default)]
pub(in crate::resample) struct FixedWeights {
    /// As many zeros follow as a group has: it is read as a whole.
    pub(super) numbers: Vec<i16>,
    /// Without those.
    length: usize,
    /// Weights of a run before they are sorted by pixel.
    rounded: Vec<[i16; SIDE]>,
}

/// A number so large that what is added to it is rounded to an integer, which its last bits then hold.
const ROUNDER: f32 = 12_582_912.0;

impl FixedWeights {
    /// Rounds the weights of all lanes; by how many bits they are scaled, `None` if they are too large. What rounding takes from
    /// one texel the next one has: each lane's sum is exactly one.
    fn round(&mut self, windows: &Windows) -> Option<u32> {
        let (mut largest, mut size) = ([0f32; SIDE], [0f32; SIDE]);
        for (weights, _) in windows.texels() {
            for lane in 0..SIDE {
                largest[lane] = largest[lane].max(weights[lane].abs());
                size[lane] += weights[lane].abs();
            }
        }
        let [largest, size] = [largest, size].map(|lanes| lanes.into_iter().fold(0f32, f32::max));
        // Sums must fit into 32 bits.
        let bits = if largest < 1.0 && size < 1.9 {
            15
        } else if largest < 1.99 && size < 3.9 {
            14
        } else {
            return None;
        };
        let scale = (1 << bits) as f32;
        let (mut sums, mut before) = ([0f32; SIDE], [ROUNDER.to_bits(); SIDE]);
        self.rounded.clear();
        for (weights, _) in windows.texels() {
            let mut rounded = [0; SIDE];
            for lane in 0..SIDE {
                sums[lane] += weights[lane] * scale;
                let sum = (sums[lane] + ROUNDER).to_bits();
                let step = (sum.wrapping_sub(before[lane]) as i32).min(i32::from(i16::MAX));
                rounded[lane] = step as i16;
                before[lane] = before[lane].wrapping_add_signed(step);
            }
            self.rounded.push(rounded);
        }
        Some(bits)
    }
}

impl Stored for FixedWeights {
    const LEAST: usize = Vec::<i16>::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        self.numbers.store(into);
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        let numbers: Vec<i16> = Vec::load(from)?;
        let length = numbers.len().checked_sub(if numbers.is_empty() { 0 } else { GROUP })?;
        Some(Self { numbers, length, rounded: Vec::new() })
    }
}

impl Weights for FixedWeights {
    fn len(&self) -> usize {
        self.length
    }

    fn keep(&mut self, windows: &Windows, run: &Run) -> bool {
        let Some(bits) = self.round(windows) else { return false };
        let width = usize::from(run.width);
        let under: Vec<[u8; SIDE]> =
            windows.texels().map(|(_, beyond)| beyond.map(|beyond| u8::from(beyond == 0.0))).collect();
        self.numbers.truncate(self.length);
        self.numbers.push(bits as i16);
        for lane in run.lanes() {
            for (weights, under) in self.rounded.chunks_exact(width).zip(under.chunks_exact(width)) {
                for (weights, under) in weights.chunks(GROUP).zip(under.chunks(GROUP)) {
                    let bits = under.iter().enumerate().fold(0, |bits, (k, under)| bits | under[lane] << k);
                    self.numbers.push(i16::from(bits));
                    self.numbers.extend(weights.iter().map(|weights| weights[lane]));
                }
            }
        }
        self.length = self.numbers.len();
        self.numbers.resize(self.length + GROUP, 0);
        true
    }

    fn clear(&mut self) {
        self.numbers.clear();
        self.length = 0;
    }

    fn shrink(&mut self) {
        self.numbers.shrink_to_fit();
        self.rounded = Vec::new();
    }

    fn are_sound(&self, run: &Run, view: [usize; 2]) -> bool {
        let (width, height) = (usize::from(run.width), usize::from(run.height));
        let Some((bits, numbers)) =
            self.numbers[..self.length].get(run.weights as usize..).and_then(<[i16]>::split_first)
        else {
            return false;
        };
        let of_lane = height * (width + width.div_ceil(GROUP));
        let is_row = |row: &[i16]| row.chunks(GROUP + 1).all(|group| (0..1 << GROUP).contains(&i32::from(group[0])));
        let size = |row: &[i16]| -> i64 {
            row.chunks(GROUP + 1).flat_map(|group| &group[1..]).map(|weight| i64::from(*weight).abs()).sum()
        };
        let is_lane = |(at, lane): (usize, usize)| {
            let Some(numbers) = numbers.get(at * of_lane..(at + 1) * of_lane) else { return false };
            let rows = || numbers.chunks(of_lane / height);
            // Sums of products with 15 bits must fit into 32.
            run.is_within(lane, [width, height], view) && rows().all(is_row) && rows().map(size).sum::<i64>() < 1 << 16
        };
        (14..=15).contains(bits) && run.lanes().enumerate().all(is_lane)
    }

    fn bytes(&self) -> usize {
        self.numbers.capacity() * size_of::<i16>()
    }

    fn used_bytes(&self) -> usize {
        self.numbers.len() * size_of::<i16>()
    }
}
