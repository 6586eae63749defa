use glam::{DMat2, DVec2};

use super::halving::halved;
use super::level::{level_of, part};
use crate::camera::PixelPoint;
use crate::filter::Kernel;
use crate::filter::ewa::scratch_pool::Pool;
use crate::filter::gather::candidate::Candidate;
use crate::filter::gather::ellipse::{Ellipse, widened};
use crate::filter::gather::tap_weights::settle;
use crate::filter::gather::texel_run::{TexelBox, ceil, floor};
use crate::filter::kernel::KernelTable;
use crate::filter::taps::{Taps, average};
use crate::raster::{Image, Rgba};

/// A flat picture on a surface, averaged over ellipses on an image pyramid (Greene & Heckbert 1986; Heckbert 1989).
///
/// Its coordinates u and v go from 0 to 1, to the right and down. Beyond them it goes on as [`Wrap`] says.
///
/// ```
/// use cosmorama::filter::{Texture, TextureFootprint, Wrap};
/// use cosmorama::raster::{Image, Rgba};
/// use glam::{DMat2, DVec2};
///
/// let stripes = Image::from_fn(64, 64, |i, _| if i % 2 == 0 { Rgba::BLACK } else { Rgba::opaque(1.0, 1.0, 1.0) });
/// let texture = Texture::new(stripes, [Wrap::Repeat; 2]);
/// // A pixel as wide as eight texels sees grey.
/// let pixel = TextureFootprint::flat(DVec2::new(7.3, 0.5), DMat2::from_diagonal(DVec2::splat(8.0 / 64.0)));
/// let seen = texture.average(&pixel);
/// assert!((seen.0[0] - 0.5).abs() < 0.01);
/// ```
#[derive(Debug)]
pub struct Texture {
    /// The picture and its halves, down to one texel.
    levels: Vec<Image<Rgba>>,
    wrap: [Wrap; 2],
    table: KernelTable,
    scratch: Pool<(Vec<Candidate>, Taps)>,
}

/// A pixel as it lies on a flat picture: an offset s of pixels from its middle is at `at` + Js/(1 + n·s).
///
/// That is exact for a plane in a perspective view. Elsewhere it is right for small offsets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureFootprint {
    /// Coordinates u and v of its middle.
    pub at: DVec2,
    /// J: the columns are the changes of (u, v) for one pixel to the right and one down.
    pub jacobian: DMat2,
    /// n: the change of nearness, one over the depth, for one pixel to the right and down, as a part of it. Zero where all is
    /// equally far away.
    pub nearing: DVec2,
}

impl TextureFootprint {
    /// Returns a pixel that lies on the picture without perspective. The columns of the matrix are the changes of (u, v) for one
    /// pixel to the right and one down.
    pub fn flat(at: DVec2, jacobian: DMat2) -> Self {
        Self { at, jacobian, nearing: DVec2::ZERO }
    }
}

/// Ratio of length to width above which a pixel is widened, so that the number of its texels stays bounded.
const LONGEST: f64 = 64.0;

/// Greatest relative change of nearness from the middle of a pixel's kernel to its edge: beyond 1 it would look past the
/// horizon.
const STEEPEST: f64 = 0.9;

/// Way in which a picture goes on beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture, mirrored every other time.
    Mirror,
    /// The texels of the edge.
    Clamp,
}

impl Wrap {
    /// Returns the column or row of a texel that may lie beyond the edges.
    ///
    /// # Panics
    /// When the size is 0.
    pub fn texel(self, at: i64, size: usize) -> usize {
        let size = size as i64;
        let inside = match self {
            Self::Repeat => at.rem_euclid(size),
            Self::Mirror => {
                let there = at.rem_euclid(2 * size);
                there.min(2 * size - 1 - there)
            }
            Self::Clamp => at.clamp(0, size - 1),
        };
        inside as usize
    }
}

impl Texture {
    /// Prepares a picture of linear light, or of other numbers; what lies beside it across and down is given.
    ///
    /// # Panics
    /// When it has no texels.
    pub fn new(picture: Image<Rgba>, wrap: [Wrap; 2]) -> Self {
        assert!(!picture.pixels().is_empty(), "a texture of no texels");
        let mut levels = vec![picture];
        while let Some(finer) = levels.last().filter(|level| level.width().max(level.height()) > 1) {
            levels.push(halved(finer));
        }
        Self { levels, wrap, table: KernelTable::new(&Kernel::ADAPTIVE), scratch: Pool::default() }
    }

    /// Returns the picture.
    pub fn picture(&self) -> &Image<Rgba> {
        &self.levels[0]
    }

    /// Returns what lies beside it, across and down.
    pub fn wrap(&self) -> [Wrap; 2] {
        self.wrap
    }

    /// Averages the picture under a pixel.
    ///
    /// A pixel that is very much longer than wide is widened, so that the number of texels is bounded. One that holds all of
    /// the picture, or is not finite, has its mean.
    pub fn average(&self, footprint: &TextureFootprint) -> Rgba {
        let TextureFootprint { at, jacobian, nearing } = *footprint;
        let coarsest = (self.levels.len() - 1) as f32;
        let number =
            level_of(DMat2::from_diagonal(size(self.picture())) * jacobian, self.table.kernel(), LONGEST) as f32;
        if !at.is_finite() || !jacobian.is_finite() || !nearing.is_finite() || number >= coarsest {
            return self.levels[self.levels.len() - 1].pixels()[0];
        }
        let mut sum = Rgba::TRANSPARENT;
        for level in [number.max(0.0) as usize, number.max(0.0) as usize + 1] {
            let part = part(number, level);
            if part > 0.0 {
                sum += self.on_level(&self.levels[level], footprint) * part;
            }
        }
        sum
    }

    /// Averages the texels of a level under a pixel's kernel.
    fn on_level(&self, level: &Image<Rgba>, footprint: &TextureFootprint) -> Rgba {
        let kernel = self.table.kernel();
        let centre = footprint.at * size(level);
        let jacobian = DMat2::from_diagonal(size(level)) * footprint.jacobian;
        let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt()) as f32;
        let reach = self.table.radius_squared();
        let widened = widened(jacobian * kernel.scale, kernel.floor);
        let lens = Lens::new(widened, footprint.nearing * kernel.scale, reach.sqrt());
        let (rows, middle) = (lens.outline.rows(reach), centre + lens.middle);
        let bounds = TexelBox::around(PixelPoint::new(middle.x, middle.y), lens.outline.half_extent(reach));
        let [across, down] = self.wrap;
        self.scratch.lend(|(candidates, taps)| {
            candidates.clear();
            taps.clear();
            for j in bounds.top..=bounds.bottom {
                let y = j as f64 + 0.5;
                let Some((least, greatest)) = rows.range(y - middle.y) else { continue };
                let row = down.texel(j, level.height()) * level.width();
                for i in ceil(middle.x + least - 0.5)..=floor(middle.x + greatest - 0.5) {
                    let Some((offset, share)) = lens.screen(DVec2::new(i as f64 + 0.5, y) - centre) else { continue };
                    let (texel, q) = (row + across.texel(i, level.width()), offset.length_squared());
                    if q < reach {
                        candidates.push(Candidate::weighed(&self.table, texel, share as f32, q, coarseness, offset));
                    }
                }
            }
            settle(candidates, kernel.centred, None, taps);
            average(taps.list(), |texel| level.pixels()[texel as usize], true)
        })
    }
}

/// Map between texels about a pixel's middle and the screen, in the kernel's unit, in perspective.
struct Lens {
    to_screen: DMat2,
    nearing: DVec2,
    /// Ellipse of the texels that the kernel reaches, about its own middle.
    outline: Ellipse,
    middle: DVec2,
}

impl Lens {
    /// Makes the map of a kernel of a radius: a place s on the screen is at Js/(1 + n·s) among the texels.
    fn new(jacobian: DMat2, nearing: DVec2, radius: f64) -> Self {
        let nearing = nearing.clamp_length_max(STEEPEST / radius);
        // The disc |s| < R is the ellipse |t − t₀|² < R²/(1 − R²n²) of t = s/(1 + n·s), flattened along n by
        // √(1 − R²n²), with t₀ = −R²n/(1 − R²n²).
        let flat = 1.0 - radius * radius * nearing.length_squared();
        let along = nearing.normalize_or_zero();
        let longer = (flat.sqrt().recip() - 1.0) * along;
        let stretch = DMat2::IDENTITY + DMat2::from_cols(along * longer.x, along * longer.y);
        Self {
            to_screen: jacobian.inverse(),
            nearing,
            outline: Ellipse::new(jacobian * stretch * flat.sqrt().recip(), 0.0),
            middle: jacobian * nearing * (-radius * radius / flat),
        }
    }

    /// Returns the place of a texel on the screen, and its area there relative to the middle's; `None` beyond the horizon.
    fn screen(&self, texel: DVec2) -> Option<(DVec2, f64)> {
        let flat = self.to_screen * texel;
        let depth = 1.0 - self.nearing.dot(flat);
        (depth > 0.0).then(|| (flat / depth, depth.powi(-3)))
    }
}

/// Two are equal if they show the same.
impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        self.wrap == other.wrap && self.levels[0] == other.levels[0]
    }
}

fn size(image: &Image<Rgba>) -> DVec2 {
    DVec2::new(image.width() as f64, image.height() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(texture: &Texture, at: DVec2, jacobian: DMat2) -> Rgba {
        texture.average(&TextureFootprint::flat(at, jacobian))
    }

    fn noise(width: usize, height: usize) -> Image<Rgba> {
        Image::from_fn(width, height, |i, j| {
            let value = ((i * 37 + j * 101 + i * j * 7) % 29) as f32 / 29.0;
            Rgba::opaque(value, 1.0 - value, value * value)
        })
    }

    /// Returns the picture as its wraps lay it out over three times its size each way, its own place in the middle.
    fn laid_out(texture: &Texture) -> Image<Rgba> {
        let (picture, [across, down]) = (texture.picture(), texture.wrap());
        let (width, height) = (picture.width(), picture.height());
        Image::from_fn(3 * width, 3 * height, |i, j| {
            let [i, j] = [across.texel(i as i64 - width as i64, width), down.texel(j as i64 - height as i64, height)];
            *picture.get(i, j)
        })
    }

    #[test]
    fn pictures_go_on_beyond_their_edges() {
        let columns = |wrap: Wrap| (-4..8).map(|at| wrap.texel(at, 3)).collect::<Vec<_>>();
        assert_eq!(columns(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(columns(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(columns(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn wrapped_averages_are_those_of_the_picture_laid_out() {
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let texture = Texture::new(noise(24, 16), [wrap, Wrap::Repeat]);
            let laid = Texture::new(laid_out(&texture), [Wrap::Clamp; 2]);
            for k in 0..60 {
                let t = f64::from(k);
                let at = DVec2::new(0.5 + 0.7 * (t * 0.7).sin(), 0.5 + 0.7 * (t * 1.3).cos());
                // Up to a texel and a half: the finest level.
                let texels = DMat2::from_cols(DVec2::from_angle(t) * 1.5, DVec2::from_angle(t + 1.2) * 0.9);
                let jacobian = DMat2::from_diagonal(DVec2::new(24.0, 16.0).recip()) * texels;
                let (found, expected) =
                    (of(&texture, at, jacobian), of(&laid, (at + 1.0) / 3.0, jacobian * (1.0 / 3.0)));
                let error = (0..4).map(|c| (found.0[c] - expected.0[c]).abs()).fold(0.0, f32::max);
                assert!(error < 1e-5, "{wrap:?}, {k}: {found:?} for {expected:?}");
            }
        }
    }

    #[test]
    fn gradients_stay_what_they_are() {
        let ramp = Image::from_fn(64, 64, |i, j| Rgba::opaque(i as f32 + 0.5, j as f32 + 0.5, 1.0));
        let texture = Texture::new(ramp, [Wrap::Clamp; 2]);
        for k in 0..40 {
            let t = f64::from(k);
            let size = 0.2 * 1.07f64.powi(k);
            let texels = DMat2::from_cols(DVec2::from_angle(t) * size, DVec2::from_angle(t + 1.0) * size * 0.5);
            let at = DVec2::new(0.5 + 0.05 * t.sin(), 0.5 + 0.05 * t.cos());
            let found = of(&texture, at, texels * (1.0 / 64.0));
            let error = (DVec2::new(found.0[0].into(), found.0[1].into()) - at * 64.0).abs().max_element();
            assert!(error < 0.01 * size.max(1.0), "{k}: {error} of {size}");
        }
    }

    #[test]
    fn a_pixel_in_perspective_reaches_what_the_screen_shows() {
        let (jacobian, nearing) = (DMat2::from_cols_array(&[3.0, 0.4, -0.7, 11.0]), DVec2::new(0.1, -0.4));
        let lens = Lens::new(jacobian, nearing, 2.0);
        for k in 0..100 {
            let place = DVec2::from_angle(f64::from(k)) * (0.02 * f64::from(k));
            let texel = jacobian * place / (1.0 + nearing.dot(place));
            let (found, _) = lens.screen(texel).expect("before the horizon");
            assert!(found.distance(place) < 1e-9, "{found} for {place}");
            // The outline is that of the disc of radius 2.
            let inside = lens.outline.distance_squared(texel - lens.middle);
            assert!((inside < 4.0) == (place.length() < 2.0), "{place}: {inside}");
        }
        let rim = |k: u32| {
            let place = DVec2::from_angle(f64::from(k)) * 2.0;
            lens.outline.distance_squared(jacobian * place / (1.0 + nearing.dot(place)) - lens.middle)
        };
        assert!((0..50).all(|k| (rim(k) - 4.0).abs() < 1e-9));
    }

    #[test]
    fn shares_are_areas_on_the_screen() {
        let lens = Lens::new(DMat2::from_cols_array(&[2.0, 0.3, 0.5, 5.0]), DVec2::new(-0.2, 0.3), 2.0);
        for k in 0..20 {
            let texel = DVec2::from_angle(f64::from(k)) * 1.5;
            let step = 1e-5;
            let at = |x: f64, y: f64| lens.screen(texel + DVec2::new(x, y)).expect("before the horizon").0;
            let (x, y) = (at(step, 0.0) - at(-step, 0.0), at(0.0, step) - at(0.0, -step));
            let area = x.perp_dot(y) / (4.0 * step * step) / lens.to_screen.determinant();
            let (_, share) = lens.screen(texel).expect("before the horizon");
            assert!((area / share - 1.0).abs() < 1e-6, "{area} {share}");
        }
    }

    #[test]
    fn the_widest_and_what_is_no_number_have_the_mean() {
        let texture = Texture::new(noise(33, 5), [Wrap::Repeat; 2]);
        let sum = texture.picture().pixels().iter().fold(Rgba::TRANSPARENT, |sum, texel| sum + *texel);
        let mean = sum * (33.0f32 * 5.0).recip();
        let wide = DMat2::from_diagonal(DVec2::splat(1e9));
        let lost = DMat2::from_diagonal(DVec2::splat(f64::NAN));
        let at = DVec2::new(0.3, 0.7);
        for found in [of(&texture, at, wide), of(&texture, at, lost), of(&texture, at * f64::INFINITY, wide)] {
            assert!((0..4).all(|c| (found.0[c] - mean.0[c]).abs() < 1e-5), "{found:?} for {mean:?}");
        }
    }
}
