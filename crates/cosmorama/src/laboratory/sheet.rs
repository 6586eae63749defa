use super::crops::{CROP, Crop};
use crate::explain::lettering;
use crate::raster::{Image, Rgba};

/// One filter's row of a sheet.
pub struct Row {
    /// Lines of text before the crops.
    pub label: Vec<String>,
    /// Crops, all of the same places.
    pub crops: Vec<Image<Rgba>>,
}

/// Pixels along a side of a pixel of a crop.
const ZOOM: usize = 2;

/// Pixels between crops.
const GAP: usize = 6;

/// Width of the text before the crops.
const LABEL: usize = 280;

/// Height of capitals.
const CAPITALS: f64 = 11.0;

impl Row {
    /// Cuts the places out of a filter's picture.
    pub fn new(label: Vec<String>, picture: &Image<Rgba>, places: &[Crop]) -> Self {
        let cut = |&(left, top): &Crop| Image::from_fn(CROP, CROP, |i, j| *picture.get(left + i, top + j));
        Self { label, crops: places.iter().map(cut).collect() }
    }
}

/// Lays rows of crops under one another, with their texts, in linear light.
pub fn sheet(rows: &[Row]) -> Image<Rgba> {
    let tile = CROP * ZOOM + GAP;
    let columns = rows.iter().map(|row| row.crops.len()).max().unwrap_or(0);
    let (width, height) = (LABEL + columns * tile + GAP, rows.len() * tile + GAP);
    let mut image = Image::filled(width, height, Rgba::opaque(0.02, 0.02, 0.025));
    for (number, row) in rows.iter().enumerate() {
        let top = GAP + number * tile;
        for (column, crop) in row.crops.iter().enumerate() {
            place(&mut image, crop, (LABEL + column * tile, top));
        }
        for (line, text) in row.label.iter().enumerate() {
            write(&mut image, text, (2.0 * GAP as f64, top as f64 + 1.9 * CAPITALS * (line as f64 + 1.0)));
        }
    }
    image
}

/// Puts a crop into a sheet, enlarged.
fn place(image: &mut Image<Rgba>, crop: &Image<Rgba>, (left, top): (usize, usize)) {
    let width = image.width();
    for (i, j) in (0..CROP * ZOOM).flat_map(|j| (0..CROP * ZOOM).map(move |i| (i, j))) {
        let Rgba([red, green, blue, _]) = *crop.get(i / ZOOM, j / ZOOM);
        image.pixels_mut()[(top + j) * width + left + i] = Rgba::opaque(red, green, blue);
    }
}

/// Writes a line of text from a baseline's start.
fn write(image: &mut Image<Rgba>, text: &str, (x, y): (f64, f64)) {
    let (lines, _) = lettering::polylines(text);
    for line in &lines {
        for pair in line.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|(u, v)| (x + u * CAPITALS, y + v * CAPITALS));
            stroke(image, from, to);
        }
    }
}

/// Draws a line that is a pixel and a half wide.
fn stroke(image: &mut Image<Rgba>, from: (f64, f64), to: (f64, f64)) {
    let span = |a: f64, b: f64, size: usize| {
        let (least, most) = (a.min(b) - 2.0, a.max(b) + 2.0);
        (least.max(0.0) as usize)..(most.max(0.0) as usize).min(size)
    };
    let (columns, rows, width) = (span(from.0, to.0, image.width()), span(from.1, to.1, image.height()), image.width());
    for (i, j) in rows.flat_map(|j| columns.clone().map(move |i| (i, j))) {
        let distance = distance((i as f64 + 0.5, j as f64 + 0.5), from, to);
        let ink = (1.25 - distance).clamp(0.0, 1.0) as f32;
        let pixel = &mut image.pixels_mut()[j * width + i];
        *pixel = *pixel * (1.0 - ink) + Rgba::opaque(0.8, 0.8, 0.8) * ink;
    }
}

/// Returns the distance of a point from a line between two points.
fn distance(at: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let square = dx * dx + dy * dy;
    let along = ((at.0 - from.0) * dx + (at.1 - from.1) * dy) / square.max(f64::MIN_POSITIVE);
    let along = along.clamp(0.0, 1.0);
    (at.0 - from.0 - along * dx).hypot(at.1 - from.1 - along * dy)
}
