//! Labels are chosen, never mixed.

use std::collections::BTreeSet;

use cosmorama::camera::View;
use cosmorama::filter::{FilterKind, FilterSettings, LabelRule, Labels};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Resampler, picture};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::{Light, World};
use testkit::{cube, equirect, fisheye, light_by_direction, light_by_texel, perspective, turned};

const RULES: [LabelRule; 2] = [LabelRule::Nearest, LabelRule::Vote];

fn filter(rule: LabelRule) -> FilterSettings {
    FilterSettings { kind: FilterKind::Labels(rule), kernel: Labels::KERNEL, anti_ringing: false }
}

fn values<'a>(pixels: impl IntoIterator<Item = &'a Rgba>) -> BTreeSet<[u32; 4]> {
    pixels.into_iter().map(|pixel| pixel.0.map(f32::to_bits)).collect()
}

fn render(rule: LabelRule, world: &World, target: &View, texels: &[Rgba]) -> Image<Rgba> {
    Resampler { world, target, filter: filter(rule) }.render(texels)
}

#[test]
fn no_pixel_has_a_value_that_no_texel_has() {
    let panorama = World::new([("sky".to_owned(), equirect(120))]).unwrap();
    let lens = View { orientation: turned([20.0, 50.0, -10.0]), ..fisheye(90, 200.0) };
    for world in [cube(&CubeFace::ALL, 40, 40), panorama] {
        let texels = light_by_texel(&world, |view, i, j, _| {
            let value = (view * 31 + i * 17 + j * 7) % 40 + 1;
            Rgba::opaque(value as f32 / 255.0, 0.5, 0.0)
        });
        let known = values(&texels);
        for rule in RULES {
            for target in [lens.clone(), perspective(50, 40, 100.0, 30.0, 60.0, 10.0), equirect(30)] {
                let made = render(rule, &world, &target, &texels);
                let mut found = values(made.pixels());
                // Outside the lens nothing is shown, and its rim is no mixture.
                found.remove(&Rgba::TRANSPARENT.0.map(f32::to_bits));
                assert!(found.is_subset(&known) && found.len() > 10, "{rule:?}");
            }
        }
    }
}

/// Two labels, divided by a plane that is oblique to every axis.
fn side(direction: Direction) -> bool {
    let v = direction.vector();
    0.8 * v.x + 0.4 * v.y - 0.3 * v.z > 0.1
}

#[test]
fn a_vote_goes_to_the_larger_part_of_a_pixel() {
    let world = cube(&CubeFace::ALL, 256, 256);
    // One texel in seven is of the other side.
    let noisy = light_by_texel(&world, |_, i, j, direction| {
        let is_odd = (i * 3 + j * 5) % 7 == 0;
        let value = if direction.is_some_and(side) != is_odd { 1.0 } else { 0.25 };
        Rgba::opaque(value, value, value)
    });
    let target = perspective(40, 30, 90.0, 25.0, 35.0, 15.0);
    let share = |rule: LabelRule| {
        let made = render(rule, &world, &target, &noisy);
        let mut right = 0;
        for (at, pixel) in made.pixels().iter().enumerate() {
            let direction = target.screen_pixel(at % 40, at / 40).unwrap().footprint.direction;
            right += usize::from((pixel.0[0] > 0.5) == side(direction));
        }
        right as f64 / made.pixels().len() as f64
    };
    let (nearest, vote) = (share(LabelRule::Nearest), share(LabelRule::Vote));
    assert!(vote > 0.97 && nearest < 0.92, "{vote} of votes are right, {nearest} of nearest");
}

#[test]
fn pictures_are_made_of_footprints() {
    let world = cube(&CubeFace::ALL, 64, 64);
    let texels = light_by_direction(&world, |at| if side(at) { [1.0; 3] } else { [0.0; 3] });
    let target = perspective(40, 30, 80.0, 25.0, 35.0, 15.0);
    for rule in RULES {
        let light = Light::new(&world, texels.clone()).unwrap();
        let prepared = cosmorama::filter::Filter::prepare(&filter(rule), &world, &light).unwrap();
        assert!(picture(&*prepared, &target) == render(rule, &world, &target, &texels));
    }
}
