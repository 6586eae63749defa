//! Mirror symmetry of a conversion: a dome made of a cube is the same left and right, before and behind, and on either side of a
//! diagonal.

use glam::DMat3;

use super::window_format::Format;
use crate::camera::{FieldStop, PixelPoint, PixelRect, View};
use crate::projection::ProjectionKind;
use crate::raster::RowLayout;
use crate::render::Resampler;
use crate::render::scan::tile::SIDE;
use crate::sphere::Direction;
use crate::world::{Source, TexelPlace, World};

/// By how much directions that are the same may differ, in radians: rounding.
const SAME: f64 = 1e-11;

/// By how many texels places that are the same may.
const SAME_TEXEL: f64 = 1e-6;

/// Points along a side at which a symmetry is tried; the formulas between are smooth.
const STEPS: usize = 16;

/// Itself, left and right exchanged, top and bottom, both; and each of these turned over its diagonal.
pub(crate) const MOST_IMAGES: usize = 8;

/// How many of them show rows as rows, at most: the others come after these.
pub(crate) const UPRIGHT: usize = 4;

/// In how many of them windows are walked through together, at most.
pub(crate) const TOGETHER: usize = 4;

/// What is left of a target to compute, and the mirrors in which the rest is seen.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mirrors {
    /// Columns to compute: all, or the left half.
    pub(crate) columns: usize,
    /// Rows to compute: all, or the upper half.
    pub(crate) rows: usize,
    /// Which pictures those make; the first is what is computed itself.
    pub(crate) images: Vec<MirrorImage>,
    /// Whether nothing lies between the texels of the light: their indices are those of the world.
    pub(crate) is_packed: bool,
    /// For each view of the world how windows in it are walked through in all of them.
    ways: Vec<Ways>,
}

/// How the mirrors go through windows of a view: as they are before those turned over their diagonal, of either those from left to
/// right first, and of these those that go down first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ways {
    /// Which mirror, and whether it exchanges left and right on the target: lanes, or rows where columns are rows.
    pub(crate) order: [(usize, bool); MOST_IMAGES],
    /// How many there are, and how many of those that are not turned go from left to right.
    pub(crate) count: usize,
    pub(crate) forward: usize,
    /// How many are turned.
    pub(crate) turned: usize,
    /// How each of them goes.
    pub(crate) walks: [Walk; MOST_IMAGES],
}

impl Ways {
    fn of(images: &[MirrorImage], view: usize) -> Self {
        let walks = images.iter().map(|image| image.view(view).walk([0; 2]));
        let mut walks: Vec<(usize, Walk)> = walks.enumerate().collect();
        walks.sort_by_key(|(_, walk)| (walk.is_turned, walk.is_reversed, walk.down < 0));
        if walks.len() == MOST_IMAGES && walks.iter().all(|(_, walk)| !walk.is_turned) {
            // Of four each way every other one, so that both halves have two each way that go alike.
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

    /// Whether four from this one on go two from left to right and two from right to left, whose steps from row to row are the same
    /// two.
    pub(crate) fn are_four(&self, first: usize) -> bool {
        let [a, b, c, d] = self.four(first);
        let alike = |a: Walk, b: Walk| !a.is_reversed && b.is_reversed && a.down == b.down;
        alike(a, c) && alike(b, d) && [b, c, d].iter().all(|walk| walk.is_turned == a.is_turned)
    }

    /// Four from this one on.
    pub(crate) fn four(&self, first: usize) -> [Walk; TOGETHER] {
        *self.walks[first..].first_chunk().expect("four ways from the first or the fifth on")
    }
}

/// A picture of what is computed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MirrorImage {
    /// Whether columns are rows on the target, and rows columns: what is turned over the diagonal is exchanged after that.
    pub(crate) is_turned: bool,
    /// Whether left and right are exchanged on the target, and whether top and bottom.
    pub(crate) flips: [bool; 2],
    /// For each view of the world what is seen in its stead.
    views: Vec<Reflection>,
}

/// A view as a mirror shows it: another one, or the same, with its texels in another order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// Where it lies in the buffer of light.
    rows: RowLayout,
    /// Whether its columns are seen as rows, and its rows as columns.
    is_turned: bool,
    /// Whether its columns run the other way, and whether its rows.
    flips: [bool; 2],
}

/// Where a window begins in the buffer of light, and the steps from texel to texel there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Walk {
    pub(crate) first: u32,
    /// Whether a row of the window is a column there: all else is told of the window as it lies there.
    pub(crate) is_turned: bool,
    /// Whether columns run the other way.
    pub(crate) is_reversed: bool,
    /// From one row to the next.
    pub(crate) down: i32,
}

impl Walk {
    /// The texels from one column of a window to the next, and from one row to the next.
    #[inline(always)]
    pub(crate) fn steps(self) -> [i32; 2] {
        let along = if self.is_reversed { -1 } else { 1 };
        if self.is_turned { [self.down, along] } else { [along, self.down] }
    }

    /// The texel so many columns and rows on.
    #[inline(always)]
    pub(crate) fn texel(self, offset: [usize; 2]) -> u32 {
        let [across, down] = self.steps();
        let moved = |first: u32, step: i32, count: usize| first.wrapping_add_signed(step.wrapping_mul(count as i32));
        moved(moved(self.first, across, offset[0]), down, offset[1])
    }
}

impl Reflection {
    /// The walk of a window whose first texel is in this column and row of the view itself.
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
    /// What is seen in place of a view.
    pub(crate) fn view(&self, index: usize) -> &Reflection {
        &self.views[index]
    }

    /// The texel that the mirror shows in place of one, by its index in the buffer of light.
    pub(crate) fn texel(&self, TexelPlace { view, texel }: TexelPlace) -> u32 {
        self.views[view].walk(texel).first
    }
}

impl Mirrors {
    /// Finds the symmetries of a conversion, in the layout of light that these weights apply to.
    pub(crate) fn of<F: Format>(Resampler { world, target, filter }: &Resampler) -> Self {
        let (width, height) = (target.width(), target.height());
        let layout = RowLayout::of(world.view_sizes(), F::pitch);
        let reflect = |flips: [bool; 2]| {
            let is_even = (!flips[0] || width % 2 == 0) && (!flips[1] || height % 2 == 0);
            // Of two texels that are as near, a point takes the one to the right, in a mirror too.
            (is_even && !filter.kind.chooses_texels())
                .then(|| MirrorImage::of((world, &layout), target, Flip { is_turned: false, axes: flips }))
                .flatten()
        };
        let (across, mut down) = (reflect([true, false]), reflect([false, true]));
        let both = if across.is_some() && down.is_some() { reflect([true, true]) } else { None };
        if across.is_some() && both.is_none() {
            // Near enough each, not together: a quarter would be in no mirror.
            down = None;
        }
        let columns = if across.is_some() { width / 2 } else { width };
        let rows = if down.is_some() { height / 2 } else { height };
        let itself = std::iter::once(MirrorImage::itself(&layout));
        let images = itself.chain([across, down, both].into_iter().flatten()).collect();
        Self::new([columns, rows], Self::with_diagonals(images, (world, &layout), target))
    }

    /// Mirrors of the target, and those along its diagonals, if they are mirrors, too, and the others are all that there may be.
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
        // Windows are walked through by fours, or the work that is spared is lost again.
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

    /// Whether there are mirrors along the diagonals: what lies to the left of the one through the first column and row is not
    /// computed either.
    pub(crate) fn has_diagonals(&self) -> bool {
        self.images.len() == MOST_IMAGES
    }

    /// Returns the mirror images of a pixel. In patches on the diagonal, computed whole, none of them is transposed.
    #[inline(always)]
    pub(crate) fn images_of(&self, [column, row]: [usize; 2]) -> &[MirrorImage] {
        let is_on_diagonal = self.has_diagonals() && column / SIDE == row / SIDE;
        if is_on_diagonal { &self.images[..UPRIGHT] } else { &self.images }
    }

    /// The first column to compute of rows from this one on that make patches or bands.
    pub(crate) fn first_column(&self, row: usize) -> usize {
        if self.has_diagonals() { row } else { 0 }
    }

    /// Where in the light each view lies.
    pub(crate) fn layout(&self) -> impl Iterator<Item = &RowLayout> {
        self.images[0].views.iter().map(|view| &view.rows)
    }

    /// How windows of a view are walked through.
    pub(crate) fn ways(&self, view: usize) -> &Ways {
        &self.ways[view]
    }
}

impl MirrorImage {
    /// What is computed itself.
    pub(crate) fn itself(layout: &[RowLayout]) -> Self {
        let (is_turned, flips) = (false, [false; 2]);
        let views = layout.iter().map(|&rows| Reflection { rows, is_turned, flips }).collect();
        Self { is_turned, flips, views }
    }

    /// The target flipped, if the world has a mirror plane, or a quarter turn, to which that belongs.
    fn of((world, layout): (&World, &[RowLayout]), target: &View, flip: Flip) -> Option<Self> {
        let mirror = mirror_of(target, flip)?;
        let seen = |source: &Source| {
            let mut others = world.sources().iter().zip(layout);
            others.find_map(|(other, &rows)| {
                let Flip { is_turned, axes: flips } = reflection(source, other, &mirror, flip.is_turned)?;
                Some(Reflection { rows, is_turned, flips })
            })
        };
        let views = world.sources().iter().map(seen).collect::<Option<_>>()?;
        Some(Self { is_turned: flip.is_turned, flips: flip.axes, views })
    }
}

/// The reflection or turn (an orthogonal matrix) of the world that flips what a target shows.
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

/// How another view is flipped as the reflection of one, if it is that: no texel of either is hidden or shared. Over its diagonal
/// only if that `may_turn`.
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

/// Whether a view follows a formula that a few points tell; a table may hold anything between them.
fn is_formula(view: &View) -> bool {
    !matches!(view.projection, ProjectionKind::StMap(_))
}

/// Points all over a picture, as parts of its width and height, none of them on its edge.
fn points() -> impl Iterator<Item = (f64, f64)> {
    let at = |step: usize| (step as f64 + 0.37) / STEPS as f64;
    (0..STEPS).flat_map(move |j| (0..STEPS).map(move |i| (at(i), at(j))))
}

/// Of left and right, and of top and bottom, none, either or both exchanged.
const FLIPS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

/// How a picture is flipped: first over its diagonal, or not, so that columns are rows, then along its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flip {
    is_turned: bool,
    axes: [bool; 2],
}

impl Flip {
    /// Where a point comes to lie in a flipped picture of this size.
    fn of(self, point: PixelPoint, [width, height]: [f64; 2]) -> PixelPoint {
        let [x, y] = exchanged([point.x, point.y], self.is_turned);
        PixelPoint { x: if self.axes[0] { width - x } else { x }, y: if self.axes[1] { height - y } else { y } }
    }
}

/// What is told of columns and rows, of rows and columns if those are `turned` over a diagonal.
#[inline(always)]
pub(crate) fn exchanged<T>([column, row]: [T; 2], is_turned: bool) -> [T; 2] {
    if is_turned { [row, column] } else { [column, row] }
}
