use crate::raster::{Image, Rgba};

/// Columns and rows of cells over which pictures are averaged. Near objects are displaced by a few pixels between two
/// eyes.
const CELLS: (usize, usize) = (32, 16);
/// Least number of cells that allow a judgement.
const LEAST: usize = 64;
/// Mean square below which a cell has no content.
const FLAT: f64 = 1e-5;

/// Returns the similarity of two pictures of one size: the correlation of their contents along rows, from −1 to 1. The
/// two eyes of a stereo pair are close to 1, unrelated pictures near 0. The average of a row is ignored, because most
/// pictures have their sky above, and so are pixels for which `counts` is false. `None` if sizes differ, or there is
/// too little content.
pub fn likeness(a: &Image<Rgba>, b: &Image<Rgba>, counts: impl Fn(usize, usize) -> bool) -> Option<f64> {
    if (a.width(), a.height()) != (b.width(), b.height()) || a.width() < CELLS.0 || a.height() < CELLS.1 {
        return None;
    }
    let mut cells = vec![Cell::default(); CELLS.0 * CELLS.1];
    for j in 0..a.height() {
        for i in (0..a.width()).filter(|i| counts(*i, j)) {
            let (column, row) = (i * CELLS.0 / a.width(), j * CELLS.1 / a.height());
            cells[row * CELLS.0 + column].add(brightness(a.get(i, j)), brightness(b.get(i, j)));
        }
    }
    let (mut aa, mut ab, mut bb, mut count) = (0.0, 0.0, 0.0, 0);
    for row in cells.chunks(CELLS.0) {
        let full: Vec<[f64; 2]> = row.iter().filter_map(Cell::mean).collect();
        let mean = |side: usize| full.iter().map(|cell| cell[side]).sum::<f64>() / full.len() as f64;
        let means = [mean(0), mean(1)];
        for cell in &full {
            let (x, y) = (cell[0] - means[0], cell[1] - means[1]);
            (aa, ab, bb) = (aa + x * x, ab + x * y, bb + y * y);
        }
        count += full.len();
    }
    let shows = count >= LEAST && aa.min(bb) > FLAT * count as f64;
    shows.then(|| ab / (aa * bb).sqrt())
}

/// Sums over a part of two pictures.
#[derive(Clone, Copy, Default)]
struct Cell {
    sums: [f64; 2],
    pixels: usize,
}

impl Cell {
    fn add(&mut self, a: f64, b: f64) {
        self.sums = [self.sums[0] + a, self.sums[1] + b];
        self.pixels += 1;
    }

    fn mean(&self) -> Option<[f64; 2]> {
        (self.pixels > 0).then(|| self.sums.map(|sum| sum / self.pixels as f64))
    }
}

/// Returns the brightness of a pixel in code values, bounded so that a sun in a float picture does not dominate.
fn brightness(pixel: &Rgba) -> f64 {
    let sum: f32 = pixel.0[..3].iter().map(|code| if code.is_finite() { code.clamp(0.0, 1.0) } else { 1.0 }).sum();
    f64::from(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shifted(seed: usize, by: usize) -> Image<Rgba> {
        Image::from_fn(128, 64, |i, j| {
            let (x, y) = (((i + by) / 8) as u32, (j / 8) as u32);
            let code =
                (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503) ^ (seed as u32 * 977)).wrapping_mul(48_271);
            let sky = 0.4 * j as f32 / 64.0;
            let light = sky + 0.5 * ((code >> 16) & 255) as f32 / 255.0;
            Rgba::opaque(light, light, light)
        })
    }

    #[test]
    fn pictures_for_two_eyes_are_alike_and_others_are_not() {
        let all = |_: usize, _: usize| true;
        assert!(likeness(&shifted(1, 0), &shifted(1, 0), all).unwrap() > 0.999_999);
        assert!(likeness(&shifted(1, 0), &shifted(1, 2), all).unwrap() > 0.8);
        assert!(likeness(&shifted(1, 0), &shifted(2, 0), all).unwrap().abs() < 0.4);
        let sky = Image::from_fn(128, 64, |_, j| Rgba::opaque(0.0, 0.0, j as f32 / 64.0));
        assert_eq!(likeness(&sky, &sky, all), None);
        assert_eq!(likeness(&sky, &Image::filled(9, 9, Rgba::BLACK), all), None);
    }
}
