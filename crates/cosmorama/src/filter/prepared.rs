//! The one act of the library: a world averaged over a footprint.

use crate::camera::Footprint;
use crate::raster::Rgba;
use crate::sphere::{Direction, DirectionJacobian};
use crate::world::{Light, LightError, World};

/// What is averaged, and how: one of this room's filters, or your own.
///
/// Every caller that needs the light under a footprint asks this way: a picture's pixel, a reflected or refracted ray, a lobe, a
/// pixel that moves. [`FilterSettings`](super::FilterSettings) is a filter chosen at run time; [`Ewa`](super::Ewa) and those beside it are
/// single ones.
///
/// ```
/// use cosmorama::camera::{CameraModel, Covariance, EquirectCamera, Footprint};
/// use cosmorama::filter::{Ewa, Filter};
/// use cosmorama::raster::Rgba;
/// use cosmorama::sphere::{Angle, Direction};
/// use cosmorama::world::{Light, World};
///
/// let sky = CameraModel::Equirect(EquirectCamera::default()).view(128, 64)?;
/// let world = World::new([("sky".to_owned(), sky)])?;
/// let light = Light::by_direction(&world, |direction| {
///     Rgba::opaque(0.5 + 0.5 * direction.vector().y as f32, 0.5, 0.5)
/// });
/// let prepared = Ewa::default().prepare(&world, &light)?;
///
/// let lobe = Covariance::round(Direction::UP, Angle::from_degrees(10.0).radians().powi(2));
/// let average = prepared.average(&Footprint::from_covariance(Direction::UP, lobe));
/// assert!(average.0[0] < 1.0 && average.0[0] > 0.95);
/// assert_eq!(average.alpha(), 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Filter {
    /// Makes all that the filter needs of a world and its light, once for any number of footprints.
    ///
    /// # Errors
    /// When the light is not that of the world.
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, LightError>;

    /// What preparing costs.
    fn setup(&self, world: &World) -> SetupCost;
}

/// What it costs to prepare a filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetupCost {
    /// Texels of light that are read once.
    pub texels: usize,
    /// Bytes that are kept, about.
    pub bytes: usize,
}

/// A filter over a world with its light: averages any number of footprints, from any number of threads.
pub trait Prepared: Send + Sync {
    /// The world.
    fn world(&self) -> &World;

    /// The average of the light under a footprint, premultiplied as all light is.
    ///
    /// What no view shows is left out: the average is that of what there is. [`Prepared::covered`] tells how much that is. It
    /// is transparent where no view is near, and for a footprint that holds a NaN or an infinity.
    ///
    /// A footprint without width is a point: filters make of it what lies between the texels around. One wider than
    /// [`WIDEST`] is taken as that wide. All filters see only the half of the world around the footprint's direction; one as wide
    /// as that gives nearly the mean of this half.
    fn average(&self, footprint: &Footprint) -> Rgba;

    /// The part of a footprint's parallelogram that some view shows, from 0 to 1, told by 8 × 8 directions in it.
    fn covered(&self, footprint: &Footprint) -> f32 {
        let seen = directions(footprint).filter(|direction| self.world().owner(*direction).is_some()).count();
        seen as f32 / (SAMPLES * SAMPLES) as f32
    }

    /// A direction under a footprint that no view shows, if one of 8 × 8 is such.
    fn missing(&self, footprint: &Footprint) -> Option<Direction> {
        directions(footprint).find(|direction| self.world().owner(*direction).is_none())
    }
}

/// The longest derivative that filters take a footprint to have, in radians per pixel: half a turn.
pub const WIDEST: f64 = std::f64::consts::PI;

/// Shorter than this, in radians, a footprint has no width: far less than any texel, and enough to tell offsets apart.
const NARROWEST: f64 = 1e-8;

/// Directions along a side of a footprint's parallelogram.
const SAMPLES: usize = 8;

/// Directions in a footprint's parallelogram, evenly.
fn directions(footprint: &Footprint) -> impl Iterator<Item = Direction> {
    let place = |k: usize| (k as f64 + 0.5) / SAMPLES as f64 - 0.5;
    let footprint = bounded(footprint);
    (0..SAMPLES * SAMPLES).filter_map(move |k| footprint?.direction_at(place(k % SAMPLES), place(k / SAMPLES)))
}

/// A footprint as filters take it: neither without width nor wider than [`WIDEST`]; `None` for one that is no number.
pub(crate) fn bounded(footprint: &Footprint) -> Option<Footprint> {
    let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } = *footprint;
    let (x, y) = (dx.length_squared(), dy.length_squared());
    let widest = x.max(y);
    if (NARROWEST * NARROWEST..=WIDEST * WIDEST).contains(&widest) {
        return if x + y < f64::INFINITY { Some(*footprint) } else { None };
    }
    if !(dx.is_finite() && dy.is_finite() && direction.vector().is_finite()) {
        return None;
    }
    if widest < NARROWEST * NARROWEST {
        let (right, up) = direction.vector().any_orthonormal_pair();
        let jacobian = DirectionJacobian { dx: right * NARROWEST, dy: up * NARROWEST };
        return Some(Footprint { direction, jacobian });
    }
    let held = |vector: glam::DVec3| vector.clamp_length_max(WIDEST);
    Some(Footprint { direction, jacobian: DirectionJacobian { dx: held(dx), dy: held(dy) } })
}
