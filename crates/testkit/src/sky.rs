use cosmorama::filter::FilterSettings;
use cosmorama::lighting::LightBalance;
use cosmorama::raster::Rgba;
use cosmorama::render::{Arithmetic, Plan, Resampler};
use cosmorama::world::World;

use crate::Form;

/// Returns radiance times solid angle, by channel, over all texels of a world.
pub fn power(world: &World, light: &[Rgba]) -> [f64; 3] {
    let of = |c: usize| light.iter().zip(world.solid_angles()).map(|(l, s)| f64::from(l.0[c]) * f64::from(s)).sum();
    [of(0), of(1), of(2)]
}

/// Conversion of a world's light to a form that shows the whole world.
#[derive(Debug)]
pub struct Sky {
    world: World,
    plans: Vec<Plan>,
    /// Balance, with the factors of each plan's pixels.
    balance: Option<(LightBalance, Vec<Vec<f32>>)>,
}

impl Sky {
    /// Prepares the geometry, for any light.
    ///
    /// # Panics
    /// With the reference filter, which records no weights.
    pub fn new(from: &World, to: &Form, filter: FilterSettings) -> Self {
        let plan = |target| Resampler { world: from, target, filter }.plan(Arithmetic::Float);
        let plans = to.views.iter().map(|view| plan(view).expect("a filter whose weights can be recorded")).collect();
        Self { world: to.world(), plans, balance: None }
    }

    /// Computes the sky's geometry and balances its light ([`LightBalance`]).
    pub fn balanced(from: &World, to: &Form, filter: FilterSettings) -> Self {
        let sky = Self::new(from, to, filter);
        let targets: Vec<_> = sky.plans.iter().zip(&to.views).collect();
        let balance = LightBalance::new(from, &targets);
        let pixels = sky.plans.iter().map(|plan| balance.pixels(plan)).collect();
        Self { balance: Some((balance, pixels)), ..sky }
    }

    /// Computes the light in the new form.
    pub fn light(&self, from: &[Rgba]) -> Vec<Rgba> {
        let balanced = self.balance.as_ref().map(|(balance, _)| balance.balanced(from));
        let from = balanced.as_deref().unwrap_or(from);
        let picture = |(index, plan): (usize, &Plan)| {
            let mut picture = plan.apply(from);
            self.balance.iter().for_each(|(_, pixels)| LightBalance::complete(&pixels[index], &mut picture));
            picture.pixels().iter().map(whole).collect::<Vec<_>>()
        };
        self.plans.iter().enumerate().flat_map(picture).collect()
    }

    /// Returns the gain or loss of light, as a fraction of the whole, of the channel that changes most.
    pub fn gain(&self, from: &World, light: &[Rgba]) -> f64 {
        let (before, after) = (power(from, light), power(&self.world, &self.light(light)));
        let gains = [0, 1, 2].map(|c| after[c] / before[c] - 1.0);
        gains.into_iter().fold(0.0, |largest: f64, gain| if gain.abs() > largest.abs() { gain } else { largest })
    }
}

/// Restores a pixel that an edge cuts, and that is darker by the missing part, to its full light.
pub(crate) fn whole(pixel: &Rgba) -> Rgba {
    if pixel.alpha() > 0.0 { *pixel * pixel.alpha().recip() } else { *pixel }
}
