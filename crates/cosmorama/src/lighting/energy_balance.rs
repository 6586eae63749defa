use std::convert::Infallible;

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
    /// Factors of the texels.
    texels: Vec<f32>,
    /// Factors of the texels in the step before, from which those of pixels follow.
    before: Vec<f32>,
}

/// Number of iterations. They leave a constant world constant to 0.3 % (rms), except for single pixels beside poles and
/// rims. In pictures as fine as a panorama 1024 wide these differ by up to 1 % in cubes, panoramas and octahedra, and
/// by 5 % in other forms; in smaller ones by twice as much.
const SETTLING: usize = 8;

/// Greatest factor of a texel's light, and the inverse of the least.
const MOST: f64 = 16.0;

/// Number of directions that are tested to see whether a world and its targets show the same.
const DIRECTIONS: usize = 2000;

/// Fraction by which they may differ, because of rims.
const DIFFERENCE: f64 = 0.01;

impl LightBalance {
    /// Number of times that [`LightBalance::of_parts`] visits all parts.
    pub const STEPS: usize = 1 + SETTLING;

    /// Returns whether targets show all that the world shows, and nothing twice. Otherwise light cannot be kept.
    pub fn applies(world: &World, targets: &[&View]) -> bool {
        let few = |part: f64| part <= DIFFERENCE;
        let is_seen = |direction: &Direction| targets.iter().any(|view| view.sees(*direction));
        let differs = |direction: &Direction| world.owner(*direction).is_some() != is_seen(direction);
        let differing = Direction::spread(DIRECTIONS).filter(differs).count();
        let shown: f64 = targets.iter().map(|view| solid_angle(view)).sum();
        let held: f64 = world.solid_angles().map(f64::from).sum();
        few(differing as f64 / DIRECTIONS as f64) && few((shown / held - 1.0).abs())
    }

    /// Returns the bytes of a balance while it is made and used, beside plans and pictures, with so many pixels at once.
    pub fn bytes(world: &World, pixels: u64) -> u64 {
        // Factors, solid angles and shares of texels, and their light; factors, solid angles and what is spread of pixels.
        let texel = 4 + 4 + 4 + 8 + size_of::<Rgba>();
        (world.texel_count() * texel) as u64 + pixels * (4 + 4 + 4 + size_of::<Rgba>() as u64)
    }

    /// Computes the balance of a conversion to which [`LightBalance::applies`]. Every pixel must show something, and
    /// the plans' weights must not be negative.
    pub fn new(world: &World, targets: &[(&Plan, &View)]) -> Self {
        let own: Vec<SolidAngles> = targets.iter().map(|(_, view)| solid_angles(view)).collect();
        let balance = Self::of_plans(world, |visit| {
            targets.iter().zip(&own).for_each(|((plan, _), angles)| visit(plan, angles));
            Ok::<(), Infallible>(())
        });
        balance.unwrap_or_else(|never| match never {})
    }

    /// Computes the balance like [`LightBalance::new`] from parts of targets, whose plans are too large together. `each` visits all parts,
    /// once for each of the [`STEPS`](LightBalance::STEPS).
    ///
    /// # Errors
    /// Whatever `each` returns as an error.
    pub fn of_parts<E>(
        world: &World,
        mut each: impl FnMut(&mut dyn FnMut(&Plan, &View)) -> Result<(), E>,
    ) -> Result<Self, E> {
        Self::of_plans(world, |visit| each(&mut |plan, view| visit(plan, &solid_angles(view))))
    }

    /// Computes the balance of plans, which `each` visits with the solid angles of their pixels.
    fn of_plans<E>(
        world: &World,
        mut each: impl FnMut(&mut dyn FnMut(&Plan, &[f32])) -> Result<(), E>,
    ) -> Result<Self, E> {
        let wanted: Vec<f32> = world.solid_angles().collect();
        let (mut shown, mut shares) = (0.0, vec![0.0; wanted.len()]);
        each(&mut |plan, angles| {
            shown += sum(angles);
            plan.spread(angles, &mut shares);
        })?;
        let scale = shown / sum(&wanted);
        let mut balance = Self { texels: vec![1.0; wanted.len()], before: Vec::new() };
        balance.share(&shares, (&wanted, scale));
        for _ in 0..SETTLING {
            shares.fill(0.0);
            balance.before.clone_from(&balance.texels);
            let light = balance.light_before();
            each(&mut |plan, angles| {
                let factors = settled(plan, &light);
                let values: Vec<f32> = factors.par_iter().zip(angles).map(|(factor, angle)| factor * angle).collect();
                plan.spread(&values, &mut shares);
            })?;
            balance.share(&shares, (&wanted, scale));
        }
        Ok(balance)
    }

    /// Updates the factors of texels, so that each has its share of the pixels.
    fn share(&mut self, shares: &[f64], (wanted, scale): (&[f32], f64)) {
        self.texels.par_iter_mut().zip(shares).zip(wanted).for_each(|((factor, share), wanted)| {
            // What no pixel shows has no share.
            let fair = (scale * f64::from(*wanted) / share).clamp(MOST.recip(), MOST) as f32;
            *factor = if *share > 0.0 { fair } else { 1.0 };
        });
    }

    /// Returns a constant world, with the factors of the step before.
    fn light_before(&self) -> Vec<Rgba> {
        self.before.par_iter().map(|factor| Rgba::opaque(*factor, *factor, *factor)).collect()
    }

    /// Returns the factors of a plan's pixels, by which a constant world stays constant.
    pub fn pixels(&self, plan: &Plan) -> Vec<f32> {
        settled(plan, &self.light_before())
    }

    /// Returns the world's light with the texels' factors applied, opaque, as input for the plans.
    pub fn balanced(&self, light: &[Rgba]) -> Vec<Rgba> {
        light.par_iter().zip(&self.texels).map(|(light, factor)| brighter(light, *factor)).collect()
    }

    /// Applies the [factors of a plan's pixels](LightBalance::pixels) to what it has made of balanced light.
    ///
    /// # Panics
    /// When there are not as many factors as pixels.
    pub fn complete(factors: &[f32], image: &mut Image<Rgba>) {
        assert_eq!(image.pixels().len(), factors.len(), "a factor for each pixel");
        image.pixels_mut().par_iter_mut().zip(factors).for_each(|(pixel, factor)| *pixel = brighter(pixel, *factor));
    }
}

/// Returns factors of a plan's pixels, by which light becomes as bright as its alpha.
fn settled(plan: &Plan, light: &[Rgba]) -> Vec<f32> {
    let made = plan.apply(light);
    let factor = |pixel: &Rgba| if pixel.0[0] > 0.0 { pixel.alpha() / pixel.0[0] } else { 1.0 };
    made.pixels().par_iter().map(factor).collect()
}

/// Multiplies light by a factor, with alpha unchanged.
fn brighter(Rgba([red, green, blue, alpha]): &Rgba, factor: f32) -> Rgba {
    Rgba([red * factor, green * factor, blue * factor, *alpha])
}

/// Returns the solid angle of all pixels of a view.
fn solid_angle(view: &View) -> f64 {
    let of_row = |j: usize| {
        let mut row = vec![0.0; view.width()];
        view.row_solid_angles(j, &mut row);
        sum(&row)
    };
    (0..view.height()).into_par_iter().map(of_row).collect::<Vec<f64>>().into_iter().sum()
}

fn solid_angles(view: &View) -> SolidAngles {
    SolidAngles::of(view, view.width())
}

fn sum(angles: &[f32]) -> f64 {
    angles.iter().copied().map(f64::from).sum()
}
