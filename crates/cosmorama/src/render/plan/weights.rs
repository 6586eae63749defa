use std::fmt::Debug;

use super::band::{Corners, Run};
use super::stored::Stored;
use crate::render::batch::window::Windows;

/// How a plan keeps the weights of a band's windows, one group of runs after the other.
pub(crate) trait Weights: Stored + Clone + Debug + Default + Send + Sync {
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

    /// Whether those of a group are all there and can be worked with, and its windows lie within a view of this size, columns and
    /// rows.
    fn are_sound(&self, group: &[Run], view: [usize; 2]) -> bool;

    /// Bytes that they take, and of those that are held.
    fn bytes(&self) -> usize;
    fn used_bytes(&self) -> usize;
}
