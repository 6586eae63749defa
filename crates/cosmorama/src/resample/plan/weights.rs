use std::fmt::Debug;

use super::band::Run;
use crate::resample::window::Windows;

/// How a plan keeps the weights of a band's windows, one run after the other.
pub(in crate::resample) trait Weights: Clone + Debug + Default + Send + Sync {
    /// How many numbers they are: where the next run's begin.
    fn len(&self) -> usize;

    /// Keeps those of a run; false, keeping nothing, if they cannot be held.
    fn keep(&mut self, windows: &Windows, run: &Run) -> bool;

    fn clear(&mut self);

    fn shrink(&mut self);

    /// Bytes that they take, and of those that are held.
    fn bytes(&self) -> usize;
    fn used_bytes(&self) -> usize;
}
