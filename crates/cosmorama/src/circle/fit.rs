use glam::{DMat3, DVec2, DVec3};

/// A circle in a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre, from the picture's upper left corner.
    pub centre: (f64, f64),
    /// Radius.
    pub radius: f64,
}

impl Circle {
    /// Returns the distance of a point outside the circle; negative inside.
    pub(super) fn beyond(&self, point: DVec2) -> f64 {
        (point - DVec2::from(self.centre)).length() - self.radius
    }

    /// Returns the circle through three points; `None` if they are collinear.
    pub(super) fn through([a, b, c]: [DVec2; 3]) -> Option<Self> {
        let (to_b, to_c) = (b - a, c - a);
        let twice_area = 2.0 * to_b.perp_dot(to_c);
        if twice_area.abs() < 1e-6 * (to_b.length_squared() + to_c.length_squared()) {
            return None;
        }
        let (bb, cc) = (to_b.length_squared(), to_c.length_squared());
        let from_a = DVec2::new(to_c.y * bb - to_b.y * cc, to_b.x * cc - to_c.x * bb) / twice_area;
        Some(Self { centre: (a + from_a).into(), radius: from_a.length() })
    }

    /// Fits a circle to points by least squares, starting from this one. Distant points get less weight (Tukey's
    /// biweight, scaled by the median distance).
    pub(super) fn fitted(self, points: &[DVec2]) -> Option<Self> {
        let mut circle = self;
        for _ in 0..24 {
            let reach = 4.7 * (1.4826 * circle.median_distance(points)).max(0.05);
            let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
            for &point in points {
                let distance = circle.beyond(point);
                let part = 1.0 - (distance / reach).powi(2);
                if part > 0.0 {
                    let away = (point - DVec2::from(circle.centre)).normalize_or_zero();
                    let slope = DVec3::new(away.x, away.y, 1.0);
                    normal += DMat3::from_cols(slope * slope.x, slope * slope.y, slope * slope.z) * (part * part);
                    right += slope * (part * part * distance);
                }
            }
            if normal.determinant().abs() < 1e-9 {
                return None;
            }
            let step = normal.inverse() * right;
            circle =
                Self { centre: (circle.centre.0 + step.x, circle.centre.1 + step.y), radius: circle.radius + step.z };
            if step.length() < 1e-5 {
                break;
            }
        }
        (circle.radius.is_finite() && circle.radius > 0.0).then_some(circle)
    }

    pub(super) fn median_distance(&self, points: &[DVec2]) -> f64 {
        let mut distances: Vec<f64> = points.iter().map(|point| self.beyond(*point).abs()).collect();
        distances.sort_by(f64::total_cmp);
        distances.get(distances.len() / 2).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_far_off_do_not_count() {
        let on = |degrees: f64| DVec2::new(50.0, 40.0) + 30.0 * DVec2::from_angle(degrees.to_radians());
        let mut points: Vec<DVec2> = (0..200).map(|k| on(f64::from(k) * 1.3)).collect();
        points.extend((0..60).map(|k| DVec2::new(f64::from(k), 3.0)));
        let start = Circle::through([on(3.0), on(100.0), on(222.0)]).unwrap();
        let circle = Circle { radius: start.radius + 1.5, ..start }.fitted(&points).unwrap();
        assert!((circle.radius - 30.0).abs() < 1e-3 && (circle.centre.0 - 50.0).abs() < 1e-3, "{circle:?}");
        assert_eq!(Circle::through([DVec2::ZERO, DVec2::X, 2.0 * DVec2::X]), None);
    }
}
