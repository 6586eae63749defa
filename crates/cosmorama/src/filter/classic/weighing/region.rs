use glam::{DMat2, DMat3, DVec2, DVec3};

use crate::camera::{Footprint, PixelPoint};
use crate::filter::Kernel;
use crate::filter::classic::method::Method;
use crate::filter::classic::tables::{Lit, Tables};
use crate::filter::gather::ellipse::widened;
use crate::filter::reference::look;
use crate::raster::Rgba;
use crate::world::{Source, World};

/// A rule that weighs the texels of one view under a footprint.
pub(in crate::filter::classic) trait Region: Send + Sync {
    /// Calls `visit` with each texel that counts, at its column and row, and with its weight.
    fn texels(&self, seen: &Seen, visit: impl FnMut([i64; 2], f64));

    /// Returns the kernel by which it weighs on the screen; `None` if it has a shape of its own.
    fn kernel(&self) -> Option<Kernel> {
        None
    }

    /// Returns the greatest offset along a side of the footprint, in pixels, of a texel that counts.
    fn reach(&self) -> f64 {
        self.kernel().map_or(1.0, |kernel| kernel.radius() * kernel.scale)
    }
}

/// A footprint as one view sees it.
pub(in crate::filter::classic) struct Seen<'a> {
    pub(in crate::filter::classic) source: &'a Source,
    pub(in crate::filter::classic) footprint: &'a Footprint,
    /// Place of its middle in the image.
    pub(in crate::filter::classic) place: DVec2,
    /// Derivatives of the place by screen x and y, in texels.
    pub(in crate::filter::classic) jacobian: DMat2,
}

/// Columns and rows, of a view or beyond its edges.
pub(in crate::filter::classic) struct Rectangle {
    pub(in crate::filter::classic) columns: std::ops::RangeInclusive<i64>,
    pub(in crate::filter::classic) rows: std::ops::RangeInclusive<i64>,
}

/// Greatest reach of a footprint in texels, beyond which an image has repeated itself, or ended, long before.
pub(in crate::filter::classic) const FARTHEST: f64 = 1e6;

/// Greatest distance of a corner from where derivatives place it, as a part of its distance from the middle, for four of
/// them to make a quadrilateral.
const BENT: f64 = 0.25;

/// Corners of a square of the screen, in order around it.
const SQUARE: [DVec2; 4] = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0)];

impl<'a> Seen<'a> {
    fn new(source: &'a Source, footprint: &'a Footprint) -> Option<Self> {
        let (pixel, jacobian) = source.view.texel_footprint(footprint)?;
        let place = DVec2::new(pixel.x, pixel.y);
        // From farther away nothing reaches an image, and what is not finite is farther away.
        let is_near = place.abs().max_element() < 4.0 * FARTHEST;
        (is_near && jacobian.is_finite()).then_some(Self { source, footprint, place, jacobian })
    }

    /// Returns half the size of the box around the parallelogram whose sides are the derivatives.
    pub(in crate::filter::classic) fn half_box(&self) -> DVec2 {
        0.5 * (self.jacobian.x_axis.abs() + self.jacobian.y_axis.abs())
    }

    /// Returns the derivatives with short ones raised, so that a footprint has at least the size of a texel each way.
    pub(in crate::filter::classic) fn widened(&self) -> DMat2 {
        widened(self.jacobian, 1.0)
    }

    /// Returns the corners of a square of the screen that reaches `half` pixels to each side of the middle. Each is mapped
    /// exactly, unless that is no quadrilateral any more: then derivatives place all of them.
    pub(in crate::filter::classic) fn corners(&self, half: f64) -> [DVec2; 4] {
        let straight = self.parallelogram(self.jacobian, half);
        let [a, b, c, d] = SQUARE.map(|at| self.mapped(at * half));
        let Some(corners) = a.zip(b).zip(c.zip(d)).map(|((a, b), (c, d))| [a, b, c, d]) else { return straight };
        let is_straight =
            |(corner, straight): (&DVec2, &DVec2)| corner.distance(*straight) < BENT * straight.distance(self.place);
        if corners.iter().zip(&straight).all(is_straight) { corners } else { straight }
    }

    /// Returns the corners of a square of the screen, as derivatives place them.
    pub(in crate::filter::classic) fn parallelogram(&self, jacobian: DMat2, half: f64) -> [DVec2; 4] {
        SQUARE.map(|at| self.place + jacobian * at * half)
    }

    /// Returns the place of a point of the screen, in pixels from the middle.
    fn pixel_at(&self, at: DVec2) -> Option<PixelPoint> {
        self.source.view.pixel(self.footprint.direction_at(at.x, at.y)?)
    }

    /// Returns the place of a point of the screen, in pixels from the middle; in a panorama, the nearest of all turns.
    fn mapped(&self, at: DVec2) -> Option<DVec2> {
        let there = self.pixel_at(at)?;
        let turns = |period: usize| ((self.place.x - there.x) / period as f64).round() * period as f64;
        Some(DVec2::new(there.x + self.source.period.map_or(0.0, turns), there.y))
    }

    /// Returns half the size of the box around the middle that holds these corners.
    pub(in crate::filter::classic) fn reach_of(&self, corners: [DVec2; 4]) -> DVec2 {
        corners.into_iter().fold(DVec2::ZERO, |reach, corner| reach.max((corner - self.place).abs()))
    }

    /// Returns the texels whose squares reach into a box around the footprint's middle, as far as the view has some.
    pub(in crate::filter::classic) fn texels_within(&self, half: DVec2) -> Rectangle {
        let half = half.min(DVec2::splat(FARTHEST));
        let (first, last) = ((self.place - half).floor(), (self.place + half).ceil());
        let (width, height) = (self.source.view.width() as i64, self.source.view.height() as i64);
        let (left, right) = match self.source.period {
            // Once around the middle is enough: further columns repeat these.
            Some(period) => {
                let opposite = (self.place.x - 0.5 * period as f64).round() as i64;
                (opposite, opposite + period as i64 - 1)
            }
            None => (0, width - 1),
        };
        Rectangle {
            columns: (first.x as i64).max(left)..=(last.x as i64 - 1).min(right),
            rows: (first.y as i64).max(0)..=(last.y as i64 - 1).min(height - 1),
        }
    }

    /// Returns the matrix from a direction to the plane that touches the sphere in the footprint's middle, in pixels, times
    /// the depth before it. `None` for a footprint that spans nothing.
    pub(in crate::filter::classic) fn screen(&self) -> Option<DMat3> {
        let (middle, jacobian) = (self.footprint.direction.vector(), &self.footprint.jacobian);
        let normal = jacobian.dx.cross(jacobian.dy);
        let square = normal.length_squared();
        let across = |side: DVec3| (side / square).reject_from_normalized(middle);
        let rows = [across(jacobian.dy.cross(normal)), across(normal.cross(jacobian.dx)), middle];
        (square > 0.0).then(|| DMat3::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose())
    }

    /// Returns whether the footprint's middle is in the image.
    fn is_inside(&self) -> bool {
        let inside = |at: f64, size: usize| at >= 0.0 && at <= size as f64;
        let view = &self.source.view;
        (self.source.period.is_some() || inside(self.place.x, view.width())) && inside(self.place.y, view.height())
    }

    /// Returns how far from the middle a texel may be that counts, in pixels along each side: some more than the reach, and a
    /// texel.
    fn farthest(&self, reach: f64) -> DVec2 {
        let jacobian = &self.footprint.jacobian;
        let sides = DVec2::new(jacobian.dx.length(), jacobian.dy.length());
        DVec2::splat(1.2 * reach) + self.source.texel_pitch / sides
    }

    /// Returns whether the view shows one of a grid of directions around the middle, that far to each side.
    fn shows_some(&self, farthest: DVec2) -> bool {
        let shown = |at| self.pixel_at(at).is_some_and(|pixel| self.source.shows(pixel));
        !self.lies_beyond(farthest) && around::<9>(farthest).any(shown)
    }

    /// Returns whether nine directions around the middle, that far to each side, lie farther beyond one edge of the image than
    /// from each other: then none between them is in it, and there is nothing to search. Not known of a picture that repeats.
    fn lies_beyond(&self, farthest: DVec2) -> bool {
        let grown = |(least, most): (DVec2, DVec2), at| {
            self.pixel_at(at).map(|PixelPoint { x, y }| (least.min(DVec2::new(x, y)), most.max(DVec2::new(x, y))))
        };
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let Some((least, most)) = around::<3>(farthest).try_fold(none, grown) else { return false };
        let size = DVec2::new(self.source.view.width() as f64, self.source.view.height() as f64);
        let beyond = (least - size).max(-most);
        self.source.period.is_none() && beyond.cmpgt(most - least).any()
    }

    /// Returns the test of which texels count. Where the middle lies beyond a view's edge, derivatives place some near that are
    /// far away, and each is mapped exactly.
    fn nearness(&self, reach: f64) -> impl Fn([i64; 2]) -> bool {
        let exact = if self.is_inside() { None } else { self.screen() };
        let farthest = self.farthest(reach);
        move |texel| {
            let Some(screen) = exact else { return true };
            self.source.view.direction(Self::centre(texel)).is_some_and(|direction| {
                let at = screen * direction.vector();
                at.z > 0.0 && at.truncate().abs().cmple(farthest * at.z).all()
            })
        }
    }

    /// Returns the offset of a texel's centre from the footprint's middle.
    pub(in crate::filter::classic) fn offset(&self, [i, j]: [i64; 2]) -> DVec2 {
        DVec2::new(i as f64 + 0.5, j as f64 + 0.5) - self.place
    }

    /// Returns the centre of a texel.
    pub(in crate::filter::classic) fn centre([i, j]: [i64; 2]) -> PixelPoint {
        PixelPoint::new(i as f64 + 0.5, j as f64 + 0.5)
    }
}

/// Returns a grid of offsets, so many along a side, from one corner to the opposite.
fn around<const SIDE: usize>(farthest: DVec2) -> impl Iterator<Item = DVec2> {
    let at = |k: usize| 2.0 * k as f64 / (SIDE - 1) as f64 - 1.0;
    (0..SIDE * SIDE).map(move |k| DVec2::new(at(k % SIDE), at(k / SIDE)) * farthest)
}

/// A rule that weighs the texels of a world under a footprint.
pub(in crate::filter::classic) trait Weighing: Send + Sync {
    /// Calls `visit` with each texel that counts, by its place in the world's light, and with its weight.
    fn for_each_texel(&self, world: &World, footprint: &Footprint, visit: impl FnMut(usize, f64));

    /// Returns the kernel by which it weighs on the screen; `None` if it has a shape of its own.
    fn kernel(&self) -> Option<Kernel>;

    /// Returns the greatest offset along a side of the footprint, in pixels, of a texel that counts.
    fn reach(&self) -> f64;
}

impl<R: Region> Weighing for R {
    fn for_each_texel(&self, world: &World, footprint: &Footprint, mut visit: impl FnMut(usize, f64)) {
        for source in world.sources() {
            let Some(seen) = reached(source, footprint, Region::reach(self)) else { continue };
            let is_near = seen.nearness(Region::reach(self));
            self.texels(&seen, |[i, j], weight| {
                let Some(column) = source.column(i).filter(|_| is_near([i, j])) else { return };
                let texel = j as usize * source.view.width() + column as usize;
                // Views that show one direction share it, so that nothing counts twice where they meet.
                let weight = weight * f64::from(source.solid_angles[texel]);
                if weight != 0.0 {
                    visit(source.offset + texel, weight);
                }
            });
        }
    }

    fn kernel(&self) -> Option<Kernel> {
        Region::kernel(self)
    }

    fn reach(&self) -> f64 {
        Region::reach(self)
    }
}

impl<W: Weighing + 'static> Method for W {
    fn tables(self: Box<Self>, _world: &World, _light: &[Rgba]) -> Box<dyn Tables> {
        Box::new(Weighed(*self))
    }

    fn kernel(&self) -> Option<Kernel> {
        Weighing::kernel(self)
    }

    fn reach(&self) -> f64 {
        Weighing::reach(self)
    }
}

/// A rule that has no tables of light.
struct Weighed<W>(W);

impl<W: Weighing> Tables for Weighed<W> {
    fn reads(&self, of: Lit, footprint: &Footprint) -> usize {
        let mut count = 0;
        self.0.for_each_texel(of.world, footprint, |_, _| count += 1);
        count
    }

    fn average(&self, of: Lit, footprint: &Footprint) -> Rgba {
        let (mut sum, mut weights) = ([0f64; 4], 0f64);
        self.0.for_each_texel(of.world, footprint, |texel, weight| {
            for (sum, channel) in sum.iter_mut().zip(of.light[texel].0) {
                *sum += weight * f64::from(channel);
            }
            weights += weight;
        });
        let mean = || Rgba(sum.map(|channel| (channel / weights) as f32));
        if weights > 0.0 { mean() } else { look(of.world, footprint.direction, of.light).unwrap_or_default() }
    }
}

/// Returns how a view sees a footprint of which so many pixels count; `None` if it shows nothing near it.
pub(in crate::filter::classic) fn reached<'a>(
    source: &'a Source,
    footprint: &'a Footprint,
    pixels: f64,
) -> Option<Seen<'a>> {
    let width = footprint.jacobian.dx.length() + footprint.jacobian.dy.length();
    let reach = 2.0 * (width * pixels.max(1.0) + source.texel_pitch);
    let seen = source.reaches(footprint.direction, reach).then(|| Seen::new(source, footprint))??;
    (seen.is_inside() || seen.shows_some(seen.farthest(pixels))).then_some(seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, Placement};
    use crate::sphere::{CubeFace, Direction};

    fn world() -> World {
        let view = CameraModel::Equirect(Default::default()).view(64, 32).expect("a panorama");
        World::new([("all".to_owned(), view)]).expect("one view")
    }

    /// Checks that few directions tell when a picture is out of reach, and never where many find something.
    #[test]
    fn what_lies_beyond_is_not_shown() {
        let face = |face: CubeFace| {
            let placed =
                Placement { orientation: face.orientation(), ..Placement::new(CameraModel::CubeFace(CubeFaceCamera)) };
            (face.name().to_owned(), placed.view(32, 32).expect("a face"))
        };
        let world = World::new(CubeFace::ALL.map(face)).expect("six faces");
        let (mut out_of_reach, mut searched) = (0, 0);
        for k in 0..2000 {
            let [x, y, z, size] = [0.73, 0.31, 0.57, 0.11].map(|step: f64| (step * f64::from(k)).fract() * 2.0 - 1.0);
            let Some(direction) = Direction::new(DVec3::new(x, y, z)) else { continue };
            let (right, up) = direction.vector().any_orthonormal_pair();
            let footprint = Footprint::new(direction, right * 0.02 * size, up * 0.005 + right * 0.01 * size);
            for source in world.sources() {
                let Some(seen) = Seen::new(source, &footprint).filter(|seen| !seen.is_inside()) else { continue };
                let farthest = seen.farthest(2.0);
                let shown = around::<33>(farthest).any(|at| seen.pixel_at(at).is_some_and(|pixel| source.shows(pixel)));
                assert!(!(shown && seen.lies_beyond(farthest)), "{footprint:?}");
                out_of_reach += usize::from(seen.lies_beyond(farthest));
                searched += usize::from(!shown);
            }
        }
        assert!(out_of_reach > 0 && out_of_reach < searched, "{out_of_reach} of {searched}");
    }

    #[test]
    fn the_screen_is_where_derivatives_point() {
        let world = world();
        let (right, up) = Direction::FRONT.vector().any_orthonormal_pair();
        let footprint = Footprint::new(Direction::FRONT, right * 0.02 + up * 0.01, up * 0.03 - right * 0.005);
        let seen = Seen::new(&world.sources()[0], &footprint).expect("in the middle of the picture");
        let screen = seen.screen().expect("a footprint with an area");
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-0.7, 0.4)] {
            let there = Direction::FRONT.vector() + footprint.jacobian.dx * x + footprint.jacobian.dy * y;
            // However long the vector is.
            let at = screen * (there * 7.0);
            assert!((at.truncate() / at.z).distance(DVec2::new(x, y)) < 1e-12, "({x}, {y}): {at}");
        }
    }
}
