use anyhow::Result;
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
            None | Some(BackgroundName::World) => Background::World,
            Some(BackgroundName::Colour(colour)) => Background::Colour(colour),
        };
        let number = worlds.iter().position(|world| world.behind.is_some()).unwrap_or(0);
        Self { background, number, world: &worlds[number] }
    }

    /// Makes the picture without things. A backdrop that does not show all directions must cover it.
    pub(super) fn picture(&self, shot: &Shot, worlds: &[Surroundings]) -> Result<Image<Rgba>> {
        /// Part of a pixel that rounding forgives.
        const LEAST: f32 = 1e-3;
        let picture = |background: Background| backdrop(&shot.camera, &worlds[self.number], background);
        let made = picture(self.background);
        let Some(behind) = self.world.behind.as_ref().filter(|behind| behind.is_partial) else { return Ok(made) };
        let all = picture(Background::Colour(Rgba::BLACK));
        let is_empty = |(seen, all): &(&Rgba, &Rgba)| seen.alpha() < all.alpha() - LEAST;
        let count = made.pixels().iter().zip(all.pixels()).filter(is_empty).count();
        if count == 0 {
            return Ok(made);
        }
        Err(behind.whence.failure(&format!(
            "{} shows nothing in {count} of the picture's pixels; fill them with --missing COLOR, as --missing black, \
             or --missing transparent",
            self.world.name
        )))
    }
}
