use std::cell::RefCell;
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, EncodedImage, FixedDecoder, FixedLight, Rgba, Samples, Transfer};
use cosmorama::render::Arithmetic;

use super::Dome;

/// A piece of work for speed measurements, which can be repeated.
pub struct Kernel {
    /// Name in tables.
    pub name: &'static str,
    /// Number of pixels that one run makes.
    pub pixels: usize,
    work: Box<dyn Fn()>,
}

impl Kernel {
    /// Runs the measured work once.
    pub fn run(&self) {
        (self.work)();
    }

    /// Returns all kernels, for a dome of so many pixels across from cube faces of half as many.
    pub fn all(size: usize) -> Vec<Self> {
        let dome = Arc::new(Dome::new(size));
        let texels: Arc<[Rgba]> = (0..dome.light.len()).map(|texel| dome.light.rgba(texel)).collect();
        let frame_texels = texels.clone();
        let plan = dome.resampler().plan(Arithmetic::Fixed).expect("a plan");
        let plan_of_floats = dome.resampler().plan(Arithmetic::Float).expect("a plan");
        vec![
            kernel(&dome, "plan of 8 bits", |dome| drop(dome.resampler().plan(Arithmetic::Fixed))),
            kernel(&dome, "plan of floats", |dome| drop(dome.resampler().plan(Arithmetic::Float))),
            kernel(&dome, "frame of 8 bits", move |dome| drop(plan.apply_fixed(&dome.light, &dome.codec))),
            kernel(&dome, "frame of floats", move |_| drop(plan_of_floats.apply(&frame_texels))),
            kernel(&dome, "still of 8 bits", |dome| drop(dome.resampler().render_fixed(&dome.light, &dome.codec))),
            kernel(&dome, "still of floats", move |dome| drop(dome.resampler().render(&texels))),
            decoder("faces of 8 bits to light", size / 2),
        ]
    }
}

fn kernel(dome: &Arc<Dome>, name: &'static str, work: impl Fn(&Dome) + 'static) -> Kernel {
    let (dome, pixels) = (dome.clone(), dome.pixels());
    Kernel { name, pixels, work: Box::new(move || work(&dome)) }
}

fn decoder(name: &'static str, face: usize) -> Kernel {
    let codes = (0..3 * face * face).map(|index| (index % 251) as u8).collect();
    let image = EncodedImage::new(face, face, Channels::Rgb, Depth::Eight, Samples::U8(codes)).expect("an image");
    let decoder = FixedDecoder::new(&Transfer::Srgb).expect("sRGB has 8 bits");
    // As in a sequence: its memory serves the next frame.
    let light = RefCell::new(FixedLight::black([[face, face]]));
    let work = move || {
        let is_taken = light.borrow_mut().views_mut().all(|view| decoder.decode(&image, view));
        assert!(is_taken, "8 bits are taken");
    };
    Kernel { name, pixels: face * face, work: Box::new(work) }
}
