//! Memory for the weights of single pixels that see much of the world.

use cosmorama::camera::{PixelPoint, View};
use cosmorama::filter::FilterKind;
use cosmorama::sphere::Direction;

use super::size_of_view;
use crate::input::Input;
use crate::source::memory_budget::area;

/// Rows of a picture that one thread makes.
const BAND_ROWS: usize = 32;

/// Number of bunches of all texels, of which each view has one at least.
const BUNCHES: usize = 48 * 48;

/// Square of a footprint's radius in the tangent plane, for each steradian of its pixel: some 1.9 pixels.
const FOOTPRINT: f64 = 3.6;

/// Bytes of a texel's weight, of its place, and of its indices in mirror images, with the room into which their lists grow.
const WEIGHT: f64 = 90.0;

/// Number of bunches around which texels are counted, for all pictures together.
const CENTRES: usize = 24 * 24;

/// Returns the bytes of the weights of texels under those pixels of these views that see most of them, one for each thread. Other filters than
/// EWA hold none.
pub(crate) fn footprint_bytes<'v>(
    filter: FilterKind,
    input: &Input,
    views: impl Iterator<Item = &'v View> + Clone,
) -> u64 {
    if filter != FilterKind::Ewa {
        return 0;
    }
    let crowd = Crowd::of(input);
    let centres = CENTRES.div_ceil(views.clone().count().max(1));
    views.map(|view| crowd.bytes_of(view, centres)).max().unwrap_or(0)
}

/// Texels of an input, in bunches. They crowd around the poles of a panorama and in views of a narrow field, so that a footprint there has
/// more of them than its part of the sphere.
struct Crowd {
    /// Directions of bunches, and the number of texels in each.
    bunches: Vec<(Direction, f64)>,
}

impl Crowd {
    /// Counts the texels of the files that are read, or of those that are planned.
    fn of(input: &Input) -> Self {
        let present: Vec<&View> = input.present().map(|(.., view)| view).collect();
        let views = if present.is_empty() { input.views().map(|view| &view.nominal).collect() } else { present };
        let across = (1..BUNCHES).take_while(|across| across * across * views.len() <= BUNCHES).last().unwrap_or(1);
        Self { bunches: views.into_iter().flat_map(|view| bunches(view, across)).collect() }
    }

    /// Returns the bytes of the weights of texels under the pixel of a view that sees most of them, looked for at so many centres.
    fn bytes_of(&self, view: &View, centres: usize) -> u64 {
        let threads = view.height().div_ceil(BAND_ROWS).min(rayon::current_num_threads());
        let some = self.bunches.iter().step_by(self.bunches.len().div_ceil(centres).max(1));
        let counts = some.filter_map(|(direction, _)| Some(self.count(*direction, solid_angle(view, *direction)?)));
        ((counts.fold(0.0, f64::max) * WEIGHT) as u64).saturating_mul(threads as u64)
    }

    /// Returns the number of texels in the footprint of a pixel of such a solid angle around a direction: in half of the sphere at most,
    /// as filters see it.
    fn count(&self, centre: Direction, solid_angle: f64) -> f64 {
        let is_inside = |direction: &Direction| {
            let cosine = direction.dot(centre);
            cosine >= 0.0 && 1.0 - cosine * cosine <= FOOTPRINT * solid_angle
        };
        self.bunches.iter().filter(|(direction, _)| is_inside(direction)).map(|(_, texels)| texels).sum()
    }
}

/// Returns the bunches of a view's texels, in so many columns and rows at most.
fn bunches(view: &View, across: usize) -> impl Iterator<Item = (Direction, f64)> {
    let (width, height) = size_of_view(view);
    let texels = area((width, height)) as f64 / (width.min(across) * height.min(across)) as f64;
    let some = move |count: usize| {
        let across = count.min(across);
        (0..across).map(move |index| (2 * index + 1) * count / (2 * across))
    };
    let pixels = some(height).flat_map(move |j| some(width).map(move |i| PixelPoint::centre(i, j)));
    pixels.filter_map(move |pixel| Some((view.direction(pixel)?, texels)))
}

/// Returns the solid angle of the pixel that sees a direction.
fn solid_angle(view: &View, direction: Direction) -> Option<f64> {
    let pixel = view.pixel(direction).filter(|pixel| view.shows(*pixel))?;
    let index = |place: f64, count: usize| (place as usize).min(count - 1);
    Some(view.texel_solid_angle(index(pixel.x, view.width()), index(pixel.y, view.height())))
}
