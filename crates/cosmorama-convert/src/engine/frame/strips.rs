//! Pictures that are too large to be held as light. They are made and encoded strip by strip, and only their samples are held.

use std::ops::ControlFlow;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples, Threads};

use super::pictures::{Engine, Layer, Making};
use crate::diagnostic::{Result, bail, failure};
use crate::engine::{BalancedLight, FrameLight, Posed, Shares};
use crate::job::STRIP;
use crate::target::TargetView;

impl Engine<'_> {
    /// Renders the samples of a file that is a picture of one view.
    pub(super) fn strips(
        &self,
        file: usize,
        (frame, light): (Option<u64>, &FrameLight),
        making: &mut Making,
    ) -> Result<EncodedImage> {
        let sheet = &self.job.target.files[file].sheet;
        let (width, height) = sheet.size;
        let [(index, _)] = sheet.pieces[..] else { bail!("several views cannot be made by strips") };
        let Layer { place, posed: whole, .. } = &making.layer;
        let share = making.shares.next(&whole.views[index].view);
        let strips: Vec<TargetView> = strips_of(&whole.views[index]).collect();
        let mut shares = Shares::new(&share, strips.iter().map(|strip| &strip.view));
        let mut made: Option<Strips> = None;
        for strip in strips {
            // What is told of the geometry is told of the whole.
            let posed = Posed::new(self.job, (whole.pose, vec![strip], false), &|_: f64| ControlFlow::Continue(()));
            let posed = Arc::new(posed.map_err(|_| self.stopped())?.0);
            let layer = Layer { place: *place, posed, balanced: BalancedLight::default(), behind: None };
            let mut of_strip = Making { layer, shares };
            let image = self.render_view(0, (frame, light), &mut of_strip)?;
            shares = of_strip.shares;
            let encoded = self.writer().encode(image, Threads::All);
            let (channels, depth, alpha_mode) = (encoded.channels(), encoded.depth(), encoded.alpha_mode());
            let samples = encoded.into_samples();
            match &mut made {
                None => made = Some(Strips { channels, depth, alpha_mode, samples }),
                Some(strips) => append(&mut strips.samples, samples, width * height * channels.count()),
            }
        }
        let Some(Strips { channels, depth, alpha_mode, samples }) = made else { bail!("a picture without rows") };
        let picture =
            EncodedImage::new(width, height, channels, depth, samples).map_err(|error| failure!("{error}"))?;
        Ok(picture.with_alpha_mode(alpha_mode))
    }
}

/// Strips of a picture so far.
struct Strips {
    channels: Channels,
    depth: Depth,
    alpha_mode: AlphaMode,
    samples: Samples,
}

/// Visits the strips of a view, from above.
fn strips_of(whole: &TargetView) -> impl Iterator<Item = TargetView> {
    let (width, height) = (whole.view.width(), whole.view.height());
    (0..height).step_by(STRIP).map(move |top| {
        let grid = whole.view.grid.window(width, STRIP.min(height - top), 0.0, top as f64);
        TargetView { view: View { grid, ..whole.view.clone() }, ..whole.clone() }
    })
}

/// Appends samples of a strip, which are of one kind with those above it, to what is to be so many.
fn append(above: &mut Samples, below: Samples, all: usize) {
    fn put<S: Copy>(above: &mut Vec<S>, below: &[S], all: usize) {
        // Once: memory is then neither copied nor taken in excess.
        above.reserve_exact(all - above.len());
        above.extend_from_slice(below);
    }
    match (above, &below) {
        (Samples::U8(above), Samples::U8(below)) => put(above, below, all),
        (Samples::U16(above), Samples::U16(below)) => put(above, below, all),
        (Samples::Half(above), Samples::Half(below)) => put(above, below, all),
        (Samples::Float(above), Samples::Float(below)) => put(above, below, all),
        _ => unreachable!("one encoder makes one kind of samples"),
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::FramePool;
    use cosmorama_io::WriteOptions;

    use super::*;
    use crate::engine::{FrameFile, Levels, Spent, ViewImage, Which, WriterOptions};
    use crate::settings::{Conversion, Existing};

    /// Compares a picture of three strips, whose last is not whole, with the picture that is made at once.
    #[test]
    fn strips_are_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let wave = |sample: usize| (sample * 37 % 251) as f32 / 251.0;
        let samples = Samples::Float((0..128 * 64 * 3).map(wave).collect());
        let sky = EncodedImage::new(128, 64, Channels::Rgb, Depth::Float, samples).unwrap();
        cosmorama_io::write(path("sky.exr"), &sky, &WriteOptions::default()).unwrap();
        let progress = &|_: f64| ControlFlow::Continue(());
        for (to, output) in [
            ("fulldome:tilt=10", "dome.png"),
            ("fulldome", "dome.exr"),
            ("perspective:fov=70,yaw=20,pitch=30,roll=5", "view.tif"),
            ("omnimax", "frame.hdr"),
        ] {
            let conversion = Conversion::new(path("sky.exr"), path(output)).to(to.parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap());
            let conversion = conversion.size("300x1100".parse().unwrap()).existing(Existing::Replace);
            let checked = conversion.check().result.unwrap();
            let (job, stages, pool) = (&checked.job, &checked.stages, FramePool::default());
            let engine = Engine::new(job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
            let files = FrameFile::all(job, None, Which::All).into_iter();
            let mut images: Vec<ViewImage> = files.flat_map(|file| file.read(job, &pool).unwrap()).collect();
            let mut light = engine.frame_light();
            light.fill(job, None, (&mut images, Spent::Freed), (stages, &pool)).unwrap();
            let frame = &job.outputs.frames[0];
            let Levels::Light(whole) = engine.render(frame, &light, progress).unwrap().remove(0) else {
                panic!("{to}")
            };
            let whole = engine.writer().encode(whole.into_iter().next().unwrap(), Threads::All);
            let view = &job.target.views[0].view;
            let shares = Shares::new(progress, std::iter::once(view));
            let mut making = Making { layer: engine.layer(frame, progress).unwrap(), shares };
            let strips = engine.strips(0, (None, &light), &mut making).unwrap();
            assert_eq!(strips_of(&job.target.views[0]).count(), 3, "{to}");
            let form = |image: &EncodedImage| {
                (image.width(), image.height(), image.channels(), image.depth(), image.alpha_mode())
            };
            assert_eq!(form(&strips), form(&whole), "{to}");
            let steps = steps_between(strips.samples(), whole.samples());
            assert!(steps <= 1.0, "{to}: {steps} steps");
        }
    }

    /// Returns the farthest distance of two samples, in codes, in last bits of halves, or in parts of white, of 250,000.
    fn steps_between(strips: &Samples, whole: &Samples) -> f32 {
        let farthest = |steps: &mut dyn Iterator<Item = f32>| steps.fold(0.0, f32::max);
        match (strips, whole) {
            (Samples::U16(a), Samples::U16(b)) => {
                farthest(&mut a.iter().zip(b).map(|(a, b)| f32::from(a.abs_diff(*b))))
            }
            (Samples::Half(a), Samples::Half(b)) => {
                farthest(&mut a.iter().zip(b).map(|(a, b)| f32::from(a.to_bits().abs_diff(b.to_bits()))))
            }
            (Samples::Float(a), Samples::Float(b)) => {
                farthest(&mut a.iter().zip(b).map(|(a, b)| (a - b).abs() * 2.5e5))
            }
            other => panic!("{other:?}"),
        }
    }
}
