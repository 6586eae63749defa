use rayon::prelude::*;

use crate::camera::{PixelPoint, View};
use crate::raster::Rgba;

/// Texels that are cut by the edge of a view's field of view, such as the rim of a circle, ball or oval map.
///
/// A picture's rim may have been antialiased. Then its texels are mixed with the surroundings, and a conversion would
/// show the rim; in an oval map it would be a line from pole to pole. Or the texels hold unmixed light. Whichever
/// better matches the whole texels beside them is assumed. Mixed texels must be restored before a world is filled with
/// the light of pictures.
#[derive(Clone, Debug, Default)]
pub struct RimTexels {
    /// Columns and rows of the view.
    size: [usize; 2],
    texels: Vec<RimTexel>,
    /// Neighbours of the rim texels, as indices in reading order.
    beside: Vec<u32>,
}

#[derive(Clone, Debug)]
struct RimTexel {
    at: u32,
    /// Fraction of the texel inside the field of view.
    coverage: f32,
    /// Index of the texel's first neighbour, number of whole neighbours, and number of neighbours after them that show
    /// nothing.
    first: usize,
    whole: u8,
    outside: u8,
}

/// Tolerance for 8-bit codes, as a fraction of the surrounding light.
const ROUNDING: f32 = 0.02;

/// Side of the blocks, in pixels, whose corners show whether the edge may cut a pixel of the block.
const BLOCK: usize = 8;

impl RimTexels {
    /// Finds the texels of a view that the edge of its field of view cuts.
    pub fn of(view: &View) -> Self {
        let mut found = Self { size: [view.width(), view.height()], ..Self::default() };
        // Fields of view are nearly convex: one that holds the corners of the image holds all of it.
        let is_full = corners_shown(view, [0, 0], view.width().max(view.height())) == 4;
        if is_full || view.projection.ends_between_samples() {
            return found;
        }
        let blocks = (0..view.height().div_ceil(BLOCK)).into_par_iter().flat_map_iter(|j| cut_blocks(view, j * BLOCK));
        let blocks: Vec<[usize; 2]> = blocks.collect();
        let cut: Vec<([usize; 2], f32)> =
            blocks.into_par_iter().flat_map_iter(|block| cut_texels(view, block)).collect();
        cut.iter().for_each(|(texel, coverage)| found.add(view, *texel, *coverage));
        found
    }

    fn add(&mut self, view: &View, [i, j]: [usize; 2], coverage: f32) {
        let (rows, columns) =
            (j.saturating_sub(1)..(j + 2).min(view.height()), i.saturating_sub(1)..(i + 2).min(view.width()));
        let beside = rows.flat_map(|j| columns.clone().map(move |i| (i, j))).filter(|at| *at != (i, j));
        let (mut whole, mut outside) = (Vec::new(), Vec::new());
        for (i, j) in beside {
            let into = match corners_shown(view, [i, j], 1) {
                4 => &mut whole,
                0 => &mut outside,
                _ => continue,
            };
            into.push((j * view.width() + i) as u32);
        }
        let at = (j * view.width() + i) as u32;
        let (first, counts) = (self.beside.len(), [&whole, &outside].map(|texels| texels.len() as u8));
        self.texels.push(RimTexel { at, coverage, first, whole: counts[0], outside: counts[1] });
        self.beside.extend(whole.into_iter().chain(outside));
    }

    /// Restores the rim texels in a view's light, which is linear and premultiplied by alpha. All rows have one length,
    /// which may exceed the view's width. `light` and `texel` convert between texels of any type and light.
    ///
    /// # Panics
    /// When the number of rows is wrong, or rows are shorter than the view's width.
    pub fn restore<T: Copy>(&self, texels: &mut [T], light: impl Fn(T) -> Rgba, texel: impl Fn(Rgba) -> T) {
        let [columns, rows] = self.size.map(|length| length.max(1));
        let pitch = texels.len() / rows;
        assert!(pitch * rows == texels.len() && pitch >= self.size[0], "rows of the view's light");
        let index = |at: u32| at as usize / columns * pitch + at as usize % columns;
        let mean = |texels: &[T], of: &[u32]| {
            let sum = of.iter().map(|at| light(texels[index(*at)])).fold(Rgba::TRANSPARENT, |a, b| a + b);
            (!of.is_empty()).then(|| sum * (of.len() as f32).recip())
        };
        // Where the rim touches the image's border, the surroundings are taken to be as they are elsewhere.
        let outside: Vec<u32> = self.texels.iter().flat_map(|rim| self.beside(rim)[1]).copied().collect();
        let around = mean(texels, &outside).unwrap_or(Rgba::TRANSPARENT);
        let (mut unmixed, mut is_mixed) = (Vec::new(), Mixture::default());
        for rim in &self.texels {
            let [whole, outside] = self.beside(rim).map(|beside| mean(texels, beside));
            // Without a whole texel beside it, a texel cannot be tested.
            let Some(expected) = whole else { continue };
            let (found, around) = (light(texels[index(rim.at)]), outside.unwrap_or(around));
            is_mixed.add(found, expected, (around, rim.coverage));
            unmixed.extend(inside(found, around, rim.coverage).map(|inside| (rim.at, inside)));
        }
        // All texels are restored or none: a single texel may look like either, and would flicker.
        if is_mixed.is_likely() {
            unmixed.into_iter().for_each(|(at, inside)| texels[index(at)] = texel(inside));
        }
    }

    /// Returns a texel's neighbours: whole ones, and those that show nothing.
    fn beside(&self, rim: &RimTexel) -> [&[u32]; 2] {
        let (whole, rest) = self.beside[rim.first..].split_at(usize::from(rim.whole));
        [whole, &rest[..usize::from(rim.outside)]]
    }
}

/// Returns the light of the inner part of a texel that is mixed with its surroundings. `None` if it would be darker
/// than black, because then the texel is no mixture.
fn inside(Rgba(mixed): Rgba, Rgba(around): Rgba, coverage: f32) -> Option<Rgba> {
    let part = |channel: usize| (mixed[channel] - (1.0 - coverage) * around[channel]) / coverage;
    let parts: [f32; 4] = std::array::from_fn(part);
    let is_light = |channel: usize| parts[channel] >= mixed[channel].min(0.0) - ROUNDING * around[channel].abs();
    let [red, green, blue, alpha] = std::array::from_fn(|channel| parts[channel].max(mixed[channel].min(0.0)));
    (0..4).all(is_light).then(|| Rgba([red, green, blue, alpha.min(1.0)]))
}

/// Least-squares test of whether texels are mixtures: where they lie between the expected whole texels and the expected
/// mixtures. It uses all rim texels, so it works for rough pictures too.
#[derive(Default)]
struct Mixture {
    way: f64,
    whole_way: f64,
}

impl Mixture {
    fn add(&mut self, Rgba(found): Rgba, Rgba(expected): Rgba, (Rgba(around), coverage): (Rgba, f32)) {
        // Where the surroundings are transparent and the texels inside are not, alpha alone decides.
        let channels = if expected[3] - around[3] > 0.5 { 3..4 } else { 0..3 };
        for channel in channels {
            let step = f64::from((1.0 - coverage) * (around[channel] - expected[channel]));
            self.way += step * f64::from(found[channel] - expected[channel]);
            self.whole_way += step * step;
        }
    }

    fn is_likely(&self) -> bool {
        self.way > 0.5 * self.whole_way
    }
}

/// Returns how many corners of a square of texels show something.
fn corners_shown(view: &View, [i, j]: [usize; 2], size: usize) -> usize {
    let (right, below) = ((i + size).min(view.width()), (j + size).min(view.height()));
    let corners = [(i, j), (right, j), (i, below), (right, below)];
    corners.into_iter().filter(|(x, y)| view.shows(PixelPoint::new(*x as f64, *y as f64))).count()
}

/// Visits the blocks in a row that the edge may cut.
fn cut_blocks(view: &View, top: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
    let blocks = (0..view.width()).step_by(BLOCK).map(move |left| [left, top]);
    blocks.filter(move |block| (1..4).contains(&corners_shown(view, *block, BLOCK)))
}

/// Returns the texels of a block that the edge cuts and whose centre shows something; others have no weight.
fn cut_texels(view: &View, [left, top]: [usize; 2]) -> Vec<([usize; 2], f32)> {
    let (rows, columns) = (top..(top + BLOCK).min(view.height()), left..(left + BLOCK).min(view.width()));
    let texels = rows.flat_map(|j| columns.clone().map(move |i| [i, j]));
    let cut = texels.filter(|texel| (0..4).contains(&corners_shown(view, *texel, 1)));
    let coverage = |[i, j]: [usize; 2]| {
        let is_seen = view.shows(PixelPoint::centre(i, j));
        let coverage = if is_seen { view.screen_pixel(i, j)?.coverage as f32 } else { return None };
        (coverage < 1.0).then_some(([i, j], coverage))
    };
    cut.filter_map(coverage).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, EquirectCamera, FisheyeCamera, MirrorBallCamera, OmnimaxCamera, WorldMapCamera};

    fn view(frame: CameraModel) -> View {
        frame.view(80, frame.natural_height(80)).expect("a view")
    }

    fn rims() -> [View; 4] {
        [
            CameraModel::WorldMap(WorldMapCamera::Hammer),
            CameraModel::Fisheye(FisheyeCamera::default()),
            CameraModel::MirrorBall(MirrorBallCamera::default()),
            CameraModel::Omnimax(OmnimaxCamera::default()),
        ]
        .map(view)
    }

    /// Returns a gradient, mixed with its surroundings by each texel's coverage if `mixed`.
    fn picture(view: &View, around: Rgba, mixed: bool) -> Vec<Rgba> {
        let texel = |i: usize, j: usize| {
            let light = Rgba::opaque(0.5 + 0.002 * i as f32, 0.3 + 0.001 * j as f32, 0.4);
            let coverage = view.screen_pixel(i, j).map_or(0.0, |pixel| pixel.coverage as f32);
            let is_seen = view.shows(PixelPoint::centre(i, j));
            let part = if mixed { coverage } else { f32::from(u8::from(is_seen)) };
            light * part + around * (1.0 - part)
        };
        (0..view.height()).flat_map(|j| (0..view.width()).map(move |i| (i, j))).map(|(i, j)| texel(i, j)).collect()
    }

    #[test]
    fn what_was_mixed_is_unmixed_and_what_was_not_is_left() {
        for view in rims() {
            let rim = RimTexels::of(&view);
            assert!(rim.texels.len() > 80, "{} texels of {:?}", rim.texels.len(), view.projection);
            let whole = picture(&view, Rgba::TRANSPARENT, false);
            for around in [Rgba::TRANSPARENT, Rgba::opaque(0.0, 0.0, 0.0), Rgba::opaque(1.0, 1.0, 1.0)] {
                for mixed in [true, false] {
                    let mut light = picture(&view, around, mixed);
                    rim.restore(&mut light, |texel| texel, |light| light);
                    for texel in &rim.texels {
                        let (found, expected) = (light[texel.at as usize], whole[texel.at as usize]);
                        let off: f32 = found.0.iter().zip(expected.0).map(|(a, b)| (a - b).abs()).sum();
                        assert!(off < 0.02, "{found:?}, not {expected:?}: {texel:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn rows_of_light_may_be_longer_than_the_view_is_wide() {
        let same = |light: Rgba| light;
        for view in rims() {
            let rim = RimTexels::of(&view);
            let (mut packed, around) = (picture(&view, Rgba::BLACK, true), Rgba([7.0; 4]));
            let rows = packed.chunks(view.width());
            let mut apart: Vec<Rgba> = rows.flat_map(|row| [row, &[around; 5]].concat()).collect();
            rim.restore(&mut packed, same, same);
            rim.restore(&mut apart, same, same);
            let rows = packed.chunks(view.width());
            assert!(apart == rows.flat_map(|row| [row, &[around; 5]].concat()).collect::<Vec<_>>());
        }
    }

    /// Tests grass and leaves, where no single texel decides, but all together do.
    #[test]
    fn rough_pictures_are_told_by_the_whole_rim() {
        let noise = |k: usize| 0.02 + (k as u32).wrapping_mul(2_654_435_761) as f32 / u32::MAX as f32;
        for view in rims() {
            let rim = RimTexels::of(&view);
            let rough = |around: Rgba, mixed| {
                let flat = Rgba::opaque(1.0, 1.0, 1.0);
                let part = picture(&view, Rgba::TRANSPARENT, mixed).into_iter().map(|texel| texel.alpha());
                part.enumerate()
                    .map(move |(k, part)| flat * (noise(k) * part) + around * (1.0 - part))
                    .collect::<Vec<_>>()
            };
            let restored = |mut light: Vec<Rgba>| {
                rim.restore(&mut light, |texel| texel, |light| light);
                light
            };
            let black = Rgba::opaque(0.0, 0.0, 0.0);
            assert_eq!(restored(rough(black, false)), rough(black, false), "{:?}: hard", view.projection);
            let (soft, hard) = (restored(rough(black, true)), rough(black, false));
            let off = |rim: &RimTexel| (soft[rim.at as usize].0[0] - hard[rim.at as usize].0[0]).abs();
            assert!(rim.texels.iter().map(off).fold(0.0, f32::max) < 1e-4, "{:?}: soft", view.projection);
        }
    }

    #[test]
    fn a_panorama_has_no_rim() {
        assert!(RimTexels::of(&view(CameraModel::Equirect(EquirectCamera::default()))).texels.is_empty());
    }
}
