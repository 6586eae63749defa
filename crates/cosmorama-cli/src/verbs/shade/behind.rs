use anyhow::{Result, anyhow};
use cosmorama::raster::{Image, Rgba};
use cosmorama_scene::{Background, Surroundings, backdrop};

use super::camera::Shot;
use super::worlds::Under;
use crate::args::{BackgroundName, ShadeArgs};

/// The picture that things stand before.
pub(super) struct Behind<'a> {
    background: Background,
    /// Number of its world, and the world.
    number: usize,
    world: &'a Under,
}

impl<'a> Behind<'a> {
    /// Returns what was asked for, of the worlds that things stand under and the backdrop behind them, if there is one.
    pub(super) fn new(args: &ShadeArgs, worlds: &'a [Under]) -> Self {
        let background = match args.background {
            BackgroundName::World => Background::World,
            BackgroundName::Colour(colour) => Background::Colour(colour),
        };
        let number = if args.backdrop.is_some() { worlds.len() - 1 } else { 0 };
        Self { background, number, world: &worlds[number] }
    }

    /// Makes the picture without things. A backdrop that does not show all directions must cover it.
    pub(super) fn picture(&self, shot: &Shot, worlds: &[Surroundings]) -> Result<Image<Rgba>> {
        /// Part of a pixel that rounding forgives.
        const LEAST: f32 = 1e-3;
        let picture = |background: Background| backdrop(&shot.camera, &worlds[self.number], background);
        let made = picture(self.background);
        if !self.world.is_partial {
            return Ok(made);
        }
        let all = picture(Background::Colour(Rgba::BLACK));
        let is_empty = |(seen, all): &(&Rgba, &Rgba)| seen.alpha() < all.alpha() - LEAST;
        let count = made.pixels().iter().zip(all.pixels()).filter(is_empty).count();
        if count == 0 {
            return Ok(made);
        }
        Err(anyhow!(
            "--backdrop: {} shows nothing in {count} of the picture's pixels; fill them with --missing COLOR, as --missing black, \
             or --missing transparent",
            self.world.name
        ))
    }
}
