use std::fmt::Debug;

use super::band::Corners;
use crate::resample::window::Windows;

/// How a plan keeps the weights of a band's windows, one run after the other.
pub(in crate::resample) trait Weights: Clone + Debug + Default + Send + Sync {
    /// How many numbers they are: where the next run's begin.
    fn len(&self) -> usize;

    /// Keeps those of the windows that have a corner, and says where these begin as they are kept; false, keeping nothing, if
    /// they cannot be held.
    fn keep(&mut self, windows: &Windows, corners: &mut Corners) -> bool;

    /// Forgets all but the first numbers, keeping the memory.
    fn truncate(&mut self, length: usize);

    fn shrink(&mut self);

    /// Bytes that they take, and of those that are held.
    fn bytes(&self) -> usize;
    fn used_bytes(&self) -> usize;
}
