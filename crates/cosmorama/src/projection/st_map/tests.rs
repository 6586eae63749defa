use std::sync::LazyLock;

use super::*;
use crate::projection::ProjectionKind;

const SIZE: (usize, usize) = (96, 64);

/// Returns where a lens with a barrel distortion, over a picture of 3:2, puts the pixel at (x, y) of the straight
/// picture.
fn bent(x: f64, y: f64) -> PlanePoint {
    let (u, v) = (x - 0.5, (0.5 - y) / 1.5);
    let scale = 1.0 - 0.3 * (u * u + v * v);
    PlanePoint::new(u * scale * 1.05, v * 1.5 * scale * 1.05)
}

/// Returns the direction that the straight picture sees at (x, y).
fn straight(x: f64, y: f64) -> Direction {
    ProjectionKind::PERSPECTIVE.unproject(PlanePoint::new(2.0 * (x - 0.5), 2.0 * (0.5 - y) / 1.5)).unwrap()
}

fn middle(i: usize, j: usize) -> (f64, f64) {
    ((i as f64 + 0.5) / SIZE.0 as f64, (j as f64 + 0.5) / SIZE.1 as f64)
}

fn map_of(table: Result<StMapTable, StMapError>) -> StMap {
    StMap::new(table.unwrap())
}

/// The bent picture, and one whose pixels look where its own table says: almost all round.
static MAPS: LazyLock<[StMap; 2]> = LazyLock::new(|| {
    let bent_picture = StMapTable::of_places(SIZE.0, SIZE.1, |i, j| {
        let (x, y) = middle(i, j);
        Some((bent(x, y), straight(x, y)))
    });
    let panorama = StMapTable::of_pixels(SIZE.0, SIZE.1, |i, j| {
        let (x, y) = middle(i, j);
        ProjectionKind::EQUIRECTANGULAR.unproject(PlanePoint::new(6.0 * (x - 0.5), 3.0 * (0.5 - y)))
    });
    [map_of(bent_picture), map_of(panorama)]
});

fn points() -> impl Iterator<Item = PlanePoint> {
    let at = |k: i32| f64::from(k) / 40.0 * 0.93;
    (-20..=20).flat_map(move |j| (-20..=20).map(move |i| PlanePoint::new(at(i), at(j))))
}

#[test]
fn a_point_comes_back_and_the_jacobian_is_the_derivative() {
    const STEP: f64 = 1e-6;
    for map in MAPS.iter() {
        for point in points() {
            let (direction, jacobian) = map.unproject_with_jacobian(point).unwrap();
            let back = map.project(direction).unwrap();
            assert!((back.x - point.x).hypot(back.y - point.y) < 1e-7, "{point:?} -> {back:?}");
            let at = |x: f64, y: f64| map.unproject(PlanePoint::new(point.x + x, point.y + y)).unwrap().vector();
            let dx = (at(STEP, 0.0) - at(-STEP, 0.0)) / (2.0 * STEP);
            let dy = (at(0.0, STEP) - at(0.0, -STEP)) / (2.0 * STEP);
            assert!((dx - jacobian.dx).length() < 1e-4, "{point:?}: {dx} is not {}", jacobian.dx);
            assert!((dy - jacobian.dy).length() < 1e-4, "{point:?}: {dy} is not {}", jacobian.dy);
        }
    }
}

#[test]
fn the_memory_of_torn_maps_is_counted() {
    let map = |is_there: fn(usize, usize) -> bool| {
        StMapTable::of_pixels(SIZE.0, SIZE.1, |i, j| {
            let (x, y) = middle(i, j);
            is_there(i, j).then(|| straight(x, y))
        })
    };
    let [whole, torn] = [map(|_, _| true), map(|i, j| i % 3 > 0 && j % 3 > 0)].map(|table| table.unwrap());
    // Each two samples by two are a cell of their own, of which a leaf's last piece has most.
    assert_eq!(torn.leaves.len(), MOST_PIECES * whole.leaves.len());
    assert_eq!(torn.bytes() - whole.bytes(), PIECE * (torn.leaves.len() - whole.leaves.len()) as u64);
    assert_eq!(torn.bytes(), StMapTable::bytes_at_most(SIZE, false));
    let place = |i, j| torn.direction(i as f64 + 0.5, j as f64 + 0.5).map(|(direction, _)| direction);
    for (i, j) in (0..SIZE.1).flat_map(|j| (0..SIZE.0).map(move |i| (i, j))).filter(|(i, j)| i % 3 > 0 && j % 3 > 0) {
        let (x, y) = middle(i, j);
        let off = place(i, j).expect("a sample").vector().distance(straight(x, y).vector());
        assert!(off < 1e-6, "({i}, {j}) is {off} away");
        let found = StMap::new(torn.clone()).project(straight(x, y)).expect("a place");
        assert!((found.x - (x - 0.5)).hypot(found.y - (0.5 - y)) < 1e-4, "({i}, {j}) is found at {found:?}");
    }
}

#[test]
fn between_samples_the_table_is_the_formula() {
    let worst = |found: f64, worst: &mut f64| *worst = worst.max(found);
    let (mut inside, mut border) = (0.0, 0.0);
    for k in 0..400 {
        for (y, worst_of) in [(0.371, &mut inside), (0.003, &mut border)] {
            let x = (f64::from(k) + 0.5) / 400.0;
            let found = MAPS[0].project(straight(x, y)).unwrap();
            let expected = bent(x, y);
            worst((found.x - expected.x).hypot(found.y - expected.y) * SIZE.0 as f64, worst_of);
        }
    }
    // Beyond the samples, places are defined but directions are not.
    let outside = bent(0.5, -1.5 / SIZE.1 as f64);
    let seen = MAPS[0].unproject(outside).unwrap();
    assert!(seen.angle_to(straight(0.5, -1.5 / SIZE.1 as f64)).degrees() < 0.02, "{seen:?}");
    assert!(MAPS[0].project(seen).is_none());
    // Pixels of the table. The lens bends by some thousandths of a pixel within one.
    assert!(inside < 1e-3 && border < 1e-2, "{inside}, {border}");
}

#[test]
fn caps_are_bounded() {
    let radius = Angle::from_degrees(5.0);
    for map in MAPS.iter() {
        for point in points().step_by(37) {
            let centre = map.unproject(point).unwrap();
            let bounds = map.cap_bounds(centre, radius);
            for other in points() {
                let inside = map.unproject(other).unwrap().angle_to(centre) <= radius;
                let held = (bounds.min.x..=bounds.max.x).contains(&other.x)
                    && (bounds.min.y..=bounds.max.y).contains(&other.y);
                assert!(held || !inside, "{other:?} is not in {bounds:?}");
            }
        }
    }
}

/// Tests a table whose samples are finer than exactness needs, in directions between them.
#[test]
fn every_direction_of_a_fine_table_is_found() {
    let (width, height) = (480, 360);
    let seen = |x: f64, y: f64| {
        let camera = PlanePoint::new(1.15 * (x / 480.0 - 0.5), 1.15 * (180.0 - y) / 480.0);
        ProjectionKind::PERSPECTIVE.unproject(camera).unwrap()
    };
    let map = map_of(StMapTable::of_places(width, height, |i, j| {
        let direction = seen(i as f64 + 0.5, j as f64 + 0.5);
        let (longitude, latitude) = direction.longitude_latitude();
        let place = PlanePoint::new(longitude.degrees() / 360.0 + 0.1, latitude.degrees() / 180.0 + 0.1);
        Some((place, direction))
    }));
    for k in 0..20_000 {
        let (x, y) = (
            480.0 * (0.0005 + 0.999 * f64::from(k % 200) / 199.0),
            360.0 * (0.0005 + 0.999 * f64::from(k / 200) / 99.0),
        );
        let back = map.project(seen(x, y)).and_then(|point| map.unproject(point)).expect("it is in the table");
        assert!(back.angle_to(seen(x, y)).radians() < 1e-9, "({x}, {y}) -> {back:?}");
    }
}

/// Returns a map of two halves that look in different directions, and a hole.
fn torn() -> StMap {
    map_of(StMapTable::of_pixels(32, 32, |i, j| {
        let hole = (20..24).contains(&i) && (20..24).contains(&j);
        let yaw = if i < 16 { -40.0 } else { 40.0 };
        let longitude = Angle::from_degrees(yaw + i as f64);
        (!hole).then(|| Direction::from_longitude_latitude(longitude, Angle::from_degrees(j as f64)))
    }))
}

#[test]
fn nothing_is_interpolated_across_a_tear() {
    let map = torn();
    let longitude = |x: f64| {
        let seen = map.unproject(PlanePoint::new(x / 32.0 - 0.5, 0.1)).unwrap();
        seen.longitude_latitude().0.degrees()
    };
    // Column 15 ends at 16, where it sees half a pixel beyond its middle.
    assert!((longitude(15.999) - (-40.0 + 15.499)).abs() < 0.02, "{}", longitude(15.999));
    assert!((longitude(16.001) - (40.0 + 15.501)).abs() < 0.02, "{}", longitude(16.001));
    for degrees in [-20.0, -10.0, 0.0, 30.0, 50.0] {
        let between = Direction::from_longitude_latitude(Angle::from_degrees(degrees), Angle::from_degrees(10.0));
        assert!(map.project(between).is_none(), "{degrees}");
    }
}

#[test]
fn holes_and_what_lies_outside_are_not_in_the_domain() {
    let map = torn();
    let at = |i: f64, j: f64| map.unproject(PlanePoint::new(i / 32.0 - 0.5, 0.5 - j / 32.0));
    assert!(at(22.0, 22.0).is_none() && at(20.1, 23.9).is_none());
    assert!(at(19.9, 22.0).is_some() && at(24.1, 22.0).is_some());
    assert!(at(-0.1, 5.0).is_none() && at(5.0, 32.1).is_none() && at(f64::NAN, 1.0).is_none());
    assert!(at(0.0, 0.0).is_some() && at(32.0, 32.0).is_some());
    let nothing = StMapTable::of_pixels(3, 3, |i, j| ((i + j) % 2 == 0).then_some(Direction::FRONT));
    assert_eq!(nothing.unwrap_err(), StMapError::NoCells { width: 3, height: 3 });
}

#[test]
fn a_table_goes_with_the_last_that_uses_it() {
    let map = map_of(StMapTable::of_pixels(8, 8, |i, j| {
        ProjectionKind::PERSPECTIVE.unproject(PlanePoint::new(i as f64 / 8.0 - 0.5, j as f64 / 8.0 - 0.5))
    }));
    let table = Arc::downgrade(&map.0);
    let other = ProjectionKind::StMap(map.clone());
    assert!(other == ProjectionKind::StMap(map.clone()), "clones share a table");
    drop(map);
    assert!(table.upgrade().is_some());
    drop(other);
    assert!(table.upgrade().is_none());
}
