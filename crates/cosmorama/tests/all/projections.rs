//! One loop over every projection: inverse both ways, Jacobian against central differences, no NaN for any input.

use cosmorama::projection::{PlanePoint, Projection, ProjectionKind};
use cosmorama::sphere::{Direction, DirectionJacobian};
use glam::DVec3;
use proptest::prelude::*;
use std::sync::LazyLock;

static EVERY: LazyLock<Vec<ProjectionKind>> = LazyLock::new(ProjectionKind::all);

/// Beside a rim where derivatives grow without bound, f64 does not hold more of a direction than this, in radians.
fn rounding_of_direction(jacobian: DirectionJacobian, point: PlanePoint) -> f64 {
    8.0 * f64::EPSILON * largest(jacobian) * point.x.hypot(point.y).max(1.0)
}

/// And beside a pole, where they vanish, no more of a point.
fn rounding_of_point(jacobian: DirectionJacobian) -> f64 {
    8.0 * f64::EPSILON * largest(jacobian) / jacobian.solid_angle()
}

fn largest(jacobian: DirectionJacobian) -> f64 {
    jacobian.dx.length().max(jacobian.dy.length())
}

fn any_direction() -> impl Strategy<Value = Direction> {
    (-1.0..1.0f64, -std::f64::consts::PI..std::f64::consts::PI).prop_map(|(y, longitude)| {
        let across = (1.0 - y * y).sqrt();
        Direction::from_unit(DVec3::new(across * longitude.sin(), y, -across * longitude.cos()))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn a_direction_comes_back(direction in any_direction()) {
        for projection in EVERY.iter() {
            let Some(point) = projection.project(direction) else { continue };
            let (back, jacobian) =
                projection.unproject_with_jacobian(point).expect("what was projected is in the domain");
            let bound = rounding_of_direction(jacobian, point).max(1e-12);
            prop_assert!(back.angle_to(direction).radians() < bound, "{projection:?}: {direction:?} -> {back:?}");
        }
    }

    #[test]
    fn a_point_comes_back(x in -3.0..3.0f64, y in -1.6..1.6f64) {
        for projection in EVERY.iter() {
            let point = PlanePoint::new(x, y);
            let Some((direction, jacobian)) = projection.unproject_with_jacobian(point) else { continue };
            let back = projection.project(direction).expect("what was unprojected is in the domain");
            let bound = rounding_of_point(jacobian).max(1e-11);
            prop_assert!((back.x - x).hypot(back.y - y) < bound, "{projection:?}: ({x}, {y}) -> {back:?}");
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative(x in -3.0..3.0f64, y in -1.6..1.6f64) {
        const STEP: f64 = 1e-5;
        for projection in EVERY.iter() {
            let at = |dx: f64, dy: f64| projection.unproject(PlanePoint::new(x + dx, y + dy)).map(Direction::vector);
            let difference = |dx: f64, dy: f64| Some((at(dx, dy)? - at(-dx, -dy)?) / (2.0 * dx.hypot(dy)));
            let Some((direction, jacobian)) = projection.unproject_with_jacobian(PlanePoint::new(x, y)) else { continue };
            // Across a crease or a seam there is no derivative.
            if projection.margin(direction) < 4.0 * STEP * largest(jacobian) {
                continue;
            }
            for (derivative, dx, dy) in [(jacobian.dx, STEP, 0.0), (jacobian.dy, 0.0, STEP)] {
                // How good a difference is, one of twice the step tells: beside a rim not very.
                let (Some(near), Some(far)) = (difference(dx, dy), difference(2.0 * dx, 2.0 * dy)) else { continue };
                let bound = (near - far).length().max(1e-8);
                prop_assert!((derivative - near).length() < bound, "{projection:?}: {derivative:?} is not {near:?}");
            }
        }
    }

    #[test]
    fn plane_derivatives_invert_the_jacobian(x in -1.2..1.2f64, y in -1.2..1.2f64) {
        for projection in EVERY.iter() {
            let point = PlanePoint::new(x, y);
            let Some((direction, jacobian)) = projection.unproject_with_jacobian(point) else { continue };
            let (_, [along_x, along_y]) = projection
                .project_with_derivatives(direction, [jacobian.dx, jacobian.dy])
                .expect("inside the domain");
            prop_assert!((along_x - glam::DVec2::X).length() < 1e-9, "{projection:?}: {along_x:?}");
            prop_assert!((along_y - glam::DVec2::Y).length() < 1e-9, "{projection:?}: {along_y:?}");
        }
    }

    #[test]
    fn nothing_is_nan(x in any::<f64>(), y in any::<f64>()) {
        for projection in EVERY.iter() {
            let point = PlanePoint::new(x, y);
            if let Some(direction) = projection.unproject(point) {
                prop_assert!(direction.vector().is_finite(), "{projection:?} at {point:?}");
            }
            if let Some(jacobian) = projection.jacobian(point) {
                prop_assert!(jacobian.dx.is_finite() && jacobian.dy.is_finite(), "{projection:?} at {point:?}");
            }
        }
    }

    #[test]
    fn a_cap_lies_within_its_bounds(
        centre in any_direction(),
        radius in 0.001..0.6f64,
        bearing in 0.0..std::f64::consts::TAU,
        part in 0.0..1.0f64,
    ) {
        let (right, up) = centre.vector().any_orthonormal_pair();
        let (sin, cos) = (radius * part).sin_cos();
        let inside = centre.vector() * cos + (right * bearing.cos() + up * bearing.sin()) * sin;
        let inside = Direction::from_unit(inside);
        for projection in EVERY.iter() {
            let Some(point) = projection.project(inside) else { continue };
            let bounds = projection.cap_bounds(centre, cosmorama::sphere::Angle::from_radians(radius));
            let turns = projection.period().map_or(vec![0.0], |period| vec![-period, 0.0, period]);
            let held = turns.iter().any(|turn| {
                let x = point.x + turn;
                x >= bounds.min.x - 1e-9 && x <= bounds.max.x + 1e-9
            });
            prop_assert!(
                held && point.y >= bounds.min.y - 1e-9 && point.y <= bounds.max.y + 1e-9,
                "{projection:?}: {point:?} is not in {bounds:?}"
            );
            // Rounding near the border, along the line's direction and across it.
            let outline = projection.cap_outline(centre, cosmorama::sphere::Angle::from_radians(radius * (1.0 + 1e-6)));
            let mut spans = Vec::new();
            outline.cut(point.y, &mut spans);
            let is_cut = spans.iter().any(|[left, right]| (left - 1e-9..=right + 1e-9).contains(&point.x));
            prop_assert!(is_cut || projection.period().is_some(), "{projection:?}: {point:?} is not in {outline:?}");
        }
    }
}

#[test]
fn the_axes_and_the_poles_have_images_or_none_but_never_nan() {
    let axes = [Direction::FRONT, Direction::BACK, Direction::LEFT, Direction::RIGHT, Direction::UP, Direction::DOWN];
    for projection in EVERY.iter() {
        for direction in axes {
            if let Some(point) = projection.project(direction) {
                assert!(point.x.is_finite() && point.y.is_finite(), "{projection:?} of {direction:?}: {point:?}");
                assert!(projection.margin(direction).is_finite());
            }
        }
        // A mirror ball shows its photographer, everything else what lies ahead.
        let axis = projection.unproject(PlanePoint::new(0.0, 0.0)).expect("the middle of the plane shows something");
        let expected = match projection {
            ProjectionKind::MirrorBall(_) => Direction::BACK,
            _ => Direction::FRONT,
        };
        assert_eq!(axis, expected, "{projection:?}");
        assert_eq!(projection.project(axis), Some(PlanePoint::new(0.0, 0.0)), "{projection:?}");
    }
}

proptest! {
    // A thousand points each.
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn a_row_is_its_points(x in -1.2..1.2f64, y in -1.2..1.2f64, step in -0.01..0.01f64) {
        for projection in EVERY.iter() {
            let mut visited = 0;
            projection.unproject_row(PlanePoint::new(x, y), step, 1000, |k, direction| {
                let expected = projection.unproject(PlanePoint::new(x + k as f64 * step, y));
                let near = expected.is_some_and(|expected| expected.angle_to(direction).radians() < 1e-12);
                assert!(near, "{projection:?}: number {k} is {direction:?}, not {expected:?}");
                visited += 1;
            });
            let all = (0..1000).filter(|&k| projection.unproject(PlanePoint::new(x + f64::from(k) * step, y)).is_some());
            prop_assert_eq!(visited, all.count());
            projection.row_solid_angles(PlanePoint::new(x, y), step, 20, |k, solid_angle| {
                let jacobian = projection.jacobian(PlanePoint::new(x + k as f64 * step, y));
                let expected = jacobian.map(|jacobian| jacobian.solid_angle());
                let is_it = match (solid_angle, expected) {
                    (Some(found), Some(expected)) => (found - expected).abs() <= 1e-12 * expected,
                    (found, expected) => found.is_none() && expected.is_none(),
                };
                assert!(is_it, "{projection:?}: number {k} is {solid_angle:?}, not {expected:?}");
            });
        }
    }
}
