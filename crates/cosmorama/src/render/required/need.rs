//! Needs of a conversion: parts of its sources, found before any light is read.

use rayon::prelude::*;

use super::block::Block;
use crate::camera::{PixelPoint, PixelRect, View};
use crate::filter::FilterSettings;
use crate::filter::gather::cap::Cap;
use crate::filter::gather::pixel_taps::PixelTaps;
use crate::filter::kernel::KernelTable;
use crate::render::Uncovered;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Part of one view of a world that targets need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// Name of the view.
    pub name: String,
    /// Bounding rectangle of the texels that target pixels fall on, without which the picture would have holes. A pixel
    /// falls where its centre does; one at a rim, where the centroid of its remaining part does.
    pub seen: Option<PixelRect>,
    /// Bounding rectangle of all texels that the filter touches. Texels outside never change a pixel.
    pub read: Option<PixelRect>,
}

/// Parts of a world that targets need.
#[derive(Clone, Debug, PartialEq)]
pub struct Needs {
    /// Needs of each view, in the world's order.
    pub views: Vec<Need>,
    /// Target pixels that no view covers.
    pub uncovered: Option<Uncovered>,
}

/// Accuracy with which needs are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// Exact: by the taps of the filter itself.
    Exact,
    /// Faster. `seen` and `uncovered` are exact; `read` is a few texels too large, and may be `Some` where nothing is read.
    Seen,
    /// Fastest. `read` is a few texels too large and `seen` may be only a part; whether each is `Some`, and `uncovered`,
    /// are exact.
    Bounds,
}

impl Needs {
    /// Finds what `targets` need of the world's views when they are made with `filter`.
    ///
    /// The world needs no light, so it may hold nominal views of missing images. For filters whose texels are not
    /// listed, such as `ewa-pyramid`, the result is an upper bound.
    pub fn of(world: &World, targets: &[View], filter: &FilterSettings, accuracy: Accuracy) -> Self {
        match accuracy {
            Accuracy::Exact if !filter.kind.lists_texels() => Self::at_most(world, targets, filter),
            Accuracy::Seen => Self::at_most(world, targets, filter),
            Accuracy::Exact => Self::surveyed(world, targets, filter, Reads::Exactly),
            Accuracy::Bounds => Self::bounds(world, targets, filter, |_, _| true),
        }
    }

    /// Finds bounds, as [`Accuracy::Bounds`] has them. Whether a view is read that no pixel's direction falls on is found where that matters,
    /// by its place in the world and its need as far as it is known; elsewhere `read` may be `Some` where nothing is read.
    pub fn bounds(
        world: &World,
        targets: &[View],
        filter: &FilterSettings,
        matters: impl Fn(usize, &Need) -> bool,
    ) -> Self {
        let quick = Self::within_reach(world, targets, filter);
        quick.unwrap_or_else(|| Self::at_most(world, targets, filter)).settled(world, targets, filter, matters)
    }

    /// Finds bounds of what is read, a few texels too large.
    pub(crate) fn at_most(world: &World, targets: &[View], filter: &FilterSettings) -> Self {
        Self::surveyed(world, targets, filter, Reads::AtMost)
    }

    /// Decides whether views that no pixel's direction falls on are still read by the kernels around.
    fn settled(
        mut self,
        world: &World,
        targets: &[View],
        filter: &FilterSettings,
        matters: impl Fn(usize, &Need) -> bool,
    ) -> Self {
        let is_open = |(at, need): (usize, &Need)| need.seen.is_none() && need.read.is_some() && matters(at, need);
        let asked: Vec<bool> = self.views.iter().enumerate().map(is_open).collect();
        if !filter.kind.lists_texels() || !asked.contains(&true) {
            return self;
        }
        let undecided = self.views.iter_mut().zip(&asked).filter(|(_, asked)| **asked);
        undecided.for_each(|(need, _)| need.read = None);
        let uncovered = self.uncovered;
        let needs = Self::surveyed_from(self, world, targets, filter, Reads::Of(&asked));
        Self { uncovered, ..needs }
    }

    fn surveyed(world: &World, targets: &[View], filter: &FilterSettings, reads: Reads) -> Self {
        Self::surveyed_from(Self::nothing(world), world, targets, filter, reads)
    }

    fn surveyed_from(known: Self, world: &World, targets: &[View], filter: &FilterSettings, reads: Reads) -> Self {
        let mut needs = known;
        for (index, target) in targets.iter().enumerate() {
            let survey = Survey { world, target, index, filter, reads };
            // The extremes lie where the picture, the lens or a view ends, in this order of likelihood. With those
            // known, the rest is quick.
            let mut ranks: [Vec<Judged>; 3] = Default::default();
            for judged in survey.judged_blocks() {
                ranks[judged.rank].push(judged);
            }
            needs = ranks.iter().fold(needs, |needs, blocks| survey.blocks(blocks, needs));
        }
        needs
    }

    /// Returns the needs of no pixels: nothing seen, nothing read.
    pub(crate) fn nothing(world: &World) -> Self {
        let need = |source: &Source| Need { name: source.name.clone(), seen: None, read: None };
        Self { views: world.sources().iter().map(need).collect(), uncovered: None }
    }

    /// Merges two sets of needs.
    pub(crate) fn merged(mut self, other: &Self) -> Self {
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
        self.uncovered = Some(self.uncovered.map_or(other, |mine| mine.union(other)));
    }
}

fn union(a: Option<PixelRect>, b: Option<PixelRect>) -> Option<PixelRect> {
    a.into_iter().chain(b).reduce(PixelRect::union)
}

/// Returns whether nothing of `part` is outside `whole`.
fn within(part: Option<PixelRect>, whole: Option<PixelRect>) -> bool {
    part.is_none_or(|part| whole.is_some_and(|whole| whole.contains(&part)))
}

/// Survey of what one target needs of a world.
pub(crate) struct Survey<'a> {
    pub(crate) world: &'a World,
    pub(crate) target: &'a View,
    pub(crate) index: usize,
    pub(crate) filter: &'a FilterSettings,
    pub(crate) reads: Reads<'a>,
}

/// Method by which the texels that a filter reads are found.
#[derive(Clone, Copy)]
pub(crate) enum Reads<'a> {
    /// By the taps of each pixel.
    Exactly,
    /// By what kernels around a block of pixels can reach.
    AtMost,
    /// By the taps of each pixel, for these views alone; what the others need is known.
    Of(&'a [bool]),
}

/// A block and what is known of it as a whole. Large blocks are inside the picture, and one view shows all of each.
pub(crate) struct Judged {
    block: Block,
    cap: Option<Cap>,
    /// Source that shows all of the block.
    owner: Option<usize>,
    /// Whether all of the block is inside the field of view, where each pixel sees what its centre does.
    is_inside: bool,
    /// Order of the survey: 0 at the edge of the picture, 1 at the edge of a view, 2 inside both.
    rank: usize,
}

impl Survey<'_> {
    fn judged_blocks(&self) -> Vec<Judged> {
        let blocks = Block::largest(self.target).into_par_iter();
        blocks
            .flat_map_iter(|block| {
                let mut judged = Vec::new();
                self.judge(block, &mut judged);
                judged
            })
            .collect()
    }

    /// Adds a block if it is not hidden. A block at the edge of the picture or of a view is divided into its smallest
    /// parts. One that no view is near is not: there may be millions of them.
    fn judge(&self, block: Block, into: &mut Vec<Judged>) {
        if block.is_hidden(self.target) {
            return;
        }
        let judged = self.judged(block);
        match block.parts() {
            Some(parts) if (judged.rank < 2 || !judged.is_inside) && !self.is_far(&judged) => {
                parts.for_each(|part| self.judge(part, into))
            }
            _ => into.push(judged),
        }
    }

    /// Returns whether no view is near enough to be seen or read by a block.
    fn is_far(&self, judged: &Judged) -> bool {
        let kernel = self.filter.reaching_kernel();
        judged.cap.is_some_and(|cap| cap.read_texels(self.world, &kernel).next().is_none())
    }

    pub(crate) fn judged(&self, block: Block) -> Judged {
        let cap = block.cap(self.target);
        let owner = cap.and_then(|cap| cap.owner(self.world));
        let rank = if cap.is_none() || block.is_at_edge_of(self.target) { 0 } else { 1 + usize::from(owner.is_some()) };
        let is_inside = cap.is_some_and(|cap| cap.is_inside(self.target));
        Judged { block, cap, owner, is_inside, rank }
    }

    /// Adds what these blocks need to what is known already.
    fn blocks(&self, blocks: &[Judged], known: Needs) -> Needs {
        let few = blocks.len().div_ceil(8 * rayon::current_num_threads()).max(1);
        let table = KernelTable::new(&self.filter.kernel);
        let found: Vec<Needs> = blocks
            .par_chunks(few)
            .map(|blocks| {
                let mut found = Needs { uncovered: None, ..known.clone() };
                let mut pixels = PixelTaps::new(self.world, self.target, self.filter, &table);
                for judged in blocks {
                    self.add_block(judged, &mut pixels, &mut found);
                }
                found
            })
            .collect();
        found.iter().fold(known, Needs::merged)
    }

    /// Adds what the pixels of a block need, unless they surely need nothing new.
    pub(crate) fn add_block(&self, judged: &Judged, pixels: &mut PixelTaps, needs: &mut Needs) {
        let reads_nothing_new = judged.cap.is_some_and(|cap| match self.reads {
            Reads::Exactly => self.reads_within(&cap, needs, |_| true),
            Reads::Of(asked) => self.reads_within(&cap, needs, |view| asked[view]),
            Reads::AtMost if judged.block.parts().is_some() => self.reads_within(&cap, needs, |_| true),
            Reads::AtMost => {
                self.add_reach(&cap, needs);
                true
            }
        });
        let is_seen_known = matches!(self.reads, Reads::Of(_));
        let sees_nothing_new = is_seen_known
            || judged.cap.zip(judged.owner).is_some_and(|(cap, owner)| {
                within(cap.seen_texels(&self.world.sources()[owner]), needs.views[owner].seen)
            });
        if reads_nothing_new && sees_nothing_new {
            return;
        }
        if let Some(parts) = judged.block.parts() {
            return parts.for_each(|part| self.add_block(&self.judged(part), pixels, needs));
        }
        for (i, j) in judged.block.pixels() {
            if reads_nothing_new && judged.is_inside {
                self.add_centre((i, j), needs);
                continue;
            }
            let Some(screen) = self.target.screen_pixel(i, j) else { continue };
            if !is_seen_known {
                self.add_pixel((i, j), screen.footprint.direction, needs);
            }
            if reads_nothing_new {
                continue;
            }
            if !self.filter.kind.lists_texels() {
                let cap = Cap::around(screen.footprint.direction, &[screen.footprint]);
                cap.iter().for_each(|cap| self.add_reach(cap, needs));
            } else {
                pixels.for_each_texel((i, j), &screen, |texel| add_read(self.world, texel, &mut needs.views));
            }
        }
    }

    /// Returns whether kernels around a block's pixels touch only texels that are known to be needed.
    fn reads_within(&self, cap: &Cap, needs: &Needs, is_asked: impl Fn(usize) -> bool) -> bool {
        let mut touched = cap.read_texels(self.world, &self.filter.reaching_kernel());
        touched.all(|(view, texels)| !is_asked(view) || within(Some(texels), needs.views[view].read))
    }

    /// Adds all that kernels around a block's pixels can touch.
    pub(crate) fn add_reach(&self, cap: &Cap, needs: &mut Needs) {
        for (view, texels) in cap.read_texels(self.world, &self.filter.reaching_kernel()) {
            let need = &mut needs.views[view];
            need.read = union(need.read, Some(texels));
        }
    }

    /// Adds what the centre of a pixel sees.
    pub(crate) fn add_centre(&self, (i, j): (usize, usize), needs: &mut Needs) {
        let direction = self.target.direction(PixelPoint::centre(i, j));
        direction.into_iter().for_each(|direction| self.add_pixel((i, j), direction, needs));
    }

    /// Adds what a pixel sees, if it shows something.
    pub(crate) fn add_screen(&self, (i, j): (usize, usize), needs: &mut Needs) {
        let screen = self.target.screen_pixel(i, j);
        screen.into_iter().for_each(|screen| self.add_pixel((i, j), screen.footprint.direction, needs));
    }

    fn add_pixel(&self, (column, row): (usize, usize), direction: Direction, needs: &mut Needs) {
        match self.world.owner(direction) {
            Some((owner, at)) => add_seen(&self.world.sources()[owner], at, &mut needs.views[owner]),
            None => {
                needs.add_uncovered(Uncovered::pixel(self.index, (column, row), direction));
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
    // Sources lie one behind the other.
    let index = world.sources().partition_point(|source| source.texels().end <= texel);
    let Some(source) = world.sources().get(index).filter(|source| source.texels().contains(&texel)) else { return };
    let (i, j) = ((texel - source.offset) % source.view.width(), (texel - source.offset) / source.view.width());
    needs[index].read = union(needs[index].read, Some(one_texel(i, j)));
}

fn one_texel(i: usize, j: usize) -> PixelRect {
    PixelRect { left: i, top: j, right: i + 1, bottom: j + 1 }
}
