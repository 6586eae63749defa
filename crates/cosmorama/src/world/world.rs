use std::collections::HashMap;
use std::sync::Arc;

use thiserror::Error;

use super::blend::{Blend, Border, Presence, parts};
use super::search::bounding_cone::SeenCone;
use super::search::view_index::{Near, ViewIndex};
use super::{SolidAngles, ViewMask, overlap};
use crate::camera::ROUNDING;
use crate::camera::{PixelPoint, PixelRect, View};
use crate::projection::{Projection, ProjectionKind};
use crate::raster::FixedLight;
use crate::sphere::Direction;

/// Reason why views do not make a world.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WorldError {
    /// There is no view.
    #[error("a world needs at least one view")]
    Empty,
    /// A view has no pixels.
    #[error("the view {0} has no pixels")]
    NoPixels(String),
    /// A mask's size differs from its view's.
    #[error("the mask of the view {name} has {}x{} pixels, but the view has {}x{}", mask.0, mask.1, view.0, view.1)]
    MaskSize {
        /// The view's name.
        name: String,
        /// Columns and rows of the mask.
        mask: (usize, usize),
        /// Columns and rows of the view.
        view: (usize, usize),
    },
    /// The world has more texels than 32 bits can count, including any padding between their rows.
    #[error("the views take room for {0} texels together, more than {max}", max = u32::MAX)]
    TooLarge(usize),
}

/// A view for [`World::blended`], with its blending and its mask.
#[derive(Clone, Debug)]
pub struct WorldView {
    /// Name for messages.
    pub name: String,
    /// Geometry of the image.
    pub view: View,
    /// Blending with other views that show the same directions.
    pub blend: Blend,
    /// Mask of the view's size; `None` if all texels count.
    pub mask: Option<Arc<ViewMask>>,
}

/// One view of a world, with the place of its texels among all the world's texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Name for messages, for example that of a cube face.
    pub name: String,
    /// Geometry of the image.
    pub view: View,
    /// Index of its first texel in the world's buffer; the rest follow row by row.
    pub offset: usize,
    /// Number of columns after which the picture repeats, if it goes all the way round.
    pub period: Option<usize>,
    /// Larger side of the largest texel, in radians.
    pub texel_pitch: f64,
    /// Solid angle of the sphere that each texel counts for.
    pub solid_angles: SolidAngles,
    /// Blending with other views that show the same directions.
    pub blend: Blend,
    /// Edges at which its picture ends.
    pub(crate) border: Border,
    /// Cone that holds its whole field of view; `None` if that may be the whole world.
    pub(super) cone: Option<SeenCone>,
    /// Mask; `None` if all texels count.
    pub mask: Option<Arc<ViewMask>>,
    /// Indices of the views that overlap it.
    pub(crate) others: Vec<usize>,
    /// Rectangle of texels that are not shared: no other view shows the same directions, and none is there twice.
    pub(crate) whole: PixelRect,
}

/// Place of a texel in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TexelPlace {
    /// Index of the view.
    pub(crate) view: usize,
    /// Column and row in the view.
    pub(crate) texel: [usize; 2],
}

impl Source {
    /// Returns whether [`Self::texel_pitch`] is an upper bound for every texel.
    ///
    /// The pitch is measured at some points. Between them, texels beside a steep rim, or of a table, may be larger.
    pub(crate) fn has_bounded_texels(&self) -> bool {
        let projection = &self.view.projection;
        !projection.has_steep_rim() && !matches!(projection, ProjectionKind::StMap(_))
    }

    /// Returns an upper bound of a texel's larger side, in radians, at a direction. Beside a steep rim texels are far
    /// larger than elsewhere, so the world's largest texel would be a poor bound for the others.
    pub fn texel_pitch_at(&self, direction: Direction) -> f64 {
        if !self.view.projection.has_steep_rim() {
            return self.texel_pitch;
        }
        let texel = self.view.pixel(direction).and_then(|pixel| self.view.texel(pixel));
        texel.map_or(self.texel_pitch, |texel| (texel.dx.length_squared() + texel.dy.length_squared()).sqrt())
    }

    /// Computes an upper bound of a texel's larger side, in radians, within `radius` radians of a direction.
    ///
    /// Towards a steep rim texels grow no faster than the distance to it shrinks.
    pub(crate) fn texel_pitch_within(&self, direction: Direction, radius: f64) -> f64 {
        let margin = self.view.margin(direction);
        if 2.0 * radius > margin {
            return self.texel_pitch;
        }
        self.texel_pitch.min(self.texel_pitch_at(direction) * margin / (margin - radius))
    }
}

impl Source {
    /// Returns this source with another grid over the same picture, and without solid angles.
    pub(super) fn with_geometry_of(&self, view: View) -> Self {
        let larger = (view.grid.step() / self.view.grid.step()).max_element();
        // Beside a steep rim texels grow otherwise.
        let is_steep = view.projection.has_steep_rim();
        Self {
            name: String::new(),
            offset: 0,
            period: view.period(),
            texel_pitch: if is_steep { texel_pitch(&view) } else { self.texel_pitch * larger },
            solid_angles: SolidAngles::none(),
            mask: None,
            others: Vec::new(),
            whole: owned(&view),
            view,
            ..*self
        }
    }

    /// Returns whether anything within `radius` radians of a direction may be visible.
    pub(crate) fn reaches(&self, direction: Direction, radius: f64) -> bool {
        self.cone.is_none_or(|cone| cone.reaches(direction, radius))
    }

    /// Returns whether the view may show a direction: quickly, and with some that lie beside it.
    pub(super) fn may_hold(&self, direction: Direction) -> bool {
        self.cone.is_none_or(|cone| cone.may_hold(direction))
    }

    /// Returns whether two views may show anything in common: most of many views do not, and need no search.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.cone.zip(other.cone).is_none_or(|(cone, other)| cone.meets(&other))
    }

    /// Returns the distance of a direction from the image, in texels: zero inside, `None` where the projection has no
    /// place for it.
    pub(crate) fn texels_beyond(&self, direction: Direction) -> Option<f64> {
        let pixel = self.view.wrapped(self.view.pixel(direction)?);
        let (width, height) = (self.view.width() as f64, self.view.height() as f64);
        let before_next_turn = self.period.map_or(f64::INFINITY, |period| (period as f64 - pixel.x).max(0.0));
        let across = (-pixel.x).max(pixel.x - width).max(0.0).min(before_next_turn);
        let down = (-pixel.y).max(pixel.y - height).max(0.0);
        let point = self.view.grid.to_plane(pixel);
        let outside = self.view.stop.circle.map_or(0.0, |radius| point.x.hypot(point.y) - radius);
        Some(across.hypot(down).max(outside / self.view.grid.step().abs().min_element()))
    }

    /// Returns whether a point of the image shows something that counts.
    pub(crate) fn shows(&self, pixel: PixelPoint) -> bool {
        self.view.shows(pixel) && self.mask.as_ref().is_none_or(|mask| mask.shows(pixel))
    }

    /// Returns the column that stands for column `i` in a picture that repeats all the way round; `None` outside
    /// others.
    pub fn column(&self, i: i64) -> Option<i64> {
        let i = self.period.map_or(i, |period| i.rem_euclid(period as i64));
        (0..self.view.width() as i64).contains(&i).then_some(i)
    }

    /// Returns the range of this view's texels in the world's buffer.
    pub fn texels(&self) -> std::ops::Range<usize> {
        self.offset..self.offset + self.view.width() * self.view.height()
    }
}

/// Radiance by direction, held as views. Texels that several views hold for one direction share its weight.
///
/// A world is geometry. The light itself is a buffer of [`crate::raster::Rgba`] texels, one for each texel of each view,
/// so that one world serves all the frames of a sequence.
#[derive(Clone, Debug)]
pub struct World {
    sources: Vec<Source>,
    /// Views by direction, where they are many.
    index: Option<Arc<ViewIndex>>,
    pitches: Pitches,
    /// Whether the first view is the only one, and shows every direction.
    is_one_sphere: bool,
}

/// Sizes of the largest texels of a world's views, in radians.
#[derive(Clone, Debug)]
struct Pitches {
    /// Whether they are equal.
    are_equal: bool,
    /// The largest.
    largest: f64,
    /// The largest of views without a steep rim.
    even: f64,
    /// Views with a steep rim, where texels differ much.
    steep: Vec<usize>,
}

impl World {
    /// Creates a world of named views.
    ///
    /// # Errors
    /// When there is no view, a view has no pixels or a mask of another size, or there are more texels than 32 bits can
    /// count.
    pub fn new(views: impl IntoIterator<Item = (String, View)>) -> Result<Self, WorldError> {
        let part = |(name, view)| WorldView { name, view, blend: Blend::default(), mask: None };
        Self::blended(views.into_iter().map(part))
    }

    /// Creates a world of views that blend where they overlap.
    ///
    /// # Errors
    /// Those of [`World::new`].
    pub fn blended(views: impl IntoIterator<Item = WorldView>) -> Result<Self, WorldError> {
        Self::made(views.into_iter().collect(), Vec::new())
    }

    /// Creates a world of other views, and reuses the solid angles of texels that both worlds have.
    ///
    /// The rest of this world is freed first: whole pictures may be far larger than the parts at hand.
    ///
    /// # Errors
    /// Those of [`World::new`].
    pub fn with_views(self, views: impl IntoIterator<Item = WorldView>) -> Result<Self, WorldError> {
        let views: Vec<WorldView> = views.into_iter().collect();
        let mut known = self.sources;
        // What was hidden or shared in this world may not be in the other.
        known.retain(|source| source.mask.is_none() && source.others.is_empty());
        known.retain(|source| views.iter().any(|other| source.view.is_alike(&other.view)));
        Self::made(views, known)
    }

    fn made(views: Vec<WorldView>, known: Vec<Source>) -> Result<Self, WorldError> {
        check(&views)?;
        let mut sources: Vec<Source> = Vec::new();
        let mut offset = 0;
        for WorldView { name, view, blend, mask } in views {
            let (period, whole) = (view.period(), owned(&view));
            // The faces of a cube have one grid: what was computed for the first serves all.
            let twin = sources.iter().chain(&known).find(|other| other.view.is_alike(&view));
            let texel_pitch = twin.map_or_else(|| texel_pitch(&view), |twin| twin.texel_pitch);
            let solid_angles = twin.map(|twin| twin.solid_angles.clone());
            let solid_angles = solid_angles.unwrap_or_else(|| SolidAngles::of(&view, whole.right));
            let cone = match twin {
                Some(twin) => twin.cone.map(|cone| cone.turned(&twin.view, &view)),
                None => SeenCone::of(&view),
            };
            let (border, others) = (Border::of(&view), Vec::new());
            sources.push(Source {
                name,
                view,
                offset,
                period,
                texel_pitch,
                solid_angles,
                blend,
                border,
                cone,
                mask,
                others,
                whole,
            });
            offset = sources.last().map_or(0, |last| last.texels().end);
        }
        hide(&mut sources);
        let cones: Vec<Option<SeenCone>> = sources.iter().map(|source| source.cone).collect();
        let index = ViewIndex::of(&cones).map(Arc::new);
        overlap::share(&mut sources, index.as_deref());
        let pitches = Pitches::of(&sources);
        let is_one_sphere = matches!(&sources[..], [all] if all.mask.is_none() && all.view.covers_sphere());
        Ok(Self { sources, index, pitches, is_one_sphere })
    }

    /// Returns the views.
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Returns the bytes of all solid angles. Views that share theirs, as the faces of a cube do, count once.
    pub fn solid_angle_bytes(&self) -> usize {
        let lists = self.sources.iter().map(|source| (source.solid_angles.address(), source.solid_angles.len()));
        let lists: HashMap<usize, usize> = lists.collect();
        lists.values().sum::<usize>() * size_of::<f32>()
    }

    /// Returns the index of the view that shows a direction, and the place in its image. Where several do, the view
    /// with the largest share is returned.
    pub fn owner(&self, direction: Direction) -> Option<(usize, PixelPoint)> {
        let first = self.first_to_hold(direction)?;
        if self.sources[first.0].others.is_empty() {
            return Some(first);
        }
        let mut largest = (0.0, first);
        self.for_each_holder(direction, |index, pixel, part| {
            if part > largest.0 {
                largest = (part, (index, pixel));
            }
        });
        Some(largest.1)
    }

    /// Returns the index of the view that [`World::owner`] finds: at once where there is but one choice.
    pub(crate) fn owner_view(&self, direction: Direction) -> Option<usize> {
        if self.is_one_sphere { Some(0) } else { self.owner(direction).map(|(view, _)| view) }
    }

    /// Calls `visit` with each view that shows a direction, the place in its image, and its share; the shares add to
    /// one.
    pub(crate) fn for_each_holder(&self, direction: Direction, mut visit: impl FnMut(usize, PixelPoint, f64)) {
        let Some((first, pixel)) = self.first_to_hold(direction) else { return };
        let source = &self.sources[first];
        if source.others.is_empty() {
            return visit(first, pixel, 1.0);
        }
        let mut present = vec![Presence::at(first, source, pixel)];
        present.extend(source.others.iter().filter_map(|&at| Presence::of(at, &self.sources[at], direction)));
        for (one, part) in present.iter().zip(parts(&present)) {
            visit(one.index, one.pixel, part);
        }
    }

    fn first_to_hold(&self, direction: Direction) -> Option<(usize, PixelPoint)> {
        // A direction on the very edge between two views may miss both by a rounding error.
        let held = |index: usize| {
            let source = &self.sources[index];
            let pixel = source.view.wrapped(source.view.pixel(direction)?);
            let (width, height) = (source.view.width() as f64, source.view.height() as f64);
            let inside = pixel.x >= -ROUNDING
                && pixel.y >= -ROUNDING
                && pixel.x <= width + ROUNDING
                && pixel.y <= height + ROUNDING
                && source.view.stop_passes(pixel)
                && source.mask.as_ref().is_none_or(|mask| mask.shows(pixel));
            inside.then_some((index, pixel))
        };
        self.near(direction, || 0.0).find_map(held)
    }

    /// Visits, in their order, the views that may show something within a radius in radians of a direction. Some of them may not. The
    /// radius is asked for only if views are many.
    pub(crate) fn near(&self, direction: Direction, radius: impl FnOnce() -> f64) -> Near<'_> {
        self.index.as_ref().map_or(Near::All(0..self.sources.len()), |index| index.near(direction, radius()))
    }

    /// Returns the greatest of some upper bounds of views' texels, which for views without a steep rim are their
    /// [`Source::texel_pitch`].
    pub(crate) fn coarsest(&self, bound: impl Fn(&Source) -> f64) -> f64 {
        let steep = self.pitches.steep.iter().map(|view| bound(&self.sources[*view]));
        steep.fold(self.pitches.even, f64::max)
    }

    /// Returns the size of the largest texel of any view, in radians.
    pub(crate) fn largest_pitch(&self) -> f64 {
        self.pitches.largest
    }

    /// Returns whether the largest texels of all views have one size.
    pub(crate) fn has_equal_pitches(&self) -> bool {
        self.pitches.are_equal
    }

    /// Returns the place of a texel, by its index in the buffer of light.
    pub(crate) fn texel(&self, index: u32) -> TexelPlace {
        let view = self.sources.partition_point(|source| source.offset <= index as usize) - 1;
        let source = &self.sources[view];
        // Texels are counted in 32 bits, in which division is twice as fast.
        let (within, width) = (index - source.offset as u32, source.view.width() as u32);
        TexelPlace { view, texel: [within % width, within / width].map(|at| at as usize) }
    }

    /// Returns the number of texels of all views: the length of the buffer of light.
    pub fn texel_count(&self) -> usize {
        self.sources.last().map_or(0, |last| last.texels().end)
    }

    /// Returns the width of the finest view's texels, in radians.
    pub fn texel_pitch(&self) -> f64 {
        self.sources.iter().map(|source| source.texel_pitch).fold(f64::INFINITY, f64::min)
    }

    /// Returns the columns and rows of each view.
    pub fn view_sizes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.sources.iter().map(|source| [source.view.width(), source.view.height()])
    }

    /// Returns the solid angle of each texel in steradians, in the order of the buffer of light; zero for a texel that
    /// shows nothing.
    pub fn solid_angles(&self) -> impl Iterator<Item = f32> + '_ {
        self.sources.iter().flat_map(|source| source.solid_angles.iter().copied())
    }
}

impl Pitches {
    fn of(sources: &[Source]) -> Self {
        let pitches = || sources.iter().map(|source| source.texel_pitch);
        let is_steep = |source: &Source| source.view.projection.has_steep_rim();
        let even = sources.iter().filter(|source| !is_steep(source)).map(|source| source.texel_pitch);
        let steep = sources.iter().enumerate().filter(|(_, source)| is_steep(source)).map(|(view, _)| view);
        Self {
            are_equal: pitches().all(|pitch| pitch == sources[0].texel_pitch),
            largest: pitches().fold(0.0, f64::max),
            even: even.fold(0.0, f64::max),
            steep: steep.collect(),
        }
    }
}

/// Checks that views make a world, before memory is allocated for it.
fn check(views: &[WorldView]) -> Result<(), WorldError> {
    let mut all = 0usize;
    for WorldView { name, view, mask, .. } in views {
        let size = (view.width(), view.height());
        if size.0 == 0 || size.1 == 0 {
            return Err(WorldError::NoPixels(name.clone()));
        }
        if let Some(found) = mask.as_ref().map(|mask| mask.size()).filter(|found| *found != size) {
            return Err(WorldError::MaskSize { name: name.clone(), mask: found, view: size });
        }
        all = all.saturating_add(FixedLight::pitch(size.0).saturating_mul(size.1));
    }
    match all {
        0 => Err(WorldError::Empty),
        1..=MOST_TEXELS => Ok(()),
        _ => Err(WorldError::TooLarge(all)),
    }
}

/// Largest number of texels, which are counted in 32 bits, in light with padded rows too.
const MOST_TEXELS: usize = u32::MAX as usize;

/// Sets the solid angles of masked texels to zero.
fn hide(sources: &mut [Source]) {
    for source in sources {
        let Some(mask) = &source.mask else { continue };
        let width = source.view.width();
        let is_hidden = |texel: usize| !mask.counts(texel % width, texel / width);
        let hidden: Vec<bool> = (0..source.texels().len()).map(is_hidden).collect();
        let angles = source.solid_angles.make_mut();
        angles.iter_mut().zip(&hidden).filter(|(_, hidden)| **hidden).for_each(|(angle, _)| *angle = 0.0);
        source.whole = overlap::unshared(source.whole, width, &hidden);
    }
}

/// Returns the larger side of the largest texel, found on a coarse grid of points. No formula here bends faster than
/// that grid. A table may, and then a kernel may miss a texel beyond a seam.
fn texel_pitch(view: &View) -> f64 {
    const STEPS: usize = 32;
    let at = |size: usize, step: usize| size as f64 * step as f64 / STEPS as f64;
    let points = (0..=STEPS).flat_map(|j| (0..=STEPS).map(move |i| (i, j)));
    let texels = points.filter_map(|(i, j)| view.texel(PixelPoint::new(at(view.width(), i), at(view.height(), j))));
    let largest = texels.map(|texel| texel.dx.length().max(texel.dy.length())).fold(0.0, f64::max);
    // Where none has neighbours to be measured by, it may be half the sphere.
    if largest > 0.0 { largest } else { std::f64::consts::PI }
}

/// Returns the texels of a view that count. A panorama with samples on its edges has one column twice, of which only
/// the first counts.
fn owned(view: &View) -> PixelRect {
    let right = view.period().map_or(view.width(), |period| period.min(view.width()));
    PixelRect { left: 0, top: 0, right, bottom: view.height() }
}
