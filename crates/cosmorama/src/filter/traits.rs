//! The one act of the library: a world averaged over a footprint.

use glam::DVec3;
use thiserror::Error;

use crate::camera::Footprint;
use crate::raster::Rgba;
use crate::sphere::{Direction, DirectionJacobian};
use crate::world::{Light, LightError, World};

/// Bits that a prepared picture must keep of the brightest texel's light, times its solid angle.
pub(crate) const LEAST_BITS: u32 = 24;

/// Reason why a filter cannot be prepared.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PrepareError {
    /// The light is not that of the world.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The filter takes perspective views only.
    #[error(
        "this filter takes worlds of perspective views, such as the faces of a cube, and a view is of another projection"
    )]
    NotPerspective,
    /// Repeated integration would keep too few bits of the light.
    #[error(
        "repeated integration of order {order} keeps light to one part in 2^{bits} of the brightest over a view of {}x{} texels, and at \
         least 2^{} is asked for; choose a lower order",
        size[0], size[1], LEAST_BITS
    )]
    LosesPrecision {
        /// Order of integration.
        order: u32,
        /// Columns and rows of the view.
        size: [usize; 2],
        /// Bits that are kept of the brightest texel's light, times its solid angle.
        bits: u32,
    },
}

/// A rule that makes one pixel of the texels under a footprint.
///
/// Every caller that needs the light under a footprint uses this trait: a pixel of a picture, a reflected or refracted
/// ray, a lobe, a pixel that moves. [`FilterSettings`](super::FilterSettings) is a filter chosen at run time.
/// [`Ewa`](super::Ewa) and the types beside it are single filters; yours may be another.
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
    /// Prepares the filter for a world and its light, once for any number of footprints.
    ///
    /// # Errors
    /// If the light does not belong to the world.
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError>;

    /// Returns what [`Filter::prepare`] costs.
    fn setup(&self, world: &World) -> SetupCost;
}

/// Cost of preparing a filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SetupCost {
    /// Number of texels of light that are read once.
    pub texels: usize,
    /// Approximate number of bytes that are kept.
    pub bytes: usize,
}

/// A filter over a world with its light, ready to average any number of footprints from any number of threads.
pub trait Prepared: Send + Sync {
    /// Returns the world.
    fn world(&self) -> &World;

    /// Averages the light under a footprint; the result is premultiplied.
    ///
    /// Parts that no view shows are left out, and the rest is averaged. [`Prepared::covered`] returns how much the rest
    /// is. The average is transparent where no view is near, and for a footprint that holds a NaN or an infinity.
    ///
    /// A footprint without width is a point: filters interpolate there between the texels around it. A flat one, whose
    /// sides lie along one line, is broadened to a ten-thousandth of its length. A footprint wider than [`WIDEST`] is taken
    /// as that wide. All filters see only the half of the world around the footprint's
    /// direction. A footprint as wide as that half gives nearly its mean.
    fn average(&self, footprint: &Footprint) -> Rgba;

    /// Returns the number of texels, or of entries in tables of them, that an average of a footprint reads. A texel counts
    /// as often as it is read.
    fn reads(&self, footprint: &Footprint) -> usize;

    /// Returns the part of a footprint's parallelogram that some view shows, from 0 to 1. It is measured by 8 × 8
    /// directions.
    fn covered(&self, footprint: &Footprint) -> f32 {
        let seen = directions(footprint).filter(|direction| self.world().owner(*direction).is_some()).count();
        seen as f32 / (SAMPLES * SAMPLES) as f32
    }

    /// Returns a direction under a footprint that no view shows, if there is one among 8 × 8 directions.
    fn missing(&self, footprint: &Footprint) -> Option<Direction> {
        directions(footprint).find(|direction| self.world().owner(*direction).is_none())
    }
}

/// Longest derivative that filters take a footprint to have, in radians per pixel: half a turn.
pub const WIDEST: f64 = std::f64::consts::PI;

/// Length in radians below which a footprint has no width. It is far less than any texel, and enough to tell offsets
/// apart.
const NARROWEST: f64 = 1e-8;

/// Breadth of a footprint, as a part of its length, below which it is flat. So the product of its matrix with itself can be
/// inverted in double precision.
const FLATTEST: f64 = 1e-4;

/// Number of directions along a side of a footprint's parallelogram.
const SAMPLES: usize = 8;

/// Returns directions spread evenly over a footprint's parallelogram.
fn directions(footprint: &Footprint) -> impl Iterator<Item = Direction> {
    let place = |k: usize| (k as f64 + 0.5) / SAMPLES as f64 - 0.5;
    let footprint = bounded(footprint);
    (0..SAMPLES * SAMPLES).filter_map(move |k| footprint?.direction_at(place(k % SAMPLES), place(k / SAMPLES)))
}

/// Returns a footprint as filters take it: neither without width nor wider than [`WIDEST`]. `None` if it is not finite.
pub(crate) fn bounded(footprint: &Footprint) -> Option<Footprint> {
    let Footprint { direction, jacobian: DirectionJacobian { dx, dy } } = *footprint;
    if !(dx.is_finite() && dy.is_finite() && direction.vector().is_finite()) {
        return None;
    }
    let [dx, dy] = [dx, dy].map(|side| side.clamp_length_max(WIDEST));
    let widest = dx.length_squared().max(dy.length_squared());
    // Only what lies in the plane that touches the sphere spans an area. Of one side, or of two along one line, nothing could
    // be inverted.
    let area = dx.cross(dy).dot(direction.vector()).abs();
    if widest >= NARROWEST * NARROWEST && area >= FLATTEST * widest {
        return Some(Footprint { direction, jacobian: DirectionJacobian { dx, dy } });
    }
    Some(Footprint { direction, jacobian: broadened(direction, [dx, dy]) })
}

/// Returns the sides of a flat footprint with the least breadth that counts.
fn broadened(direction: Direction, sides: [DVec3; 2]) -> DirectionJacobian {
    let [x, y] = sides.map(|side| side.reject_from_normalized(direction.vector()));
    let (longer, shorter) = if x.length_squared() >= y.length_squared() { (x, y) } else { (y, x) };
    if longer.length() < NARROWEST {
        let (right, up) = direction.vector().any_orthonormal_pair();
        return DirectionJacobian { dx: right * NARROWEST, dy: up * NARROWEST };
    }
    let (along, length) = (longer.normalize(), longer.length().hypot(shorter.length()));
    DirectionJacobian { dx: along * length, dy: direction.vector().cross(along) * (FLATTEST * length) }
}
