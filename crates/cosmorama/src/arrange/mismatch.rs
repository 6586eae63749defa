use super::border::Sample;
use super::{Border, Pose, Side};

/// Mismatch between each side of each picture and each side of the others.
///
/// A sample's mismatch is `ln(1 + d² / s²)`, where d is the difference of tones and s the uncertainty of both. It is 0
/// where they agree, and grows slowly for large differences, so that a seam inside a face's own border does not
/// dominate. It is stored for parts of a side, whose spread tells how much mismatch is due to chance.
#[derive(Clone, Debug)]
pub struct Mismatch {
    pictures: usize,
    seams: Vec<Seam>,
}

/// Two sides next to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seam {
    /// Sum of the mismatch over the seam's parts.
    pub(super) cost: f64,
    /// Variance of that sum, estimated from its parts.
    pub(super) variance: f64,
}

/// Difference of tones that may be due to rounding: two 8-bit codes.
const TONE: f32 = 2.0 / 255.0;
/// Least standard deviation of the mismatch of parts, however smooth they are.
const LEAST_SPREAD: f64 = 0.25;

impl Mismatch {
    /// Number of parts of a side.
    pub(super) const PARTS: usize = 8;

    /// Compares the borders of pictures, which all have the same number of samples.
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

    /// Returns the number of pictures.
    pub(super) fn pictures(&self) -> usize {
        self.pictures
    }

    /// Panics unless there is one pose for each picture.
    pub(super) fn check(&self, poses: &[Pose]) {
        assert_eq!(poses.len(), self.pictures, "a pose for each picture");
    }

    /// Returns the mismatch of two sides; `mirrored` if exactly one of the two pictures is mirrored.
    pub(super) fn seam(&self, here: (usize, Side), there: (usize, Side), mirrored: bool) -> Seam {
        self.seams[index(self.pictures, here, there, mirrored)]
    }

    /// Returns the seams of an arrangement, where pictures lie next to each other.
    pub(super) fn seams(&self, poses: &[Pose]) -> Vec<SeamKey> {
        let pairs = (0..poses.len()).flat_map(|a| (a + 1..poses.len()).map(move |b| (a, b)));
        let key = |(a, b): (usize, usize)| {
            let (here, there) = (poses[a].side_towards(poses[b].face)?, poses[b].side_towards(poses[a].face)?);
            let mirrored = poses[a].is_mirrored() != poses[b].is_mirrored();
            Some(SeamKey { here: (a, here), there: (b, there), mirrored })
        };
        pairs.filter_map(key).collect()
    }

    /// Returns the total mismatch of some seams.
    pub(super) fn sum<'a>(&self, keys: impl Iterator<Item = &'a SeamKey>) -> Seam {
        keys.map(|key| self.seam(key.here, key.there, key.mirrored)).fold(Seam::default(), |sum, seam| Seam {
            cost: sum.cost + seam.cost,
            variance: sum.variance + seam.variance,
        })
    }

    /// Returns the least mismatch of all pairs of sides.
    pub(super) fn least(&self) -> f64 {
        let of_two = |index: &usize| index / (8 * 4 * self.pictures) != index / 8 % self.pictures;
        let costs = (0..self.seams.len()).filter(of_two).map(|index| self.seams[index].cost);
        costs.fold(f64::INFINITY, f64::min)
    }
}

/// A pair of sides that lie next to each other.
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
    /// Compares two sides. Both run clockwise around their pictures, so one is reversed, unless one picture is
    /// mirrored.
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
