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

#[test]
fn no_pixel_of_any_projection_takes_more_texels_than_said() {
    let worlds = whole_worlds(700).into_iter().chain(partial_worlds(500)).chain([("panorama", equirect(6000))]);
    let mut most = 0;
    for (number, (name, view)) in worlds.enumerate() {
        let world = World::new([(name.to_owned(), view.clone())]).expect("one view");
        let texels_a_radian = view.pixels_per_radian();
        // Every other place of each world: its neighbour in the list, of the same family, has the rest.
        for (k, [yaw, pitch, roll]) in places().enumerate().filter(|(k, _)| k % 2 == number % 2) {
            let shrink = [1.0, 2.0, 3.7, 8.0, 17.0, 40.0, 64.0][k % 7];
            let pixel = shrink / texels_a_radian;
            let fov = Angle::from_radians((6.0 * pixel).min(2.0)).degrees();
            let camera = perspective(6, 6, fov, yaw, pitch, roll);
            let mut targets = vec![camera];
            // A map has hundreds of pixels of 15 degrees: at every other of these places.
            if k / 2 % 2 == 0 {
                targets.push(View { orientation: turned([yaw, pitch, roll]), ..equirect(24) });
            }
            for target in targets {
                let gathered = Report::of(&world, &target, &PYRAMID).gathered;
                assert!(gathered.most <= MOST_TEXELS, "{name} at {yaw}, {pitch}, shrunk by {shrink}: {gathered:?}");
                most = most.max(gathered.most);
            }
        }
    }
    assert!(most > MOST_TEXELS / 8, "the bound is far from what is taken: {most}");
}
