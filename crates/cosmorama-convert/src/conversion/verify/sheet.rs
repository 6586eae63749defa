use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};

/// Frames that a contact sheet shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SheetLayout {
    /// Distance of the frames that are shown, 1 at least; the first is.
    pub every: usize,
}

/// Longest side of a small picture, in pixels.
const EDGE: usize = 160;

/// Pixels between small pictures.
const GAP: usize = 4;

impl SheetLayout {
    /// Returns whether a frame is shown, given its place among all.
    pub(super) fn shows(self, index: usize) -> bool {
        index.is_multiple_of(self.every.max(1))
    }

    /// Returns how many of so many frames are shown.
    pub(super) fn count(self, frames: usize) -> usize {
        frames.div_ceil(self.every.max(1))
    }
}

/// Returns the columns and rows in which so many pictures are laid out.
fn grid(pictures: usize) -> [usize; 2] {
    let columns = (1..).find(|columns| columns * columns >= pictures).unwrap_or(1);
    [columns, pictures.div_ceil(columns).max(1)]
}

/// Returns the bytes of so many small pictures, their sheet, and its samples in a file, which may be floats.
pub(super) fn bytes(pictures: usize) -> u64 {
    let [columns, rows] = grid(pictures);
    let pixel = size_of::<[u8; 3]>() + size_of::<Rgba>() + size_of::<[f32; 3]>();
    ((columns * rows) as u64).saturating_mul(((EDGE + GAP) * (EDGE + GAP) * pixel) as u64)
}

/// Lays small pictures out, row by row, on black.
pub(super) fn of<'a>(pictures: impl Iterator<Item = &'a Image<[u8; 3]>>) -> Image<Rgba> {
    let pictures: Vec<&Image<[u8; 3]>> = pictures.collect();
    let [columns, rows] = grid(pictures.len());
    let width = pictures.iter().map(|picture| picture.width()).max().unwrap_or(1) + GAP;
    let height = pictures.iter().map(|picture| picture.height()).max().unwrap_or(1) + GAP;
    let decode = |code: usize| Transfer::Srgb.decode(code as f64 / 255.0, ColourChannel::Red) as f32;
    let lights: [f32; 256] = std::array::from_fn(decode);
    Image::from_fn(columns * width - GAP, rows * height - GAP, |i, j| {
        let picture = pictures.get(j / height * columns + i / width);
        let (x, y) = (i % width, j % height);
        let shown = picture.filter(|picture| x < picture.width() && y < picture.height());
        shown.map_or(Rgba::BLACK, |picture| {
            let [red, green, blue] = picture.get(x, y).map(|code| lights[usize::from(code)]);
            Rgba::opaque(red, green, blue)
        })
    })
}

/// Returns a small picture of a frame, in codes of sRGB.
pub(super) fn thumbnail(light: &Image<Rgba>) -> Image<[u8; 3]> {
    let longest = light.width().max(light.height()).max(1);
    let part = |side: usize| if longest <= EDGE { side } else { (side * EDGE / longest).max(1) };
    let [columns, rows] = [part(light.width()), part(light.height())];
    let small = reduced(light, [columns, rows]);
    Image::from_fn(columns, rows, |i, j| codes(small.get(i, j)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_keep_their_shape_and_fit_the_bytes_told() {
        let picture = Image::filled(400, 200, Rgba::opaque(0.5, 0.25, 1.0));
        let small = thumbnail(&picture);
        assert_eq!((small.width(), small.height(), *small.get(0, 0)), (160, 80, codes(picture.get(0, 0))));
        let sheet = of([&small; 5].into_iter());
        assert_eq!((sheet.width(), sheet.height()), (3 * 160 + 2 * GAP, 2 * 80 + GAP));
        assert_eq!(codes(sheet.get(0, 0)), *small.get(0, 0));
        assert_eq!(codes(sheet.get(487, 163)), [0; 3]);
        assert!(size_of_val(sheet.pixels()) as u64 <= bytes(5));
    }

    #[test]
    fn every_third_of_seven_is_three() {
        let layout = SheetLayout { every: 3 };
        assert_eq!((0..7).filter(|index| layout.shows(*index)).collect::<Vec<_>>(), [0, 3, 6]);
        assert_eq!(layout.count(7), 3);
    }
}
