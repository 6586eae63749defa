use crate::camera::View;
use crate::filter::FilterSettings;
use crate::world::World;

/// A conversion from a world to a target view.
#[derive(Clone, Copy, Debug)]
pub struct Resampler<'a> {
    /// World to average.
    pub world: &'a World,
    /// View to fill.
    pub target: &'a View,
    /// Filter to average by.
    pub filter: FilterSettings,
}

impl<'a> Resampler<'a> {
    /// Returns the conversion by the default filter.
    pub const fn new(world: &'a World, target: &'a View) -> Self {
        Self { world, target, filter: FilterSettings::DEFAULT }
    }

    /// Returns the conversion by another filter.
    #[must_use]
    pub const fn by(self, filter: FilterSettings) -> Self {
        Self { filter, ..self }
    }
}
