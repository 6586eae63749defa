//! Mirror symmetry of a conversion: a dome made of a cube is the same left and right, before and behind.

use glam::DMat3;

use super::weights::Weights;
use crate::projection::ProjectionKind;
use crate::raster::RowLayout;
use crate::resample::patch::SIDE;
use crate::resample::{FilterKind, Resampler};
use crate::sphere::Direction;
use crate::world::{FieldStop, PixelPoint, PixelRect, Source, TexelPlace, View, World};

/// By how much directions that are the same may differ, in radians: rounding.
const SAME: f64 = 1e-11;

/// By how many texels places that are the same may.
const SAME_TEXEL: f64 = 1e-6;

/// Points along a side at which a symmetry is tried; the formulas between are smooth.
const STEPS: usize = 16;

/// Itself, left and right exchanged, top and bottom, both.
pub(super) const MOST_IMAGES: usize = 4;

/// What is left of a target to compute, and the mirrors in which the rest is seen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mirrors {
    /// Columns to compute: all, or the left half.
    pub(super) columns: usize,
    /// Rows to compute: all, or the upper half.
    pub(super) rows: usize,
    /// Which pictures those make; the first is what is computed itself.
    pub(super) images: Vec<MirrorImage>,
    /// Whether nothing lies between the texels of the light: their indices are those of the world.
    pub(super) is_packed: bool,
    /// For each view of the world how windows in it are walked through in all of them.
    ways: Vec<Ways>,
}

/// How the mirrors go through windows of a view: those from left to right first, and of either those that go down first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ways {
    /// Which mirror, and what exchanges left and right in the index of a lane if that does.
    pub(super) order: [(usize, usize); MOST_IMAGES],
    /// How many there are, and how many of them go from left to right.
    pub(super) count: usize,
    pub(super) forward: usize,
    /// Texels from one row to the next, for each.
    pub(super) down: [i32; MOST_IMAGES],
}

impl Ways {
    fn of(images: &[MirrorImage], view: usize) -> Self {
        let walks = images.iter().map(|image| image.view(view).walk([0; 2]));
        let mut walks: Vec<(usize, Walk)> = walks.enumerate().collect();
        walks.sort_by_key(|(_, walk)| (walk.is_reversed, walk.down < 0));
        let mut ways = Self { count: walks.len(), ..Self::default() };
        for (at, (index, walk)) in walks.into_iter().enumerate() {
            ways.order[at] = (index, if images[index].flips[0] { SIDE - 1 } else { 0 });
            ways.down[at] = walk.down;
            ways.forward += usize::from(!walk.is_reversed);
        }
        ways
    }
}

/// A picture of what is computed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MirrorImage {
    /// Whether left and right are exchanged on the target, and whether top and bottom.
    pub(super) flips: [bool; 2],
    /// For each view of the world what is seen in its stead.
    views: Vec<Reflection>,
}

/// A view as a mirror shows it: another one, or the same, with its texels in another order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reflection {
    /// Where it lies in the buffer of light.
    rows: RowLayout,
    /// Whether its columns run the other way, and whether its rows.
    flips: [bool; 2],
}

/// Where a window begins in the buffer of light, and the steps from texel to texel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Walk {
    pub(super) first: u32,
    /// Whether columns run the other way.
    pub(super) is_reversed: bool,
    /// From one row to the next.
    pub(super) down: i32,
}

impl Walk {
    /// The same of a window so many columns and rows further on.
    #[inline(always)]
    pub(super) fn moved(self, [columns, rows]: [u8; 2]) -> Self {
        let columns = u32::from(columns);
        let first = if self.is_reversed { self.first.wrapping_sub(columns) } else { self.first.wrapping_add(columns) };
        Self { first: first.wrapping_add_signed(self.down.wrapping_mul(i32::from(rows))), ..self }
    }

    /// The same one row further down.
    #[inline(always)]
    pub(super) fn one_down(self) -> Self {
        Self { first: self.first.wrapping_add_signed(self.down), ..self }
    }
}

impl Reflection {
    /// Columns and rows of the view.
    #[inline(always)]
    pub(super) fn size(&self) -> [usize; 2] {
        self.rows.size
    }

    /// The walk of a window whose first texel is in this column and row of the view itself.
    #[inline(always)]
    pub(super) fn walk(&self, [column, row]: [usize; 2]) -> Walk {
        let RowLayout { size: [width, height], pitch, .. } = self.rows;
        let column = if self.flips[0] { width - 1 - column } else { column };
        let (row, down) = if self.flips[1] { (height - 1 - row, -(pitch as i32)) } else { (row, pitch as i32) };
        // Texels of a world, and what fills up their rows, are counted in 32 bits.
        Walk { first: self.rows.index([column, row]) as u32, is_reversed: self.flips[0], down }
    }
}

impl MirrorImage {
    /// What is seen in place of a view.
    pub(super) fn view(&self, index: usize) -> &Reflection {
        &self.views[index]
    }

    /// The texel that the mirror shows in place of one, by its index in the buffer of light.
    pub(super) fn texel(&self, TexelPlace { view, texel }: TexelPlace) -> u32 {
        self.views[view].walk(texel).first
    }
}

impl Mirrors {
    /// Those in which a conversion is the same, for the light that weights like these are for.
    pub(super) fn of<W: Weights>(Resampler { world, target, filter }: &Resampler) -> Self {
        let (width, height) = (target.width(), target.height());
        let layout = RowLayout::of(world.view_sizes(), W::pitch);
        let reflect = |flips: [bool; 2]| {
            let is_even = (!flips[0] || width % 2 == 0) && (!flips[1] || height % 2 == 0);
            // Of two texels that are as near, a point takes the one to the right, in a mirror too.
            (is_even && filter.kind != FilterKind::Point)
                .then(|| MirrorImage::of((world, &layout), target, flips))
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
        let images = std::iter::once(MirrorImage::itself(&layout));
        Self::new([columns, rows], images.chain([across, down, both].into_iter().flatten()).collect())
    }

    pub(super) fn new([columns, rows]: [usize; 2], images: Vec<MirrorImage>) -> Self {
        let views = &images[0].views;
        let is_packed = views.iter().all(|view| view.rows.pitch == view.rows.size[0]);
        let ways = (0..views.len()).map(|view| Ways::of(&images, view)).collect();
        Self { columns, rows, images, is_packed, ways }
    }

    /// Where in the light each view lies.
    pub(super) fn layout(&self) -> impl Iterator<Item = &RowLayout> {
        self.images[0].views.iter().map(|view| &view.rows)
    }

    /// Texels of the light, with what fills up their rows.
    pub(super) fn texel_count(&self) -> usize {
        self.images[0].views.last().map_or(0, |view| view.rows.end())
    }

    /// How windows of a view are walked through.
    pub(super) fn ways(&self, view: usize) -> &Ways {
        &self.ways[view]
    }
}

impl MirrorImage {
    /// What is computed itself.
    pub(super) fn itself(layout: &[RowLayout]) -> Self {
        let flips = [false; 2];
        Self { flips, views: layout.iter().map(|&rows| Reflection { rows, flips }).collect() }
    }

    /// The target flipped, if the world has a mirror plane to which that belongs.
    fn of((world, layout): (&World, &[RowLayout]), target: &View, flips: [bool; 2]) -> Option<Self> {
        let mirror = mirror_of(target, flips)?;
        let seen = |source: &Source| {
            let mut others = world.sources().iter().zip(layout);
            others.find_map(|(other, &rows)| Some(Reflection { rows, flips: reflection(source, other, &mirror)? }))
        };
        Some(Self { flips, views: world.sources().iter().map(seen).collect::<Option<_>>()? })
    }
}

/// The reflection (an orthogonal matrix) of the world that flips what a target shows.
fn mirror_of(target: &View, flips: [bool; 2]) -> Option<DMat3> {
    let size = [target.width() as f64, target.height() as f64];
    let at = |x: f64, y: f64| PixelPoint::new(size[0] * x, size[1] * y);
    let flipped = |point| flip(point, size, flips);
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
        let is_centred = (!flips[0] || centre.x.abs() < SAME) && (!flips[1] || centre.y.abs() < SAME);
        let side = target.stop.half_space.map(|side| target.orientation.to_world(side).vector());
        is_centred && side.is_none_or(|side| (mirror * side - side).length() < SAME)
    };
    let is_mirror = is_formula(target)
        && is_orthogonal
        && points().all(|(x, y)| is_same(at(x, y)))
        && (target.stop == FieldStop::NONE || stop_is_same());
    is_mirror.then_some(mirror)
}

/// Which axes of another view run the other way as the reflection of one, if it is that: no texel of either is hidden or shared.
fn reflection(source: &Source, other: &Source, mirror: &DMat3) -> Option<[bool; 2]> {
    let (a, b) = (&source.view, &other.view);
    let is_plain = |source: &Source| {
        let all = PixelRect { left: 0, top: 0, right: source.view.width(), bottom: source.view.height() };
        source.whole == all && source.mask.is_none() && source.view.stop == FieldStop::NONE && is_formula(&source.view)
    };
    if a.projection != b.projection
        || (a.width(), a.height()) != (b.width(), b.height())
        || !is_plain(source)
        || !is_plain(other)
    {
        return None;
    }
    let size = [a.width() as f64, a.height() as f64];
    let fits = |flips: [bool; 2]| {
        points().all(|(x, y)| {
            let point = PixelPoint::new(size[0] * x, size[1] * y);
            let Some(direction) = a.direction(point) else { return b.direction(flip(point, size, flips)).is_none() };
            let seen = b.pixel(Direction::from_unit(*mirror * direction.vector()));
            let expected = flip(point, size, flips);
            let near = |pixel: PixelPoint| (pixel.x - expected.x).hypot(pixel.y - expected.y) < SAME_TEXEL;
            seen.is_some_and(|pixel| near(b.wrapped(pixel)))
        })
    };
    let all = [[false, false], [true, false], [false, true], [true, true]];
    all.into_iter().find(|&flips| fits(flips))
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

fn flip(point: PixelPoint, [width, height]: [f64; 2], flips: [bool; 2]) -> PixelPoint {
    PixelPoint {
        x: if flips[0] { width - point.x } else { point.x },
        y: if flips[1] { height - point.y } else { point.y },
    }
}
