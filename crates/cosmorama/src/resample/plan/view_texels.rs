use super::mirrors::{MOST_IMAGES, Mirrors, Walk};
use super::texels::Texels;

/// A view's texels in all mirrors, those together that filters work on at once: looked at here once for a band, not in each run. (Not
/// once for all bands: these are pointers, which threads do not share.)
pub(super) enum ViewTexels<'a, T> {
    /// Two from left to right and two from right to left, whose steps from row to row are the same two.
    Four(Texels<'a, T, 4, 2>),
    /// One each way.
    Two(Texels<'a, T, 2, 1>),
    /// As many as there are, one by one.
    OneByOne { forward: Vec<Texels<'a, T, 1, 0>>, reversed: Vec<Texels<'a, T, 1, 1>> },
}

impl<'a, T: Copy> ViewTexels<'a, T> {
    /// Those of each view, in the order of its [`super::mirrors::Ways`], given the samples of the light.
    ///
    /// # Panics
    /// If a view is not among the samples.
    pub(super) fn all(mirrors: &Mirrors, samples: &'a [T]) -> Vec<Self> {
        (0..mirrors.layout().count()).map(|view| Self::of(mirrors, view, samples)).collect()
    }

    fn of(mirrors: &Mirrors, view: usize, samples: &'a [T]) -> Self {
        let ways = mirrors.ways(view);
        let (mut walks, size) = ([Walk::default(); MOST_IMAGES], mirrors.images[0].view(view).size());
        for (walk, (index, _)) in walks.iter_mut().zip(&ways.order[..ways.count]) {
            *walk = mirrors.images[*index].view(view).walk([0; 2]);
        }
        match (ways.forward, ways.count) {
            (2, 4) if ways.down[..2] == ways.down[2..] => Self::Four(Texels::new(samples, walks, size)),
            (1, 2) => Self::Two(Texels::new(samples, [walks[0], walks[1]], size)),
            (forward, count) => Self::OneByOne {
                forward: walks[..forward].iter().map(|walk| Texels::new(samples, [*walk], size)).collect(),
                reversed: walks[forward..count].iter().map(|walk| Texels::new(samples, [*walk], size)).collect(),
            },
        }
    }
}
