//! Conversions in one process know nothing of each other.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use cosmorama_convert::{Conversion, Observer, Quiet, Report, Stop};
use cosmorama_spec::MemorySize;

/// A dome, sharp and turned, of each of three frames.
fn dome(folder: &Path, name: &str) -> Conversion {
    let path = |name: &str| folder.join(name).display().to_string();
    Conversion::new(path("sky_#.png"), path(&format!("{name}_#.png")))
        .from("equirect".parse().unwrap())
        .to("fulldome:tilt=20,yaw=11".parse().unwrap())
        .size("200".parse().unwrap())
}

/// Faces of a panorama of floats.
fn faces(folder: &Path, name: &str) -> Conversion {
    let path = |name: &str| folder.join(name).display().to_string();
    Conversion::new(path("light.exr"), path(&format!("{name}_{{face}}.exr")))
        .from("equirect".parse().unwrap())
        .to("cube:rotate=012301".parse().unwrap())
        .size("96".parse().unwrap())
}

fn make_inputs(folder: &Path) {
    let path = |name: &str| folder.join(name).display().to_string();
    for (world, name) in
        [("demo", "sky_1.png"), ("checker", "sky_2.png"), ("directions", "sky_3.png"), ("demo", "light.exr")]
    {
        let conversion = Conversion::new(format!("builtin:{world}"), path(name)).to("equirect".parse().unwrap());
        conversion.size("512".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    }
}

fn run(conversion: Conversion) -> Report {
    conversion.check().result.unwrap().run(&mut Quiet).unwrap()
}

/// The bytes of what was made, by the part of its name that says which it is.
fn bytes(report: &Report) -> BTreeMap<String, Vec<u8>> {
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().split_once('_').unwrap().1.to_owned();
    report.outputs.iter().map(|path| (name(path), std::fs::read(path).unwrap())).collect()
}

#[test]
fn two_at_once_with_other_threads_and_memory_make_what_each_makes_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make_inputs(folder);
    let (dome_alone, faces_alone) = (run(dome(folder, "alone")), run(faces(folder, "alone")));
    assert_eq!((dome_alone.outputs.len(), faces_alone.outputs.len()), (3, 6));
    let (small, large) = (MemorySize::Bytes(48 << 20), MemorySize::Bytes(2 << 30));
    let pairs = [((1, small), (3, large)), ((4, large), (1, small))];
    for (index, ((dome_threads, dome_memory), (face_threads, face_memory))) in pairs.into_iter().enumerate() {
        let name = format!("pair{index}");
        let (dome_made, faces_made) = std::thread::scope(|scope| {
            let dome = dome(folder, &name).threads(dome_threads).memory(dome_memory);
            let faces = faces(folder, &name).threads(face_threads).memory(face_memory);
            let (dome, faces) = (scope.spawn(|| run(dome)), scope.spawn(|| run(faces)));
            (dome.join().unwrap(), faces.join().unwrap())
        });
        assert!(bytes(&dome_made) == bytes(&dome_alone), "{name}");
        assert!(bytes(&faces_made) == bytes(&faces_alone), "{name}");
    }
}

/// Counts what it is told.
#[derive(Default)]
struct Counter {
    frames: Option<usize>,
    done: Vec<Option<u64>>,
}

impl Observer for Counter {
    fn begin(&mut self, frames: Option<usize>) {
        self.frames = frames;
    }

    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        self.done.push(frame);
        ControlFlow::Continue(())
    }
}

#[test]
fn an_observer_learns_of_every_frame_in_order() {
    let folder = tempfile::tempdir().unwrap();
    make_inputs(folder.path());
    let mut counter = Counter::default();
    let report = dome(folder.path(), "out").check().result.unwrap().run(&mut counter).unwrap();
    assert_eq!((counter.frames, report.frames), (Some(3), 3));
    assert_eq!(counter.done, [Some(1), Some(2), Some(3)]);
}
