use cosmorama::raster::{ColourChannel, Image, Rgba, Transfer};

/// Frames that a contact sheet shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SheetLayout {
    /// Distance of the frames that are shown, 1 at least; the first is.
    pub every: usize,
}

/// Longest side of a small picture, in pixels.
const EDGE: usize = 160;

/// Pixels between small pictures, and above and below their numbers.
const GAP: usize = 4;

/// Digits of 3 × 5 dots, row by row from the highest bit.
const DIGITS: [u16; 10] = [
    0b111_101_101_101_111,
    0b010_110_010_010_111,
    0b111_001_111_100_111,
    0b111_001_111_001_111,
    0b101_101_111_001_001,
    0b111_100_111_001_111,
    0b111_100_111_101_111,
    0b111_001_010_010_010,
    0b111_101_111_101_111,
    0b111_101_111_001_111,
];

/// Columns and rows of a digit's dots.
const DOTS: [usize; 2] = [3, 5];

/// Pixels of a dot along each side.
const DOT: usize = 2;

/// Rows of a number, with those above it.
const NUMBER: usize = GAP + DOTS[1] * DOT;

/// A frame on a contact sheet.
pub(super) struct Shown<'a> {
    pub(super) number: u64,
    /// Small picture, if the frame is whole.
    pub(super) picture: Option<&'a Image<[u8; 3]>>,
    /// Whether it has faults: its number is red.
    pub(super) is_faulty: bool,
}

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
    let [width, height] = [EDGE.max(width_of(u64::MAX)) + GAP, EDGE + NUMBER + GAP];
    ((columns * rows) as u64).saturating_mul((width * height * pixel) as u64)
}

/// Lays frames out, row by row, on black: small pictures with their numbers below.
pub(super) fn of(frames: &[Shown]) -> Image<Rgba> {
    let [columns, rows] = grid(frames.len());
    let pictures = || frames.iter().filter_map(|frame| frame.picture);
    let widths = pictures().map(Image::width).chain(frames.iter().map(|frame| width_of(frame.number)));
    let width = widths.max().unwrap_or(1) + GAP;
    let below = pictures().map(Image::height).max().unwrap_or(1);
    let height = below + NUMBER + GAP;
    let decode = |code: usize| Transfer::Srgb.decode(code as f64 / 255.0, ColourChannel::Red) as f32;
    let lights: [f32; 256] = std::array::from_fn(decode);
    Image::from_fn(columns * width - GAP, rows * height - GAP, |i, j| {
        let Some(frame) = frames.get(j / height * columns + i / width) else { return Rgba::BLACK };
        let (x, y) = (i % width, j % height);
        if y >= below + GAP && has_dot(frame.number, [x, y - below - GAP]) {
            return if frame.is_faulty { Rgba::opaque(1.0, 0.1, 0.1) } else { Rgba::opaque(0.5, 0.5, 0.5) };
        }
        let shown = frame.picture.filter(|picture| x < picture.width() && y < picture.height());
        shown.map_or(Rgba::BLACK, |picture| {
            let [red, green, blue] = picture.get(x, y).map(|code| lights[usize::from(code)]);
            Rgba::opaque(red, green, blue)
        })
    })
}

/// Returns the columns of a number: a dot's width lies between digits.
fn width_of(number: u64) -> usize {
    let digits = number.checked_ilog10().unwrap_or(0) as usize + 1;
    (digits * (DOTS[0] + 1) - 1) * DOT
}

/// Returns whether a pixel of a number's is set.
fn has_dot(number: u64, [x, y]: [usize; 2]) -> bool {
    let ([column, row], digits) = ([x / DOT, y / DOT], number.to_string());
    let digit = digits.as_bytes().get(column / (DOTS[0] + 1)).map(|digit| DIGITS[usize::from(digit - b'0')]);
    let column = column % (DOTS[0] + 1);
    let dot = (column < DOTS[0] && row < DOTS[1]).then(|| DOTS[0] * DOTS[1] - 1 - (row * DOTS[0] + column));
    digit.zip(dot).is_some_and(|(digit, dot)| digit >> dot & 1 == 1)
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
        let shown = |number: u64| Shown { number, picture: (number != 7).then_some(&small), is_faulty: number == 7 };
        let sheet = of(&[5, 6, 7, 8, 9].map(shown));
        assert_eq!((sheet.width(), sheet.height()), (3 * 160 + 2 * GAP, 2 * (80 + NUMBER) + GAP));
        assert_eq!(codes(sheet.get(0, 0)), *small.get(0, 0));
        assert_eq!(codes(sheet.get(487, 177)), [0; 3]);
        // Frame 7 is not whole: there is its number, alone and red.
        assert_eq!((codes(sheet.get(2 * 164, 0)), codes(sheet.get(2 * 164, 84))[0]), ([0; 3], 255));
        assert!(size_of_val(sheet.pixels()) as u64 <= bytes(5));
        let none = of(&[shown(7)]);
        assert_eq!((none.width(), none.height()), (6, 1 + NUMBER));
    }

    #[test]
    fn numbers_can_be_read() {
        let drawn = |number: u64| {
            let row = |y: usize| {
                let dots = (0..width_of(number)).step_by(DOT).map(|x| if has_dot(number, [x, y]) { '#' } else { '.' });
                dots.collect::<String>()
            };
            (0..DOTS[1]).map(|line| row(DOT * line)).collect::<Vec<_>>()
        };
        assert_eq!(drawn(17), [".#..###", "##....#", ".#...#.", ".#...#.", "###..#."]);
        assert_eq!(drawn(0), ["###", "#.#", "#.#", "#.#", "###"]);
        assert_eq!(drawn(84), ["###.#.#", "#.#.#.#", "###.###", "#.#...#", "###...#"]);
        assert_eq!(drawn(u64::MAX)[0].len(), 20 * 4 - 1);
    }

    #[test]
    fn every_third_of_seven_is_three() {
        let layout = SheetLayout { every: 3 };
        assert_eq!((0..7).filter(|index| layout.shows(*index)).collect::<Vec<_>>(), [0, 3, 6]);
        assert_eq!(layout.count(7), 3);
    }
}
