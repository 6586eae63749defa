use std::borrow::Cow;

use crate::lighting::texel_angles::texel_angles;
use crate::raster::Rgba;
use crate::world::{Light, LightError, Source, World};

/// The texels of a world, with their light and their solid angles.
pub(super) struct LitTexels<'w> {
    world: &'w World,
    texels: &'w [Rgba],
    /// Solid angles, by view.
    angles: Vec<Cow<'w, [f32]>>,
}

/// A view of a world with the light and the solid angles of its texels, row by row.
#[derive(Clone, Copy)]
pub(super) struct LitView<'a> {
    pub(super) source: &'a Source,
    pub(super) texels: &'a [Rgba],
    pub(super) angles: &'a [f32],
}

impl<'w> LitTexels<'w> {
    /// Pairs a world with its light.
    pub(super) fn new(world: &'w World, light: &'w Light) -> Result<Self, LightError> {
        light.check(world)?;
        Ok(Self::of_texels(world, light.texels()))
    }

    /// Pairs a world with the light of its texels.
    ///
    /// # Panics
    /// When there are not as many texels as the world has.
    pub(super) fn of_texels(world: &'w World, texels: &'w [Rgba]) -> Self {
        assert_eq!(texels.len(), world.texel_count(), "one texel of light for each texel of the world");
        Self { world, texels, angles: world.sources().iter().map(texel_angles).collect() }
    }

    /// Returns the number of views.
    pub(super) fn count(&self) -> usize {
        self.angles.len()
    }

    /// Returns a view.
    pub(super) fn view(&self, index: usize) -> LitView<'_> {
        let source = &self.world.sources()[index];
        LitView { source, texels: &self.texels[source.texels()], angles: &self.angles[index] }
    }

    /// Visits all views.
    pub(super) fn views(&self) -> impl Iterator<Item = LitView<'_>> {
        (0..self.count()).map(|index| self.view(index))
    }
}

impl<'a> LitView<'a> {
    /// Returns columns and rows.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.source.view.width(), self.source.view.height())
    }

    /// Returns the light and the solid angles of a row.
    pub(super) fn row(&self, j: usize) -> (&'a [Rgba], &'a [f32]) {
        let width = self.source.view.width();
        (&self.texels[j * width..(j + 1) * width], &self.angles[j * width..(j + 1) * width])
    }
}
