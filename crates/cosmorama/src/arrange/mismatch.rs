use super::border::Sample;
use super::{Border, Pose, Side};

/// Mismatch of each side of each picture with each side of the others.
///
/// A sample's mismatch is `ln(1 + d² / s²)`, d the difference of tones and s how far both may be off: nothing for what
/// agrees, and no more for what differs wildly than for what differs much, so that a seam within a face's own border does
/// not outweigh the rest. It is kept by part of the side, to tell from chance what is more than that.
#[derive(Clone, Debug)]
pub struct Mismatch {
    pictures: usize,
    seams: Vec<Seam>,
}

/// Two sides beside each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seam {
    /// The sum of the mismatch of its parts.
    pub(super) cost: f64,
    /// The variance of that sum, as far as its parts tell.
    pub(super) variance: f64,
}

/// Tones that differ by this may be the same: two codes of eight bits.
const TONE: f32 = 2.0 / 255.0;
/// Parts that differ by chance differ by at least this, however smooth they are.
const LEAST_SPREAD: f64 = 0.25;

impl Mismatch {
    /// Parts of a side.
    pub(super) const PARTS: usize = 8;

    /// Compares the borders of pictures, all of as many samples.
    ///
    /// # Panics
    /// When borders have different numbers of samples.
    pub fn new(borders: &[Border]) -> Self {
        assert!(borders.iter().all(|border| border.samples() == borders[0].samples()), "borders of one length");
        let pictures = borders.len();
        let mut seams = vec![Seam::default(); pictures * 4 * pictures * 4 * 2];
        for (a, first) in borders.iter().enumerate() {
            for (b, second) in borders.iter().enumerate().filter(|(b, _)| *b != a) {
                for (here, there) in Side::ALL.into_iter().flat_map(|here| Side::ALL.map(|there| (here, there))) {
                    for mirrored in [false, true] {
                        let seam = Seam::between(first.side(here), second.side(there), mirrored);
                        seams[index(pictures, (a, here), (b, there), mirrored)] = seam;
                    }
                }
            }
        }
        Self { pictures, seams }
    }

    /// How many pictures there are.
    pub(super) fn pictures(&self) -> usize {
        self.pictures
    }

    /// Panics unless there is a pose for each picture.
    pub(super) fn check(&self, poses: &[Pose]) {
        assert_eq!(poses.len(), self.pictures, "a pose for each picture");
    }

    /// Two sides; `mirrored` where one of the two pictures is and the other is not.
    pub(super) fn seam(&self, here: (usize, Side), there: (usize, Side), mirrored: bool) -> Seam {
        self.seams[index(self.pictures, here, there, mirrored)]
    }

    /// The seams of an arrangement: where pictures lie beside each other.
    pub(super) fn seams(&self, poses: &[Pose]) -> Vec<SeamKey> {
        let pairs = (0..poses.len()).flat_map(|a| (a + 1..poses.len()).map(move |b| (a, b)));
        let key = |(a, b): (usize, usize)| {
            let (here, there) = (poses[a].side_towards(poses[b].face)?, poses[b].side_towards(poses[a].face)?);
            let mirrored = poses[a].is_mirrored() != poses[b].is_mirrored();
            Some(SeamKey { here: (a, here), there: (b, there), mirrored })
        };
        pairs.filter_map(key).collect()
    }

    /// The mismatch of some seams.
    pub(super) fn sum<'a>(&self, keys: impl Iterator<Item = &'a SeamKey>) -> Seam {
        keys.map(|key| self.seam(key.here, key.there, key.mirrored)).fold(Seam::default(), |sum, seam| Seam {
            cost: sum.cost + seam.cost,
            variance: sum.variance + seam.variance,
        })
    }

    /// The least mismatch of all.
    pub(super) fn least(&self) -> f64 {
        let of_two = |index: &usize| index / (8 * 4 * self.pictures) != index / 8 % self.pictures;
        let costs = (0..self.seams.len()).filter(of_two).map(|index| self.seams[index].cost);
        costs.fold(f64::INFINITY, f64::min)
    }
}

/// Which sides lie beside each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SeamKey {
    here: (usize, Side),
    there: (usize, Side),
    mirrored: bool,
}

fn index(pictures: usize, here: (usize, Side), there: (usize, Side), mirrored: bool) -> usize {
    let sides = (here.0 * 4 + here.1 as usize) * pictures * 4 + there.0 * 4 + there.1 as usize;
    sides * 2 + usize::from(mirrored)
}

impl Seam {
    /// Both sides go round their picture clockwise, so that one of them runs backwards, unless one picture is mirrored.
    fn between(here: &[Sample], there: &[Sample], mirrored: bool) -> Self {
        let count = here.len();
        let mut parts = [(0.0, 0_usize); Mismatch::PARTS];
        for (k, sample) in here.iter().enumerate() {
            let opposite = &there[if mirrored { k } else { count - 1 - k }];
            let part = &mut parts[k * Mismatch::PARTS / count];
            *part = (part.0 + sample.mismatch(opposite), part.1 + 1);
        }
        let filled = || parts.iter().filter(|part| part.1 > 0).map(|(sum, count)| sum / *count as f64);
        let number = filled().count() as f64;
        let mean = filled().sum::<f64>() / number;
        let spread = filled().map(|part| (part - mean) * (part - mean)).sum::<f64>() / (number - 1.0).max(1.0);
        Self { cost: number * mean, variance: number * spread.max(LEAST_SPREAD * LEAST_SPREAD) }
    }
}

impl Sample {
    fn mismatch(&self, other: &Self) -> f64 {
        let channel = |c: usize| {
            let difference = self.colour[c] - other.colour[c];
            let doubt = TONE * TONE + self.doubt[c] + other.doubt[c];
            f64::from(difference * difference / doubt).ln_1p()
        };
        (0..3).map(channel).sum::<f64>() / 3.0
    }
}
