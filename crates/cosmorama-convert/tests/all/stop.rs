//! An observer may end a conversion before its last frame.

use std::ops::ControlFlow;
use std::path::Path;

use cosmorama::motion::{Easing, Ramp};
use cosmorama_convert::{
    CameraMovement, Code, Conversion, ConvertError, Existing, Observer, Quiet, Report, Result, Stop, Work,
};
use cosmorama_io::{FrameList, Limits, read};

const FRAMES: usize = 32;

/// Wants no more than so many frames, and remembers which it has learned of.
struct StopAfter {
    most: usize,
    done: Vec<Option<u64>>,
}

impl Observer for StopAfter {
    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        self.done.push(frame);
        if self.done.len() < self.most { ControlFlow::Continue(()) } else { ControlFlow::Break(Stop) }
    }
}

fn make_skies(folder: &Path) {
    let first = folder.join("sky_01.png");
    let sky = Conversion::new("builtin:demo", first.display().to_string()).to("equirect".parse().unwrap());
    sky.size("128".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    for frame in 2..=FRAMES {
        std::fs::copy(&first, folder.join(format!("sky_{frame:02}.png"))).unwrap();
    }
}

fn domes(folder: &Path) -> Conversion {
    let path = |name: &str| folder.join(name).display().to_string();
    let domes = Conversion::new(path("sky_##.png"), path("dome_##.png")).to("fulldome".parse().unwrap());
    domes.size("64".parse().unwrap())
}

fn stopped(conversion: Conversion, most: usize) -> (Result<Report>, Vec<Option<u64>>) {
    let mut observer = StopAfter { most, done: Vec::new() };
    (conversion.check().result.unwrap().run(&mut observer), observer.done)
}

/// The domes in a folder, each of which can be read; nothing but skies may lie beside them.
fn whole_domes(folder: &Path) -> Vec<String> {
    let entries = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = entries.filter(|name| !name.starts_with("sky_")).collect();
    names.sort_unstable();
    for name in &names {
        assert!(name.starts_with("dome_"), "{name}");
        read(folder.join(name), &Limits::default()).unwrap();
    }
    names
}

#[test]
fn a_sequence_ends_within_a_frame_and_leaves_whole_files_that_can_be_resumed() {
    for threads in [1, 4] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        make_skies(folder);
        let (result, told) = stopped(domes(folder).threads(threads), 2);
        let error = result.unwrap_err();
        assert!(matches!(error, ConvertError::Stopped { done: 2, frames: Some(FRAMES) }), "{error}");
        assert_eq!((error.code(), error.is_of_settings()), (Code::Stopped, false));
        assert_eq!(told, [Some(1), Some(2)], "of frames after the stop nothing is said");
        let names = whole_domes(folder);
        // Those that were under way are finished: no more than are read and written at once, and eight that wait for their disk.
        assert!((2..=3 + threads + 8).contains(&names.len()), "{threads} threads: {names:?}");
        let report = domes(folder).existing(Existing::Resume).check().result.unwrap().run(&mut Quiet).unwrap();
        assert_eq!((report.skipped, report.frames), (names.len(), FRAMES - names.len()));
        assert_eq!(whole_domes(folder).len(), FRAMES);
    }
}

#[test]
fn files_made_one_after_the_other_end_as_soon() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make_skies(folder);
    let path = |name: &str| folder.join(name).display().to_string();
    let maps = Conversion { st_map: true, ..Conversion::new(path("sky_##.png"), path("dome_##.exr")) };
    let maps = maps.from("equirect".parse().unwrap()).to("fulldome".parse().unwrap()).size("64".parse().unwrap());
    let (result, told) = stopped(maps, 3);
    assert!(matches!(result, Err(ConvertError::Stopped { done: 3, frames: Some(FRAMES) })));
    assert_eq!((told.len(), whole_domes(folder).len()), (3, 3));
}

#[test]
fn after_the_last_frame_there_is_nothing_to_stop() {
    let folder = tempfile::tempdir().unwrap();
    make_skies(folder.path());
    let (result, told) = stopped(domes(folder.path()), FRAMES);
    assert_eq!((result.unwrap().frames, told.len()), (FRAMES, FRAMES));
    let still = domes(folder.path()).frames(FrameList::new([5])).existing(Existing::Replace);
    assert_eq!(stopped(still, 1).0.unwrap().frames, 1);
}

/// Keeps what it is told of the work, and may stop a picture at a certain fraction.
struct Bands {
    at: f64,
    told: Vec<(Work, f64)>,
    done: usize,
}

impl Bands {
    fn stopping_at(at: f64) -> Self {
        Self { at, told: Vec::new(), done: 0 }
    }
}

impl Observer for Bands {
    fn advance(&mut self, work: Work, fraction: f64) -> ControlFlow<Stop> {
        self.told.push((work, fraction));
        if work == Work::Plan || fraction < self.at { ControlFlow::Continue(()) } else { ControlFlow::Break(Stop) }
    }

    fn frame_done(&mut self, _: Option<u64>) -> ControlFlow<Stop> {
        self.done += 1;
        ControlFlow::Continue(())
    }
}

/// One dome, large enough to be made in many bands.
fn still(folder: &Path, name: &str) -> Conversion {
    let path = |name: &str| folder.join(name).display().to_string();
    let dome = Conversion::new(path("sky_01.png"), path(name)).to("fulldome".parse().unwrap());
    dome.size("512".parse().unwrap())
}

#[test]
fn a_single_picture_tells_how_far_it_is_and_is_the_same_for_all_who_watch() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    make_skies(folder);
    still(folder, "dome_quiet.png").threads(1).check().result.unwrap().run(&mut Quiet).unwrap();
    for threads in [1, 3] {
        let mut bands = Bands::stopping_at(f64::INFINITY);
        let name = format!("dome_{threads}.png");
        still(folder, &name).threads(threads).check().result.unwrap().run(&mut bands).unwrap();
        let of = |work: Work| bands.told.iter().filter(move |told| told.0 == work).map(|told| told.1);
        let fractions: Vec<f64> = of(Work::Render(None)).collect();
        assert_eq!(of(Work::Plan).collect::<Vec<_>>(), [0.0, 1.0], "nothing is shared");
        assert!(
            fractions.len() > 2 && fractions.is_sorted() && (fractions[0], fractions.last()) == (0.0, Some(&1.0)),
            "{fractions:?}"
        );
        assert!(std::fs::read(folder.join(name)).unwrap() == std::fs::read(folder.join("dome_quiet.png")).unwrap());
    }
}

#[test]
fn a_picture_that_is_stopped_leaves_nothing_behind() {
    for at in [0.0, 0.5, 1.0] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        make_skies(folder);
        let mut bands = Bands::stopping_at(at);
        let error = still(folder, "new/dome.png").check().result.unwrap().run(&mut bands).unwrap_err();
        assert!(matches!(error, ConvertError::Stopped { done: 0, frames: Some(1) }), "{error}");
        let after = bands.told.iter().filter(|(work, fraction)| *work != Work::Plan && *fraction >= at);
        assert_eq!(after.count(), 1, "{:?}", bands.told);
        assert_eq!((bands.done, whole_domes(folder)), (0, Vec::new()));
    }
}

/// Stops the work on the geometry or on a frame.
struct StopIn(Work, Vec<Option<u64>>);

impl Observer for StopIn {
    fn advance(&mut self, work: Work, _: f64) -> ControlFlow<Stop> {
        if work == self.0 { ControlFlow::Break(Stop) } else { ControlFlow::Continue(()) }
    }

    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        self.1.push(frame);
        ControlFlow::Continue(())
    }
}

#[test]
fn a_sequence_that_is_stopped_within_a_frame_finishes_those_before_it() {
    for (work, done) in [(Work::Plan, 0), (Work::Render(Some(1)), 0), (Work::Render(Some(5)), 4)] {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        make_skies(folder);
        let mut observer = StopIn(work, Vec::new());
        let error = domes(folder).check().result.unwrap().run(&mut observer).unwrap_err();
        assert!(
            matches!(error, ConvertError::Stopped { done: found, frames: Some(FRAMES) } if found == done),
            "{error}"
        );
        assert_eq!((observer.1.len(), whole_domes(folder).len()), (done, done), "{work:?}");
    }
}

#[test]
fn the_frames_of_a_path_are_looked_at_under_an_observer_who_may_stop_that() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let faces = Conversion::new("builtin:demo", path("{face}.png")).to("cube".parse().unwrap());
    faces.size("32".parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
    let angles = [90.0, 0.0, 0.0].map(|to| Ramp { from: 0.0, to });
    let turn = CameraMovement::Turn { angles, fov: None, easing: Easing::default() };
    let domes = Conversion::new(path("{face}.png"), path("dome_###.png")).to("fulldome".parse().unwrap()).moved(turn);
    let domes = domes.size("64".parse().unwrap()).frames(FrameList::new(1..=400));
    let mut told = Bands::stopping_at(2.0);
    assert!(domes.clone().check_watched(&mut told).result.is_ok());
    assert!(told.told.iter().all(|(work, _)| *work == Work::Path));
    let fractions: Vec<f64> = told.told.iter().map(|(_, fraction)| *fraction).collect();
    assert!(
        fractions.is_sorted() && fractions.first() == Some(&0.0) && fractions.last() == Some(&1.0),
        "{fractions:?}"
    );
    assert!(fractions.len() > 10, "each frame is looked at: {fractions:?}");
    let mut stopping = Bands::stopping_at(0.3);
    let error = domes.check_watched(&mut stopping).result.err().unwrap();
    assert_eq!(error.code(), Code::Stopped, "{error}");
    // Well before the last frame.
    assert!(stopping.told.last().unwrap().1 < 0.9, "{:?}", stopping.told.last());
}
