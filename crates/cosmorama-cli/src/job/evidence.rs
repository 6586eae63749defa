//! What the pixels of an image say about its projection.

use std::path::Path;

use cosmorama::circle::{self, Circle, Found};
use cosmorama::raster::{EncodedImage, Image, Rgba, Transfer, Uniform};
use cosmorama::world::{CubeLayout, LayoutKind, PixelRect};
use cosmorama_io::{Header, Limits, probe, read};

use super::memory::light_bytes;

/// Beyond this an image is not decoded only to find out what it is.
const MOST_BYTES: u64 = 1 << 30;
/// Of what should be blank, so much must be.
const BLANK: f64 = 0.98;
/// A picture of which more is blank shows nothing that could tell.
const EMPTY: f64 = 0.9;
/// Pixels around what is drawn that a JPEG file's blocks may blur into.
const BLOCK: usize = 8;
/// A circle that fills a square does so to this part of it.
const ROUND: f64 = 0.02;
/// Codes up to this are black, in a picture of codes from 0 to 1.
const BLACK: f32 = 0.06;

/// The light of an image, as far as it matters to see what it is; `None` where it is too large or damaged.
pub(crate) fn light_of(path: &Path) -> Option<Image<Rgba>> {
    let image = decoded(path)?;
    let transfer = if image.depth().is_float() { Transfer::Linear } else { Transfer::Srgb };
    Some(image.to_light(&transfer))
}

fn decoded(path: &Path) -> Option<EncodedImage> {
    // Light takes more memory than the samples that it is made of.
    if light_bytes(&probe(path).ok()?) > MOST_BYTES {
        return None;
    }
    Some(read(path, &Limits::memory(MOST_BYTES)).ok()?.image)
}

/// What an image is, as far as its blank parts tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Evidence {
    /// A circle that fills a square, black around it.
    Circle,
    /// A cross of faces, one colour around it.
    Cross(LayoutKind),
    /// A circle somewhere, black around it.
    Disc(Found),
}

impl Evidence {
    /// Looks at the pixels: at what its shape gives reason to expect first.
    pub(super) fn of(path: &Path, header: &Header) -> Option<Self> {
        if header.window.is_some() {
            return None;
        }
        let codes = decoded(path)?.to_light(&Transfer::Linear);
        let is_empty = codes.uniformity(|_, _| true).is_none_or(|all| all.share >= EMPTY);
        let crosses = [LayoutKind::CrossH, LayoutKind::CrossV];
        if let Some(kind) = crosses.into_iter().find(|kind| !is_empty && is_cross(*kind, &codes)) {
            return Some(Self::Cross(kind));
        }
        match circle::find(&codes) {
            Some(found) if !fills(&found.circle(), &codes) => Some(Self::Disc(found)),
            _ => (!is_empty && is_round(&codes)).then_some(Self::Circle),
        }
    }
}

fn is_blank(around: Option<Uniform>) -> bool {
    around.is_some_and(|around| around.share >= BLANK)
}

/// Whether one colour surrounds a cross.
fn is_cross(kind: LayoutKind, codes: &Image<Rgba>) -> bool {
    let layout = CubeLayout::new(kind);
    let Ok(edge) = layout.edge(codes.width(), codes.height()) else { return false };
    let faces = layout.faces(edge);
    let within = |k: usize, start: usize, end: usize| k + BLOCK >= start && k < end + BLOCK;
    let near = |rect: PixelRect, i, j| within(i, rect.left, rect.right) && within(j, rect.top, rect.bottom);
    is_blank(codes.uniformity(|i, j| !faces.iter().any(|face| near(face.rect, i, j))))
}

/// Whether a square is black around the circle that fills it.
fn is_round(codes: &Image<Rgba>) -> bool {
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
    let around = codes.uniformity(outside);
    let is_black =
        |around: Uniform| around.colour.alpha() == 0.0 || around.colour.0[..3].iter().all(|code| *code <= BLACK);
    is_blank(around) && around.is_some_and(is_black)
}

/// Whether a circle is the one that fills a square.
fn fills(circle: &Circle, codes: &Image<Rgba>) -> bool {
    let (half, reach) = (codes.width() as f64 / 2.0, ROUND * codes.width() as f64);
    let (x, y) = circle.centre;
    codes.width() == codes.height() && [x, y, circle.radius].iter().all(|length| (length - half).abs() < reach)
}
