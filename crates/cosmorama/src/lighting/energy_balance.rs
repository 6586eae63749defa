use rayon::prelude::*;

use crate::camera::View;
use crate::raster::{Image, Rgba};
use crate::render::Plan;
use crate::sphere::Direction;
use crate::world::{SolidAngles, World};

/// Scale factors of rows and columns that make the weight matrix conservative.
///
/// With them, each pixel's weights sum to one, and each texel's to its solid angle. Pictures of a whole sphere then
/// keep the world's total radiance, wherever it comes from.
///
/// Near poles, seams and the corners of faces, a kernel that is normalised for each pixel gives some texels too much
/// weight. One factor for each texel and one for each pixel correct this, by the iteration of R. Sinkhorn and P. Knopp
/// (*Concerning nonnegative matrices and doubly stochastic matrices*, Pacific Journal of Mathematics 21, 1967). It ends
/// with a step for the texels, whose sums are therefore exact; a constant world stays constant up to the error of the
/// last step.
#[derive(Clone, Debug)]
pub struct LightBalance {
    texels: Vec<f32>,
    /// Factors of the pixels of each target.
    pixels: Vec<Vec<f32>>,
}

/// Number of iterations. They leave a constant world constant to 0.3 % (rms), except for single pixels beside poles and
/// rims. In pictures as fine as a panorama 1024 wide these differ by up to 1 % in cubes, panoramas and octahedra, and
/// by 5 % in other forms; in smaller ones by twice as much.
const STEPS: usize = 8;

/// Greatest factor of a texel's light, and the inverse of the least.
const MOST: f64 = 16.0;

/// Number of directions that are tested to see whether a world and its targets show the same.
const DIRECTIONS: usize = 2000;

/// Fraction by which they may differ, because of rims.
const DIFFERENCE: f64 = 0.01;

impl LightBalance {
    /// Returns whether targets show all that the world shows, and nothing twice. Otherwise light cannot be kept.
    pub fn applies(world: &World, targets: &[&View]) -> bool {
        let few = |part: f64| part <= DIFFERENCE;
        let is_seen = |direction: &Direction| targets.iter().any(|view| view.sees(*direction));
        let differs = |direction: &Direction| world.owner(*direction).is_some() != is_seen(direction);
        let differing = Direction::spread(DIRECTIONS).filter(differs).count();
        let shown: f64 = targets.iter().map(|view| sum(&solid_angles(view))).sum();
        let held: f64 = world.solid_angles().map(f64::from).sum();
        few(differing as f64 / DIRECTIONS as f64) && few((shown / held - 1.0).abs())
    }

    /// Returns the bytes of a balance while it is made and used, beside plans and pictures.
    pub fn bytes(world: &World, targets: &[&View]) -> u64 {
        let pixels: u64 = targets.iter().map(|view| view.width() as u64 * view.height() as u64).sum();
        // Factors, solid angles and shares of texels, and their light; factors, solid angles and what is spread of pixels.
        (world.texel_count() * (4 + 4 + 8 + size_of::<Rgba>())) as u64 + pixels * (4 + 4 + 4 + size_of::<Rgba>() as u64)
    }

    /// Computes the balance of a conversion to which [`LightBalance::applies`]. Every pixel must show something, and
    /// the plans' weights must not be negative.
    pub fn new(world: &World, targets: &[(&Plan, &View)]) -> Self {
        let wanted: Vec<f32> = world.solid_angles().collect();
        let own: Vec<SolidAngles> = targets.iter().map(|(_, view)| solid_angles(view)).collect();
        let scale = own.iter().map(|angles| sum(angles)).sum::<f64>() / sum(&wanted);
        let mut balance = Self {
            texels: vec![1.0; wanted.len()],
            pixels: own.iter().map(|angles| vec![1.0; angles.len()]).collect(),
        };
        let plans = || targets.iter().map(|(plan, _)| *plan);
        balance.share(plans(), &own, (&wanted, scale));
        for _ in 0..STEPS {
            balance.settle(plans());
            balance.share(plans(), &own, (&wanted, scale));
        }
        balance
    }

    /// Updates the factors of texels, so that each has its share of the pixels.
    fn share<'a>(
        &mut self,
        plans: impl Iterator<Item = &'a Plan>,
        own: &[SolidAngles],
        (wanted, scale): (&[f32], f64),
    ) {
        let mut shares = vec![0.0; wanted.len()];
        for ((plan, factors), angles) in plans.zip(&self.pixels).zip(own) {
            let values: Vec<f32> =
                factors.par_iter().zip(angles.par_iter()).map(|(factor, angle)| factor * angle).collect();
            plan.spread(&values, &mut shares);
        }
        self.texels.par_iter_mut().zip(shares).zip(wanted).for_each(|((factor, share), wanted)| {
            // What no pixel shows has no share.
            let fair = (scale * f64::from(*wanted) / share).clamp(MOST.recip(), MOST) as f32;
            *factor = if share > 0.0 { fair } else { 1.0 };
        });
    }

    /// Updates the factors of pixels, so that a constant world stays constant.
    fn settle<'a>(&mut self, plans: impl Iterator<Item = &'a Plan>) {
        let light: Vec<Rgba> = self.texels.par_iter().map(|factor| Rgba::opaque(*factor, *factor, *factor)).collect();
        for (plan, factors) in plans.zip(&mut self.pixels) {
            let made = plan.apply(&light);
            factors.par_iter_mut().zip(made.pixels()).for_each(|(factor, pixel)| {
                *factor = if pixel.0[0] > 0.0 { pixel.alpha() / pixel.0[0] } else { 1.0 };
            });
        }
    }

    /// Returns the world's light with the texels' factors applied, opaque, as input for the plans.
    pub fn balanced(&self, light: &[Rgba]) -> Vec<Rgba> {
        light.par_iter().zip(&self.texels).map(|(light, factor)| brighter(light, *factor)).collect()
    }

    /// Applies the pixels' factors to the result of a target's plan for balanced light.
    ///
    /// # Panics
    /// When the image's size differs from the target's.
    pub fn complete(&self, target: usize, image: &mut Image<Rgba>) {
        let factors = &self.pixels[target];
        assert_eq!(image.pixels().len(), factors.len(), "a factor for each pixel");
        image.pixels_mut().par_iter_mut().zip(factors).for_each(|(pixel, factor)| *pixel = brighter(pixel, *factor));
    }
}

/// Multiplies light by a factor, with alpha unchanged.
fn brighter(Rgba([red, green, blue, alpha]): &Rgba, factor: f32) -> Rgba {
    Rgba([red * factor, green * factor, blue * factor, *alpha])
}

fn solid_angles(view: &View) -> SolidAngles {
    SolidAngles::of(view, view.width())
}

fn sum(angles: &[f32]) -> f64 {
    angles.iter().copied().map(f64::from).sum()
}
