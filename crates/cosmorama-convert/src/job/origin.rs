//! Words about how a frame is made, which its file holds: digests of what is computed, not of how it was asked for. Angles,
//! windows and frames that come to the same give the same words.

use std::collections::HashMap;
use std::fmt::Debug;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use cosmorama::camera::{PixelPoint, View};
use cosmorama::motion::Shutter;
use xxhash_rust::xxh3::xxh3_64;

use crate::diagnostic::Result;
use crate::job::ConvertJob;
use crate::settings::Conversion;
use crate::source::video::{FrameDamage, FrameName};
use crate::source::{Files, ViewFiles};
use crate::target::time;

/// Part of an origin that all frames of a run share: the program's version, with digests of the settings.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    shared: String,
    /// Files that the output's projection names.
    named: Vec<PathBuf>,
    /// Digests of files that serve all frames, which are read once.
    still: OnceLock<Samples>,
}

/// Digests of files, by their paths; `None` where one cannot be read. Many views may share a file.
#[derive(Clone, Debug, Default)]
struct Samples(HashMap<PathBuf, Option<u64>>);

/// Parts of a file that are looked at: its whole length divided evenly, so that they also meet pictures without compression.
const PARTS: u64 = 32;

/// Bytes of each part.
const PART: u64 = 4096;

/// Places across a view, and down, at which its directions are compared.
const LATTICE: usize = 7;

/// Fineness of these directions: far below any pixel, and above what computers of different makes differ by.
const FINENESS: f64 = 1e9;

impl Origin {
    pub(crate) fn of(job: &ConvertJob, settings: &Conversion) -> Self {
        let Conversion { in_primaries, ignore_profile, ocio, part, channels, layers, .. } = settings;
        let Conversion { quality, mips, remarks, st_map, .. } = settings;
        let named = settings.geometry.to.iter().flat_map(|spec| spec.files.iter().cloned());
        let all = || job.layers();
        let inputs = all().flat_map(|job| job.input.there());
        let views: Vec<_> = inputs.map(|(input, _, view)| (seen(view), input.part, input.blend)).collect();
        // Of a moving camera, those before it is moved.
        let wanted: Vec<_> = all().flat_map(|job| &job.target.views).map(|target| seen(&target.view)).collect();
        let files: Vec<_> = job.target.files.iter().map(|file| file.levels().collect::<Vec<_>>()).collect();
        let shown: Vec<_> = job.target.views.iter().map(|view| (view.eye, view.level)).collect();
        let geometry = digest(&(views, wanted, files, shown, job.target.envmap, job.target.panorama, st_map));
        let blur = job.movement.as_ref().and_then(|movement| movement.blur);
        let filter = digest(&(job.filter, &job.lighting, blur.map(|blur| (blur.method, blur.shutter.curve))));
        let lights: Vec<_> = all().map(|job| (job.light.definition(), job.opacity, job.missing)).collect();
        let asked = (in_primaries, ignore_profile, ocio, part, channels, layers);
        let colour = digest(&(lights, asked, (quality, mips, remarks)));
        Self {
            shared: format!("{VERSION}, geometry {geometry:08x}, filter {filter:08x}, colour {colour:08x}"),
            named: named.collect(),
            still: OnceLock::new(),
        }
    }

    /// Returns the origin of a frame, in words; `None` for a picture that is no frame. Damage of a film is in them once the film's frame was
    /// decoded.
    ///
    /// # Errors
    /// When a view cannot be posed so.
    pub(crate) fn of_frame(&self, job: &ConvertJob, frame: Option<u64>) -> Result<Option<String>> {
        let Some(number) = frame else { return Ok(None) };
        let times = |shutter: Shutter| shutter.division(time(number)).to_vec();
        let mut poses = Vec::new();
        for layer in job.layers() {
            let Some(movement) = &layer.movement else { continue };
            let exposed = movement.blur.map_or_else(Vec::new, |blur| times(blur.shutter));
            let at = [&[time(number)], &exposed[..]].concat();
            let views = movement.views_at(&layer.target.views, &at)?;
            poses.extend(views.iter().flatten().map(|target| seen(&target.view)));
        }
        let formulas: Vec<_> = job.layers().map(ConvertJob::formula).collect();
        let place = job.place(frame);
        let still = self.still.get_or_init(|| self.still_of(job));
        let read_by = |layer: &ConvertJob| -> Vec<Option<u64>> {
            let mut own = Samples::default();
            let frame = layer.input.frames[place];
            let paths: Vec<PathBuf> = layer.input.there().map(|(view, ..)| view.files.path(frame)).collect();
            let read = |path: &PathBuf| {
                let file = FrameName::file(path);
                let bytes = still.known(&file).unwrap_or_else(|| own.of(&*layer.files, file))?;
                // Frames of a video are told apart by their numbers.
                Some(FrameName::parse(path).map_or(bytes, |name| xxh3_64(format!("{bytes} {}", name.frame).as_bytes())))
            };
            paths.iter().chain(&layer.input.beside).map(read).collect()
        };
        let named: Vec<_> = self.named.iter().map(|path| still.known(path).flatten()).collect();
        let read = (job.layers().map(read_by).collect::<Vec<_>>(), named);
        let (pose, input) = (digest(&poses), digest(&(formulas, read)));
        let damage = worst_damage(job, place).map_or_else(String::new, |damage| format!("{DAMAGE}{}", name(damage)));
        Ok(Some(checked(format!("{}{POSE}{pose:08x}, input {input:08x}{damage}", self.shared))))
    }
}

impl Origin {
    /// Returns the digests of files that serve all frames: lists, masks, maps, stills and videos.
    fn still_of(&self, job: &ConvertJob) -> Samples {
        let mut samples = Samples::default();
        for layer in job.layers() {
            let stills = layer.input.there().filter(|(view, ..)| !matches!(view.files, ViewFiles::Sequence(_)));
            let stills = stills.map(|(view, ..)| view.files.file(None));
            stills.chain(layer.input.beside.iter().cloned()).for_each(|path| _ = samples.of(&*layer.files, path));
        }
        self.named.iter().for_each(|path| _ = samples.of(&*job.files, path.clone()));
        samples
    }
}

impl Samples {
    /// Returns the digest of a file if it is known.
    fn known(&self, path: &Path) -> Option<Option<u64>> {
        self.0.get(path).copied()
    }

    /// Returns the digest of a file, which is read if it is not known yet.
    fn of(&mut self, files: &dyn Files, path: PathBuf) -> Option<u64> {
        *self.0.entry(path).or_insert_with_key(|path| sample(files, path))
    }
}

/// Returns the worst of what is the matter with the frames of films of which a frame was made.
fn worst_damage(job: &ConvertJob, place: usize) -> Option<FrameDamage> {
    let of_layer = |layer: &ConvertJob| {
        let videos = layer.files.videos()?;
        let names = layer.input.paths(layer.input.frames[place]);
        names.iter().filter_map(|path| videos.damage(&FrameName::parse(path)?)).max()
    };
    job.layers().filter_map(of_layer).max()
}

fn name(damage: FrameDamage) -> &'static str {
    match damage {
        FrameDamage::Traces => "traces",
        FrameDamage::Held => "held",
    }
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Beginning of the part of an origin that is each frame's own.
const POSE: &str = ", pose ";

/// Beginning of the word for damage of an input.
const DAMAGE: &str = ", damage ";

/// Beginning of the digest of the words before it. Of most formats, texts have no checksum: a flipped bit would look like other
/// settings.
const CHECK: &str = ", check ";

/// Finding about a file whose origin [`is_damaged`].
pub(crate) const DAMAGED_ORIGIN: &str = "its words about how it was made are not as they were written";

/// Returns an origin with a digest of its words.
fn checked(words: String) -> String {
    let check = words_digest(&words);
    words + CHECK + &check
}

/// Returns whether a digest at the end of an origin is not that of its words, or is lacking where this version would write it.
pub(crate) fn is_damaged(origin: &str) -> bool {
    match origin.rsplit_once(CHECK) {
        Some((words, check)) => check != words_digest(words),
        // With the program's name before them, words are not as they were written.
        None => {
            origin.split(',').next().is_some_and(|first| first == VERSION || first.ends_with(&format!("({VERSION}")))
        }
    }
}

fn words_digest(words: &str) -> String {
    format!("{:08x}", xxh3_64(words.as_bytes()) as u32)
}

/// Returns the part of an origin that frames of one run share.
pub(crate) fn settings_of(origin: &str) -> Option<&str> {
    Some(origin.split_once(POSE)?.0)
}

/// Returns what an origin says of damaged inputs; `None` if they were whole.
pub(crate) fn damage_of(origin: &str) -> Option<FrameDamage> {
    let word = origin.split_once(DAMAGE)?.1.split(',').next()?;
    [FrameDamage::Traces, FrameDamage::Held].into_iter().find(|damage| name(*damage) == word)
}

/// Returns whether two origins are of one version of the program; others may compute alike.
pub(crate) fn are_of_one_version(found: &str, expected: &str) -> bool {
    found.split(", ").next() == expected.split(", ").next()
}

/// Returns the names of the parts in which two origins differ, but for damage of inputs; none if they are of different versions of the program.
pub(crate) fn differences(found: &str, expected: &str) -> Vec<String> {
    if !are_of_one_version(found, expected) {
        return Vec::new();
    }
    let (found, expected): (Vec<&str>, Vec<&str>) = (found.split(", ").collect(), expected.split(", ").collect());
    let differ = expected.iter().filter(|part| !found.contains(part));
    let names = differ.filter_map(|part| Some(part.split_once(' ')?.0));
    names.filter(|name| !["check", "damage"].contains(name)).map(str::to_owned).collect()
}

/// Returns whether the first of two origins is damaged, the names of the parts in which they differ, the first one's settings, and what it says of damaged inputs: fuzzing compares them
/// without a conversion.
#[cfg(fuzzing)]
pub fn compared_origins<'a>(
    found: &'a str,
    expected: &str,
) -> (bool, Vec<String>, Option<&'a str>, Option<&'static str>) {
    (is_damaged(found), differences(found, expected), settings_of(found), damage_of(found).map(name))
}

/// Returns the size of a view, its limits, and the directions at a lattice of its pixels.
fn seen(view: &View) -> impl Debug + use<> {
    let (width, height) = (view.width(), view.height());
    let at = |k: usize, length: usize| length as f64 * (k as f64 + 0.5) / LATTICE as f64;
    let rounded = |part: f64| (part * FINENESS).round() as i64;
    let direction = |k: usize| {
        let pixel = PixelPoint::new(at(k % LATTICE, width), at(k / LATTICE, height));
        let vector = view.direction(pixel)?.vector();
        Some([vector.x, vector.y, vector.z].map(rounded))
    };
    let directions: Vec<Option<[i64; 3]>> = (0..LATTICE * LATTICE).map(direction).collect();
    (width, height, view.stop, directions)
}

fn digest(value: &impl Debug) -> u32 {
    xxh3_64(format!("{value:?}").as_bytes()) as u32
}

/// Returns a digest of a file's length and of parts of it; `None` if it cannot be read.
fn sample(files: &dyn Files, path: &Path) -> Option<u64> {
    let mut file = files.open(path).ok()?;
    let length = file.seek(SeekFrom::End(0)).ok()?;
    let mut bytes = length.to_le_bytes().to_vec();
    let last = length.saturating_sub(PART);
    let count = PARTS.min(length.div_ceil(PART)).max(1);
    for part in 0..count {
        file.seek(SeekFrom::Start(last * part / (count - 1).max(1))).ok()?;
        (&mut file).take(PART).read_to_end(&mut bytes).ok()?;
    }
    Some(xxh3_64(&bytes))
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use cosmorama_io::{IoError, ReadSeek};

    use super::*;
    use crate::source::InMemory;

    #[test]
    fn what_differs_is_named() {
        let one = "0.1.0, geometry 1, filter 2, colour 3, pose 5, input 4";
        let other = "0.1.0, geometry 1, filter 5, colour 3, pose 5, input 6";
        assert_eq!(differences(one, one), Vec::<String>::new());
        assert_eq!(differences(one, other), ["filter", "input"]);
        assert_eq!(differences("0.1.0", one), ["geometry", "filter", "colour", "pose", "input"]);
        assert_eq!(differences(&other.replace("0.1.0", "0.2.0"), one), Vec::<String>::new());
        assert_eq!((settings_of(one), settings_of("")), (Some("0.1.0, geometry 1, filter 2, colour 3"), None));
    }

    #[test]
    fn damage_is_no_setting() {
        let whole = "0.1.0, geometry 1, filter 2, colour 3, pose 5, input 4";
        for damage in [FrameDamage::Traces, FrameDamage::Held] {
            let damaged = checked(format!("{whole}{DAMAGE}{}", name(damage)));
            assert_eq!((damage_of(&damaged), damage_of(&checked(whole.to_owned()))), (Some(damage), None));
            assert_eq!(differences(&damaged, whole), Vec::<String>::new());
            assert_eq!(differences(whole, &damaged), Vec::<String>::new());
        }
        assert!(FrameDamage::Held > FrameDamage::Traces);
    }

    #[test]
    fn a_changed_letter_of_an_origin_is_damage() {
        let whole = checked(format!("{VERSION}, geometry 1, filter 2, colour 3, pose 5, input 4"));
        assert!(!is_damaged(&whole));
        assert_eq!(differences(&whole, &checked(whole.replace("input 4", "input 6"))), ["input"]);
        for at in 0..whole.len() {
            let mut damaged = whole.clone().into_bytes();
            damaged[at] ^= 1;
            assert!(is_damaged(&String::from_utf8(damaged).unwrap()), "{at}");
            let is_before_the_words = at < VERSION.len();
            assert!(is_before_the_words || is_damaged(&whole[..at]), "{at}");
        }
        // As they are read where a letter is none: with the program's name, and a mark in that letter's place.
        let named = format!("cosmorama ({whole})");
        for at in 0..named.len() {
            assert!(is_damaged(&format!("{}?{}", &named[..at], &named[at + 1..])), "{at}");
        }
        // Those of versions before had no such digest.
        assert!(!is_damaged("0.1.0, geometry 1, filter 2"));
    }

    #[test]
    fn files_are_told_apart_by_length_and_by_bytes_all_over() {
        let of = |bytes: &[u8]| {
            let mut files = InMemory::default();
            files.insert("it", bytes.to_vec());
            sample(&files, Path::new("it"))
        };
        for length in [0, 1, 4095, 4096, 4097, 20_000, 131_072, 131_073, 1 << 20] {
            let bytes = vec![7_u8; length];
            assert!(of(&bytes).is_some() && of(&bytes) == of(&bytes), "{length}");
            assert_ne!(of(&bytes), of(&[&bytes[..], &[7]].concat()), "{length}");
            // A block of a 24th of the file is met wherever it is; up to 32 parts, every byte is.
            let block = if length as u64 <= PARTS * PART { 1 } else { length / 24 };
            for start in (0..length.saturating_sub(block - 1)).step_by(block.max(length / 500).max(1)) {
                let mut other = bytes.clone();
                other[start..start + block].fill(8);
                assert_ne!(of(&bytes), of(&other), "{block} at {start} of {length}");
            }
        }
        assert_eq!(sample(&InMemory::default(), Path::new("none")), None);
    }

    /// Files that count how often they are opened.
    #[derive(Debug, Default)]
    struct Counted {
        files: InMemory,
        opened: AtomicUsize,
    }

    impl Files for Counted {
        fn open(&self, path: &Path) -> std::result::Result<Box<dyn ReadSeek + Send>, IoError> {
            self.opened.fetch_add(1, Ordering::Relaxed);
            self.files.open(path)
        }

        fn holds(&self, path: &Path) -> bool {
            self.files.holds(path)
        }
    }

    #[test]
    fn a_file_of_many_views_is_read_once() {
        let mut files = Counted::default();
        files.files.insert("it", vec![7; 100]);
        let (mut samples, path) = (Samples::default(), PathBuf::from("it"));
        assert_eq!(samples.known(&path), None);
        let first = samples.of(&files, path.clone());
        assert!(first.is_some() && (0..1000).all(|_| samples.of(&files, path.clone()) == first));
        assert_eq!((samples.known(&path), files.opened.load(Ordering::Relaxed)), (Some(first), 1));
    }
}
