mod gaussian;
mod least_squares;

use rayon::prelude::*;

use super::pair::Pair;
use super::quantile::quantile;
use crate::compare::Mask;
use crate::raster::{Image, Rgba};
use gaussian::blurred;
use least_squares::{NormalEquations, Vector, dot};

/// Distance from an excluded pixel within which pixels are left out, because their gradients may see it.
const RIM: u8 = 8;

/// Number of fits; each after the first leaves out the pixels that fitted worst.
const PASSES: usize = 3;

/// Fraction of the pixels that a fit keeps from the one before.
const KEPT: f64 = 0.98;

/// Greatest flow, in pixels, that can be trusted: slopes tell nothing about places further away.
const DOUBT: f64 = 1.0;

/// Place of one picture on another: the affine flow u for which second(x) = first(x + u) fits best.
///
/// All figures are zero for geometrically identical pictures, and so is any component that the pictures do not show,
/// such as a shift along stripes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registration {
    /// Distance by which the first picture lies to the right of the second, at the centre, in pixels.
    pub dx: f64,
    /// Distance by which the first picture lies below the second, at the centre, in pixels.
    pub dy: f64,
    /// Relative excess of the first picture's width: 0.01 is 1 %.
    pub scale_x: f64,
    /// Relative excess of the first picture's height.
    pub scale_y: f64,
    /// Clockwise rotation of the first picture, in radians.
    pub rotation: f64,
    /// Shear of the first picture: half the change of the angle between its axes, in radians.
    pub shear: f64,
}

impl Registration {
    /// Returns the length of the shift at the centre, in pixels.
    pub fn shift(&self) -> f64 {
        self.dx.hypot(self.dy)
    }

    /// Returns the displacement, right and down, of a point given by its distances right of and below the centre, in
    /// pixels.
    pub fn displacement(&self, right: f64, down: f64) -> (f64, f64) {
        (
            self.dx + self.scale_x * right + (self.shear - self.rotation) * down,
            self.dy + (self.shear + self.rotation) * right + self.scale_y * down,
        )
    }

    /// Fits the flow. `None` when every compared pixel is near one that is not, or when the differences correspond to
    /// an error of [`DOUBT`] or more.
    pub(in crate::compare) fn between(pair: &Pair<'_>) -> Option<Self> {
        let flow = Flow::new(pair);
        let mut fit = flow.fit(|_| true);
        for _ in 1..PASSES {
            let limit = quantile(&mut flow.residuals(&fit), KEPT)?;
            fit = flow.fit(|equation| f64::from(equation.residual(&fit)) <= limit);
        }
        (flow.doubt(&fit) <= DOUBT).then(|| flow.registration(&fit))
    }
}

/// Equations of the flow, one for each pixel: brightness difference = gradient · displacement.
struct Flow {
    first: Image<f32>,
    second: Image<f32>,
    counted: Mask,
}

impl Flow {
    fn new(pair: &Pair<'_>) -> Self {
        let [first, second] = [pair.first(), pair.second()].map(|picture| blurred(&brightness(picture)));
        Self { first, second, counted: pair.mask().eroded(RIM) }
    }

    /// Returns the flow that best fits the equations to be kept.
    fn fit(&self, kept: impl Fn(&Equation) -> bool + Sync) -> Vector {
        let of_row = |j| {
            let mut equations = NormalEquations::default();
            self.row(j).filter(&kept).for_each(|equation| equations.observe(&equation.factors, equation.value));
            equations
        };
        // Rows are added in their order, so that the sums do not depend on the number of threads.
        let rows: Vec<_> = (0..self.first.height()).into_par_iter().map(of_row).collect();
        let mut all = NormalEquations::default();
        rows.iter().for_each(|row| all.add(row));
        all.solve()
    }

    fn residuals(&self, flow: &Vector) -> Vec<f32> {
        let of_row = |j| self.row(j).map(|equation| equation.residual(flow)).collect();
        let rows: Vec<Vec<f32>> = (0..self.first.height()).into_par_iter().map(of_row).collect();
        rows.concat()
    }

    /// Returns the displacement, in pixels, that would explain the differences left by a flow: their deviation divided
    /// by that of the slopes. For pictures of different content it is about as long as their features are wide.
    fn doubt(&self, flow: &Vector) -> f64 {
        let of_row = |j| {
            let rest = |equation: Equation| {
                let [across, down, ..] = equation.factors;
                let rest = equation.value - dot(&equation.factors, flow);
                [1.0, rest, rest * rest, across * across + down * down]
            };
            self.row(j).map(rest).fold([0.0; 4], sum)
        };
        let rows: Vec<[f64; 4]> = (0..self.first.height()).into_par_iter().map(of_row).collect();
        let [count, rest, squares, slopes] = rows.into_iter().fold([0.0; 4], sum);
        let variance = (squares - rest * rest / count).max(0.0);
        // Slopes of one of two directions. If no difference is left, nothing is in doubt, whatever the slopes.
        if variance > 0.0 { (2.0 * variance / slopes).sqrt() } else { 0.0 }
    }

    /// Visits the equations of a row's compared pixels.
    fn row(&self, j: usize) -> impl Iterator<Item = Equation> {
        let counted = self.counted.row(j).iter().enumerate().filter(|(_, counted)| **counted);
        counted.map(move |(i, _)| self.equation(i, j))
    }

    /// Returns a pixel's equation. The unknowns are the displacement at the centre, and its change from there to the
    /// picture's longer edge.
    fn equation(&self, i: usize, j: usize) -> Equation {
        let average = |i, j| (f64::from(*self.first.get(i, j)) + f64::from(*self.second.get(i, j))) / 2.0;
        let across = (average(i + 1, j) - average(i - 1, j)) / 2.0;
        let down = (average(i, j + 1) - average(i, j - 1)) / 2.0;
        let [x, y] = [(i, self.first.width()), (j, self.first.height())]
            .map(|(index, length)| (index as f64 - (length as f64 - 1.0) / 2.0) / self.reach());
        Equation {
            factors: [across, down, across * x, across * y, down * x, down * y],
            value: f64::from(*self.second.get(i, j)) - f64::from(*self.first.get(i, j)),
        }
    }

    /// Returns the distance from the centre to the farther edges in pixels; as a unit of length it gives all unknowns a
    /// similar size.
    fn reach(&self) -> f64 {
        self.first.width().max(self.first.height()) as f64 / 2.0
    }

    fn registration(&self, flow: &Vector) -> Registration {
        let [dx, dy, slopes @ ..] = *flow;
        let [scale_x, x_by_y, y_by_x, scale_y] = slopes.map(|slope| slope / self.reach());
        Registration { dx, dy, scale_x, scale_y, rotation: (y_by_x - x_by_y) / 2.0, shear: (y_by_x + x_by_y) / 2.0 }
    }
}

/// Equation of one pixel: `factors · flow = value`.
struct Equation {
    factors: Vector,
    value: f64,
}

impl Equation {
    fn residual(&self, flow: &Vector) -> f32 {
        (dot(&self.factors, flow) - self.value).abs() as f32
    }
}

fn sum(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|at| a[at] + b[at])
}

fn brightness(picture: &Image<Rgba>) -> Image<f32> {
    Image::from_fn(picture.width(), picture.height(), |i, j| {
        let [red, green, blue, _] = picture.get(i, j).finite().0;
        (red + green + blue) / 3.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws a smooth picture: the value of a wave at the place of each pixel.
    fn waves(place: impl Fn(f64, f64) -> (f64, f64)) -> Image<Rgba> {
        Image::from_fn(96, 80, |i, j| {
            let (x, y) = place(i as f64 - 47.5, j as f64 - 39.5);
            let wave = |phase: f64| (0.5 + 0.2 * (0.11 * x + phase).sin() + 0.2 * (0.09 * y + 0.05 * x).cos()) as f32;
            Rgba::opaque(wave(0.0), wave(0.5), wave(1.0))
        })
    }

    fn registration(first: &Image<Rgba>, second: &Image<Rgba>) -> Registration {
        Registration::between(&Pair::new(first, second, &Mask::everything(96, 80)).unwrap()).unwrap()
    }

    #[test]
    fn shifts_are_found() {
        let still = waves(|x, y| (x, y));
        for (right, down) in [(0.01, 0.0), (0.0, -0.1), (0.3, 0.2), (-0.05, 0.3)] {
            let found = registration(&waves(|x, y| (x - right, y - down)), &still);
            assert!((found.dx - right).abs() < 1e-3 && (found.dy - down).abs() < 1e-3, "{right} {down}: {found:?}");
        }
    }

    #[test]
    fn scale_rotation_and_shear_are_found() {
        let still = waves(|x, y| (x, y));
        let wider = registration(&waves(|x, y| (x / 1.002, y)), &still);
        assert!((wider.scale_x - 0.002).abs() < 2e-5 && wider.scale_y.abs() < 2e-5, "{wider:?}");
        let (sin, cos) = 0.003_f64.sin_cos();
        let turned = registration(&waves(|x, y| (cos * x + sin * y, cos * y - sin * x)), &still);
        assert!((turned.rotation - 0.003).abs() < 2e-5 && turned.shear.abs() < 2e-5, "{turned:?}");
        let (right, down) = turned.displacement(40.0, 0.0);
        assert!(right.abs() < 2e-3 && (down - 0.12).abs() < 2e-3);
    }

    #[test]
    fn identical_pictures_lie_exactly_on_each_other() {
        let still = waves(|x, y| (x, y));
        let found = registration(&still, &still);
        assert_eq!((found.shift(), found.scale_x, found.scale_y, found.rotation), (0.0, 0.0, 0.0, 0.0));
    }

    #[test]
    fn pictures_that_slopes_do_not_bring_together_have_no_registration() {
        // Squares at random, a few pixels wide, so that no place tells anything of the next.
        let squares = |right: usize| {
            Image::from_fn(96, 80, |i, j| {
                let number = ((i + right) / 4 * 31 + j / 4 * 17) as u64;
                let light = (number.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f32 / (1 << 24) as f32;
                Rgba::opaque(light, light, light)
            })
        };
        let between = |right: usize| {
            Registration::between(&Pair::new(&squares(right), &squares(0), &Mask::everything(96, 80)).unwrap())
        };
        assert!((between(1).expect("a pixel is not too far").dx + 1.0).abs() < 0.5);
        for far in [4, 8, 40] {
            assert_eq!(between(far), None, "{far} pixels");
        }
    }

    #[test]
    fn too_few_pixels_give_no_registration() {
        let still = Image::filled(16, 16, Rgba::BLACK);
        assert_eq!(Registration::between(&Pair::new(&still, &still, &Mask::everything(16, 16)).unwrap()), None);
    }
}
