use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use cosmorama::raster::{Channels, Depth, EncodedImage, FramePool, Image, Primaries, Rgba, Transfer};
use cosmorama_convert::{encoded_beside, packed_blocks};
use cosmorama_io::{Format, Metadata, WriteOptions, write};

use crate::args::{BackgroundName, ShadeArgs};
use crate::console::Console;
use crate::failure::usage;
use crate::verbs::check_depth;

/// Form of the picture that is written.
pub(super) struct Output {
    format: Format,
    depth: Depth,
    gain: f32,
    /// Memory that the encoder takes again for the next picture.
    pool: Arc<FramePool>,
}

/// Alpha from which a pixel counts as opaque: sums of coverages are rounded.
const OPAQUE: f32 = 0.9999;

impl Output {
    /// Checks that the format can hold what is asked for.
    pub(super) fn check(args: &ShadeArgs) -> Result<Self> {
        let path = Path::new(&args.output);
        if *args.output == *"-" {
            return Err(usage("pictures of things are files; name one, as in ball.png"));
        }
        let format = Format::from_extension(path).map_err(|error| usage(error.to_string()))?;
        if format.is_cube_map() {
            return Err(usage(format!("{} is {format}, which holds cubes; name the output .png or .exr", args.output)));
        }
        let depth = match args.depth {
            Some(name) => {
                let depth = Depth::from(name);
                check_depth(path, format, depth, format.depths())?;
                depth
            }
            None => {
                format.nearest_depth(if format.depths().contains(&Depth::Half) { Depth::Half } else { Depth::Eight })
            }
        };
        let is_clear = matches!(args.background, Some(BackgroundName::Colour(colour)) if colour.alpha() < 1.0);
        if is_clear && !format.nearest_channels(Channels::Rgba).has_alpha() {
            let message =
                format!("--background: {} is {format}, which has no alpha; name the output .png or .exr", args.output);
            return Err(usage(message));
        }
        Ok(Self { format, depth, gain: args.gain, pool: Arc::default() })
    }

    /// Returns the bytes of the samples of so many pixels, in rows of so many, with what encoders hold beside them.
    pub(super) fn bytes(&self, pixels: usize, width: usize) -> u64 {
        let pixel = (Channels::Rgba.count() * self.depth.bytes()) as u64;
        let samples = pixels as u64 * pixel;
        samples + encoded_beside(self.format, samples) + packed_blocks(self.format, samples, width as u64 * pixel)
    }

    /// Writes a picture. What the format cannot hold is told.
    pub(super) fn write(
        &self,
        path: &Path,
        mut image: Image<Rgba>,
        primaries: Primaries,
        console: &Console,
    ) -> Result<()> {
        for Rgba([red, green, blue, _]) in image.pixels_mut() {
            [red, green, blue].into_iter().for_each(|channel| *channel *= self.gain);
        }
        let is_opaque = image.pixels().iter().all(|pixel| pixel.alpha() >= OPAQUE);
        let wanted = if is_opaque { Channels::Rgb } else { Channels::Rgba };
        let channels = self.format.nearest_channels(wanted);
        if !channels.has_alpha() {
            image.lay_over(Rgba::BLACK);
        }
        self.tell_clipped((path, &image), console);
        let transfer = if self.depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
        let encoded = EncodedImage::encode(&image, channels, self.depth, &transfer);
        drop(image);
        let held = self.format.holds_primaries(&primaries).then_some(primaries);
        if held.is_none() && !primaries.is_same(&Primaries::REC709) {
            console.warning(format_args!(
                "{}: {} cannot name the light's primaries; write OpenEXR",
                path.display(),
                self.format
            ));
        }
        let metadata = Metadata { transfer: Some(transfer), primaries: held, ..Metadata::default() };
        let (unfinished, pool) = (console.unfinished.clone(), self.pool.clone());
        let options = WriteOptions { unfinished, pool, ..WriteOptions::with_metadata(metadata) };
        Ok(write(path, &encoded, &options)?)
    }

    /// Warns of samples that integers cut to white.
    fn tell_clipped(&self, (path, image): (&Path, &Image<Rgba>), console: &Console) {
        /// Part of white that rounding forgives.
        const WHITE: f32 = 1.002;
        if self.depth.is_float() {
            return;
        }
        let samples = image
            .pixels()
            .iter()
            .flat_map(|pixel| pixel.0[..3].iter().map(|channel| *channel / pixel.alpha().max(OPAQUE)));
        let count = samples.filter(|sample| *sample > WHITE).count();
        if count > 0 {
            console.warning(format_args!(
                "{}: {count} samples are brighter than white, and are cut to it; write OpenEXR, or darken with --gain",
                path.display()
            ));
        }
    }
}
