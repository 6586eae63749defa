use cosmorama::motion::{Easing, Ramp, Shutter};
use cosmorama::raster::{Channels, Depth, FramePool, Samples};
use cosmorama_io::{Choice, FrameList, LayeredImage, Limits, PlaneSamples, SampleKind, WriteOptions};
use cosmorama_spec::FilterName;

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
        let frame = &job.outputs.frames[0];
        let light = light_of((&checked.job, &checked.stages), &engine, frame);
        assert_eq!(matches!(light.texels(), Texels::Fixed(_)), sky == "sky.png", "{to}");
        let layer = engine.layer(frame, progress).unwrap();
        let kept = KeptStrips::compile(job, &layer.posed.geometry, progress);
        let (kept, told) = kept.unwrap_or_else(|_| panic!("stopped"));
        assert!(told.is_empty() && kept.bytes() > 0, "{to}: {told:?}");
        keeping.strips = kept;
        let further = &FurtherFiles::new(job, frame.frame);
        let whole = Whole { frame, light: &light, layer: &layer, moments: None, further, progress };
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
                    [&engine, &keeping].map(|engine| picture_rows(engine, &whole, (file, rows.clone()))).into();
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

/// Compares strips by other filters than EWA, and by the kernel that keeps light, with their picture.
#[test]
fn strips_by_any_filter_are_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    cosmorama_io::write(path("sky.exr"), &smooth_sky(), &WriteOptions::default()).unwrap();
    let progress = &|_: f64| ControlFlow::Continue(());
    let filters = FilterName::NAMES.iter().map(|(name, _)| (*name, "adaptive"));
    let by_strips = filters.filter(|(filter, _)| *filter != "two-pass" && !filter.starts_with("labels"));
    for (filter, kernel) in by_strips.chain([("ewa", "light")]) {
        let conversion = Conversion::new(path("sky.exr"), path("view.exr")).from("equirect".parse().unwrap());
        let conversion = conversion.to("equirect:yaw=40,pitch=50,roll=20".parse().unwrap());
        let mut conversion = conversion.size("8x530".parse().unwrap()).existing(Existing::Replace);
        conversion.depth = Some(Depth::Float);
        (conversion.geometry.filter, conversion.geometry.kernel) = (filter.parse().unwrap(), kernel.parse().unwrap());
        let checked = conversion.check().result.unwrap_or_else(|error| panic!("{filter}: {error}"));
        let engine =
            Engine::new(&checked.job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
        let frame = &checked.job.outputs.frames[0];
        let light = light_of((&checked.job, &checked.stages), &engine, frame);
        let Some(Levels::Light(mut picture)) = engine.render(frame, &light, progress).unwrap().pop() else {
            panic!("no light")
        };
        let layer = engine.layer(frame, progress).unwrap();
        assert_eq!(layer.posed.geometry.bytes() > 0, kernel == "light", "{filter}: balanced");
        let picture = engine.writer().encode(picture.remove(0), Threads::All);
        let further = &FurtherFiles::new(&checked.job, frame.frame);
        let whole = Whole { frame, light: &light, layer: &layer, moments: None, further, progress };
        let mut farthest = 0.0f32;
        for top in (0..picture.height()).step_by(STRIP) {
            let rows = top..picture.height().min(top + STRIP);
            let made = picture_rows(&engine, &whole, (0, rows.clone()));
            let part = picture.cropped((0, rows.start), (picture.width(), rows.len()));
            let (Samples::Float(made), Samples::Float(part)) = (made.samples(), part.samples()) else {
                panic!("no floats")
            };
            let differs = |sample: &f32| (sample - part[0]).abs() > 0.01;
            assert!(part.iter().any(differs), "{filter}, {kernel}: nothing is to be seen");
            farthest = made.iter().zip(part).map(|(made, part)| (made - part).abs()).fold(farthest, f32::max);
        }
        assert!(farthest <= 2e-5, "{filter}, {kernel}: {farthest}");
    }
}

/// Compares further channels of strips with those of their picture.
#[test]
fn strips_have_the_channels_of_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let picture = smooth_sky();
    let named = |name: &str, samples| Plane { name: name.to_owned(), samples };
    let planes = || {
        let numbers = |first: usize| PlaneSamples::Float((first..first + 128 * 64).map(smooth).collect());
        let labels = PlaneSamples::Uint((0..128 * 64).map(|at| at as u32 / 500).collect());
        let light = ["glow.R", "glow.G", "glow.B"].into_iter().enumerate();
        let light = light.map(|(channel, name)| named(name, numbers(100 * channel)));
        light.chain([named("Z", numbers(7)), named("id", labels)]).collect::<Vec<_>>()
    };
    let progress = &|_: f64| ControlFlow::Continue(());
    for (name, picture) in [("all.exr", Some(&picture)), ("numbers.exr", None)] {
        // Three colours alone would be the picture.
        let planes: Vec<Plane> = planes().into_iter().skip(if picture.is_some() { 0 } else { 3 }).collect();
        let count = planes.len();
        let all = LayeredImage { size: (128, 64), picture, names: Vec::new(), planes };
        cosmorama_io::write_layers(path(name), all, &WriteOptions::default()).unwrap();
        let conversion = Conversion::new(path(name), path("view.exr")).from("equirect".parse().unwrap());
        let conversion = conversion.to("equirect:yaw=30".parse().unwrap()).size("20x530".parse().unwrap());
        let checked = conversion.existing(Existing::Replace).check().result.unwrap();
        let engine =
            Engine::new(&checked.job, WriterOptions::default(), progress).unwrap_or_else(|_| panic!("stopped"));
        let frame = &checked.job.outputs.frames[0];
        let light = light_of((&checked.job, &checked.stages), &engine, frame);
        let Some(Levels::Layered { planes, .. }) = engine.render(frame, &light, progress).unwrap().pop() else {
            panic!("no channels")
        };
        assert_eq!(planes.len(), count, "{name}");
        let layer = engine.layer(frame, progress).unwrap();
        let further = &FurtherFiles::new(&checked.job, frame.frame);
        let whole = Whole { frame, light: &light, layer: &layer, moments: None, further, progress };
        let (mut others, mut seen) = (0, 0);
        for top in (0..530).step_by(STRIP) {
            let rows = top..530.min(top + STRIP);
            let made = engine.rows(&whole, 0, rows.clone()).unwrap();
            assert_eq!(made.picture.is_some(), picture.is_some(), "{name}");
            let here = rows.start * 20..rows.end * 20;
            for (made, plane) in made.planes.iter().zip(&planes) {
                assert_eq!((&made.name, made.samples.len()), (&plane.name, here.len()), "{name}");
                for (at, from) in here.clone().enumerate() {
                    let (made, number) = (made.samples.number(at), plane.samples.number(from));
                    others += usize::from((made - number).abs() > 2e-5);
                    seen += usize::from(made != 0.0);
                }
            }
        }
        assert!(others <= 20 && seen > count * 2000, "{name}: {others} others of {seen}");
        engine.file_by_strips(&whole, &frame.files[0]).unwrap().appear().unwrap();
        let choice = Choice { without_picture: true, ..Choice::default() };
        let file = cosmorama_io::open(path("view.exr").as_ref()).unwrap();
        let header = cosmorama_io::probe_chosen(file, "view.exr", &choice).unwrap();
        let further = header.metadata.layers.further;
        assert!(further.iter().any(|channel| channel.name == "id" && channel.kind == SampleKind::Uint), "{further:?}");
    }
}

/// Compares strips of a frame whose camera moves, with and without blur, and with a world behind it, with its picture.
#[test]
fn strips_are_the_picture_that_a_moving_camera_takes() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    cosmorama_io::write(path("sky.exr"), &smooth_sky(), &WriteOptions::default()).unwrap();
    let samples = Samples::Float((0..64 * 64 * 4).map(smooth).collect());
    let front = EncodedImage::new(64, 64, Channels::Rgba, Depth::Float, samples).unwrap();
    cosmorama_io::write(path("front.exr"), &front, &WriteOptions::default()).unwrap();
    let progress = &|_: f64| ControlFlow::Continue(());
    let blurs = [None, Some(BlurMethod::Swept), Some(BlurMethod::Ellipse)];
    for (blur, has_backdrop) in blurs.into_iter().flat_map(|blur| [(blur, false), (blur, true)]) {
        let angles = [(0.0, 12.0), (5.0, 9.0), (0.0, 6.0)].map(|(from, to)| Ramp { from, to });
        let turn = CameraMovement::Turn { angles, fov: None, easing: Easing::default() };
        let input = if has_backdrop { ("front.exr", "perspective:fov=80,pitch=20") } else { ("sky.exr", "equirect") };
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
        let (moments, further) = (moments.as_deref(), &FurtherFiles::new(job, frame.frame));
        let whole = Whole { frame, light: &light, layer: &layer, moments, further, progress };
        for top in (0..picture.height()).step_by(STRIP) {
            let rows = top..picture.height().min(top + STRIP);
            let made = picture_rows(&engine, &whole, (0, rows.clone()));
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
        let further = &FurtherFiles::new(&checked.job, frame.frame);
        let whole = Whole { frame, light: &light, layer: &layer, moments: None, further, progress };
        for rows in [0..512, 512..1024] {
            let made = picture_rows(&engine, &whole, (0, rows.clone()));
            let part = picture.cropped((0, rows.start), (64, rows.len()));
            let steps = steps_between(made.samples(), part.samples());
            assert!(steps <= 1.0, "{input}, rows {rows:?}: {steps} steps");
        }
    }
}

/// Makes a panorama of 128×64 that is smooth along its rows.
fn smooth_sky() -> EncodedImage {
    let samples = Samples::Float((0..128 * 64 * 3).map(smooth).collect());
    EncodedImage::new(128, 64, Channels::Rgb, Depth::Float, samples).unwrap()
}

/// Returns a sample of a wave that rises and falls.
fn smooth(sample: usize) -> f32 {
    ((sample % 480) as f32 / 240.0 - 1.0).abs()
}

/// Makes rows of a picture.
fn picture_rows(engine: &Engine, whole: &Whole, (file, rows): (usize, Range<usize>)) -> EncodedImage {
    engine.rows(whole, file, rows).unwrap().picture.unwrap()
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
    let front = EncodedImage::new(64, 32, Channels::Rgba, Depth::Eight, Samples::U8(vec![90; 64 * 32 * 4])).unwrap();
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
        (Samples::U16(a), Samples::U16(b)) => farthest(&mut a.iter().zip(b).map(|(a, b)| f32::from(a.abs_diff(*b)))),
        (Samples::Half(a), Samples::Half(b)) => {
            farthest(&mut a.iter().zip(b).map(|(a, b)| f32::from(a.to_bits().abs_diff(b.to_bits()))))
        }
        (Samples::Float(a), Samples::Float(b)) => farthest(&mut a.iter().zip(b).map(|(a, b)| (a - b).abs() * 2.5e5)),
        other => panic!("{other:?}"),
    }
}
