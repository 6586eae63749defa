//! Pictures on surfaces: a checkered plane that goes to the horizon, against many samples a pixel.

use cosmorama::camera::PixelPoint;
use cosmorama::filter::{Kernel, Texture, TextureFootprint, Wrap};
use cosmorama::prelude::*;
use cosmorama_scene::{Camera, Place};
use glam::{DMat2, DVec2, DVec3};

const WIDTH: usize = 200;
const HEIGHT: usize = 150;

/// Distance of the columns that are compared.
const APART: usize = 4;

/// Texels of the picture's edge, and length of the edge on the plane.
const EDGE: usize = 256;
const LENGTH: f64 = 1.5;

/// Two by two checks.
fn checks() -> Image<Rgba> {
    Image::from_fn(EDGE, EDGE, |i, j| {
        let shade = if (2 * i / EDGE + 2 * j / EDGE).is_multiple_of(2) { 0.05 } else { 0.9 };
        Rgba::opaque(shade, shade, shade)
    })
}

/// A camera one unit above the plane, a little turned, whose picture ends well above the horizon.
fn camera() -> Camera {
    let place = Place { eye: DVec3::Y, target: DVec3::new(0.4, 0.65, -1.0) };
    let lens = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(70.0)));
    Camera::lens(place, Placement::new(lens.into()).view(WIDTH, HEIGHT).unwrap()).unwrap()
}

/// Returns how a pixel lies on the plane's picture; `None` in the sky.
fn chart(camera: &Camera, at: PixelPoint) -> Option<TextureFootprint> {
    let ray = camera.ray(at)?;
    let distance = ray.origin.y / -ray.direction.y;
    let met = (distance > 0.0).then(|| ray.met(distance, DVec3::Y))?;
    let flat = |point: DVec3| DVec2::new(point.x, point.z) / LENGTH;
    let jacobian = DMat2::from_cols(flat(met.dx.origin), flat(met.dy.origin));
    Some(TextureFootprint { at: flat(met.origin), jacobian, nearing: ray.nearing(DVec3::Y) })
}

/// Returns the number of samples along the side of a pixel, enough for the pictures that it is long.
fn samples(jacobian: &DMat2) -> f64 {
    (20.0 * jacobian.y_axis.length()).ceil().clamp(12.0, 150.0)
}

/// Averages samples of the picture, straight between its texels, by the kernel in screen space. As the filter does, it
/// clamps the average to the samples under the pixel.
fn brute(camera: &Camera, picture: &Image<Rgba>, (i, j): (usize, usize), jacobian: &DMat2) -> f64 {
    const UNDER: f64 = 1.5;
    let (kernel, side) = (Kernel::ADAPTIVE, samples(jacobian));
    let part = kernel.coarseness(jacobian.determinant().abs().sqrt() * EDGE as f64);
    let count = (kernel.radius() * kernel.scale * side).ceil() as i64;
    let (mut sum, mut whole, mut least, mut greatest) = (0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY);
    for (a, b) in (-count..count).flat_map(|a| (-count..count).map(move |b| (a, b))) {
        let [x, y] = [a, b].map(|k| (k as f64 + 0.5) / side);
        let r = x.hypot(y) / kernel.scale;
        let weight = kernel.fine.weight(r) * (1.0 - part) + kernel.coarse.weight(r) * part;
        if weight == 0.0 {
            continue;
        }
        let place = PixelPoint::new(i as f64 + 0.5 + x, j as f64 + 0.5 + y);
        let Some(seen) = chart(camera, place) else { continue };
        let sample = bilinear(picture, seen.at);
        sum += weight * sample;
        whole += weight;
        if r * r < UNDER {
            (least, greatest) = (least.min(sample), greatest.max(sample));
        }
    }
    (sum / whole).clamp(least, greatest)
}

fn bilinear(picture: &Image<Rgba>, at: DVec2) -> f64 {
    let at = at * EDGE as f64 - 0.5;
    let (first, part) = (at.floor(), at - at.floor());
    let texel = |x: f64, y: f64| {
        let [i, j] = [first.x + x, first.y + y].map(|place| place.rem_euclid(EDGE as f64) as usize);
        f64::from(picture.get(i % EDGE, j % EDGE).0[0])
    };
    let row = |y: f64| texel(0.0, y) * (1.0 - part.x) + texel(1.0, y) * part.x;
    row(0.0) * (1.0 - part.y) + row(1.0) * part.y
}

#[test]
fn a_checkered_plane_is_that_of_many_samples_up_to_the_horizon() {
    let (camera, picture) = (camera(), checks());
    let texture = Texture::new(picture.clone(), [Wrap::Repeat; 2]);
    let (mut squares, mut count, mut worst, mut far) = (0.0, 0usize, 0.0f64, 0usize);
    for (i, j) in (0..HEIGHT).flat_map(|j| (0..WIDTH).step_by(APART).map(move |i| (i, j))) {
        let Some(footprint) = chart(&camera, PixelPoint::centre(i, j)) else { continue };
        let jacobian = footprint.jacobian;
        let found = f64::from(texture.average(&footprint).0[0]);
        let error = (found - brute(&camera, &picture, (i, j), &jacobian)).abs();
        squares += error * error;
        count += 1;
        // Moiré would show where a pixel is longer than the picture.
        if jacobian.y_axis.length() > 1.0 {
            worst = worst.max(error);
            far += 1;
        }
    }
    let psnr = -10.0 * (squares / count as f64).log10();
    println!("{psnr:.1} dB over {count} pixels; {far} far ones differ by {worst:.4} at most");
    assert!(APART * count > WIDTH * HEIGHT / 2 && far > 200);
    assert!(psnr > 45.0, "{psnr} dB");
    assert!(worst < 0.04, "{worst}");
}
