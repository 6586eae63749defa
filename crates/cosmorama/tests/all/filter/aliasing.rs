//! What a filter must not do: alias, ring, or make light of nothing.

use cosmorama::filter::{CrossSection, FilterKind, FilterSettings, Kernel};
use cosmorama::raster::{ColourChannel, Rgba, Transfer};
use cosmorama::render::Resampler;
use cosmorama::sphere::{CubeFace, Direction};
use testkit::{cube, fisheye, light_by_direction, light_by_texel, perspective};

fn srgb(light: f64) -> f64 {
    Transfer::Srgb.encode(light, ColourChannel::Green)
}

/// Mean and standard deviation inside the disc, sRGB-encoded, of 255.
fn checker_statistics(kind: FilterKind) -> (f64, f64) {
    let world = cube(&CubeFace::ALL, 2048, 2048);
    let light = light_by_texel(&world, |_, i, j, _| {
        let value = ((i + j) % 2) as f32;
        Rgba::opaque(value, value, value)
    });
    let target = fisheye(512, 180.0);
    let image =
        Resampler { world: &world, target: &target, filter: FilterSettings { kind, ..FilterSettings::DEFAULT } }
            .render(&light);
    let inside = image.pixels().iter().enumerate().filter(|(index, _)| {
        target.screen_pixel(index % 512, index / 512).is_some_and(|screen| screen.coverage == 1.0)
    });
    let values: Vec<f64> = inside.map(|(_, pixel)| 255.0 * srgb(f64::from(pixel.0[1]))).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    (mean, variance.sqrt())
}

#[test]
fn a_checkerboard_of_single_texels_becomes_grey() {
    let (mean, deviation) = checker_statistics(FilterKind::Ewa);
    assert!(deviation < 0.1, "standard deviation {deviation} of 255");
    assert!((mean - 255.0 * srgb(0.5)).abs() < 0.5, "mean {mean}");
    let (_, deviation) = checker_statistics(FilterKind::Point);
    assert!(deviation > 60.0, "point sampling must alias, or this test sees nothing: {deviation}");
}

/// A sun of a few texels, 65000 times as bright as the sky.
fn sun(direction: Direction) -> [f32; 3] {
    let sun = Direction::from_longitude_latitude(
        cosmorama::sphere::Angle::from_degrees(44.7),
        cosmorama::sphere::Angle::from_degrees(20.0),
    );
    if direction.angle_to(sun).degrees() < 0.7 { [65000.0, 60000.0, 50000.0] } else { [1.0, 1.2, 2.0] }
}

#[test]
fn no_dark_ring_round_a_sun() {
    let world = cube(&CubeFace::ALL, 256, 256);
    let light = light_by_direction(&world, sun);
    let lanczos = Kernel::uniform(CrossSection::JincJinc { lobes: 3, blur: 1.0 });
    for kernel in [Kernel::ADAPTIVE, lanczos] {
        let filter = FilterSettings { kernel, ..FilterSettings::DEFAULT };
        for (fov, size) in [(5.0, 200), (40.0, 200), (90.0, 60)] {
            let target = perspective(size, size, fov, 44.7, 20.0, 0.0);
            let image = Resampler { world: &world, target: &target, filter }.render(&light);
            for pixel in image.pixels() {
                for (value, (least, most)) in pixel.0.iter().zip([(1.0, 65000.0), (1.2, 60000.0), (2.0, 50000.0)]) {
                    let within = *value >= least && *value <= most;
                    assert!(within, "{kernel:?}, fov {fov}: {value} is not within {least} to {most}");
                }
            }
        }
    }
}

#[test]
fn a_missing_texel_is_left_out() {
    let world = cube(&CubeFace::ALL, 32, 32);
    let grey = Rgba::opaque(0.5, 0.5, 0.5);
    let mut light = vec![grey; world.texel_count()];
    light[16 * 32 + 16] = Rgba([f32::NAN, 0.5, 0.5, 1.0]).finite();
    let target = perspective(64, 64, 90.0, 0.0, 0.0, 0.0);
    let filter = FilterSettings { kind: FilterKind::Bilinear, ..FilterSettings::DEFAULT };
    for filter in [filter, FilterSettings::DEFAULT] {
        let image = Resampler { world: &world, target: &target, filter }.render(&light);
        for pixel in image.pixels() {
            assert!(pixel.0.iter().all(|c| c.is_finite()), "{pixel:?}");
            if pixel.alpha() > 0.0 {
                assert!((pixel.unpremultiplied()[0] - 0.5).abs() < 1e-5, "{pixel:?}: the hole coloured its neighbours");
            }
        }
        assert!(image.pixels().iter().any(|pixel| pixel.alpha() < 1.0), "the hole must show");
    }
}

#[test]
fn an_infinite_texel_is_the_largest_half() {
    let world = cube(&CubeFace::ALL, 32, 32);
    let mut light = vec![Rgba::opaque(0.5, 0.5, 0.5); world.texel_count()];
    light[16 * 32 + 16] = Rgba([f32::INFINITY, 0.5, 0.5, 1.0]).finite();
    let target = perspective(64, 64, 90.0, 0.0, 0.0, 0.0);
    let image = Resampler { world: &world, target: &target, filter: FilterSettings::DEFAULT }.render(&light);
    let brightest = image.pixels().iter().map(|pixel| pixel.0[0]).fold(0.0, f32::max);
    assert!(brightest > 30_000.0 && brightest <= 65_504.0, "{brightest}");
}
