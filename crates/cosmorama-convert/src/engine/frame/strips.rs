//! Pictures that are too large to be held. They are made strip by strip while they are written.

use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::raster::{EncodedImage, Threads};
use cosmorama::render::Share;
use cosmorama_io::pending::Hidden;

use super::pictures::{Engine, Layer, Making};
use crate::diagnostic::{ConvertError, Result, bail};
use crate::engine::{BalancedLight, FrameLight, FrameWords, Posed, Shares, Texels};
use crate::job::STRIP;
use crate::target::TargetView;

impl Engine<'_> {
    /// Makes a file that is a picture of one view, and writes it, but for its name.
    pub(super) fn strips(
        &self,
        (file, path): (usize, &Path),
        (frame, light): (Option<u64>, &FrameLight),
        making: &mut Making,
    ) -> Result<Hidden> {
        let sheet = &self.job.target.files[file].sheet;
        let [(index, _)] = sheet.pieces[..] else { bail!("several views cannot be made by strips") };
        let Layer { place, posed: whole, .. } = &making.layer;
        let share = making.shares.next(&whole.views[index].view);
        let at = |rows: usize| (rows as f64 / sheet.size.1 as f64).min(1.0);
        let (mut done, mut failed) = (0, None);
        let mut make = |rows: Range<usize>| {
            let share = Share { whole: &share, from: at(done), to: at(done + rows.len()) };
            done += rows.len();
            let strip = strip_of(&whole.views[index], rows);
            let shares = Shares::new(&share, std::iter::once(&strip.view));
            let made = self.strip((*place, whole, strip), (frame, light), shares);
            made.map_err(|error: ConvertError| failed = Some(error)).ok()
        };
        let origin = self.job.origin_of(frame)?.map(Arc::from);
        let words = FrameWords { place: *place, carried: light.carried(), origin };
        let written = self.writer().save_rows(words, path, (sheet.size, STRIP), &mut make);
        failed.map_or(written, Err)
    }

    /// Makes the samples of a strip.
    fn strip(
        &self,
        (place, whole, strip): (usize, &Posed, TargetView),
        light: (Option<u64>, &FrameLight),
        shares: Shares,
    ) -> Result<EncodedImage> {
        // What is told of the geometry is told of the whole.
        let posed = Posed::new(self.job, (whole.pose, vec![strip], false), &|_: f64| ControlFlow::Continue(()));
        let posed = Arc::new(posed.map_err(|_| self.stopped())?.0);
        let layer = Layer { place, posed, balanced: BalancedLight::default(), behind: None };
        let mut making = Making { layer, shares };
        if let (Texels::Fixed(worlds), Some(codec)) = (light.1.texels(), &self.codec) {
            return Ok(EncodedImage::of_codes(self.codes(0, (worlds, codec), &mut making)?));
        }
        let image = self.render_view(0, light, &mut making)?;
        Ok(self.writer().encode(image, Threads::All))
    }
}

/// Returns the part of a view that these rows show.
fn strip_of(whole: &TargetView, rows: Range<usize>) -> TargetView {
    let grid = whole.view.grid.window(whole.view.width(), rows.len(), 0.0, rows.start as f64);
    TargetView { view: View { grid, ..whole.view.clone() }, ..whole.clone() }
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::{Channels, Depth, FramePool, Samples};
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
        let codes = Samples::U8((0..128 * 64 * 3).map(|sample| (sample * 37 % 251) as u8).collect());
        let sky = EncodedImage::new(128, 64, Channels::Rgb, Depth::Eight, codes).unwrap();
        cosmorama_io::write(path("sky.png"), &sky, &WriteOptions::default()).unwrap();
        let progress = &|_: f64| ControlFlow::Continue(());
        for (sky, to, output) in [
            ("sky.exr", "fulldome:tilt=10", "dome.png"),
            ("sky.exr", "fulldome", "dome.exr"),
            ("sky.exr", "perspective:fov=70,yaw=20,pitch=30,roll=5", "view.tif"),
            ("sky.exr", "omnimax", "frame.hdr"),
            ("sky.png", "fulldome:tilt=10", "codes.png"),
            ("sky.png", "fulldome", "upright.png"),
            ("sky.png", "equirect", "panorama.jpg"),
        ] {
            let conversion = Conversion::new(path(sky), path(output)).to(to.parse().unwrap());
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
            let whole = match engine.render(frame, &light, progress).unwrap().remove(0) {
                Levels::Light(mut whole) => engine.writer().encode(whole.remove(0), Threads::All),
                Levels::Codes(mut whole) => EncodedImage::of_codes(whole.remove(0)),
                _ => panic!("{to}"),
            };
            let view = &job.target.views[0];
            let shares = || Shares::new(progress, std::iter::once(&view.view));
            let mut making = Making { layer: engine.layer(frame, progress).unwrap(), shares: shares() };
            let form = |image: &EncodedImage| (image.width(), image.channels(), image.depth(), image.alpha_mode());
            let (mut steps, mut others, of) = (0.0f32, 0, whole.samples().len());
            for rows in [0..512, 512..1024, 1024..1100] {
                let strip = (0, &*making.layer.posed, strip_of(view, rows.clone()));
                let strip = engine.strip(strip, (None, &light), shares()).unwrap();
                assert_eq!((form(&strip), strip.height()), (form(&whole), rows.len()), "{to}");
                let part = whole.cropped((0, rows.start), (whole.width(), rows.len()));
                steps = steps.max(steps_between(strip.samples(), part.samples()));
                others += other_codes(strip.samples(), part.samples());
            }
            assert!(steps <= 1.0, "{to}: {steps} steps");
            assert!(others <= of / 1000, "{to}: {others} codes of {of} are others");
            assert_eq!(matches!(light.texels(), Texels::Fixed(_)), sky == "sky.png", "{to}");
            let file = path(output);
            engine.strips((0, file.as_ref()), (None, &light), &mut making).unwrap().appear().unwrap();
            let file = cosmorama_io::probe(file).unwrap();
            let form = (file.width, file.height, file.channels, file.depth);
            assert_eq!(form, (whole.width(), whole.height(), whole.channels(), whole.depth()), "{to}");
        }
    }

    /// Checks that memory is asked for a strip alone where the format is written row by row, and for all samples where it is not.
    #[test]
    fn a_picture_by_strips_needs_the_memory_of_a_strip() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let samples = Samples::U8(vec![90; 64 * 32 * 3]);
        let sky = EncodedImage::new(64, 32, Channels::Rgb, Depth::Eight, samples).unwrap();
        cosmorama_io::write(path("sky.png"), &sky, &WriteOptions::default()).unwrap();
        for (output, depth, memory, is_enough) in [
            ("dome.png", Depth::Eight, "150M", true),
            ("dome.png", Depth::Sixteen, "300M", true),
            ("dome.png", Depth::Sixteen, "150M", false),
            ("dome.exr", Depth::Half, "300M", true),
            ("dome.tif", Depth::Sixteen, "300M", true),
            ("dome.tif", Depth::Sixteen, "150M", false),
            ("dome.hdr", Depth::Float, "300M", true),
            ("dome.jpg", Depth::Eight, "300M", false),
            ("dome.jpg", Depth::Eight, "1000M", true),
        ] {
            let conversion = Conversion::new(path("sky.png"), path(output)).to("fulldome:tilt=20".parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap()).size("16384".parse().unwrap()).threads(2);
            let depth = Some(depth);
            let checked = Conversion { depth, ..conversion }.memory(memory.parse().unwrap()).check().result;
            let told = checked.as_ref().err().map(ToString::to_string).unwrap_or_default();
            assert_eq!(checked.is_ok(), is_enough, "{output} in {memory}: {told}");
            assert_eq!(told.contains("needs about"), !is_enough, "{told}");
        }
    }

    /// Counts codes of 8 bits that differ.
    fn other_codes(strips: &Samples, whole: &Samples) -> usize {
        let (Samples::U8(a), Samples::U8(b)) = (strips, whole) else { return 0 };
        a.iter().zip(b).filter(|(a, b)| a != b).count()
    }

    /// Returns the farthest distance of two samples, in codes, in last bits of halves, or in parts of white, of 250,000.
    fn steps_between(strips: &Samples, whole: &Samples) -> f32 {
        let farthest = |steps: &mut dyn Iterator<Item = f32>| steps.fold(0.0, f32::max);
        match (strips, whole) {
            (Samples::U8(a), Samples::U8(b)) => farthest(&mut a.iter().zip(b).map(|(a, b)| f32::from(a.abs_diff(*b)))),
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
