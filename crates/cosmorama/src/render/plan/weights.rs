use std::fmt::Debug;

use super::span::{Corners, Run};
use crate::render::batch::window::Windows;

/// How a plan keeps the weights of a band's windows, one group of runs after the other.
pub(crate) trait Weights: Clone + Debug + Default + Send + Sync {
    /// How many texels there are from one row of a view to the next in the light that they are for, if rows hold so many.
    fn pitch(width: usize) -> usize;

    /// How many numbers they are: where the next run's begin.
    fn len(&self) -> usize;

    /// Keeps those of the windows that have a corner, as the windows of this run of their group, and says where these begin as they are
    /// kept; false, keeping nothing, if they cannot be held.
    fn keep(&mut self, windows: &Windows, corners: &mut Corners, run: usize) -> bool;

    /// Forgets all but the first numbers, keeping the memory.
    fn truncate(&mut self, length: usize);

    /// Sorts those of each group by shape, and gives back memory that is not needed.
    fn settle<'a>(&mut self, groups: impl Iterator<Item = &'a [Run]>);

    /// Bytes that they take, and of those that are held.
    fn bytes(&self) -> usize;
    fn used_bytes(&self) -> usize;
}
