use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};

/// Frames that a contact sheet shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SheetLayout {
    /// Distance of the frames that are shown.
    pub every: u64,
}

/// Longest side of a small picture, in pixels.
const EDGE: usize = 160;

/// Pixels between small pictures.
const GAP: usize = 4;

impl SheetLayout {
    /// Returns whether a frame is shown, given the first.
    pub(super) fn shows(self, first: u64, frame: u64) -> bool {
        (frame - first).is_multiple_of(self.every.max(1))
    }
}

/// Lays small pictures out, row by row, on black.
pub(super) fn of<'a>(pictures: impl Iterator<Item = &'a Image<Rgba>>) -> Image<Rgba> {
    let pictures: Vec<&Image<Rgba>> = pictures.collect();
    let columns = (1..).find(|columns| columns * columns >= pictures.len()).unwrap_or(1);
    let rows = pictures.len().div_ceil(columns);
    let width = pictures.iter().map(|picture| picture.width()).max().unwrap_or(1) + GAP;
    let height = pictures.iter().map(|picture| picture.height()).max().unwrap_or(1) + GAP;
    Image::from_fn((columns * width - GAP).max(1), (rows.max(1) * height - GAP).max(1), |i, j| {
        let picture = pictures.get(j / height * columns + i / width);
        let (x, y) = (i % width, j % height);
        let shown = picture.filter(|picture| x < picture.width() && y < picture.height());
        shown.map_or(Rgba::BLACK, |picture| *picture.get(x, y))
    })
}

/// Returns a small picture of a frame.
pub(super) fn thumbnail(light: &Image<Rgba>) -> Image<Rgba> {
    let longest = light.width().max(light.height()).max(1);
    let part = |side: usize| (side * EDGE / longest).clamp(1, side.max(1));
    reduced(
        light,
        if longest <= EDGE { [light.width(), light.height()] } else { [part(light.width()), part(light.height())] },
    )
}

/// Returns the means of the parts of a picture, each of whole pixels.
pub(super) fn reduced(light: &Image<Rgba>, [columns, rows]: [usize; 2]) -> Image<Rgba> {
    let part = |at: usize, parts: usize, side: usize| {
        let first = at * side / parts;
        first..((at + 1) * side / parts).max(first + 1).min(side)
    };
    Image::from_fn(columns, rows, |i, j| {
        let (across, down) = (part(i, columns, light.width()), part(j, rows, light.height()));
        let count = (across.len() * down.len()).max(1);
        let pixels = down.flat_map(|y| &light.row(y)[across.clone()]);
        pixels.fold(Rgba::TRANSPARENT, |sum, pixel| sum + *pixel) * (count as f32).recip()
    })
}

/// Returns a colour as codes of sRGB.
pub(super) fn codes(light: &Rgba) -> [u8; 3] {
    let code = |light: f32, channel| {
        let light = f64::from(light.clamp(0.0, 1.0));
        (255.0 * Transfer::Srgb.encode(light, channel) + 0.5) as u8
    };
    let [red, green, blue, _] = light.0;
    [code(red, ColourChannel::Red), code(green, ColourChannel::Green), code(blue, ColourChannel::Blue)]
}
