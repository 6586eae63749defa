use super::band::{Corners, Run};
use super::stored::Stored;
use super::weights::Weights;
use crate::resample::patch::SIDE;
use crate::resample::window::Windows;

/// The weights of windows, a lane for each of the pixels beside each other. Their last bit tells whether the texel lies under
/// the pixel.
#[derive(Clone, Debug, Default)]
pub(in crate::resample) struct FloatWeights(pub(super) Vec<[f32; SIDE]>);

impl Stored for FloatWeights {
    const LEAST: usize = Vec::<[f32; SIDE]>::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        self.0.store(into);
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        Vec::load(from).map(Self)
    }
}

impl Weights for FloatWeights {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn keep(&mut self, windows: &Windows, _: &mut Corners) -> bool {
        let texels = windows.texels();
        self.0.extend(texels.map(|(weights, under)| std::array::from_fn(|k| marked(weights[k], under >> k & 1 == 1))));
        true
    }

    fn truncate(&mut self, length: usize) {
        self.0.truncate(length);
    }

    fn shrink(&mut self) {
        self.0.shrink_to_fit();
    }

    fn are_sound(&self, run: &Run, view: [usize; 2]) -> bool {
        let window = [usize::from(run.width), usize::from(run.height)];
        let weights = self.0.get(run.weights as usize..).and_then(|from| from.get(..window[0] * window[1]));
        let is_sound = |lane: usize, weights: &[[f32; SIDE]]| {
            run.is_within(lane, window, view) && weights.iter().all(|weights| weights[lane].is_finite())
        };
        weights.is_some_and(|weights| run.lanes().all(|lane| is_sound(lane, weights)))
    }

    fn bytes(&self) -> usize {
        self.0.capacity() * size_of::<[f32; SIDE]>()
    }

    fn used_bytes(&self) -> usize {
        self.0.len() * size_of::<[f32; SIDE]>()
    }
}

/// A weight that says whether its texel lies under the pixel.
fn marked(weight: f32, is_under: bool) -> f32 {
    f32::from_bits(weight.to_bits() & !1 | u32::from(is_under))
}
