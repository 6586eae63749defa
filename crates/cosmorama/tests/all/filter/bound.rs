//! `ewa-pyramid` takes a bounded number of texels a pixel, whatever the world and wherever the target looks.

use cosmorama::camera::View;
use cosmorama::explain::Report;
use cosmorama::filter::{FilterKind, FilterSettings, MOST_TEXELS};
use cosmorama::sphere::{Angle, Direction};
use cosmorama::world::World;
use testkit::{equirect, partial_worlds, perspective, turned, whole_worlds};

const PYRAMID: FilterSettings = FilterSettings { kind: FilterKind::EwaPyramid, ..FilterSettings::DEFAULT };

/// Where a world's poles, rims, seams and corners are, and other places.
fn places() -> impl Iterator<Item = [f64; 3]> {
    let odd =
        [[0.0, 0.0], [180.0, 0.0], [0.0, 90.0], [0.0, -90.0], [90.0, 0.0], [45.0, 35.3], [25.0, 15.0], [179.0, 1.0]];
    let anywhere = Direction::spread(4).map(|direction| {
        let (yaw, pitch) = direction.longitude_latitude();
        [yaw.degrees(), pitch.degrees()]
    });
    odd.into_iter().chain(anywhere).enumerate().map(|(k, [yaw, pitch])| [yaw, pitch, 17.0 * k as f64])
}

/// Texels a pixel at most, in a target of such a world.
fn most(world: &World, target: &View) -> usize {
    Report::of(world, target, &PYRAMID).gathered.most
}

/// Targets that look to a place: a camera whose pixels are as wide as so many texels, up to 19°, and maps of pixels of 22.5° and 36°.
fn targets([yaw, pitch, roll]: [f64; 3], pixel: f64) -> [View; 3] {
    let fov = Angle::from_radians((6.0 * pixel).min(2.0)).degrees();
    let map = |width| View { orientation: turned([yaw, pitch, roll]), ..equirect(width) };
    [perspective(6, 6, fov, yaw, pitch, roll), map(16), map(10)]
}

#[test]
fn no_pixel_of_any_projection_takes_more_texels_than_said() {
    let worlds = whole_worlds(400).into_iter().chain(partial_worlds(400)).chain([("panorama", equirect(3000))]);
    let mut greatest = 0;
    for (number, (name, view)) in worlds.enumerate() {
        let world = World::new([(name.to_owned(), view.clone())]).expect("one view");
        let texels_a_radian = view.pixels_per_radian();
        // Every ninth place of each world: its neighbours in the list, of the same family, have the rest.
        for (k, place) in places().enumerate().filter(|(k, _)| k % 9 == number % 9) {
            let shrink = [1.0, 2.0, 3.7, 8.0, 17.0, 40.0, 64.0][k % 7];
            for (at, target) in targets(place, shrink / texels_a_radian).iter().enumerate() {
                // One map at each: they have many pixels.
                if at > 0 && (k / 9 + at) % 2 == 0 {
                    continue;
                }
                let found = most(&world, target);
                assert!(found <= MOST_TEXELS, "{name} at {place:?}, shrunk by {shrink}, target {at}: {found}");
                greatest = greatest.max(found);
            }
        }
    }
    assert!(greatest > MOST_TEXELS / 4, "the bound is far from what is taken: {greatest}");
}

/// Places at which more was once taken: the seam of a Mercator map, and the open ends of a central cylinder.
#[test]
fn wide_pixels_across_seams_and_ends_take_no_more() {
    for (name, yaw) in [("mercator", 180.0), ("central cylinder", 90.0)] {
        let (_, view) = partial_worlds(500).into_iter().find(|(found, _)| *found == name).expect("such a world");
        let world = World::new([(name.to_owned(), view)]).expect("one view");
        for roll in [0.0, 17.0, 68.0] {
            for target in &targets([yaw, 0.0, roll], 0.01)[1..] {
                let found = most(&world, target);
                assert!(found <= MOST_TEXELS, "{name}: {found} of a map of {}", target.width());
            }
        }
    }
}
