use std::f64::consts::{FRAC_PI_2, PI};

use crate::lighting::prefilter::Lobe;

/// Factors by which a lobe multiplies the bands of a world's light: band l by 2π ∫ w(θ) P_l(cos θ) sin θ dθ (Funk & Hecke; Basri &
/// Jacobs 2003, equation 6). The first is the lobe's integral.
///
/// Bands beyond them are left out. They are so weak that this is not seen.
pub(super) struct Bands(Vec<f64>);

/// Part of a lobe, as the root of its square sum, that bands left out may hold.
///
/// The error of an average is at most that times the root of the brightest light's share in all. Light of large share is no part of
/// the bands: it is summed texel by texel.
const LEFT_OUT: f64 = 5e-4;

/// Highest band. Sharper lobes have no bands, and are averaged in other ways.
const HIGHEST: usize = 767;

/// Bands between two looks at whether there are enough.
const STEP: usize = 32;

impl Bands {
    /// Computes the factors of a lobe; `None` if it is too sharp.
    pub(super) fn of(lobe: &Lobe) -> Option<Self> {
        let mut factors = Factors::new(lobe);
        let mut found: Vec<f64> = Vec::new();
        loop {
            found.extend((0..STEP).map(|_| factors.next()));
            let whole = found[0];
            let power = |(l, factor): (usize, &f64)| (2 * l + 1) as f64 * (factor / whole).powi(2);
            let beyond = |first: usize| found.iter().enumerate().skip(first).map(power).sum::<f64>();
            // As powers of l, what follows is less than what lies between the half and the end.
            if beyond(found.len() / 2) < LEFT_OUT * LEFT_OUT {
                let mut rest = 0.0;
                let is_needed = |place: &(usize, &f64)| {
                    rest += power(*place);
                    rest > LEFT_OUT * LEFT_OUT
                };
                let last = found.iter().enumerate().rev().find(is_needed).map_or(0, |(l, _)| l);
                found.truncate(last + 1);
                return Some(Self(found));
            }
            if found.len() > 2 * HIGHEST {
                return None;
            }
        }
    }

    /// Returns the highest band.
    pub(super) fn highest(&self) -> usize {
        self.0.len() - 1
    }

    /// Returns the angle over which light may be taken together, in radians. A band is weakened by (l·angle)²/24, the variance of a
    /// square; of all bands that is no more than what is left out.
    pub(super) fn grain(&self) -> f64 {
        let bent = self.0.iter().enumerate().map(|(l, factor)| {
            let bent = (l * l) as f64 * factor / self.0[0];
            (2 * l + 1) as f64 * bent * bent
        });
        (24.0 * LEFT_OUT / bent.sum::<f64>().sqrt()).sqrt()
    }

    /// Returns the factor of a band.
    pub(super) fn factor(&self, l: usize) -> f64 {
        self.0[l]
    }
}

/// Integrals of a lobe times Legendre's polynomials, one after the other.
struct Factors {
    /// Polynomials before the next one at each sample, and their degree.
    older: Vec<f64>,
    newer: Vec<f64>,
    degree: usize,
    cosines: Vec<f64>,
    /// Weights of the lobe times those of Gauss's rule.
    weights: Vec<f64>,
}

/// Parts of the hemisphere, to each of which Gauss's rule of four points is applied. The highest band that is looked at turns over
/// less than half a wave in one.
const PARTS: usize = 1024;

/// Places and weights of Gauss's rule of four points, from −1 to 1.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

impl Factors {
    fn new(lobe: &Lobe) -> Self {
        let half = 0.5 * FRAC_PI_2 / PARTS as f64;
        let middle = |part: usize| (2 * part + 1) as f64 * half;
        let samples =
            (0..PARTS).flat_map(|part| GAUSS.map(|(place, weight)| (middle(part) + half * place, half * weight)));
        let sample = |(theta, weight): (f64, f64)| {
            // 1 − cos θ, exact near the axis.
            let s = 2.0 * (0.5 * theta).sin().powi(2);
            (theta.cos(), 2.0 * PI * weight * theta.sin() * lobe.weight_off_axis(s))
        };
        let (cosines, weights): (Vec<f64>, Vec<f64>) = samples.map(sample).unzip();
        let count = cosines.len();
        Self { older: vec![0.0; count], newer: vec![1.0; count], degree: 0, cosines, weights }
    }

    /// Returns the next integral.
    fn next(&mut self) -> f64 {
        const LANES: usize = 8;
        let degree = self.degree as f64;
        let (rise, fall) = ((2.0 * degree + 1.0) / (degree + 1.0), degree / (degree + 1.0));
        let mut sums = [0.0; LANES];
        let samples = self.older.as_chunks_mut::<LANES>().0.iter_mut().zip(self.newer.as_chunks_mut::<LANES>().0);
        let fixed = self.cosines.as_chunks::<LANES>().0.iter().zip(self.weights.as_chunks::<LANES>().0);
        for ((older, newer), (cosines, weights)) in samples.zip(fixed) {
            for lane in 0..LANES {
                sums[lane] += weights[lane] * newer[lane];
                let next = rise * cosines[lane] * newer[lane] - fall * older[lane];
                older[lane] = newer[lane];
                newer[lane] = next;
            }
        }
        self.degree += 1;
        sums.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares Lambert's factors with those of Ramamoorthi & Hanrahan 2001, equations 7 to 9.
    #[test]
    fn matt_bands_are_those_of_the_paper() {
        let bands = Bands::of(&Lobe::LAMBERT).expect("few bands");
        let expected = [PI, 2.0 * PI / 3.0, PI / 4.0, 0.0, -PI / 24.0, 0.0, PI / 64.0];
        for (l, expected) in expected.into_iter().enumerate() {
            assert!((bands.factor(l) - expected).abs() < 1e-9, "{l}: {}", bands.factor(l));
        }
        assert!((100..250).contains(&bands.highest()), "{}", bands.highest());
    }

    #[test]
    fn sharp_lobes_have_more_bands_and_needles_none() {
        let highest = |alpha: f64| Bands::of(&Lobe::ggx(alpha).expect("in range")).map(|bands| bands.highest());
        assert!(highest(0.05) > highest(0.2) && highest(0.02) > highest(0.05));
        assert_eq!(highest(0.002), None);
        for lobe in [Lobe::phong(64.0), Lobe::blinn(64.0), Lobe::charlie(0.2)] {
            let lobe = lobe.expect("in range");
            let bands = Bands::of(&lobe).expect("few bands");
            assert!((bands.factor(0) / lobe.integral() - 1.0).abs() < 1e-9, "{lobe:?}");
        }
    }
}
