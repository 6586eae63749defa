use super::PixelPoint;

/// A shape in an image, that a mask leaves or takes away.
#[derive(Clone, Debug, PartialEq)]
pub enum MaskShape {
    /// Only what lies in the circle counts.
    Circle {
        /// Its centre.
        centre: PixelPoint,
        /// Its radius in pixels.
        radius: f64,
    },
    /// What lies in the polygon does not count; where it crosses itself, by even and odd.
    Hole(Vec<PixelPoint>),
}

impl MaskShape {
    /// Whether a point of the image counts, as far as this shape is concerned.
    pub fn leaves(&self, point: PixelPoint) -> bool {
        match self {
            Self::Circle { centre, radius } => (point.x - centre.x).hypot(point.y - centre.y) <= *radius,
            Self::Hole(corners) => !is_within(corners, point),
        }
    }
}

/// Whether a ray to the right leaves a polygon an odd number of times.
fn is_within(corners: &[PixelPoint], point: PixelPoint) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crossings = corners.iter().zip(next).filter(|(a, b)| {
        let crosses = (a.y > point.y) != (b.y > point.y);
        crosses && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)
    });
    crossings.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hole_is_what_its_corners_enclose() {
        let corners = [(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (5.0, 4.0), (1.0, 9.0)];
        let hole = MaskShape::Hole(corners.map(|(x, y)| PixelPoint::new(x, y)).to_vec());
        for (x, y, leaves) in
            [(5.0, 2.0, false), (5.0, 6.0, true), (2.0, 6.0, false), (0.5, 5.0, true), (9.5, 5.0, true)]
        {
            assert_eq!(hole.leaves(PixelPoint::new(x, y)), leaves, "({x}, {y})");
        }
        assert!(MaskShape::Hole(Vec::new()).leaves(PixelPoint::new(0.0, 0.0)));
        let circle = MaskShape::Circle { centre: PixelPoint::new(5.0, 5.0), radius: 2.0 };
        assert!(circle.leaves(PixelPoint::new(6.9, 5.0)) && !circle.leaves(PixelPoint::new(6.5, 6.5)));
    }
}
