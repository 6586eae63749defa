use rayon::prelude::*;

use crate::camera::View;
use crate::raster::{Image, Rgba};
use crate::render::Plan;
use crate::sphere::Direction;
use crate::world::{SolidAngles, World};

/// Row and column scale factors that make the weight matrix conservative.
///
/// Each pixel's weights then sum to one, and each texel's to its solid angle. A picture of a whole sphere keeps the world's
/// total radiance, wherever that comes from.
///
/// Near poles, seams and the corners of faces a kernel that looks right from each pixel gives some texels more than their
/// share. The factors, one for each texel and one for each pixel, are those of R. Sinkhorn and P. Knopp (*Concerning
/// nonnegative matrices and doubly stochastic matrices*, Pacific Journal of Mathematics 21, 1967). Texels' shares are right in
/// the end, and a constant world stays constant but for what the last step leaves.
#[derive(Clone, Debug)]
pub struct LightBalance {
    texels: Vec<f32>,
    /// For each target.
    pixels: Vec<Vec<f32>>,
}

/// Steps after which a constant world is constant to 0.3 % (rms), but for single pixels beside poles and rims: of pictures as fine
/// as a panorama 1024 wide up to 1 % in cubes, panoramas and octahedra, 5 % in others, of smaller ones twice as much.
const STEPS: usize = 8;

/// A texel gets so many times its light at most, or is left with this part of it.
const MOST: f64 = 16.0;

/// Directions by which it is found whether a world and its targets show the same.
const DIRECTIONS: usize = 2000;

/// By what part they may differ: what rims cut.
const DIFFERENCE: f64 = 0.01;

impl LightBalance {
    /// Whether targets show what the world shows, all of it and nothing twice: else its light cannot be kept.
    pub fn applies(world: &World, targets: &[&View]) -> bool {
        let few = |part: f64| part <= DIFFERENCE;
        let is_seen = |direction: &Direction| targets.iter().any(|view| view.sees(*direction));
        let differs = |direction: &Direction| world.owner(*direction).is_some() != is_seen(direction);
        let differing = Direction::spread(DIRECTIONS).filter(differs).count();
        let shown: f64 = targets.iter().map(|view| sum(&solid_angles(view))).sum();
        let held: f64 = world.solid_angles().map(f64::from).sum();
        few(differing as f64 / DIRECTIONS as f64) && few((shown / held - 1.0).abs())
    }

    /// Bytes that one takes while it is made and used, beside plans and pictures.
    pub fn bytes(world: &World, targets: &[&View]) -> u64 {
        let pixels: u64 = targets.iter().map(|view| view.width() as u64 * view.height() as u64).sum();
        // Factors, solid angles and shares of texels, and their light; factors, solid angles and what is spread of pixels.
        (world.texel_count() * (4 + 4 + 8 + size_of::<Rgba>())) as u64 + pixels * (4 + 4 + 4 + size_of::<Rgba>() as u64)
    }

    /// Of a conversion for which [`LightBalance::applies`] and in which every pixel sees something; plans are of weights that are not negative.
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

    /// Gives each texel its share of the pixels.
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

    /// Makes pixels of a constant world constant.
    fn settle<'a>(&mut self, plans: impl Iterator<Item = &'a Plan>) {
        let light: Vec<Rgba> = self.texels.par_iter().map(|factor| Rgba::opaque(*factor, *factor, *factor)).collect();
        for (plan, factors) in plans.zip(&mut self.pixels) {
            let made = plan.apply(&light);
            factors.par_iter_mut().zip(made.pixels()).for_each(|(factor, pixel)| {
                *factor = if pixel.0[0] > 0.0 { pixel.alpha() / pixel.0[0] } else { 1.0 };
            });
        }
    }

    /// The light of the world, opaque, as plans are to take it.
    pub fn balanced(&self, light: &[Rgba]) -> Vec<Rgba> {
        light.par_iter().zip(&self.texels).map(|(light, factor)| brighter(light, *factor)).collect()
    }

    /// Completes what the plan of a target makes of balanced light.
    ///
    /// # Panics
    /// When it is not of that target's size.
    pub fn complete(&self, target: usize, image: &mut Image<Rgba>) {
        let factors = &self.pixels[target];
        assert_eq!(image.pixels().len(), factors.len(), "a factor for each pixel");
        image.pixels_mut().par_iter_mut().zip(factors).for_each(|(pixel, factor)| *pixel = brighter(pixel, *factor));
    }
}

/// Light times a factor, as opaque as before.
fn brighter(Rgba([red, green, blue, alpha]): &Rgba, factor: f32) -> Rgba {
    Rgba([red * factor, green * factor, blue * factor, *alpha])
}

fn solid_angles(view: &View) -> SolidAngles {
    SolidAngles::of(view, view.width())
}

fn sum(angles: &[f32]) -> f64 {
    angles.iter().copied().map(f64::from).sum()
}
