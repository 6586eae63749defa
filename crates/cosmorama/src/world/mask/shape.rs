use crate::camera::PixelPoint;

/// A shape in an image that a mask keeps or removes.
#[derive(Clone, Debug, PartialEq)]
pub enum MaskShape {
    /// Keeps only the inside of a circle.
    Circle {
        /// Centre of the circle.
        centre: PixelPoint,
        /// Radius in pixels.
        radius: f64,
    },
    /// Removes the inside of a polygon; where it crosses itself, by the even-odd rule.
    Hole(Vec<PixelPoint>),
}

impl MaskShape {
    /// Returns whether this shape keeps a point of the image.
    pub fn leaves(&self, point: PixelPoint) -> bool {
        self.row(point.y).leaves(point.x)
    }

    /// Returns the part of a horizontal line that the shape keeps.
    pub(crate) fn row(&self, y: f64) -> RowCut {
        match self {
            Self::Circle { centre, radius } => {
                RowCut::Circle { middle: centre.x, height: y - centre.y, radius: *radius }
            }
            Self::Hole(corners) => RowCut::Hole(crossings(corners, y)),
        }
    }
}

/// The part of a horizontal line that a shape keeps. A polygon's corners are examined once per line.
#[derive(Clone, Debug)]
pub(crate) enum RowCut {
    Circle {
        middle: f64,
        /// Height of the line above the circle's centre.
        height: f64,
        radius: f64,
    },
    /// Crossings of the line with a polygon, from left to right.
    Hole(Vec<f64>),
}

impl RowCut {
    /// Returns whether the point at `x` is kept.
    pub(crate) fn leaves(&self, x: f64) -> bool {
        match self {
            Self::Circle { middle, height, radius } => (x - middle).hypot(*height) <= *radius,
            // A ray to the right leaves the polygon an even number of times.
            Self::Hole(crossings) => {
                (crossings.len() - crossings.partition_point(|crossing| *crossing <= x)).is_multiple_of(2)
            }
        }
    }
}

fn crossings(corners: &[PixelPoint], y: f64) -> Vec<f64> {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossing = sides.filter(|(a, b)| (a.y > y) != (b.y > y));
    let mut crossings: Vec<f64> = crossing.map(|(a, b)| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)).collect();
    crossings.sort_unstable_by(f64::total_cmp);
    crossings
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
