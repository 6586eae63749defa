use super::texels::Texels;
use crate::render::plan::symmetry::{Mirrors, TOGETHER, Ways, exchanged};

/// Texels of a view in all mirror images, grouped as filters process them together. They are checked here once for a
/// band, not in each run. (Not once for all bands: they are pointers, which threads do not share.)
pub(crate) enum ViewTexels<'a, T> {
    /// Eight mirror images, as two groups of four.
    Eight([FourTexels<'a, T>; 2]),
    /// Eight mirror images, as two groups of four; in the second, rows of windows are columns.
    Turned([FourTexels<'a, T>; 2]),
    Four(FourTexels<'a, T>),
    /// Two mirror images, one for each direction.
    Two(Texels<'a, T, 2, 1>),
    /// Any other number of mirror images, at most [`TOGETHER`], one by one.
    OneByOne {
        forward: Vec<Texels<'a, T, 1, 0>>,
        reversed: Vec<Texels<'a, T, 1, 1>>,
    },
}

/// Two mirror images from left to right and two from right to left. Both pairs have the same two steps from row to row.
pub(crate) type FourTexels<'a, T> = Texels<'a, T, TOGETHER, 2>;

impl<'a, T: Copy> ViewTexels<'a, T> {
    /// Checks the texels of every view against the samples of the light, in the order of the view's [`Ways`].
    ///
    /// # Panics
    /// If a view is not among the samples.
    pub(crate) fn all(mirrors: &Mirrors, samples: &'a [T]) -> Vec<Self> {
        let views = mirrors.layout().enumerate();
        views.map(|(view, rows)| Self::of(mirrors.ways(view), rows.size, samples)).collect()
    }

    fn of(ways: &Ways, size: [usize; 2], samples: &'a [T]) -> Self {
        let four = |first: usize, is_turned: bool| Texels::new(samples, ways.four(first), exchanged(size, is_turned));
        let walks = &ways.walks[..ways.count];
        match (ways.forward, ways.turned, ways.count) {
            (4, 0, 8) => Self::Eight([four(0, false), four(TOGETHER, false)]),
            (2, 4, 8) => Self::Turned([four(0, false), four(TOGETHER, true)]),
            (2, 0, 4) if ways.are_four(0) => Self::Four(four(0, false)),
            (1, 0, 2) => Self::Two(Texels::new(samples, [walks[0], walks[1]], size)),
            (forward, turned, _) => {
                assert_eq!(turned, 0, "columns are rows in four mirrors together");
                assert!(ways.count <= TOGETHER, "eight mirrors are taken as twice four");
                Self::OneByOne {
                    forward: walks[..forward].iter().map(|walk| Texels::new(samples, [*walk], size)).collect(),
                    reversed: walks[forward..].iter().map(|walk| Texels::new(samples, [*walk], size)).collect(),
                }
            }
        }
    }
}
