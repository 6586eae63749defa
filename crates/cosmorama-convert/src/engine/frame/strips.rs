//! Pictures that are too large to be held. They are made strip by strip while they are written.

use std::ops::{ControlFlow, Range};
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama::motion::Moment;
use cosmorama::raster::{EncodedImage, Image, Pixel, Threads};
use cosmorama::render::{Progress, Share, Stopped};
use cosmorama_io::pending::Hidden;

use super::blur::FramePart;
use super::pictures::{Engine, Layer, Making};
use crate::diagnostic::{ConvertError, Diagnostic, Result, failure};
use crate::engine::geometry::partly_anew;
use crate::engine::{BalancedLight, FrameLight, FrameWords, Geometry, Levels, Posed, Shares};
use crate::job::{ConvertJob, FrameOutputs, STRIP, with_reserve};
use crate::target::{Strip, TargetFile};

/// Geometry of the strips of a job's pictures, which all its frames share: as much of it as fits into memory. Empty where strips are
/// made once, and where the camera moves.
#[derive(Default)]
pub(crate) struct KeptStrips {
    /// Rows and geometry of the strips of each file, from above.
    files: Vec<Vec<(Range<usize>, Arc<Geometry>)>>,
}

impl KeptStrips {
    /// Compiles the geometry of strips that are made again. Also returns the warnings about it.
    pub(super) fn new(job: &ConvertJob, progress: &dyn Progress) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        if job.is_by_strips() && job.movement.is_none() && job.outputs.are_many() {
            Self::compile(job, progress)
        } else {
            Ok((Self::default(), Vec::new()))
        }
    }

    fn compile(job: &ConvertJob, progress: &dyn Progress) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let (mut kept, mut told) = (Self::default(), Vec::new());
        let pixels: usize = job.target.files.iter().map(|file| area(file.sheet.size)).sum();
        let (mut bytes, mut done) = (0, 0);
        for (file, TargetFile { sheet, .. }) in job.target.files.iter().enumerate() {
            let mut strips = Vec::new();
            for top in (0..sheet.size.1).step_by(STRIP) {
                let rows = with_margin(top..sheet.size.1.min(top + STRIP), sheet.size.1, job.strips_have_margins());
                let strip = Strip::of(&job.target, file, rows);
                // Margins are made twice.
                let at = |done: usize| (done as f64 / pixels as f64).min(1.0);
                let share = Share { whole: progress, from: at(done), to: at(done + area(strip.sheet.size)) };
                done += area(strip.sheet.size);
                let views = strip.views(&job.target.views);
                let (geometry, warnings) = Geometry::compile(job, (&views, true), bytes, &share)?;
                bytes += with_reserve(geometry.bytes());
                strips.push((strip.rows, Arc::new(geometry)));
                told.extend(warnings.into_iter().filter(|warning| !told.contains(warning)).collect::<Vec<_>>());
            }
            kept.files.push(strips);
        }
        if !told.is_empty() && kept.kept() > 0 {
            let all = kept.files.iter().map(Vec::len).sum();
            told = vec![partly_anew(kept.kept(), all)];
        }
        Ok((kept, told))
    }

    /// Returns the geometry of a strip, if it is kept.
    fn of(&self, strip: &Strip) -> Option<Arc<Geometry>> {
        let kept = self.files.get(strip.file)?.iter().find(|(rows, _)| *rows == strip.rows)?;
        Some(Arc::clone(&kept.1))
    }

    fn all(&self) -> impl Iterator<Item = &Geometry> {
        self.files.iter().flatten().map(|(_, geometry)| &**geometry)
    }

    /// Returns the number of plans that are kept.
    pub(super) fn kept(&self) -> usize {
        self.all().map(Geometry::kept).sum()
    }

    /// Returns the bytes that it holds, with what the allocator keeps beside them.
    pub(super) fn bytes(&self) -> u64 {
        self.all().map(|geometry| with_reserve(geometry.bytes())).sum()
    }
}

/// A frame whose files are made strip by strip.
#[derive(Clone, Copy)]
struct Whole<'a> {
    frame: &'a FrameOutputs,
    light: &'a FrameLight,
    layer: &'a Layer,
    /// Moments of its exposure.
    moments: Option<&'a [Moment]>,
    progress: &'a dyn Progress,
}

impl Engine<'_> {
    /// Makes the files of a frame and writes them, but for their names.
    pub(super) fn strips(
        &self,
        frame: &FrameOutputs,
        light: &FrameLight,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let (layer, moments) = (self.layer(frame, progress)?, self.blur_of(frame)?);
        let pixels_of = |(file, _): &(usize, PathBuf)| area(self.job.target.files[*file].sheet.size);
        let pixels: usize = frame.files.iter().map(pixels_of).sum();
        let mut done = 0;
        let written = |file: &(usize, PathBuf)| {
            let at = |done: usize| done as f64 / pixels as f64;
            let share = Share { whole: progress, from: at(done), to: at(done + pixels_of(file)) };
            done += pixels_of(file);
            let whole = Whole { frame, light, layer: &layer, moments: moments.as_deref(), progress: &share };
            Ok(Levels::Written(self.file_by_strips(&whole, file)?))
        };
        frame.files.iter().map(written).collect()
    }

    fn file_by_strips(&self, whole: &Whole, (file, path): &(usize, PathBuf)) -> Result<Hidden> {
        let size = self.job.target.files[*file].sheet.size;
        let at = |rows: usize| (rows as f64 / size.1 as f64).min(1.0);
        let (mut done, mut failed) = (0, None);
        let mut make = |rows: Range<usize>| {
            let share = Share { whole: whole.progress, from: at(done), to: at(done + rows.len()) };
            done += rows.len();
            let made = self.rows(&Whole { progress: &share, ..*whole }, *file, rows);
            made.map_err(|error: ConvertError| failed = Some(error)).ok()
        };
        let origin = self.job.origin_of(whole.frame.frame)?.map(Arc::from);
        let words = FrameWords { place: whole.layer.place, carried: whole.light.carried(), origin };
        let written = self.writer().save_rows(words, path, (size, STRIP), &mut make);
        failed.map_or(written, Err)
    }

    /// Makes the samples of rows of a file. Where some lack texels, or a view, neighbours decide what becomes of them; so a margin is made,
    /// too.
    fn rows(&self, whole: &Whole, file: usize, rows: Range<usize>) -> Result<EncodedImage> {
        let (_, height) = self.job.target.files[file].sheet.size;
        let has_margin = self.job.strips_have_margins() || !self.is_complete(whole.light);
        let made = with_margin(rows.clone(), height, has_margin);
        let strip = Strip::of(&self.job.target, file, made.clone());
        let wanted = rows.start - made.start..rows.end - made.start;
        let encoded = match self.strip(whole, &strip)? {
            Some(Levels::Light(mut made)) => {
                made.pop().map(|image| self.writer().encode(self.rows_of(image, wanted), Threads::All))
            }
            Some(Levels::Codes(mut made)) => {
                made.pop().map(|image| EncodedImage::of_codes(self.rows_of(image, wanted)))
            }
            Some(Levels::Written(_) | Levels::Layered { .. }) | None => None,
        };
        encoded.ok_or_else(|| failure!("a strip has no picture"))
    }

    /// Makes the light, or the codes, of a strip.
    fn strip(&self, whole: &Whole, strip: &Strip) -> Result<Option<Levels>> {
        let &Whole { frame, light, moments, progress, .. } = whole;
        match moments {
            Some(moments) => {
                let part = FramePart { frame, strip: Some(strip) };
                Ok(self.render_blurred(part, (light, moments), progress)?.pop())
            }
            None => {
                let layer = self.layer_of_strip(whole.layer, strip)?;
                let views = strip.views(&self.job.target.views);
                let all = views.iter().map(|target| &target.view).cycle().take(views.len() * self.layers());
                let making = &mut Making { layer, shares: Shares::new(progress, all) };
                Ok(Some(self.render_sheets(&[&strip.sheet], (frame.frame, light), making)?))
            }
        }
    }

    /// Returns rows of an image, whose memory goes back to the pool.
    fn rows_of<P: Pixel>(&self, image: Image<P>, rows: Range<usize>) -> Image<P> {
        if rows.len() == image.height() {
            return image;
        }
        let width = image.width();
        let mut part = self.pool.take_image(width, rows.len());
        part.pixels_mut().copy_from_slice(&image.pixels()[rows.start * width..rows.end * width]);
        self.pool.give_image(image);
        part
    }

    /// Returns the geometry of a strip, and of what lies behind it, in the pose of the whole.
    pub(super) fn layer_of_strip(&self, whole: &Layer, strip: &Strip) -> Result<Layer> {
        let (pose, views) = (whole.posed.pose, strip.views(&whole.posed.views));
        let posed = match self.strips.of(strip) {
            Some(geometry) => Posed::of((pose, views), geometry),
            // What is told of the geometry is told of the whole.
            None => {
                let posed = Posed::new(self.job, (pose, views, false), &|_: f64| ControlFlow::Continue(()));
                posed.map_err(|Stopped| self.stopped())?.0
            }
        };
        let behind = self.behind.as_ref().zip(whole.behind.as_ref());
        let behind = behind.map(|(behind, whole)| behind.engine.layer_of_strip(whole, strip).map(Box::new));
        let (posed, behind) = (Arc::new(posed), behind.transpose()?);
        Ok(Layer { place: whole.place, posed, balanced: BalancedLight::default(), behind })
    }
}

/// Returns rows with those beside them on which they depend: pixels around one that is filled, and those around these, which tell where
/// the world ends.
fn with_margin(rows: Range<usize>, height: usize, is_needed: bool) -> Range<usize> {
    let margin = if is_needed { 3 } else { 0 };
    rows.start.saturating_sub(margin)..height.min(rows.end + margin)
}

fn area((width, height): (usize, usize)) -> usize {
    width * height
}

#[cfg(test)]
mod tests {
    use cosmorama::motion::{Easing, Ramp, Shutter};
    use cosmorama::raster::{Channels, Depth, FramePool, Samples};
    use cosmorama_io::{FrameList, Limits, WriteOptions};

    use super::*;
    use crate::engine::{FrameFile, Spent, Stages, Texels, ViewImage, Which, WriterOptions};
    use crate::settings::{Backdrop, BlurMethod, CameraMovement, Conversion, Existing, MotionBlur};

    /// Compares pictures of three strips, whose last is not whole, with those that are made at once.
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
        for (sky, to, size, output) in [
            ("sky.exr", "fulldome:tilt=10", "64x1100", "dome.png"),
            ("sky.exr", "fulldome", "64x1100", "dome.exr"),
            ("sky.exr", "perspective:fov=70,yaw=20,pitch=30,roll=5", "64x1100", "view.tif"),
            ("sky.exr", "omnimax", "64x1100", "frame.hdr"),
            ("sky.exr", "cube", "100", "face_{face}.png"),
            ("sky.png", "cube:layout=cross-v", "150", "cross.png"),
            ("sky.png", "fulldome:tilt=10", "64x1100", "codes.png"),
            ("sky.png", "fulldome", "64x1100", "upright.png"),
            ("sky.png", "equirect", "64x1100", "panorama.jpg"),
            ("sky.png", "equirect:stereo=tb,yaw=30,pitch=20", "64x1100", "eyes.tga"),
        ] {
            let conversion = Conversion::new(path(sky), path(output)).to(to.parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap());
            let conversion = conversion.size(size.parse().unwrap()).existing(Existing::Replace);
            let checked = conversion.check().result.unwrap_or_else(|error| panic!("{to}: {error}"));
            let job = &checked.job;
            let engine = || Engine::new(job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
            let (engine, mut keeping) = (engine(), engine());
            let (kept, told) = KeptStrips::compile(job, progress).unwrap_or_else(|_| panic!("stopped"));
            assert!(told.is_empty() && kept.bytes() > 0, "{to}: {told:?}");
            keeping.strips = kept;
            let frame = &job.outputs.frames[0];
            let light = light_of((&checked.job, &checked.stages), &engine, frame);
            assert_eq!(matches!(light.texels(), Texels::Fixed(_)), sky == "sky.png", "{to}");
            let layer = engine.layer(frame, progress).unwrap();
            let whole = Whole { frame, light: &light, layer: &layer, moments: None, progress };
            let form = |image: &EncodedImage| (image.width(), image.channels(), image.depth(), image.alpha_mode());
            for (file, picture) in engine.render(frame, &light, progress).unwrap().into_iter().enumerate() {
                let picture = match picture {
                    Levels::Light(mut picture) => engine.writer().encode(picture.remove(0), Threads::All),
                    Levels::Codes(mut picture) => EncodedImage::of_codes(picture.remove(0)),
                    _ => panic!("{to}"),
                };
                let (mut steps, mut others, of) = (0.0f32, 0, picture.samples().len());
                for top in (0..picture.height()).step_by(STRIP) {
                    let rows = top..picture.height().min(top + STRIP);
                    let (made, again) =
                        [&engine, &keeping].map(|engine| engine.rows(&whole, file, rows.clone()).unwrap()).into();
                    assert!(made.samples() == again.samples(), "{to}: with and without kept geometry");
                    assert_eq!((form(&made), made.height()), (form(&picture), rows.len()), "{to}");
                    let part = picture.cropped((0, rows.start), (picture.width(), rows.len()));
                    steps = steps.max(steps_between(made.samples(), part.samples()));
                    others += other_codes(made.samples(), part.samples());
                }
                assert!(steps <= 1.0, "{to}: {steps} steps");
                assert!(others <= of / 1000, "{to}: {others} codes of {of} are others");
                engine.file_by_strips(&whole, &frame.files[file]).unwrap().appear().unwrap();
                let read = cosmorama_io::read(&frame.files[file].1, &Limits::default()).unwrap().image;
                assert_eq!(form(&read).0, form(&picture).0, "{to}");
                assert_eq!((read.height(), read.depth()), (picture.height(), picture.depth()), "{to}");
                if !output.ends_with(".jpg") && !output.ends_with(".hdr") {
                    assert!(steps_between(read.samples(), picture.samples()) <= 1.0, "{to}");
                }
            }
        }
    }

    /// Compares strips of a frame whose camera moves, with and without blur, and with a world behind it, with its picture.
    #[test]
    fn strips_are_the_picture_that_a_moving_camera_takes() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let smooth = |sample: usize| ((sample % 480) as f32 / 240.0 - 1.0).abs();
        let samples = Samples::Float((0..128 * 64 * 3).map(smooth).collect());
        let sky = EncodedImage::new(128, 64, Channels::Rgb, Depth::Float, samples).unwrap();
        cosmorama_io::write(path("sky.exr"), &sky, &WriteOptions::default()).unwrap();
        let samples = Samples::Float((0..64 * 64 * 4).map(smooth).collect());
        let front = EncodedImage::new(64, 64, Channels::Rgba, Depth::Float, samples).unwrap();
        cosmorama_io::write(path("front.exr"), &front, &WriteOptions::default()).unwrap();
        let progress = &|_: f64| ControlFlow::Continue(());
        let blurs = [None, Some(BlurMethod::Swept), Some(BlurMethod::Ellipse)];
        for (blur, has_backdrop) in blurs.into_iter().flat_map(|blur| [(blur, false), (blur, true)]) {
            let angles = [(0.0, 12.0), (5.0, 9.0), (0.0, 6.0)].map(|(from, to)| Ramp { from, to });
            let turn = CameraMovement::Turn { angles, fov: None, easing: Easing::default() };
            let input =
                if has_backdrop { ("front.exr", "perspective:fov=80,pitch=20") } else { ("sky.exr", "equirect") };
            let conversion = Conversion::new(path(input.0), path("view_#.exr")).from(input.1.parse().unwrap());
            let conversion = conversion.to("fulldome:tilt=30".parse().unwrap()).size("70x530".parse().unwrap());
            let mut conversion = conversion.moved(turn).frames(FrameList::new(vec![1, 2, 3]));
            conversion.depth = Some(Depth::Float);
            let shutter = Shutter::centred(0.8);
            conversion.geometry.blur = blur.map(|method| MotionBlur { shutter, method });
            if has_backdrop {
                let behind = Backdrop { from: Some("equirect".parse().unwrap()), ..Backdrop::new(path("sky.exr")) };
                conversion = conversion.over(behind);
            }
            let checked = conversion.check().result.unwrap();
            let job = &checked.job;
            let engine = Engine::new(job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
            let frame = &job.outputs.frames[1];
            let light = light_of((&checked.job, &checked.stages), &engine, frame);
            let moments = engine.blur_of(frame).unwrap();
            assert_eq!(moments.is_some(), blur.is_some());
            let Some(Levels::Light(mut picture)) = engine.render(frame, &light, progress).unwrap().pop() else {
                panic!("no light")
            };
            let picture = engine.writer().encode(picture.remove(0), Threads::All);
            let layer = engine.layer(frame, progress).unwrap();
            let whole = Whole { frame, light: &light, layer: &layer, moments: moments.as_deref(), progress };
            for top in (0..picture.height()).step_by(STRIP) {
                let rows = top..picture.height().min(top + STRIP);
                let made = engine.rows(&whole, 0, rows.clone()).unwrap();
                let part = picture.cropped((0, rows.start), (picture.width(), rows.len()));
                let (Samples::Float(made), Samples::Float(part)) = (made.samples(), part.samples()) else {
                    panic!("no floats")
                };
                let farthest = made.iter().zip(part).map(|(made, part)| (made - part).abs()).fold(0.0, f32::max);
                let most = if blur == Some(BlurMethod::Swept) { 1e-3 } else { 4e-6 };
                assert!(farthest <= most, "{blur:?}, backdrop {has_backdrop}, row {top}: {farthest}");
            }
            let Samples::Float(samples) = picture.samples() else { panic!("no floats") };
            assert!(samples.iter().any(|sample| *sample > 0.5), "{blur:?}, backdrop {has_backdrop}");
        }
    }

    /// Compares strips whose border is an edge of what the input shows, or lies among missing texels, with their picture.
    #[test]
    fn strips_know_what_lies_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        // Two rows around the equator are missing, and a third far from it.
        let texel = |at: usize| if [31, 32, 50].contains(&(at / (128 * 3))) { f32::NAN } else { (at % 7) as f32 / 7.0 };
        let samples = Samples::Float((0..128 * 64 * 3).map(texel).collect());
        let holes = EncodedImage::new(128, 64, Channels::Rgb, Depth::Float, samples).unwrap();
        cosmorama_io::write(path("holes.exr"), &holes, &WriteOptions::default()).unwrap();
        let half = holes.cropped((0, 0), (128, 30));
        cosmorama_io::write(path("half.exr"), &half, &WriteOptions::default()).unwrap();
        let progress = &|_: f64| ControlFlow::Continue(());
        for (input, from) in [("holes.exr", "equirect"), ("half.exr", "cylinder:hfov=360,vfov=20,pitch=10.05")] {
            let conversion = Conversion::new(path(input), path("picture.exr")).from(from.parse().unwrap());
            let conversion = conversion.to("equirect".parse().unwrap()).size("64x1024".parse().unwrap());
            let conversion = conversion.missing("red".parse().unwrap()).existing(Existing::Replace);
            let checked = conversion.check().result.unwrap();
            let engine =
                Engine::new(&checked.job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
            let frame = &checked.job.outputs.frames[0];
            let light = light_of((&checked.job, &checked.stages), &engine, frame);
            let Some(Levels::Light(mut picture)) = engine.render(frame, &light, progress).unwrap().pop() else {
                panic!("no light")
            };
            let picture = engine.writer().encode(picture.remove(0), Threads::All);
            let layer = engine.layer(frame, progress).unwrap();
            let whole = Whole { frame, light: &light, layer: &layer, moments: None, progress };
            for rows in [0..512, 512..1024] {
                let made = engine.rows(&whole, 0, rows.clone()).unwrap();
                let part = picture.cropped((0, rows.start), (64, rows.len()));
                let steps = steps_between(made.samples(), part.samples());
                assert!(steps <= 1.0, "{input}, rows {rows:?}: {steps} steps");
            }
        }
    }

    /// Reads the light of a frame.
    fn light_of((job, stages): (&ConvertJob, &Stages), engine: &Engine, frame: &FrameOutputs) -> FrameLight {
        let pool = FramePool::default();
        let files = FrameFile::all(job, frame.frame, Which::All).into_iter();
        let mut images: Vec<ViewImage> = files.flat_map(|file| file.read(job, &pool).unwrap()).collect();
        let mut light = engine.frame_light();
        light.fill(job, frame.frame, (&mut images, Spent::Freed), (stages, &pool)).unwrap();
        light
    }

    /// Checks that memory is asked for a strip alone, of a picture and of each frame of a sequence, but for what a job holds whole.
    #[test]
    fn pictures_by_strips_need_the_memory_of_a_strip() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let samples = Samples::U8(vec![90; 64 * 32 * 3]);
        let sky = EncodedImage::new(64, 32, Channels::Rgb, Depth::Eight, samples).unwrap();
        for name in ["sky.png", "sky_1.png", "sky_2.png"] {
            cosmorama_io::write(path(name), &sky, &WriteOptions::default()).unwrap();
        }
        let front =
            EncodedImage::new(64, 32, Channels::Rgba, Depth::Eight, Samples::U8(vec![90; 64 * 32 * 4])).unwrap();
        cosmorama_io::write(path("front.png"), &front, &WriteOptions::default()).unwrap();
        for (input, to, output, depth, memory, is_enough) in [
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Eight, "150M", true),
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Sixteen, "300M", true),
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Sixteen, "150M", false),
            ("sky.png", "fulldome:tilt=20", "dome.exr", Depth::Half, "350M", true),
            ("sky.png", "fulldome:tilt=20", "dome.tif", Depth::Sixteen, "300M", true),
            ("sky.png", "fulldome:tilt=20", "dome.tif", Depth::Sixteen, "150M", false),
            ("sky.png", "fulldome:tilt=20", "dome.hdr", Depth::Float, "400M", true),
            ("sky.png", "fulldome:tilt=20", "dome.jpg", Depth::Eight, "150M", true),
            ("sky.png", "fulldome:tilt=20", "dome.tga", Depth::Eight, "150M", true),
            ("sky.png", "cube", "face_{face}.png", Depth::Sixteen, "350M", true),
            ("sky.png", "equirect:stereo=tb", "eyes.png", Depth::Sixteen, "500M", true),
            // A texture is written as a whole.
            ("sky.png", "cube", "sky.dds", Depth::Eight, "1G", false),
            ("sky_#.png", "fulldome:tilt=20", "dome_#.png", Depth::Sixteen, "350M", true),
            ("sky_#.png", "fulldome:tilt=20", "dome_#.png", Depth::Sixteen, "150M", false),
            ("sky_#.png", "fulldome:tilt=20", "dome_#.jpg", Depth::Eight, "150M", true),
            ("sky_#.png", "cube", "face_#_{face}.png", Depth::Eight, "150M", true),
            ("front.png", "fulldome:tilt=20", "before.png", Depth::Eight, "900M", true),
            ("front.png", "fulldome:tilt=20", "before.png", Depth::Eight, "300M", false),
        ] {
            let conversion = Conversion::new(path(input), path(output)).to(to.parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap()).size("16384".parse().unwrap()).threads(2);
            let behind = Backdrop { from: Some("equirect".parse().unwrap()), ..Backdrop::new(path("sky.png")) };
            let (depth, backdrop) = (Some(depth), (input == "front.png").then_some(behind));
            let checked = Conversion { depth, backdrop, ..conversion }.memory(memory.parse().unwrap()).check().result;
            let told = checked.as_ref().err().map(ToString::to_string).unwrap_or_default();
            assert_eq!(checked.is_ok(), is_enough, "{input} → {output} in {memory}: {told}");
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
