//! A folder of its own for each test, pictures to put into it, and the program to run in it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Samples, Transfer};
use cosmorama::sphere::CubeFace;
use cosmorama_io::{Limits, Metadata, WriteOptions, read, write};

/// A folder that goes away with the test.
pub(crate) struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program, to be run in the folder.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cosmorama"));
        command.current_dir(self.folder.path()).args(args);
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().unwrap()
    }

    /// Runs what must succeed; its standard output.
    pub(crate) fn succeed(&self, args: &[&str]) -> String {
        let output = self.run(args);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert!(output.status.success(), "{args:?} failed: {err}{out}");
        out
    }

    /// Runs what must fail with this exit code, with one message, nothing on standard output and no new file or folder. The
    /// message.
    pub(crate) fn fail(&self, code: i32, args: &[&str]) -> String {
        let (before, folders) = (self.files(), self.folders());
        let output = self.run(args);
        assert_eq!(self.folders(), folders, "no folder may be left");
        self.check_failure(code, &output, &before)
    }

    pub(crate) fn check_failure(&self, code: i32, output: &Output, before: &BTreeSet<PathBuf>) -> String {
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "{err}{out}");
        assert_eq!(out, "", "standard output is for what was asked for");
        assert_eq!(err.matches("error: ").count(), 1, "one message: {err}");
        assert!(!err.contains("panicked"), "{err}");
        assert_eq!(&self.files(), before, "no file may be left: {err}");
        err
    }

    /// Every file under the folder, hidden ones too.
    pub(crate) fn files(&self) -> BTreeSet<PathBuf> {
        self.entries().into_iter().filter(|path| !path.is_dir()).collect()
    }

    /// Every folder under the folder.
    pub(crate) fn folders(&self) -> BTreeSet<PathBuf> {
        self.entries().into_iter().filter(|path| path.is_dir()).collect()
    }

    fn entries(&self) -> BTreeSet<PathBuf> {
        fn walk(folder: &Path, entries: &mut BTreeSet<PathBuf>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    walk(&path, entries);
                }
                entries.insert(path);
            }
        }
        let mut entries = BTreeSet::new();
        walk(self.folder.path(), &mut entries);
        entries
    }

    /// Six faces of a size, `PREFIX_front.png` and so on, each with its own pattern.
    pub(crate) fn faces(&self, prefix: &str, size: usize) {
        for face in CubeFace::ALL {
            self.face(&format!("{prefix}{}.png", word(face)), face, size, size);
        }
    }

    pub(crate) fn face(&self, name: &str, face: CubeFace, width: usize, height: usize) {
        self.save(name, &picture(face as usize, width, height));
    }

    pub(crate) fn save(&self, name: &str, image: &EncodedImage) {
        self.save_as(name, image, Some(if image.depth().is_float() { Transfer::Linear } else { Transfer::Srgb }));
    }

    pub(crate) fn save_as(&self, name: &str, image: &EncodedImage, transfer: Option<Transfer>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        write(&path, image, &WriteOptions::with_metadata(Metadata { transfer, ..Metadata::default() })).unwrap();
    }

    pub(crate) fn load(&self, name: &str) -> EncodedImage {
        read(self.path(name), &Limits::NONE).unwrap().image
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The name of a face in words.
pub(crate) fn word(face: CubeFace) -> &'static str {
    ["front", "right", "back", "left", "top", "bottom"][face as usize]
}

/// A smooth picture, another for each seed.
pub(crate) fn picture(seed: usize, width: usize, height: usize) -> EncodedImage {
    let light = Image::from_fn(width, height, |i, j| {
        let (x, y) = (i as f32 / width as f32, j as f32 / height as f32);
        let k = seed as f32;
        Rgba::opaque(0.1 + 0.8 * x, 0.1 + 0.1 * k, 0.5 + 0.4 * (6.0 * (x - y) + k).sin())
    });
    EncodedImage::encode(&light, Channels::Rgb, Depth::Eight, &Transfer::Srgb)
}

/// One colour of code values.
pub(crate) fn flat(width: usize, height: usize, pixel: &[u8]) -> EncodedImage {
    let channels = Channels::ALL.into_iter().find(|channels| channels.count() == pixel.len()).unwrap();
    let samples = Samples::U8(pixel.repeat(width * height));
    EncodedImage::new(width, height, channels, Depth::Eight, samples).unwrap()
}

/// Float pixels.
pub(crate) fn floats(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> EncodedImage {
    let samples = (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).flat_map(|(i, j)| pixel(i, j)).collect();
    EncodedImage::new(width, height, Channels::Rgb, Depth::Float, Samples::Float(samples)).unwrap()
}

/// Float pixels with an alpha of 1 everywhere.
pub(crate) fn veiled(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> EncodedImage {
    let opaque = floats(width, height, pixel);
    let Samples::Float(samples) = opaque.into_samples() else { panic!("floats are floats") };
    let samples = samples.chunks(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 1.0]).collect();
    EncodedImage::new(width, height, Channels::Rgba, Depth::Float, Samples::Float(samples)).unwrap()
}

/// The samples of an image of 8 bits.
pub(crate) fn eight_bits(image: &EncodedImage) -> &[u8] {
    match image.samples() {
        Samples::U8(samples) => samples,
        other => panic!("8 bits were expected, not {other:?}"),
    }
}

/// A message holds all of these parts.
#[track_caller]
pub(crate) fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "'{part}' is not in: {message}");
    }
}
