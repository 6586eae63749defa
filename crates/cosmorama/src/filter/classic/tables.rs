use std::fmt;
use std::sync::Arc;

use crate::camera::Footprint;
use crate::filter::traits::{Prepared, bounded};
use crate::raster::Rgba;
use crate::world::World;

/// Tables that a filter of the literature has made of a world's light, once for any number of pictures: a pyramid, or sums.
///
/// The light itself is not kept. So its owner can hold the tables beside it.
///
/// ```
/// use cosmorama::filter::{Classic, FilterKind, FilterSettings};
/// use cosmorama::prelude::*;
///
/// let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.5, 0.5)))?;
/// let filter = FilterSettings { kind: FilterKind::Classic(Classic::SummedArea), ..FilterSettings::DEFAULT };
/// let tables = filter.tables(&world, light.texels());
/// let dome = CameraModel::from(FulldomeCamera::default()).view(32, 32)?;
/// let resampler = Resampler::new(&world, &dome).by(filter);
/// let picture = resampler.render_by(tables.as_ref(), light.texels(), Rgba::BLACK);
/// assert_eq!(picture.pixels(), resampler.render_over(light.texels(), Rgba::BLACK).pixels());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct ClassicTables(Arc<dyn Tables>);

/// A filter with its tables of the light of a world.
pub(super) trait Tables: Send + Sync {
    /// Averages the light under a footprint, as [`Prepared::average`] does, of a footprint in bounds.
    fn average(&self, of: Lit, footprint: &Footprint) -> Rgba;

    /// Returns the number of texels, or of entries, that an average of a footprint in bounds reads.
    fn reads(&self, of: Lit, footprint: &Footprint) -> usize;
}

/// A world and the light that tables are of.
#[derive(Clone, Copy)]
pub(super) struct Lit<'w> {
    pub(super) world: &'w World,
    pub(super) light: &'w [Rgba],
}

/// Tables over the light that they are of.
struct Tabled<'w> {
    of: Lit<'w>,
    tables: Arc<dyn Tables>,
}

impl ClassicTables {
    pub(super) fn new(tables: Box<dyn Tables>) -> Self {
        Self(tables.into())
    }

    /// Returns the filter, prepared for the world's light that the tables are of.
    pub fn over<'w>(&self, world: &'w World, light: &'w [Rgba]) -> Box<dyn Prepared + 'w> {
        Box::new(Tabled { of: Lit { world, light }, tables: Arc::clone(&self.0) })
    }
}

impl fmt::Debug for ClassicTables {
    fn fmt(&self, into: &mut fmt::Formatter) -> fmt::Result {
        into.debug_struct("ClassicTables").finish_non_exhaustive()
    }
}

impl Prepared for Tabled<'_> {
    fn world(&self) -> &World {
        self.of.world
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        bounded(footprint).map_or(Rgba::TRANSPARENT, |footprint| self.tables.average(self.of, &footprint))
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        bounded(footprint).map_or(0, |footprint| self.tables.reads(self.of, &footprint))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::camera::CameraModel;
    use crate::filter::classic::method::Method;
    use crate::sphere::{CubeFace, Direction};

    /// A method that counts how often it is prepared, and shows one colour, which no texel has.
    struct Counting(Arc<AtomicUsize>);

    const SHOWN: Rgba = Rgba::opaque(0.25, 0.5, 0.75);

    struct Shown;

    impl Method for Counting {
        fn tables(self: Box<Self>, _: &World, _: &[Rgba]) -> Box<dyn Tables> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Box::new(Shown)
        }
    }

    impl Tables for Shown {
        fn average(&self, _: Lit, _: &Footprint) -> Rgba {
            SHOWN
        }

        fn reads(&self, _: Lit, _: &Footprint) -> usize {
            1
        }
    }

    /// Asks for many pictures of one light: none of them makes tables of its own.
    #[test]
    fn many_pictures_are_prepared_once() {
        let panorama = CameraModel::Equirect(Default::default()).view(32, 16).expect("a panorama");
        let world = World::new([("all".to_owned(), panorama)]).expect("one view");
        let light = vec![Rgba::opaque(1.0, 1.0, 1.0); world.texel_count()];
        let count = Arc::new(AtomicUsize::new(0));
        let tables = ClassicTables::new(Box::new(Counting(Arc::clone(&count))).tables(&world, &light));
        for face in CubeFace::ALL {
            let prepared = tables.over(&world, &light);
            let forward = face.orientation().to_world(Direction::FRONT);
            assert_eq!(prepared.average(&Footprint::point(forward)), SHOWN, "{face:?}");
        }
        assert_eq!(count.load(Ordering::Relaxed), 1);
    }
}
