//! Evidence in the pixels of an image about its projection.

use std::path::{Path, PathBuf};

use cosmorama::camera::{CameraModel, Mirror, OmnimaxCamera, PixelRect};
use cosmorama::circle;
use cosmorama::circle::{Circle, Found};
use cosmorama::layout::{Arrangement, CubeLayout, LayoutKind};
use cosmorama::raster::{EncodedImage, FramePool, Image, Rgba, Samples, Transfer, Uniform};
use cosmorama_io::{Choice, Header, ImageFile, IoError, Limits};

use crate::detect::oval::is_oval;
use crate::detect::{Circles, Continuity, Twins, cross_variants, seams};
use crate::diagnostic::{Code, ConvertError, Result, failed_as};
use crate::source::memory_budget::read_bytes;
use crate::source::{DecodedPicture, Files, MemoryBudget, light_bytes, probe, read, read_choice};

/// Size, in bytes, above which an image is not decoded for detection only.
const MOST_BYTES: u64 = 1 << 30;
/// Least fraction of an area that must be blank.
const BLANK: f64 = 0.98;
/// Greatest blank fraction of a picture that can tell anything.
const EMPTY: f64 = 0.9;
/// Pixels around drawn content into which a JPEG file's blocks may blur.
pub(crate) const BLOCK: usize = 8;
/// Tolerances, as a fraction and in pixels, for a measured circle that fills a square.
const EXACTLY: (f64, f64) = (0.005, 2.0);
/// Tolerance for a circle whose rim cannot be measured, or that is one of two.
const ROUGHLY: f64 = 0.02;
/// Columns of the coarse copy of a panorama, at least.
const COARSE: usize = 1024;
/// Greatest code that counts as black, of codes from 0 to 1.
pub(crate) const BLACK: f32 = 0.06;

/// Reads the light of an image for detection; `None` if it is too large or damaged.
pub fn light_of(files: &dyn Files, path: &Path) -> Option<Image<Rgba>> {
    decoded(files, path).ok().map(|file| light(&file.image))
}

fn light(image: &EncodedImage) -> Image<Rgba> {
    image.to_light(if image.depth().is_float() { &Transfer::Linear } else { &Transfer::Srgb })
}

/// Returns whether an image is small enough to be decoded for detection only.
pub(crate) fn is_small(header: &Header) -> bool {
    light_bytes(header) <= MOST_BYTES
}

fn decoded(files: &dyn Files, path: &Path) -> Result<ImageFile, IoError> {
    // Light takes more memory than the samples that it is made of.
    let limit = if is_small(&probe(files, path)?) { MOST_BYTES } else { 0 };
    read(files, path, &Limits::memory(limit))
}

/// Returns the damage of a file whose pixels cannot be read; `None` also for one that is too large for the memory. Channels that
/// form no picture are read, too.
pub fn damage_of(files: &dyn Files, path: &Path, memory: MemoryBudget) -> Option<String> {
    let choice = Choice { without_picture: true, ..files.choice() };
    let limits = Limits::memory(memory.bytes);
    match read_choice(files, path, (&limits, &FramePool::default()), &choice) {
        Ok(_) | Err(IoError::TooLarge { .. }) => None,
        Err(error) => Some(error.to_string()),
    }
}

/// Bytes of a picture that is read for a better message.
const FOR_A_MESSAGE: u64 = 1 << 26;

/// Replaces an error about what files seem to lack by the error about damage, if the pixels of one of them, which is not large, cannot be
/// read. They are read one by one: the memory is for one of them.
pub(crate) fn unless_damaged(
    (files, memory): (&dyn Files, MemoryBudget),
    paths: Vec<PathBuf>,
    error: ConvertError,
) -> ConvertError {
    let is_of_content = matches!(error.code(), Code::Uncovered | Code::WrongSize | Code::Geometry | Code::Ambiguous);
    let memory = memory.at_most(FOR_A_MESSAGE);
    let damage = |path: PathBuf| if is_of_content { damage_of(files, &path, memory) } else { None };
    paths.into_iter().find_map(damage).map_or(error, |damage| failed_as(Code::Damaged, damage))
}

/// Finding from the blank areas of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Evidence {
    /// A circle that fills a square, on black.
    Circle,
    /// A cross of faces on one colour.
    Cross(LayoutKind),
    /// A cross with its long arm at the other end, as if mirrored so.
    CrossElsewhere(LayoutKind, Mirror),
    /// A circle elsewhere, on black.
    Disc(Found),
    /// A circle in each half, on black.
    Circles(Circles),
    /// The circle of an Omnimax frame, cut off below, on black.
    Omnimax,
    /// An oval that fills a picture of 2:1, on one colour.
    Oval,
    /// Halves that are alike, as for two eyes.
    Twins(Arrangement),
}

/// Result of an examination of the pixels.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Seen {
    /// A finding.
    Evidence(Evidence),
    /// No finding: no circle on black, no cross on one colour, no halves that are alike.
    Nothing,
    /// The pixels were not examined, for this reason.
    Unseen(String),
    /// The pixels cannot be read; holds the reader's message.
    Damaged(String),
}

impl Seen {
    /// Examines the pixels, beginning with what the image's shape suggests. If blank areas decide nothing, the borders
    /// of faces are compared, as they would lie in each of these layouts.
    pub(crate) fn of(
        files: &dyn Files,
        path: &Path,
        (header, layouts): (&Header, &[LayoutKind]),
        held: &DecodedPicture,
    ) -> (Self, Option<Continuity>) {
        if header.window.is_some() {
            return (Self::Unseen("it is a part of a larger picture".to_owned()), None);
        }
        let file = match decoded(files, path) {
            Ok(file) => file,
            Err(IoError::TooLarge { .. }) => {
                return (Self::Unseen("it is too large to look at its pixels".to_owned()), None);
            }
            Err(error) => return (Self::Damaged(error.to_string()), None),
        };
        let seen = Evidence::of_image(&file.image).map_or(Self::Nothing, Self::Evidence);
        let may_be_cube = !layouts.is_empty() && matches!(seen, Self::Nothing | Self::Evidence(Evidence::Twins(_)));
        let borders = if may_be_cube { seams::among(layouts, &light(&file.image)) } else { None };
        // Beside its samples, the file itself, and coarse copies.
        let looked_at = if may_be_cube { light_bytes(header) } else { 2 * read_bytes(header) };
        held.put(path, file, looked_at);
        (seen, borders)
    }
}

impl Evidence {
    /// Examines a picture. One with a panorama's shape is examined in a coarse copy first, since most have no such
    /// features.
    fn of_image(image: &EncodedImage) -> Option<Self> {
        let step = image.width() / COARSE;
        if image.width() == 2 * image.height() && step > 1 {
            match thinned(image, step).map(|coarse| Self::of(&coarse.to_light(&Transfer::Linear))) {
                Some(None) => return None,
                Some(Some(Self::Twins(arrangement))) => return Some(Self::Twins(arrangement)),
                // Circles and ovals are measured in all pixels.
                _ => {}
            }
        }
        Self::of(&image.to_light(&Transfer::Linear))
    }

    fn of(codes: &Image<Rgba>) -> Option<Self> {
        let is_empty = codes.uniformity(|_, _| true).is_none_or(|all| all.share >= EMPTY);
        if is_empty {
            return circle::find(codes).filter(|found| !is_domemaster(found, codes)).map(Self::Disc);
        }
        let crosses = [LayoutKind::CrossH, LayoutKind::CrossV];
        if let Some(kind) = crosses.into_iter().find(|kind| is_cross(*kind, Mirror::default(), codes)) {
            return Some(Self::Cross(kind));
        }
        let elsewhere = crosses.into_iter().filter_map(|kind| Some((kind, cross_variants::axis(kind)?)));
        if let Some((kind, mirror)) = elsewhere.into_iter().find(|(kind, mirror)| is_cross(*kind, *mirror, codes)) {
            return Some(Self::CrossElsewhere(kind, mirror));
        }
        if let Some(circles) = Circles::find(codes) {
            return Some(Self::Circles(circles));
        }
        if is_oval(codes) {
            return Some(Self::Oval);
        }
        if is_omnimax(codes) {
            return Some(Self::Omnimax);
        }
        match circle::find(codes) {
            Some(found) if !is_domemaster(&found, codes) => Some(Self::Disc(found)),
            _ if is_round(codes) => Some(Self::Circle),
            _ => Twins::find(codes).map(Self::Twins),
        }
    }
}

/// Returns a copy with every so many columns and rows.
fn thinned(image: &EncodedImage, step: usize) -> Option<EncodedImage> {
    let (width, height, count) = (image.width() / step, image.height() / step, image.channels().count());
    let places = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
    let first = |(i, j): (usize, usize)| ((j * step + step / 2) * image.width() + i * step + step / 2) * count;
    let starts = places.map(first);
    let samples = match image.samples() {
        Samples::U8(all) => Samples::U8(chosen(all, starts, count)),
        Samples::U16(all) => Samples::U16(chosen(all, starts, count)),
        Samples::Half(all) => Samples::Half(chosen(all, starts, count)),
        Samples::Float(all) => Samples::Float(chosen(all, starts, count)),
    };
    let thinned = EncodedImage::new(width, height, image.channels(), image.depth(), samples).ok()?;
    Some(thinned.with_alpha_mode(image.alpha_mode()))
}

fn chosen<S: Copy>(all: &[S], starts: impl Iterator<Item = usize>, count: usize) -> Vec<S> {
    starts.flat_map(|start| all[start..start + count].iter().copied()).collect()
}

pub(crate) fn is_blank(around: Option<Uniform>) -> bool {
    around.is_some_and(|around| around.share >= BLANK)
}

/// Returns whether one colour surrounds a cross that is mirrored so.
fn is_cross(kind: LayoutKind, mirror: Mirror, codes: &Image<Rgba>) -> bool {
    let layout = CubeLayout::new(kind).mirrored(mirror);
    let Ok(edge) = layout.edge(codes.width(), codes.height()) else { return false };
    let faces = layout.faces(edge);
    let within = |k: usize, start: usize, end: usize| k + BLOCK >= start && k < end + BLOCK;
    let near = |rect: PixelRect, i, j| within(i, rect.left, rect.right) && within(j, rect.top, rect.bottom);
    is_blank(codes.uniformity(|i, j| !faces.iter().any(|face| near(face.rect, i, j))))
}

/// Returns whether a square is black around the circle that fills it.
pub(crate) fn is_round(codes: &Image<Rgba>) -> bool {
    let side = codes.width() as i64;
    if codes.width() != codes.height() {
        return false;
    }
    // In half pixels from the centre.
    let radius = side + 2 * BLOCK as i64;
    let outside = |i: usize, j: usize| {
        let (x, y) = (2 * i as i64 + 1 - side, 2 * j as i64 + 1 - side);
        x * x + y * y > radius * radius
    };
    is_black_where(codes, outside)
}

/// Returns whether nearly all of a region is black, or the region is empty.
fn is_black_where(codes: &Image<Rgba>, region: impl FnMut(usize, usize) -> bool) -> bool {
    let around = codes.uniformity(region);
    is_blank(around) && around.is_some_and(|around| is_black(&around.colour))
}

fn is_black(pixel: &Rgba) -> bool {
    pixel.alpha() == 0.0 || pixel.0[..3].iter().all(|code| *code <= BLACK)
}

/// Returns whether a circle fills a square, as far as it was measured.
fn is_domemaster(found: &Found, codes: &Image<Rgba>) -> bool {
    let (part, pixels) = EXACTLY;
    match found {
        Found::Measured(circle) => is_inscribed(circle, codes, pixels.max(part * codes.width() as f64)),
        Found::Roughly(circle) => fills(circle, codes),
    }
}

/// Returns whether a circle roughly fills a square.
pub(crate) fn fills(circle: &Circle, codes: &Image<Rgba>) -> bool {
    is_inscribed(circle, codes, ROUGHLY * codes.width() as f64)
}

fn is_inscribed(circle: &Circle, codes: &Image<Rgba>, reach: f64) -> bool {
    let half = codes.width() as f64 / 2.0;
    let (x, y) = circle.centre;
    codes.width() == codes.height() && [x, y, circle.radius].iter().all(|length| (length - half).abs() < reach)
}

/// Returns whether a picture is black outside an Omnimax frame of its size, and lit up to its left, right, upper and
/// lower limits. A smaller disc does not qualify.
fn is_omnimax(codes: &Image<Rgba>) -> bool {
    let (width, height) = (codes.width(), codes.height());
    let (right, bottom) = (width.saturating_sub(1), height.saturating_sub(1));
    // Most pictures have lit corners, and need no further test.
    let corners = [(0, 0), (right, 0), (0, bottom), (right, bottom)];
    if width <= height || !corners.iter().all(|(i, j)| is_black(codes.get(*i, *j))) {
        return false;
    }
    let Ok(view) = CameraModel::Omnimax(OmnimaxCamera::default()).view(width, height) else { return false };
    let shown = Image::from_fn(width, height, |i, j| view.screen_pixel(i, j).is_some());
    let hidden = shown.pixels().iter().filter(|shown| !**shown).count();
    // In a frame that shows nearly everything, too little is hidden to tell.
    if 10 * hidden < width * height {
        return false;
    }
    let lit = |i: usize, j: usize| !is_black(codes.get(i, j));
    let (Some(expected), Some(found)) = (extent(&shown, |i, j| *shown.get(i, j)), extent(codes, lit)) else {
        return false;
    };
    let reach = BLOCK + width / 50;
    let is_far = |i: usize, j: usize| {
        let near = |k: usize, size: usize, at: usize| (k + at).clamp(BLOCK, size + BLOCK - 1) - BLOCK;
        [0, BLOCK, 2 * BLOCK]
            .iter()
            .all(|x| [0, BLOCK, 2 * BLOCK].iter().all(|y| !*shown.get(near(i, width, *x), near(j, height, *y))))
    };
    expected.iter().zip(found).all(|(expected, found)| expected.abs_diff(found) <= reach)
        && is_black_where(codes, is_far)
}

/// Returns the first and last column and row of the chosen pixels.
fn extent<P>(image: &Image<P>, chosen: impl Fn(usize, usize) -> bool) -> Option<[usize; 4]> {
    let mut extent: Option<[usize; 4]> = None;
    for j in 0..image.height() {
        for i in (0..image.width()).filter(|i| chosen(*i, j)) {
            let [left, right, top, bottom] = extent.unwrap_or([i, i, j, j]);
            extent = Some([left.min(i), right.max(i), top.min(j), bottom.max(j)]);
        }
    }
    extent
}
