//! Inputs that vanish or change while a sequence is made, and outputs whose folder does.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, SystemTime};

use cosmorama_convert::{Code, Conversion, ConvertError, Existing, Observer, Quiet, Report, Result, Stop};
use cosmorama_io::{Limits, read};

const FRAMES: u64 = 32;

/// Does something to the files when the second frame is done.
struct Meanwhile<F>(F);

impl<F: Fn()> Observer for Meanwhile<F> {
    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        if frame == Some(2) {
            self.0();
        }
        ControlFlow::Continue(())
    }
}

fn sky(path: &Path, size: &str) {
    let sky = Conversion::new("builtin:demo", path.display().to_string()).to("equirect".parse().unwrap());
    sky.size(size.parse().unwrap()).existing(Existing::Replace).check().result.unwrap().run(&mut Quiet).unwrap();
}

fn skies(folder: &Path) {
    sky(&folder.join("sky_01.png"), "128");
    for frame in 2..=FRAMES {
        std::fs::copy(folder.join("sky_01.png"), folder.join(format!("sky_{frame:02}.png"))).unwrap();
    }
}

fn domes(folder: &Path) -> Conversion {
    let path = |name: &str| folder.join(name).display().to_string();
    let domes = Conversion::new(path("sky_##.png"), path("dome_##.png")).to("fulldome".parse().unwrap());
    domes.size("64".parse().unwrap()).threads(1)
}

fn run(conversion: Conversion, meanwhile: impl Fn()) -> Result<Report> {
    conversion.check().result.unwrap().run(&mut Meanwhile(meanwhile))
}

/// The number of domes, each of which is whole; nothing but skies and they may be there.
fn whole_domes(folder: &Path) -> usize {
    let names = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let domes: Vec<String> = names.filter(|name| !name.starts_with("sky_")).collect();
    for name in &domes {
        assert!(name.starts_with("dome_"), "{name}");
        read(folder.join(name), &Limits::default()).unwrap();
    }
    domes.len()
}

/// A run fails with this code and names the file of the last frame; then the files are mended, and the run goes on.
fn fails_and_goes_on(code: Code, spoil: impl Fn(&Path), words: &str) -> ConvertError {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    skies(folder);
    let error = run(domes(folder), || spoil(folder)).unwrap_err();
    let message = error.message().to_string();
    assert_eq!((error.code(), error.is_of_settings()), (code, false), "{message}");
    assert!(message.contains("sky_32.png") && message.contains(words), "{message}");
    let made = whole_domes(folder);
    assert!((2..FRAMES as usize).contains(&made), "{made}");
    skies(folder);
    let report = domes(folder).existing(Existing::Resume).check().result.unwrap().run(&mut Quiet).unwrap();
    assert_eq!((report.skipped, report.frames), (made, FRAMES as usize - made));
    assert_eq!(whole_domes(folder), FRAMES as usize);
    error
}

#[test]
fn a_frame_that_vanishes_is_named() {
    let vanish = |folder: &Path| std::fs::remove_file(folder.join("sky_32.png")).unwrap();
    fails_and_goes_on(Code::NotFound, vanish, "frame 32");
}

#[test]
fn a_frame_that_is_replaced_by_one_of_another_size_is_named() {
    fails_and_goes_on(Code::WrongSize, |folder| sky(&folder.join("sky_32.png"), "64"), "64x32");
}

#[test]
fn a_frame_that_is_cut_off_is_named() {
    let cut = |folder: &Path| {
        let whole = std::fs::read(folder.join("sky_32.png")).unwrap();
        std::fs::write(folder.join("sky_32.png"), &whole[..whole.len() / 2]).unwrap();
    };
    fails_and_goes_on(Code::Damaged, cut, "frame 32");
}

/// Of a still, all frames are made of what was read first: their files must not say that they are made of something else.
#[test]
fn a_still_that_changes_while_frames_are_made_of_it_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    skies(folder);
    std::fs::rename(folder.join("sky_01.png"), folder.join("back.png")).unwrap();
    let world = folder.join("world.toml");
    let text = "[[view]]\nimage = \"back.png\"\nspec = \"equirect\"\n[[view]]\nimage = \"sky_##.png\"\nspec = \"perspective:fov=60\"\n";
    std::fs::write(&world, text.replace("sky_##", "small_##")).unwrap();
    for frame in 1..=FRAMES {
        let small = Conversion::new("builtin:demo", folder.join(format!("small_{frame:02}.png")).display().to_string());
        let small = small.to("perspective:fov=60".parse().unwrap()).size("32".parse().unwrap());
        small.check().result.unwrap().run(&mut Quiet).unwrap();
    }
    let conversion = Conversion { input: world.display().to_string().into(), ..domes(folder) };
    let later = SystemTime::now() + Duration::from_secs(3600);
    let touch =
        || std::fs::File::options().write(true).open(folder.join("back.png")).unwrap().set_modified(later).unwrap();
    let error = run(conversion, touch).unwrap_err();
    assert_eq!(error.code(), Code::Changed, "{}", error.message());
    assert!(error.message().to_string().contains("back.png"), "{}", error.message());
}

/// Clocks are set back, and disks have clocks of their own: nothing depends on which of two times is later.
#[test]
fn files_of_the_future_are_files_like_others() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    skies(folder);
    let later = SystemTime::now() + Duration::from_secs(400 * 24 * 3600);
    let touch =
        |name: &str| std::fs::File::options().write(true).open(folder.join(name)).unwrap().set_modified(later).unwrap();
    (1..=FRAMES).for_each(|frame| touch(&format!("sky_{frame:02}.png")));
    let of_another_machine = ".cosmorama-0123.45-4194305-abcdef.part";
    std::fs::write(folder.join(of_another_machine), "").unwrap();
    touch(of_another_machine);
    assert_eq!(run(domes(folder), || touch("dome_01.png")).unwrap().frames, FRAMES as usize);
    assert!(folder.join(of_another_machine).exists(), "whoever writes it may be alive");
    std::fs::remove_file(folder.join("dome_02.png")).unwrap();
    let report = domes(folder).existing(Existing::Resume).check().result.unwrap().run(&mut Quiet).unwrap();
    assert_eq!((report.skipped, report.frames), (FRAMES as usize - 1, 1));
}

/// Not as root, whom no permission keeps out: there the folder vanishes instead.
#[test]
fn a_folder_of_outputs_that_vanishes_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    skies(folder);
    let out = folder.join("sky_domes");
    let conversion = || Conversion { output: out.join("dome_##.png").display().to_string().into(), ..domes(folder) };
    // A frame may be written into it meanwhile.
    let is_refilled = |error: std::io::Error| error.kind() == std::io::ErrorKind::DirectoryNotEmpty;
    let vanish = || while std::fs::remove_dir_all(&out).is_err_and(is_refilled) {};
    let error = run(conversion(), vanish).unwrap_err();
    let message = error.message().to_string();
    assert_eq!(error.code(), Code::Unwritable, "{message}");
    assert!(message.contains("sky_domes/dome_"), "{message}");
    let report = conversion().existing(Existing::Resume).check().result.unwrap().run(&mut Quiet).unwrap();
    assert_eq!(report.frames, FRAMES as usize);
}
