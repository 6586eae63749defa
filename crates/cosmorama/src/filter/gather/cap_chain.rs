use std::ops::Range;

use glam::DVec3;

use super::cap::texels_within;
use crate::camera::{PixelPoint, PixelRect};
use crate::projection::{PlanePoint, PlaneRect, Projection};
use crate::sphere::{Angle, Direction};
use crate::world::Source;

/// A chain of caps that holds all of a long ellipse, where a single cap would hold many times as much.
#[derive(Clone, Debug)]
pub(crate) struct CapChain {
    /// The cap that holds all of the ellipse.
    whole: (Direction, f64),
    links: Vec<(Direction, f64)>,
    /// Semi-axes in the tangent plane, each divided by its squared length.
    axes: [DVec3; 2],
    /// Share of the caps' total area that the ellipse fills.
    filled: f64,
}

/// Ratio of length to width up to which an ellipse has one cap.
const ROUND: f64 = 2.0;

/// Semi-major axis, in radians, above which an ellipse has one cap as well, because the sphere bends too much along it.
const LONG: f64 = 0.5;

/// Greatest number of rows, and of columns, that are tested to estimate a count of texels.
const LINES: usize = 32;

/// Greatest number of caps in a chain.
const MOST: f64 = 16.0;

impl CapChain {
    /// Returns the chain around an ellipse with these semi-axes in the plane tangent to the sphere at `centre`. It
    /// holds all directions that lie in the ellipse when projected onto that plane along `centre`.
    pub(crate) fn around(centre: Direction, major: DVec3, minor: f64) -> Self {
        let length = major.length();
        let across = centre.vector().cross(major).normalize_or_zero() / minor;
        let axes = [major / (length * length), across];
        let one = Self { filled: minor / length, axes, ..Self::of(centre, length) };
        // Of an ellipse that is no number, one cap holds all that could be meant.
        let is_long = length > ROUND * minor && length <= LONG;
        if !is_long {
            return one;
        }
        let count = (length / minor).ceil().min(MOST);
        // No point of the ellipse is farther than `radius` from the next disc's centre in the plane, or than `chord` on
        // the sphere.
        let radius = minor.hypot(length / count);
        let chord = radius / (1.0 - length * length).sqrt();
        let link = |k: usize| {
            let offset = major * ((2 * k + 1) as f64 / count - 1.0);
            let up = (1.0 - offset.length_squared()).sqrt();
            (Direction::from_unit(offset + centre.vector() * up), 2.0 * (chord / 2.0).min(1.0).asin())
        };
        let filled = length * minor / (count * radius * radius);
        Self { links: (0..count as usize).map(link).collect(), filled, ..one }
    }

    /// Returns a chain of one cap, around a disc in the plane tangent to the sphere at `centre`.
    pub(crate) fn of(centre: Direction, radius: f64) -> Self {
        let whole = (centre, radius.min(1.0).asin());
        let (right, up) = centre.vector().any_orthonormal_pair();
        Self { whole, links: vec![whole], axes: [right / radius, up / radius], filled: 1.0 }
    }

    /// Calls `visit` with the runs of texels of a source that can lie in the chain, row by row and each texel once.
    /// Around a rim these are far fewer texels than the rectangle around the chain has.
    pub(crate) fn each_run(&self, source: &Source, mut visit: impl FnMut(usize, Range<usize>)) {
        let (centre, radius) = self.whole;
        let Some(rect) = texels_within(source, centre, radius) else { return };
        if source.period.is_some() {
            return (rect.top..rect.bottom).for_each(|j| visit(j, rect.left..rect.right));
        }
        let grid = &source.view.grid;
        let outline =
            |(centre, radius): &(Direction, f64)| source.view.cap_outline(*centre, Angle::from_radians(*radius));
        let outlines: Vec<_> = self.links.iter().map(outline).collect();
        let column = |x: f64, y: f64| grid.to_pixel(PlanePoint::new(x, y)).x.clamp(rect.left as f64, rect.right as f64);
        let mut spans = Vec::new();
        for j in rect.top..rect.bottom {
            let y = grid.to_plane(PixelPoint::centre(rect.left, j)).y;
            spans.clear();
            outlines.iter().for_each(|outline| outline.cut(y, &mut spans));
            for span in &mut spans {
                let [a, b] = span.map(|x| column(x, y));
                // In a mirrored image, columns run against x.
                *span = [a.min(b), a.max(b)];
            }
            spans.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            let mut done = rect.left;
            for [left, right] in &spans {
                let (left, right) = (done.max(left.floor() as usize), right.ceil() as usize);
                if left < right {
                    visit(j, left..right);
                    done = right;
                }
            }
        }
    }

    /// Estimates the number of texels of a source in the ellipse from the area of the caps in the image. In a panorama,
    /// whose texels converge at the poles, it tests some of the texels instead.
    pub(crate) fn texels(&self, source: &Source) -> f64 {
        let (centre, radius) = self.whole;
        let Some(rect) = texels_within(source, centre, radius) else { return 0.0 };
        let all = (rect.width() * rect.height()) as f64;
        if source.period.is_some() {
            return all * self.part_of(source, rect);
        }
        let grid = &source.view.grid;
        let corners = [PixelPoint::new(0.0, 0.0), PixelPoint::new(grid.width() as f64, grid.height() as f64)];
        let [a, b] = corners.map(|corner| grid.to_plane(corner));
        let picture = PlaneRect {
            min: PlanePoint::new(a.x.min(b.x), a.y.min(b.y)),
            max: PlanePoint::new(a.x.max(b.x), a.y.max(b.y)),
        };
        let area = |(centre, radius): &(Direction, f64)| {
            source.view.cap_outline(*centre, Angle::from_radians(*radius)).area_within(picture)
        };
        let texel = grid.step().x * grid.step().y;
        all.min(self.links.iter().map(area).sum::<f64>() * self.filled / texel.abs())
    }

    /// Estimates the part of a rectangle of texels that lies in the ellipse, from tests of some rows and columns.
    fn part_of(&self, source: &Source, rect: PixelRect) -> f64 {
        let [across, down] = [rect.width(), rect.height()].map(|size| size.div_ceil(LINES));
        let step = source.view.grid.step().x * across as f64;
        let (mut count, mut all) = (0, 0);
        for j in (rect.top + (rect.height() - 1) % down / 2..rect.bottom).step_by(down) {
            let first = source.view.grid.to_plane(PixelPoint::centre(rect.left + (rect.width() - 1) % across / 2, j));
            source.view.projection.unproject_row(first, step, rect.width().div_ceil(across), |_, direction| {
                count += usize::from(self.holds(source.view.orientation.to_world(direction)));
            });
            all += rect.width().div_ceil(across);
        }
        f64::from(count as u32) / all.max(1) as f64
    }

    /// Returns whether a direction is in the ellipse.
    fn holds(&self, direction: Direction) -> bool {
        let [along, across] = self.axes.map(|axis| axis.dot(direction.vector()));
        along * along + across * across < 1.0 && self.whole.0.dot(direction) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, EquirectCamera, MirrorBallCamera, OctahedralCamera, WorldMapCamera};
    use crate::world::World;

    fn worlds() -> impl Iterator<Item = World> {
        let frames = [
            CameraModel::MirrorBall(MirrorBallCamera::default()),
            CameraModel::Octahedral(OctahedralCamera::default()),
            CameraModel::WorldMap(WorldMapCamera::Hammer),
            CameraModel::Equirect(EquirectCamera::default()),
        ];
        frames.into_iter().map(|frame| {
            let view = frame.view(64, frame.natural_height(64)).expect("a view");
            World::new([("all".to_owned(), view)]).expect("one view")
        })
    }

    #[test]
    fn a_chain_holds_its_ellipse_and_nothing_twice() {
        for world in worlds() {
            let source = &world.sources()[0];
            for (k, centre) in Direction::spread(300).enumerate() {
                let (right, up) = centre.vector().any_orthonormal_pair();
                let (sin, cos) = (k as f64).sin_cos();
                let (length, minor) = (0.05 + 0.001 * k as f64, [0.3, 0.05, 0.01][k % 3]);
                let (along, across) = (right * cos + up * sin, up * cos - right * sin);
                let chain = CapChain::around(centre, along * length.max(minor), minor.min(length));
                let mut visits = vec![0; source.view.width() * source.view.height()];
                chain.each_run(source, |j, columns| {
                    columns.for_each(|i| visits[j * source.view.width() + i] += 1);
                });
                assert!(visits.iter().all(|visits| *visits < 2), "{centre:?}");
                for (texel, visits) in visits.into_iter().enumerate() {
                    let at = PixelPoint::centre(texel % source.view.width(), texel / source.view.width());
                    let Some(direction) = source.view.direction(at) else { continue };
                    let offset = direction.vector();
                    let place = (along.dot(offset) / length.max(minor), across.dot(offset) / minor.min(length));
                    let is_inside = centre.dot(direction) > 0.0 && place.0.hypot(place.1) < 1.0;
                    assert!(visits == 1 || !is_inside, "{:?}: {at:?} around {centre:?}", source.view.projection);
                }
            }
        }
    }

    #[test]
    fn a_long_ellipse_is_walked_along() {
        let world = worlds().next().expect("a mirror ball");
        let count = |chain: CapChain| {
            let mut count = 0;
            chain.each_run(&world.sources()[0], |_, columns| count += columns.len());
            count
        };
        let (centre, major) = (Direction::UP, DVec3::X * 0.4);
        let (chain, cap) = (count(CapChain::around(centre, major, 0.03)), count(CapChain::of(centre, 0.4)));
        assert!(4 * chain < cap, "{chain} texels, not {cap}");
    }
}
