use crate::raster::{Image, Rgba};

/// Side of a crop, in pixels.
pub const CROP: usize = 64;

/// Left and upper edge of a crop.
pub type Crop = (usize, usize);

/// Finds up to so many places of a picture with most detail, where all pixels count, busiest first.
pub fn busiest(picture: &Image<Rgba>, counts: impl Fn(usize, usize) -> bool, most: usize) -> Vec<Crop> {
    let places = |size: usize| (0..size / CROP).map(|k| k * CROP);
    let tiles = places(picture.height()).flat_map(|top| places(picture.width()).map(move |left| (left, top)));
    let whole = |&(left, top): &Crop| (0..CROP * CROP).all(|k| counts(left + k % CROP, top + k / CROP));
    let mut tiles: Vec<(f64, Crop)> = tiles.filter(whole).map(|tile| (detail(picture, tile), tile)).collect();
    tiles.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let mut chosen: Vec<Crop> = Vec::new();
    for (_, tile) in tiles {
        let is_near = |other: &Crop| tile.0.abs_diff(other.0).max(tile.1.abs_diff(other.1)) <= 2 * CROP;
        if chosen.len() < most && !chosen.iter().any(is_near) {
            chosen.push(tile);
        }
    }
    chosen
}

/// Returns the sum of squared differences between neighbours, in rows and in columns.
fn detail(picture: &Image<Rgba>, (left, top): Crop) -> f64 {
    let difference = |a: Rgba, b: Rgba| (0..3).map(|c| f64::from(a.0[c] - b.0[c]).powi(2)).sum::<f64>();
    let row = |j: usize| &picture.row(j)[left..left + CROP];
    let along = |j: usize| row(j).windows(2).map(|pair| difference(pair[0], pair[1])).sum::<f64>();
    let below = |j: usize| row(j).iter().zip(row(j + 1)).map(|(a, b)| difference(*a, *b)).sum::<f64>();
    (top..top + CROP).map(along).sum::<f64>() + (top..top + CROP - 1).map(below).sum::<f64>()
}
