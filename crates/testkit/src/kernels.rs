use std::cell::RefCell;
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, EncodedImage, FixedCodec, FixedDecoder, FixedLight, Rgba, Samples, Transfer};
use cosmorama::resample::{Filter, Resampler};
use cosmorama::sphere::CubeFace;
use cosmorama::world::{View, World};

use super::{cube, fisheye, turned};

/// A piece of work whose speed counts, ready to be done any number of times.
pub struct Kernel {
    /// What it is called.
    pub name: &'static str,
    /// Pixels that it makes each time.
    pub pixels: usize,
    work: Box<dyn Fn()>,
}

impl Kernel {
    /// Does it once.
    pub fn run(&self) {
        (self.work)();
    }

    /// All of them, for a dome of so many pixels across from cube faces of half as many.
    pub fn all(size: usize) -> Vec<Self> {
        let dome = Arc::new(Dome::new(size));
        vec![
            dome.kernel("plan of 8 bits", |dome| drop(dome.resampler().fixed_plan())),
            dome.kernel("plan of floats", |dome| drop(dome.resampler().plan())),
            dome.planned("frame of 8 bits"),
            dome.planned_in_floats("frame of floats"),
            dome.kernel("still of 8 bits", |dome| drop(dome.resampler().render_fixed(&dome.light, &dome.codec))),
            dome.kernel("still of floats", |dome| drop(dome.resampler().render(&dome.texels))),
            decoder("faces of 8 bits to light", size / 2),
        ]
    }
}

/// The conversion that all but one of the kernels do.
struct Dome {
    world: World,
    target: View,
    light: FixedLight,
    texels: Vec<Rgba>,
    codec: FixedCodec,
}

impl Dome {
    fn new(size: usize) -> Self {
        let world = cube(&CubeFace::ALL, size / 2, size / 2);
        let target = View { orientation: turned([0.0, 90.0, 0.0]), ..fisheye(size, 180.0) };
        let mut light = FixedLight::black(world.texel_count());
        for (index, texel) in light.texels_mut().iter_mut().enumerate() {
            // Any light will do that is not all the same.
            *texel = [index % 32_749, index / 7 % 32_749, index * 5 % 32_749, 0].map(|sample| sample as i16);
        }
        let texels = (0..light.len()).map(|texel| light.rgba(texel)).collect();
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        Self { world, target, light, texels, codec }
    }

    fn resampler(&self) -> Resampler<'_> {
        Resampler { world: &self.world, target: &self.target, filter: Filter::DEFAULT }
    }

    fn kernel(self: &Arc<Self>, name: &'static str, work: impl Fn(&Self) + 'static) -> Kernel {
        let dome = self.clone();
        Kernel { name, pixels: self.target.width() * self.target.height(), work: Box::new(move || work(&dome)) }
    }

    fn planned(self: &Arc<Self>, name: &'static str) -> Kernel {
        let plan = self.resampler().fixed_plan().expect("a plan");
        self.kernel(name, move |dome| drop(plan.apply(&dome.light, &dome.codec)))
    }

    fn planned_in_floats(self: &Arc<Self>, name: &'static str) -> Kernel {
        let plan = self.resampler().plan().expect("a plan");
        self.kernel(name, move |dome| drop(plan.apply(&dome.texels)))
    }
}

fn decoder(name: &'static str, face: usize) -> Kernel {
    let codes = (0..3 * face * face).map(|index| (index % 251) as u8).collect();
    let image = EncodedImage::new(face, face, Channels::Rgb, Depth::Eight, Samples::U8(codes)).expect("an image");
    let decoder = FixedDecoder::new(&Transfer::Srgb).expect("sRGB has 8 bits");
    // As in a sequence: its memory serves the next frame.
    let light = RefCell::new(FixedLight::black(face * face));
    let work = move || assert!(decoder.decode(&image, light.borrow_mut().texels_mut()), "8 bits are taken");
    Kernel { name, pixels: face * face, work: Box::new(work) }
}
