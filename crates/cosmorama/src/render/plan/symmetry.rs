//! Mirror symmetry of a conversion. A dome made from a cube is symmetric left and right, before and behind, and about
//! its diagonals.

use glam::DMat3;

use super::window_format::Format;
use crate::camera::{FieldStop, PixelPoint, PixelRect, View};
use crate::projection::ProjectionKind;
use crate::raster::RowLayout;
use crate::render::Resampler;
use crate::render::scan::tile::SIDE;
use crate::sphere::Direction;
use crate::world::{Near, Source, TexelPlace, World};

/// Rounding error in radians by which equal directions may differ.
const SAME: f64 = 1e-11;

/// Rounding error in texels by which equal places may differ.
const SAME_TEXEL: f64 = 1e-6;

/// Number of points along a side at which a symmetry is tested; the formulas between are smooth.
const STEPS: usize = 16;

/// Greatest number of mirror images: the part itself, left and right exchanged, top and bottom exchanged, both; and
/// each of these transposed.
pub(crate) const MOST_IMAGES: usize = 8;

/// Greatest number of mirror images that are not transposed. The transposed ones come after these.
pub(crate) const UPRIGHT: usize = 4;

/// Greatest number of mirror images in which windows are traversed together.
pub(crate) const TOGETHER: usize = 4;

/// Part of a target that is computed, and the mirror images that make up the rest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mirrors {
    /// Number of columns to compute: all, or the left half.
    pub(crate) columns: usize,
    /// Number of rows to compute: all, or the upper half.
    pub(crate) rows: usize,
    /// Mirror images of the computed part; the first is the part itself.
    pub(crate) images: Vec<MirrorImage>,
    /// Whether the light is packed without gaps, so that its indices are those of the world.
    pub(crate) is_packed: bool,
    /// Traversals of windows in all images, for each view of the world.
    ways: Vec<Ways>,
}

/// Traversals of windows of a view, one for each mirror image. Images that are not transposed come first. Among either
/// kind, traversals from left to right come first, and among these, those that go down.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ways {
    /// Index of the mirror image of each traversal, and whether that image reverses lanes on the target. In a
    /// transposed image it is rows that it reverses.
    pub(crate) order: [(usize, bool); MOST_IMAGES],
    /// Number of traversals, and the number of those from left to right that are not transposed.
    pub(crate) count: usize,
    pub(crate) forward: usize,
    /// Number of transposed traversals.
    pub(crate) turned: usize,
    /// Walk of each traversal.
    pub(crate) walks: [Walk; MOST_IMAGES],
}

impl Ways {
    fn of(images: &[MirrorImage], view: usize) -> Self {
        let walks = images.iter().map(|image| image.view(view).walk([0; 2]));
        let mut walks: Vec<(usize, Walk)> = walks.enumerate().collect();
        walks.sort_by_key(|(_, walk)| (walk.is_turned, walk.is_reversed, walk.down < 0));
        if walks.len() == MOST_IMAGES && walks.iter().all(|(_, walk)| !walk.is_turned) {
            // Every other one of the four in each direction, so that both halves have two in each direction with the
            // same steps.
            walks = [0, 2, 4, 6, 1, 3, 5, 7].map(|at| walks[at]).to_vec();
        }
        let mut ways = Self { count: walks.len(), ..Self::default() };
        for (at, (index, walk)) in walks.into_iter().enumerate() {
            let flips = images[index].flips;
            ways.order[at] = (index, flips[0]);
            ways.walks[at] = walk;
            ways.forward += usize::from(!walk.is_reversed && !walk.is_turned);
            ways.turned += usize::from(walk.is_turned);
        }
        ways
    }

    /// Returns whether four traversals from this one on are two from left to right and two from right to left. Both
    /// pairs must have the same two steps from row to row.
    pub(crate) fn are_four(&self, first: usize) -> bool {
        let [a, b, c, d] = self.four(first);
        let alike = |a: Walk, b: Walk| !a.is_reversed && b.is_reversed && a.down == b.down;
        alike(a, c) && alike(b, d) && [b, c, d].iter().all(|walk| walk.is_turned == a.is_turned)
    }

    /// Returns four traversals from this one on.
    pub(crate) fn four(&self, first: usize) -> [Walk; TOGETHER] {
        *self.walks[first..].first_chunk().expect("four ways from the first or the fifth on")
    }
}

/// A mirror image of the computed part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MirrorImage {
    /// Whether columns and rows are exchanged on the target, before the flips.
    pub(crate) is_turned: bool,
    /// Whether left and right are exchanged on the target, and whether top and bottom are.
    pub(crate) flips: [bool; 2],
    /// Reflection of each view of the world.
    views: Vec<Reflection>,
}

/// A view as a mirror image shows it: as another view or itself, with its texels in another order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// Place of the view in the buffer of light.
    rows: RowLayout,
    /// Whether its columns are seen as rows, and its rows as columns.
    is_turned: bool,
    /// Whether the order of columns is reversed, and whether that of rows is.
    flips: [bool; 2],
}

/// First texel of a window in the buffer of light, and the steps from texel to texel there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Walk {
    pub(crate) first: u32,
    /// Whether a row of the window is a column in the buffer. The other fields describe the window as it lies in the
    /// buffer.
    pub(crate) is_turned: bool,
    /// Whether columns run from right to left.
    pub(crate) is_reversed: bool,
    /// Step from one row to the next, in texels.
    pub(crate) down: i32,
}

impl Walk {
    /// Returns the steps in texels from one column of a window to the next, and from one row to the next.
    #[inline(always)]
    pub(crate) fn steps(self) -> [i32; 2] {
        let along = if self.is_reversed { -1 } else { 1 };
        if self.is_turned { [self.down, along] } else { [along, self.down] }
    }

    /// Returns the texel at this offset in columns and rows.
    #[inline(always)]
    pub(crate) fn texel(self, offset: [usize; 2]) -> u32 {
        let [across, down] = self.steps();
        let moved = |first: u32, step: i32, count: usize| first.wrapping_add_signed(step.wrapping_mul(count as i32));
        moved(moved(self.first, across, offset[0]), down, offset[1])
    }
}

impl Reflection {
    /// Returns the walk of a window whose first texel is in this column and row of the view itself.
    #[inline(always)]
    pub(crate) fn walk(&self, texel: [usize; 2]) -> Walk {
        let RowLayout { size: [width, height], pitch, .. } = self.rows;
        let [column, row] = exchanged(texel, self.is_turned);
        let column = if self.flips[0] { width - 1 - column } else { column };
        let (row, down) = if self.flips[1] { (height - 1 - row, -(pitch as i32)) } else { (row, pitch as i32) };
        // Texels of a world, and what fills up their rows, are counted in 32 bits.
        let first = self.rows.index([column, row]) as u32;
        Walk { first, is_turned: self.is_turned, is_reversed: self.flips[0], down }
    }
}

impl MirrorImage {
    /// Returns the view that the mirror image shows in place of this one.
    pub(crate) fn view(&self, index: usize) -> &Reflection {
        &self.views[index]
    }

    /// Returns the texel that the mirror image shows in place of this one, by its index in the buffer of light.
    pub(crate) fn texel(&self, TexelPlace { view, texel }: TexelPlace) -> u32 {
        self.views[view].walk(texel).first
    }
}

impl Mirrors {
    /// Returns the one picture of a conversion without mirror images.
    pub(crate) fn none<F: Format>(Resampler { world, target, .. }: &Resampler) -> Self {
        let layout = RowLayout::of(world.view_sizes(), F::pitch);
        Self::new([target.width(), target.height()], vec![MirrorImage::itself(&layout)])
    }

    /// Finds the symmetries of a conversion, in the layout of light that these weights apply to.
    pub(crate) fn of<F: Format>(Resampler { world, target, filter }: &Resampler) -> Self {
        let (width, height) = (target.width(), target.height());
        let layout = RowLayout::of(world.view_sizes(), F::pitch);
        let reflect = |flips: [bool; 2]| {
            let is_even = (!flips[0] || width % 2 == 0) && (!flips[1] || height % 2 == 0);
            // Of two texels that are equally near, the point filter takes the right one, in a mirror image as well.
            (is_even && !filter.kind.chooses_texels())
                .then(|| MirrorImage::of((world, &layout), target, Flip { is_turned: false, axes: flips }))
                .flatten()
        };
        let (across, mut down) = (reflect([true, false]), reflect([false, true]));
        let both = if across.is_some() && down.is_some() { reflect([true, true]) } else { None };
        if across.is_some() && both.is_none() {
            // Each flip is near enough alone, but not both together: a quarter of the picture would have no mirror
            // image.
            down = None;
        }
        let columns = if across.is_some() { width / 2 } else { width };
        let rows = if down.is_some() { height / 2 } else { height };
        let itself = std::iter::once(MirrorImage::itself(&layout));
        let images = itself.chain([across, down, both].into_iter().flatten()).collect();
        Self::new([columns, rows], Self::with_diagonals(images, (world, &layout), target))
    }

    /// Adds the mirror images about the target's diagonals to those that are upright. They are added only if all
    /// upright ones exist, and all diagonal ones too.
    fn with_diagonals(
        upright: Vec<MirrorImage>,
        (world, layout): (&World, &[RowLayout]),
        target: &View,
    ) -> Vec<MirrorImage> {
        if upright.len() < UPRIGHT || target.width() != target.height() {
            return upright;
        }
        let turned = FLIPS.map(|axes| MirrorImage::of((world, layout), target, Flip { is_turned: true, axes }));
        let all: Vec<_> = upright.iter().cloned().chain(turned.into_iter().flatten()).collect();
        // Unless windows can be traversed by fours, the time that the diagonals save is lost again.
        let are_fours = |view: usize| {
            let ways = Ways::of(&all, view);
            ways.are_four(0) && ways.are_four(TOGETHER)
        };
        if all.len() == MOST_IMAGES && (0..layout.len()).all(are_fours) { all } else { upright }
    }

    pub(crate) fn new([columns, rows]: [usize; 2], images: Vec<MirrorImage>) -> Self {
        let views = &images[0].views;
        let is_packed = views.iter().all(|view| view.rows.pitch == view.rows.size[0]);
        let ways = (0..views.len()).map(|view| Ways::of(&images, view)).collect();
        Self { columns, rows, images, is_packed, ways }
    }

    /// Returns whether there are mirror images about the diagonals. If so, pixels to the left of the diagonal through
    /// the first column and row are not computed either.
    pub(crate) fn has_diagonals(&self) -> bool {
        self.images.len() == MOST_IMAGES
    }

    /// Returns the mirror images of a pixel. Patches on the diagonal are computed whole, and have no transposed images.
    #[inline(always)]
    pub(crate) fn images_of(&self, [column, row]: [usize; 2]) -> &[MirrorImage] {
        let is_on_diagonal = self.has_diagonals() && column / SIDE == row / SIDE;
        if is_on_diagonal { &self.images[..UPRIGHT] } else { &self.images }
    }

    /// Returns the first column to compute in rows from this one on, which make patches or bands.
    pub(crate) fn first_column(&self, row: usize) -> usize {
        if self.has_diagonals() { row } else { 0 }
    }

    /// Returns the place of each view in the light.
    pub(crate) fn layout(&self) -> impl Iterator<Item = &RowLayout> {
        self.images[0].views.iter().map(|view| &view.rows)
    }

    /// Returns the traversals of windows of a view.
    pub(crate) fn ways(&self, view: usize) -> &Ways {
        &self.ways[view]
    }
}

impl MirrorImage {
    /// Returns the image that is the computed part itself.
    pub(crate) fn itself(layout: &[RowLayout]) -> Self {
        let (is_turned, flips) = (false, [false; 2]);
        let views = layout.iter().map(|&rows| Reflection { rows, is_turned, flips }).collect();
        Self { is_turned, flips, views }
    }

    /// Returns the mirror image of a flip; `None` unless the world has a mirror plane, or a quarter turn, that fits.
    fn of((world, layout): (&World, &[RowLayout]), target: &View, flip: Flip) -> Option<Self> {
        let mirror = mirror_of(target, flip)?;
        let seen = |source: &Source| {
            let [across, down] = [source.view.width(), source.view.height()].map(|size| 0.5 * size as f64);
            // Of many views, those that show what is behind its middle in the mirror.
            let middle = source.view.direction(PixelPoint::new(across, down));
            let mut others = middle.map_or(Near::All(0..world.sources().len()), |middle| {
                world.near(Direction::from_unit(mirror * middle.vector()), || 0.0)
            });
            others.find_map(|view| {
                let other = &world.sources()[view];
                let Flip { is_turned, axes: flips } = reflection(source, other, &mirror, flip.is_turned)?;
                Some(Reflection { rows: layout[view], is_turned, flips })
            })
        };
        let views = world.sources().iter().map(seen).collect::<Option<_>>()?;
        Some(Self { is_turned: flip.is_turned, flips: flip.axes, views })
    }
}

/// Returns the reflection or rotation of the world (an orthogonal matrix) that flips what a target shows.
fn mirror_of(target: &View, flip: Flip) -> Option<DMat3> {
    let size = [target.width() as f64, target.height() as f64];
    let at = |x: f64, y: f64| PixelPoint::new(size[0] * x, size[1] * y);
    let flipped = |point| flip.of(point, size);
    let seen = |point| target.direction(point).map(Direction::vector);
    let three = [(0.4, 0.45), (0.55, 0.4), (0.6, 0.65)].map(|(x, y)| at(x, y));
    let columns = |points: [PixelPoint; 3]| {
        let [a, b, c] = points.map(seen);
        Some(DMat3::from_cols(a?, b?, c?))
    };
    let here = columns(three)?;
    let mirror = columns(three.map(flipped))? * here.inverse();
    let is_orthogonal = (mirror * mirror.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-9);
    let is_same = |point: PixelPoint| match (seen(point), seen(flipped(point))) {
        (Some(a), Some(b)) => (mirror * a - b).length() < SAME,
        (None, None) => true,
        _ => false,
    };
    let stop_is_same = || {
        let centre = target.grid.to_plane(at(0.5, 0.5));
        let off = |axis: usize| [centre.x, centre.y][axis].abs();
        let is_centred = (0..2).all(|axis| !(flip.axes[axis] || flip.is_turned) || off(axis) < SAME);
        let side = target.stop.half_space.map(|side| target.orientation.to_world(side).vector());
        is_centred && side.is_none_or(|side| (mirror * side - side).length() < SAME)
    };
    let is_mirror = is_formula(target)
        && is_orthogonal
        && points().all(|(x, y)| is_same(at(x, y)))
        && (target.stop == FieldStop::NONE || stop_is_same());
    is_mirror.then_some(mirror)
}

/// Returns the flip that makes another view the reflection of one; `None` if it is not, or if texels of either are
/// hidden or shared. Flips over the diagonal count only with `may_turn`.
fn reflection(source: &Source, other: &Source, mirror: &DMat3, may_turn: bool) -> Option<Flip> {
    let (a, b) = (&source.view, &other.view);
    let is_plain = |source: &Source| {
        let all = PixelRect { left: 0, top: 0, right: source.view.width(), bottom: source.view.height() };
        source.whole == all && source.mask.is_none() && source.view.stop == FieldStop::NONE && is_formula(&source.view)
    };
    let [size, other_size] = [a, b].map(|view| [view.width() as f64, view.height() as f64]);
    if a.projection != b.projection || !is_plain(source) || !is_plain(other) {
        return None;
    }
    let fits = |flip: &Flip| {
        let same_size = exchanged(size, flip.is_turned) == other_size;
        same_size
            && points().all(|(x, y)| {
                let point = PixelPoint::new(size[0] * x, size[1] * y);
                let expected = flip.of(point, other_size);
                let Some(direction) = a.direction(point) else { return b.direction(expected).is_none() };
                let seen = b.pixel(Direction::from_unit(*mirror * direction.vector()));
                let near = |pixel: PixelPoint| (pixel.x - expected.x).hypot(pixel.y - expected.y) < SAME_TEXEL;
                seen.is_some_and(|pixel| near(b.wrapped(pixel)))
            })
    };
    let turns = if may_turn { &[false, true][..] } else { &[false] };
    let all = turns.iter().flat_map(|&is_turned| FLIPS.map(|axes| Flip { is_turned, axes }));
    all.into_iter().find(fits)
}

/// Returns whether a view follows a formula that a few points determine; a table may hold anything between them.
fn is_formula(view: &View) -> bool {
    !matches!(view.projection, ProjectionKind::StMap(_))
}

/// Returns points all over a picture, as parts of its width and height, none of them on its edge.
fn points() -> impl Iterator<Item = (f64, f64)> {
    let at = |step: usize| (step as f64 + 0.37) / STEPS as f64;
    (0..STEPS).flat_map(move |j| (0..STEPS).map(move |i| (at(i), at(j))))
}

/// All flips along the axes: none, left and right exchanged, top and bottom exchanged, both.
const FLIPS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// Flip of a picture: first over its diagonal, or not, so that columns become rows; then along its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flip {
    is_turned: bool,
    axes: [bool; 2],
}

impl Flip {
    /// Returns the place of a point in a flipped picture of this size.
    fn of(self, point: PixelPoint, [width, height]: [f64; 2]) -> PixelPoint {
        let [x, y] = exchanged([point.x, point.y], self.is_turned);
        PixelPoint { x: if self.axes[0] { width - x } else { x }, y: if self.axes[1] { height - y } else { y } }
    }
}

/// Exchanges column and row if `is_turned`.
#[inline(always)]
pub(crate) fn exchanged<T>([column, row]: [T; 2], is_turned: bool) -> [T; 2] {
    if is_turned { [row, column] } else { [column, row] }
}
