//! What a conversion needs of its sources, before any light is looked at.

use rayon::prelude::*;

use super::block::{Block, Cap};
use super::gather::Gather;
use super::kernel::KernelTable;
use super::{Filter, FilterKind, Taps, lookup, reference};
use crate::sphere::Direction;
use crate::world::{PixelPoint, PixelRect, Source, View, World};

/// What targets need of one view of a world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The view's name.
    pub name: String,
    /// Bounding rectangle of the texels in which target pixels (their centres, or the centroids of what a rim leaves of
    /// them) fall. Without these there would be holes in the picture.
    pub seen: Option<PixelRect>,
    /// Bounding rectangle of all texels that the filter touches. Whatever is outside never changes a pixel.
    pub read: Option<PixelRect>,
}

/// Target pixels that look where no view does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncovered {
    /// How many there are, in all targets together.
    pub pixels: usize,
    /// Index of the target of the first of them.
    pub target: usize,
    /// The column of the first of them.
    pub column: usize,
    /// Its row.
    pub row: usize,
    /// Where it looks.
    pub direction: Direction,
}

/// What targets need of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Needs {
    /// One for each view, in the world's order.
    pub views: Vec<Need>,
    /// What no view covers.
    pub uncovered: Option<Uncovered>,
}

impl Needs {
    /// What `targets` need of the world's views when they are made with `filter`.
    ///
    /// To ask for views whose image is missing, give a world of nominal views: it holds no light. The result is exact:
    /// it comes from the taps of the filter itself. Only blocks of pixels that cannot widen the rectangles found so far
    /// are passed over.
    pub fn of(world: &World, targets: &[View], filter: &Filter) -> Self {
        let mut needs = Self::nothing(world);
        for (index, target) in targets.iter().enumerate() {
            let survey = Survey { world, target, index, filter };
            // The extremes lie where the frame, the lens or a view ends: with those known, the rest is quick.
            let (edges, inside): (Vec<_>, Vec<_>) = Block::all(target)
                .into_iter()
                .map(|block| (block, survey.owner(&block)))
                .partition(|(block, owner)| block.at_border || owner.is_none());
            needs = survey.blocks(&edges, needs);
            needs = survey.blocks(&inside, needs);
        }
        needs
    }

    fn nothing(world: &World) -> Self {
        let need = |source: &Source| Need { name: source.name.clone(), seen: None, read: None };
        Self { views: world.sources().iter().map(need).collect(), uncovered: None }
    }

    fn merged(mut self, other: &Self) -> Self {
        for (mine, theirs) in self.views.iter_mut().zip(&other.views) {
            mine.seen = union(mine.seen, theirs.seen);
            mine.read = union(mine.read, theirs.read);
        }
        if let Some(other) = other.uncovered {
            self.add_uncovered(other);
        }
        self
    }

    fn add_uncovered(&mut self, other: Uncovered) {
        let place = |uncovered: &Uncovered| (uncovered.target, uncovered.row, uncovered.column);
        self.uncovered = Some(match self.uncovered {
            None => other,
            Some(mine) => {
                let first = if place(&other) < place(&mine) { other } else { mine };
                Uncovered { pixels: mine.pixels + other.pixels, ..first }
            }
        });
    }
}

fn union(a: Option<PixelRect>, b: Option<PixelRect>) -> Option<PixelRect> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (one, other) => one.or(other),
    }
}

/// Whether nothing of `part` is outside `whole`.
fn within(part: Option<PixelRect>, whole: Option<PixelRect>) -> bool {
    part.is_none_or(|part| whole.is_some_and(|whole| whole.contains(&part)))
}

/// One target's look at a world.
struct Survey<'a> {
    world: &'a World,
    target: &'a View,
    index: usize,
    filter: &'a Filter,
}

impl Survey<'_> {
    /// The cap of a block and the source that shows all of it.
    fn owner(&self, block: &Block) -> Option<(Cap, usize)> {
        let cap = block.cap(self.target)?;
        let source = self.world.sources().iter().position(|source| cap.is_shown_by(source))?;
        Some((cap, source))
    }

    /// Adds what these blocks need to what is known already.
    fn blocks(&self, blocks: &[(Block, Option<(Cap, usize)>)], known: Needs) -> Needs {
        let few = blocks.len().div_ceil(8 * rayon::current_num_threads()).max(1);
        let table = KernelTable::new(&self.filter.kernel);
        let found: Vec<Needs> = blocks
            .par_chunks(few)
            .map(|blocks| {
                let mut found = Needs { uncovered: None, ..known.clone() };
                let mut pixels = PixelTaps::new(self, &table);
                for (block, owner) in blocks {
                    if !owner.as_ref().is_some_and(|(cap, owner)| self.adds_nothing(cap, *owner, &found)) {
                        pixels.add_block(block, &mut found);
                    }
                }
                found
            })
            .collect();
        found.iter().fold(known, Needs::merged)
    }

    /// Whether a block that one source shows whole can need only texels that are needed anyway.
    fn adds_nothing(&self, cap: &Cap, owner: usize, found: &Needs) -> bool {
        let sources = self.world.sources();
        within(cap.seen_texels(&sources[owner]), found.views[owner].seen)
            && sources
                .iter()
                .zip(&found.views)
                .all(|(source, need)| within(cap.read_texels(source, &self.filter.kernel), need.read))
    }
}

/// The texels of single pixels.
struct PixelTaps<'a> {
    survey: &'a Survey<'a>,
    gather: Gather<'a>,
    taps: Taps,
}

impl<'a> PixelTaps<'a> {
    fn new(survey: &'a Survey<'a>, table: &'a KernelTable) -> Self {
        Self { survey, gather: Gather::new(survey.world, table), taps: Taps::default() }
    }

    fn add_block(&mut self, block: &Block, needs: &mut Needs) {
        for j in block.pixels.top..block.pixels.bottom {
            for i in block.pixels.left..block.pixels.right {
                self.add_pixel(i, j, needs);
            }
        }
    }

    fn add_pixel(&mut self, i: usize, j: usize, needs: &mut Needs) {
        let Survey { world, target, index, filter } = *self.survey;
        let Some(screen) = target.screen_pixel(i, j) else { return };
        let direction = screen.footprint.direction;
        match lookup::owner(world, direction) {
            Some((owner, pixel)) => add_seen(&world.sources()[owner], pixel, &mut needs.views[owner]),
            None => needs.add_uncovered(Uncovered { pixels: 1, target: index, column: i, row: j, direction }),
        }
        let mut read = |texel: u32, _: f64| add_read(world, texel as usize, &mut needs.views);
        match filter.kind {
            FilterKind::Ewa => {
                self.gather.taps(&screen.footprint, &mut self.taps);
                self.taps.as_slice().iter().for_each(|tap| read(tap.texel, 0.0));
            }
            FilterKind::Point => lookup::nearest(world, direction, read),
            FilterKind::Bilinear => lookup::bilinear(world, direction, read),
            FilterKind::Reference { samples } => {
                reference::for_each_texel(world, target, filter, samples, (i, j), read)
            }
        }
    }
}

fn add_seen(source: &Source, pixel: PixelPoint, need: &mut Need) {
    let inside = |value: f64, size: usize| (value.max(0.0) as usize).min(size - 1);
    let (i, j) = (inside(pixel.x, source.view.width()), inside(pixel.y, source.view.height()));
    need.seen = union(need.seen, Some(one_texel(i, j)));
}

fn add_read(world: &World, texel: usize, needs: &mut [Need]) {
    let owner = world.sources().iter().position(|source| source.texels().contains(&texel));
    let Some(index) = owner else { return };
    let source = &world.sources()[index];
    let (i, j) = ((texel - source.offset) % source.view.width(), (texel - source.offset) / source.view.width());
    needs[index].read = union(needs[index].read, Some(one_texel(i, j)));
}

fn one_texel(i: usize, j: usize) -> PixelRect {
    PixelRect { left: i, top: j, right: i + 1, bottom: j + 1 }
}
