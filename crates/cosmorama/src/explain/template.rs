use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::{Footprint, PixelPoint, View};
use crate::raster::{Image, Rgba};
use crate::sphere::Direction;

/// Layer of guides over the pictures of a world, for those who paint them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guide {
    /// Lines of longitude and latitude, every 15°; those of 45° are stronger.
    Grid,
    /// The horizon.
    Horizon,
    /// Parts that other pictures show, too, and a strip along edges beyond which another picture goes on.
    Overlaps,
    /// Lines a twentieth and a tenth of the picture inside of its edge or its circle; what is nearer to the edge is tinted.
    SafeArea,
}

/// Distance of lines of longitude and latitude, and of the stronger ones, in radians.
const LINES: f64 = TAU / 24.0;
const STRONG: usize = 3;

/// Distance of lines in pixels below which they are left out.
const CLOSEST: f64 = 4.0;

/// Parts of a picture inside its edge: the strip beside a neighbour, and the two safe areas.
const STRIP: f64 = 1.0 / 32.0;
const SAFE: [f64; 2] = [0.05, 0.1];

const GREY: [f32; 3] = [0.2, 0.2, 0.2];
const RED: [f32; 3] = [0.8, 0.02, 0.02];
const BLUE: [f32; 3] = [0.02, 0.1, 0.8];
const GREEN: [f32; 3] = [0.02, 0.5, 0.05];

impl Guide {
    /// All layers, the lowest first.
    pub const ALL: [Self; 4] = [Self::Overlaps, Self::SafeArea, Self::Grid, Self::Horizon];

    /// Returns the layer's name, as in `horizon`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Horizon => "horizon",
            Self::Overlaps => "overlaps",
            Self::SafeArea => "safe-area",
        }
    }

    /// Draws the layer over one of several pictures, transparent where there is nothing to show.
    pub fn picture(self, views: &[View], index: usize) -> Image<Rgba> {
        let view = &views[index];
        let mut image = Image::filled(view.width(), view.height(), Rgba::TRANSPARENT);
        image.pixels_mut().par_chunks_mut(view.width().max(1)).enumerate().for_each(|(j, row)| {
            for (i, pixel) in row.iter_mut().enumerate() {
                let Some(screen) = view.screen_pixel(i, j) else { continue };
                let (part, [red, green, blue]) = match self {
                    Self::Grid => (grid(&screen.footprint), GREY),
                    Self::Horizon => (horizon(&screen.footprint), RED),
                    Self::Overlaps => (overlap(views, index, (i, j), screen.footprint.direction), BLUE),
                    Self::SafeArea => (safe_area(view, (i, j)), GREEN),
                };
                *pixel = Rgba::opaque(red, green, blue) * (part * screen.coverage) as f32;
            }
        });
        image
    }
}

/// Returns the part of a pixel that a line covers, of which the pixel's centre is so many pixels away.
fn line(distance: f64, width: f64) -> f64 {
    (width / 2.0 + 0.5 - distance).clamp(0.0, 1.0)
}

/// Returns the change of an angle over a pixel, given its derivatives by the direction.
fn per_pixel(footprint: &Footprint, gradient: DVec3) -> f64 {
    gradient.dot(footprint.jacobian.dx).hypot(gradient.dot(footprint.jacobian.dy))
}

/// Returns latitude and longitude, each with its change over a pixel.
fn place(footprint: &Footprint) -> [(f64, f64); 2] {
    let direction = footprint.direction.vector();
    let (longitude, latitude) = footprint.direction.longitude_latitude();
    let level = direction.x.hypot(direction.z).max(1e-9);
    let around = DVec3::new(-direction.z, 0.0, direction.x) / (level * level);
    let upwards = DVec3::Y / level;
    [(latitude.radians(), per_pixel(footprint, upwards)), (longitude.radians(), per_pixel(footprint, around))]
}

fn grid(footprint: &Footprint) -> f64 {
    let lines = |(angle, change): (f64, f64)| {
        let nearest = (angle / LINES).round();
        let is_strong = nearest.rem_euclid(STRONG as f64) == 0.0;
        // Towards a pole lines of longitude meet.
        let room = LINES / change;
        if room < CLOSEST {
            0.0
        } else {
            line((angle - nearest * LINES).abs() / change, 1.0) * if is_strong { 0.9 } else { 0.45 }
        }
    };
    let [latitude, longitude] = place(footprint);
    lines(latitude).max(lines(longitude))
}

fn horizon(footprint: &Footprint) -> f64 {
    let [(latitude, change), _] = place(footprint);
    // At the poles of a coarse picture there is no line, however near.
    if latitude.abs() > FRAC_PI_2 / 2.0 { 0.0 } else { line(latitude.abs() / change, 3.0) }
}

/// Returns the tint of a pixel that other pictures show, or beside which another picture goes on.
fn overlap(views: &[View], index: usize, (i, j): (usize, usize), direction: Direction) -> f64 {
    let is_elsewhere =
        |direction: Direction| views.iter().enumerate().any(|(other, view)| other != index && view.sees(direction));
    if is_elsewhere(direction) {
        return 0.4;
    }
    let view = &views[index];
    let (width, height) = (view.width() as f64, view.height() as f64);
    let (x, y) = (i as f64 + 0.5, j as f64 + 0.5);
    let strip = STRIP * width.min(height);
    // As far beyond each edge as the pixel is inside.
    let beyond = [(x, (-x, y)), (width - x, (2.0 * width - x, y)), (y, (x, -y)), (height - y, (x, 2.0 * height - y))];
    let goes_on = |(distance, (x, y)): (f64, (f64, f64))| {
        distance < strip && view.direction(PixelPoint::new(x, y)).is_some_and(is_elsewhere)
    };
    if beyond.into_iter().any(goes_on) { 0.25 } else { 0.0 }
}

/// Returns the tint of a pixel near the edge of its picture, with the lines around what is safe.
fn safe_area(view: &View, (i, j): (usize, usize)) -> f64 {
    let centre = PixelPoint::centre(i, j);
    let size = view.width().min(view.height()) as f64;
    let (width, height) = (view.width() as f64, view.height() as f64);
    let to_edge = centre.x.min(width - centre.x).min(centre.y).min(height - centre.y);
    let point = view.grid.to_plane(centre);
    let step = view.grid.step().abs().min_element();
    let to_circle = view.stop.circle.map_or(f64::INFINITY, |radius| (radius - point.x.hypot(point.y)) / step);
    let inside = to_edge.min(to_circle);
    let lines = SAFE.iter().map(|part| line((inside - part * size).abs(), 1.5)).fold(0.0, f64::max);
    lines.max(if inside < SAFE[0] * size { 0.15 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, EquirectCamera};
    use crate::sphere::CubeFace;

    fn faces(size: usize) -> Vec<View> {
        let view = CameraModel::CubeFace(CubeFaceCamera).view(size, size).unwrap();
        CubeFace::ALL.map(|face| View { orientation: face.orientation(), ..view.clone() }).to_vec()
    }

    #[test]
    fn the_horizon_is_a_line_through_the_middle() {
        let views = faces(64);
        let front = Guide::Horizon.picture(&views, 0);
        let alpha = |i: usize, j: usize| front.get(i, j).alpha();
        for i in 0..64 {
            assert!(alpha(i, 31) > 0.9 && alpha(i, 32) > 0.9 && alpha(i, 28) == 0.0 && alpha(i, 35) == 0.0, "{i}");
        }
        assert!(
            Guide::Horizon.picture(&views, CubeFace::Up as usize).pixels().iter().all(|pixel| pixel.alpha() == 0.0)
        );
    }

    #[test]
    fn lines_of_a_panorama_are_every_15_degrees() {
        let view = CameraModel::Equirect(EquirectCamera::default()).view(720, 360).unwrap();
        let image = Guide::Grid.picture(&[view], 0);
        for degrees in (15..180).step_by(15) {
            let j = 2 * degrees;
            let strong = (degrees % 45) == 0;
            let alpha = image.get(7, j).alpha().max(image.get(7, j - 1).alpha());
            let expected = if strong { 0.45 } else { 0.225 };
            assert!((alpha - expected).abs() < 0.01, "{degrees}: {alpha} for {expected}");
            assert_eq!(image.get(7, j + 8).alpha(), 0.0);
        }
    }

    #[test]
    fn strips_lie_beside_neighbours_only() {
        let views = faces(64);
        // Up and front are there, so that front's upper edge alone has a neighbour.
        let two = [views[0].clone(), views[CubeFace::Up as usize].clone()];
        let image = Guide::Overlaps.picture(&two, 0);
        let alpha = |i: usize, j: usize| image.get(i, j).alpha();
        assert!(alpha(32, 0) > 0.2 && alpha(32, 1) > 0.2);
        assert_eq!([alpha(32, 3), alpha(32, 63), alpha(0, 32), alpha(63, 32)], [0.0; 4]);
        let safe = Guide::SafeArea.picture(&two, 0);
        assert!(safe.get(0, 32).alpha() > 0.1 && safe.get(32, 32).alpha() == 0.0 && safe.get(6, 32).alpha() > 0.5);
    }
}
