//! Pictures that are too large to be held. They are made strip by strip while they are written.

use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::motion::Pose;
use cosmorama::raster::{EncodedImage, Threads};
use cosmorama::render::{Progress, Share, Stopped};
use cosmorama_io::pending::Hidden;

use super::pictures::{Engine, Layer, Making};
use crate::diagnostic::{ConvertError, Diagnostic, Result, bail, failure};
use crate::engine::{BalancedLight, FrameLight, FrameWords, Geometry, Levels, Posed, Shares};
use crate::job::{ConvertJob, STRIP};
use crate::target::{Sheet, TargetFile, TargetView};

/// Geometry of the strips of a job's pictures, which all its frames share: as much of it as fits into memory. Empty where strips are
/// made once, and where the camera moves.
#[derive(Default)]
pub(crate) struct KeptStrips {
    /// Of each file, from above.
    files: Vec<Vec<Arc<Geometry>>>,
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
        for TargetFile { sheet, .. } in &job.target.files {
            let mut strips = Vec::new();
            for top in (0..sheet.size.1).step_by(STRIP) {
                let strip = Strip::of((&job.target.views, sheet), top..sheet.size.1.min(top + STRIP));
                let at = |done: usize| done as f64 / pixels as f64;
                let share = Share { whole: progress, from: at(done), to: at(done + area(strip.sheet.size)) };
                done += area(strip.sheet.size);
                let (geometry, warnings) = Geometry::compile(job, (&strip.views, true), bytes, &share)?;
                bytes += geometry.bytes();
                strips.push(Arc::new(geometry));
                told.extend(warnings.into_iter().filter(|warning| !told.contains(warning)).collect::<Vec<_>>());
            }
            kept.files.push(strips);
        }
        Ok((kept, told))
    }

    /// Returns the geometry of these rows of a file, if they are a strip.
    fn of(&self, file: usize, rows: &Range<usize>, height: usize) -> Option<Arc<Geometry>> {
        let is_strip = rows.start % STRIP == 0 && rows.end == height.min(rows.start + STRIP);
        let strips = self.files.get(file).filter(|_| is_strip)?;
        strips.get(rows.start / STRIP).map(Arc::clone)
    }

    fn all(&self) -> impl Iterator<Item = &Geometry> {
        self.files.iter().flatten().map(|geometry| &**geometry)
    }

    /// Returns the number of plans that are kept.
    pub(super) fn kept(&self) -> usize {
        self.all().map(Geometry::kept).sum()
    }

    /// Returns the bytes that it holds.
    pub(super) fn bytes(&self) -> u64 {
        self.all().map(Geometry::bytes).sum()
    }
}

/// Rows of a sheet, with the views that lie there.
struct Strip {
    /// Sheet of these rows alone.
    sheet: Sheet,
    /// Parts of its pieces, in their order.
    views: Vec<TargetView>,
}

impl Strip {
    /// Returns the strip of these rows of a sheet of views.
    fn of((views, sheet): (&[TargetView], &Sheet), rows: Range<usize>) -> Self {
        let mut strip =
            Self { sheet: Sheet { size: (sheet.size.0, rows.len()), pieces: Vec::new() }, views: Vec::new() };
        for &(index, (left, top)) in &sheet.pieces {
            let whole = &views[index];
            let (first, end) = (rows.start.max(top), rows.end.min(top + whole.view.height()));
            if first < end {
                let grid = whole.view.grid.window(whole.view.width(), end - first, 0.0, (first - top) as f64);
                strip.sheet.pieces.push((strip.views.len(), (left, first - rows.start)));
                strip.views.push(TargetView { view: View { grid, ..whole.view.clone() }, ..whole.clone() });
            }
        }
        strip
    }
}

impl Engine<'_> {
    /// Makes a file and writes it, but for its name.
    pub(super) fn strips(
        &self,
        (file, path): (usize, &Path),
        (frame, light): (Option<u64>, &FrameLight),
        making: &mut Making,
    ) -> Result<Hidden> {
        let sheet = &self.job.target.files[file].sheet;
        let Layer { place, posed: whole, .. } = &making.layer;
        let mut shares = sheet.pieces.iter().map(|(index, _)| making.shares.next(&whole.views[*index].view));
        let Some(first) = shares.next() else { bail!("a picture of nothing") };
        let share = Share { to: shares.last().map_or(first.to, |last| last.to), ..first };
        let at = |rows: usize| (rows as f64 / sheet.size.1 as f64).min(1.0);
        let (mut done, mut failed) = (0, None);
        let mut make = |rows: Range<usize>| {
            let share = Share { whole: &share, from: at(done), to: at(done + rows.len()) };
            done += rows.len();
            let strip = Strip::of((&whole.views, sheet), rows.clone());
            let kept = self.strips.of(file, &rows, sheet.size.1);
            let made = self.strip((*place, whole.pose), (strip, kept), (frame, light), &share);
            made.map_err(|error: ConvertError| failed = Some(error)).ok()
        };
        let origin = self.job.origin_of(frame)?.map(Arc::from);
        let words = FrameWords { place: *place, carried: light.carried(), origin };
        let written = self.writer().save_rows(words, path, (sheet.size, STRIP), &mut make);
        failed.map_or(written, Err)
    }

    /// Makes the samples of a strip, whose geometry may be kept.
    fn strip(
        &self,
        (place, pose): (usize, Option<Pose>),
        (Strip { sheet, views }, kept): (Strip, Option<Arc<Geometry>>),
        light: (Option<u64>, &FrameLight),
        progress: &dyn Progress,
    ) -> Result<EncodedImage> {
        let shares = Shares::new(progress, views.iter().map(|target| &target.view));
        let posed = match kept {
            Some(geometry) => Posed::of((pose, views), geometry),
            // What is told of the geometry is told of the whole.
            None => {
                let posed = Posed::new(self.job, (pose, views, false), &|_: f64| ControlFlow::Continue(()));
                posed.map_err(|Stopped| self.stopped())?.0
            }
        };
        let layer = Layer { place, posed: Arc::new(posed), balanced: BalancedLight::default(), behind: None };
        let made = match self.render_sheets(&[&sheet], light, &mut Making { layer, shares })? {
            Levels::Light(made) => made.into_iter().next().map(|image| self.writer().encode(image, Threads::All)),
            Levels::Codes(made) => made.into_iter().next().map(EncodedImage::of_codes),
            Levels::Written(_) | Levels::Layered { .. } => None,
        };
        made.ok_or_else(|| failure!("a strip has no picture"))
    }
}

fn area((width, height): (usize, usize)) -> usize {
    width * height
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::{Channels, Depth, FramePool, Samples};
    use cosmorama_io::WriteOptions;

    use super::*;
    use crate::engine::{FrameFile, Spent, Texels, ViewImage, Which, WriterOptions};
    use crate::settings::{Conversion, Existing};

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
            ("sky.exr", "fulldome:tilt=10", "200x1100", "dome.png"),
            ("sky.exr", "fulldome", "200x1100", "dome.exr"),
            ("sky.exr", "perspective:fov=70,yaw=20,pitch=30,roll=5", "200x1100", "view.tif"),
            ("sky.exr", "omnimax", "200x1100", "frame.hdr"),
            ("sky.exr", "cube", "520", "face_{face}.png"),
            ("sky.png", "cube:layout=cross-v", "300", "cross.png"),
            ("sky.png", "fulldome:tilt=10", "200x1100", "codes.png"),
            ("sky.png", "fulldome", "200x1100", "upright.png"),
            ("sky.png", "equirect", "200x1100", "panorama.jpg"),
            ("sky.png", "equirect:stereo=tb,yaw=30,pitch=20", "200x1100", "eyes.tga"),
        ] {
            let conversion = Conversion::new(path(sky), path(output)).to(to.parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap());
            let conversion = conversion.size(size.parse().unwrap()).existing(Existing::Replace);
            let checked = conversion.check().result.unwrap_or_else(|error| panic!("{to}: {error}"));
            let (job, stages, pool) = (&checked.job, &checked.stages, FramePool::default());
            let engine = Engine::new(job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
            let (kept, told) = KeptStrips::compile(job, progress).unwrap_or_else(|_| panic!("stopped"));
            assert!(told.is_empty() && kept.bytes() > 0, "{to}: {told:?}");
            let files = FrameFile::all(job, None, Which::All).into_iter();
            let mut images: Vec<ViewImage> = files.flat_map(|file| file.read(job, &pool).unwrap()).collect();
            let mut light = engine.frame_light();
            light.fill(job, None, (&mut images, Spent::Freed), (stages, &pool)).unwrap();
            assert_eq!(matches!(light.texels(), Texels::Fixed(_)), sky == "sky.png", "{to}");
            let frame = &job.outputs.frames[0];
            let form = |image: &EncodedImage| (image.width(), image.channels(), image.depth(), image.alpha_mode());
            for (file, whole) in engine.render(frame, &light, progress).unwrap().into_iter().enumerate() {
                let whole = match whole {
                    Levels::Light(mut whole) => engine.writer().encode(whole.remove(0), Threads::All),
                    Levels::Codes(mut whole) => EncodedImage::of_codes(whole.remove(0)),
                    _ => panic!("{to}"),
                };
                let (views, sheet) = (&job.target.views[..], &job.target.files[file].sheet);
                let (mut steps, mut others, of) = (0.0f32, 0, whole.samples().len());
                for top in (0..whole.height()).step_by(STRIP) {
                    let rows = top..whole.height().min(top + STRIP);
                    let made = |kept: Option<Arc<Geometry>>| {
                        let strip = Strip::of((views, sheet), rows.clone());
                        engine.strip((0, None), (strip, kept), (None, &light), progress).unwrap()
                    };
                    let strip = made(None);
                    let again = made(kept.of(file, &rows, whole.height()));
                    assert!(strip.samples() == again.samples(), "{to}: with and without kept geometry");
                    assert_eq!((form(&strip), strip.height()), (form(&whole), rows.len()), "{to}");
                    let part = whole.cropped((0, rows.start), (whole.width(), rows.len()));
                    steps = steps.max(steps_between(strip.samples(), part.samples()));
                    others += other_codes(strip.samples(), part.samples());
                }
                assert!(steps <= 1.0, "{to}: {steps} steps");
                assert!(others <= of / 1000, "{to}: {others} codes of {of} are others");
                let shares = Shares::new(progress, views.iter().map(|target| &target.view));
                let mut making = Making { layer: engine.layer(frame, progress).unwrap(), shares };
                let path = &frame.files[file].1;
                engine.strips((file, path), (None, &light), &mut making).unwrap().appear().unwrap();
                let file = cosmorama_io::probe(path).unwrap();
                let form = (file.width, file.height, file.channels, file.depth);
                assert_eq!(form, (whole.width(), whole.height(), whole.channels(), whole.depth()), "{to}");
            }
        }
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
        for (input, to, output, depth, memory, is_enough) in [
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Eight, "150M", true),
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Sixteen, "350M", true),
            ("sky.png", "fulldome:tilt=20", "dome.png", Depth::Sixteen, "150M", false),
            ("sky.png", "fulldome:tilt=20", "dome.exr", Depth::Half, "350M", true),
            ("sky.png", "fulldome:tilt=20", "dome.tif", Depth::Sixteen, "350M", true),
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
        ] {
            let conversion = Conversion::new(path(input), path(output)).to(to.parse().unwrap());
            let conversion = conversion.from("equirect".parse().unwrap()).size("16384".parse().unwrap()).threads(2);
            let depth = Some(depth);
            let checked = Conversion { depth, ..conversion }.memory(memory.parse().unwrap()).check().result;
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
