//! Points of published references, to the digits that those print.

use cosmorama::projection::{Octahedral, OctahedralKind, PlanePoint, Projection, ProjectionKind};
use cosmorama::sphere::{Angle, Direction};

/// PROJ's test/gie/builtins.gie, on the sphere of 6 400 000 m: longitude 2°, latitude 1°, and where that lands in metres.
/// PROJ compares to 0.1 mm.
#[test]
fn maps_are_those_of_proj() {
    const RADIUS: f64 = 6_400_000.0;
    for (projection, x, y) in [
        (ProjectionKind::MERCATOR, 223_402.144_255_274, 111_706.743_574_944),
        (ProjectionKind::EQUAL_AREA_CYLINDER, 223_402.144_255_274, 111_695.401_198_614),
        (ProjectionKind::MOLLWEIDE, 201_113.698_641_813, 124_066.283_433_860),
        (ProjectionKind::HAMMER, 223_373.788_703_241, 111_703.907_397_767),
        (ProjectionKind::SINUSOIDAL, 223_368.119_026_632, 111_701.072_127_637),
    ] {
        for (sign_x, sign_y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let (longitude, latitude) = (Angle::from_degrees(2.0 * sign_x), Angle::from_degrees(sign_y));
            let direction = Direction::from_longitude_latitude(longitude, latitude);
            let point = projection.project(direction).expect("on the map");
            let error = (point.x * RADIUS - x * sign_x).hypot(point.y * RADIUS - y * sign_y);
            assert!(error < 1e-8, "{projection:?}: {error} m");
        }
    }
}

/// pbrt-v4's `EqualAreaSquareToSphere` (src/pbrt/util/math.cpp), evaluated independently: r = 1 − |1 − u − v|,
/// φ = ((v − u)/r + 1) π/4, z = ±(1 − r²), its z where our front is.
#[test]
fn the_equal_area_octahedron_is_pbrt_s() {
    let pbrt = |x: f64, y: f64| {
        let (u, v) = (x.abs(), y.abs());
        let signed = 1.0 - (u + v);
        let r = 1.0 - signed.abs();
        let phi = ((v - u) / r + 1.0) * std::f64::consts::FRAC_PI_4;
        let across = r * (2.0 - r * r).sqrt();
        (phi.cos().copysign(x) * across, phi.sin().copysign(y) * across, (1.0 - r * r).copysign(signed))
    };
    let octahedron = ProjectionKind::Octahedral(Octahedral(OctahedralKind::EqualArea));
    for step in 0..400 {
        let (x, y) = (f64::from(step % 20) / 10.0 - 0.93, f64::from(step / 20) / 10.0 - 0.97);
        let (px, py, pz) = pbrt(x, y);
        let seen = octahedron.unproject(PlanePoint::new(x, y)).expect("in the square").vector();
        let error = (seen.x - px).abs() + (seen.y - py).abs() + (seen.z + pz).abs();
        assert!(error < 1e-14, "({x}, {y}): {seen}, not ({px}, {py}, {pz})");
    }
}
