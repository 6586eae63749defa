use glam::{DMat2, DVec2};

use super::tile::{HALF, SIDE};
use crate::camera::{Footprint, PixelPoint, View};
use crate::filter::Kernel;
use crate::filter::gather::cap::Cap;
use crate::render::scan::sampling::Sampling;
use crate::world::Source;

/// Lattice of the points at which patches are measured. A patch has nine points, and shares some of them with its
/// neighbours. Each point is computed once.
#[derive(Clone, Debug)]
pub(crate) struct Lattice<'a> {
    target: &'a View,
    sampling: Sampling<'a>,
    /// Whether pixels are taken as circles, as [`Kernel::round`](crate::filter::Kernel::round) says.
    round: bool,
    slots: Vec<Slot>,
}

/// A point of a patch: its place among the texels of a view, and its derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub(crate) place: DVec2,
    /// Change of the place from pixel to pixel.
    pub(crate) slope: DMat2,
    /// Axes of the pixel's footprint. They are the slope, unless pixels are taken as circles, or are those of a lens.
    pub(crate) jacobian: DMat2,
}

/// Results for the last point that used this slot.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    /// Pixel at whose centre the point lies.
    pixel: Option<[usize; 2]>,
    /// Footprint of the pixel.
    screen: Option<Footprint>,
    /// Direction and its derivatives: those of the footprint, unless that is a lens's.
    step: Option<Footprint>,
    /// Point as a view sees it, with the view's index.
    seen: Option<(usize, Option<Point>)>,
}

/// Number of points across that are remembered: more than a tile has.
const ACROSS: usize = 32;

/// Number of points down that are remembered: more than a patch has.
const DOWN: usize = 4;

impl Point {
    /// Measures a direction in a view, with its derivatives, and the footprint of a pixel there.
    fn of(source: &Source, step: &Footprint, screen: &Footprint) -> Option<Self> {
        let (at, slope) = source.view.texel_footprint(step)?;
        let other = (screen != step).then(|| source.view.texel_footprint(screen));
        let jacobian = other.flatten().map_or(slope, |(_, jacobian)| jacobian);
        Some(Self { place: DVec2::new(at.x, at.y), slope, jacobian })
    }
}

impl<'a> Lattice<'a> {
    pub(crate) fn new((target, sampling): (&'a View, Sampling<'a>), kernel: &Kernel) -> Self {
        Self { target, sampling, round: kernel.round, slots: vec![Slot::default(); ACROSS * DOWN] }
    }

    pub(crate) fn target(&self) -> &'a View {
        self.target
    }

    /// Measures a pixel in a view, given its direction and its derivatives.
    pub(super) fn measure(&self, source: &Source, step: &Footprint) -> Option<Point> {
        self.shaped(source, step, &self.sampling.footprint(step)?)
    }

    fn shaped(&self, source: &Source, step: &Footprint, screen: &Footprint) -> Option<Point> {
        Point::of(source, step, &if self.round { screen.rounded() } else { *screen })
    }

    /// Returns the footprint of a pixel whose column and row are multiples of half a patch.
    pub(crate) fn footprint(&mut self, pixel: [usize; 2]) -> Option<Footprint> {
        self.slot(pixel).screen
    }

    /// Returns the footprint of a pixel at half-patch steps, and its point in the view at this index.
    pub(crate) fn point(
        &mut self,
        pixel: [usize; 2],
        (view, source): (usize, &Source),
    ) -> Option<(Footprint, Option<Point>)> {
        let Slot { screen, step, seen, .. } = *self.slot(pixel);
        let screen = screen?;
        let point = match seen {
            Some((known, point)) if known == view => point,
            _ => {
                let point = self.shaped(source, &step?, &screen);
                self.slot(pixel).seen = Some((view, point));
                point
            }
        };
        Some((screen, point))
    }

    /// Returns the cap that holds the pixels of the patch with this first pixel. `None` where a corner has no
    /// direction, or where the cap would be wide.
    pub(crate) fn cap(&mut self, [i, j]: [usize; 2]) -> Option<Cap> {
        let middle = self.footprint([i + HALF, j + HALF])?.direction;
        let mut corner = |i, j| self.footprint([i, j]);
        let corners = [corner(i, j)?, corner(i + SIDE, j)?, corner(i, j + SIDE)?, corner(i + SIDE, j + SIDE)?];
        Cap::around(middle, &corners).map(Cap::of_whole_pixels)
    }

    fn slot(&mut self, pixel @ [i, j]: [usize; 2]) -> &mut Slot {
        let slot = &mut self.slots[j / HALF % DOWN * ACROSS + i / HALF % ACROSS];
        if slot.pixel != Some(pixel) {
            let step = self.target.footprint(PixelPoint::centre(i, j));
            let screen = step.as_ref().and_then(|step| self.sampling.footprint(step));
            *slot = Slot { pixel: Some(pixel), screen, step, seen: None };
        }
        slot
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{World, panorama};

    #[test]
    fn points_are_those_of_the_pixels_asked_for() {
        let (target, sky) = (panorama(800, 400), panorama(640, 320));
        let world = World::new(["a", "b"].map(|name| (name.to_owned(), sky.clone()))).expect("two views");
        let mut lattice = Lattice::new((&target, Sampling::default()), &Kernel::ADAPTIVE);
        // Pixels that share one slot, each of them twice, and in two views.
        for (k, pixel) in [[4, 8], [4 + 128, 8], [4, 8], [4, 24], [4, 24], [8, 24], [4, 8]].into_iter().enumerate() {
            let exact = target.footprint(PixelPoint::centre(pixel[0], pixel[1]));
            let source = &world.sources()[k % 2];
            let (screen, point) = lattice.point(pixel, (k % 2, source)).expect("a panorama looks everywhere");
            assert_eq!((Some(screen), lattice.footprint(pixel)), (exact, exact));
            let (at, jacobian) = source.view.texel_footprint(&screen).expect("a panorama looks everywhere");
            let point = point.expect("a panorama looks everywhere");
            assert_eq!((point.place, point.jacobian), (DVec2::new(at.x, at.y), jacobian));
        }
    }
}
