use super::{FieldStop, Footprint, PixelPoint, PixelRect, View};
use crate::projection::{PlanePoint, Projection};
use crate::sphere::Direction;

/// A pixel of a target: the fraction of it that the field of view covers, and the footprint of that part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenPixel {
    /// The covered part of the pixel's area, more than 0, at most 1.
    pub coverage: f64,
    /// Footprint at the centroid of the covered part, which is the centre of a whole pixel.
    pub footprint: Footprint,
}

/// Angle, in radians, below which a great circle is taken as straight: sub-samples cannot tell the difference.
const STRAIGHT: f64 = 0.05;

/// Sub-samples per side that measure a partly covered pixel.
const SUB_SAMPLES: usize = 16;

/// Corners of a pixel, relative to its centre.
const CORNERS: [(f64, f64); 4] = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];

/// Position of a pixel relative to the edge of the field of view.
enum Side {
    Inside,
    Outside,
    /// Circle, great circle, or both, that may cut the pixel.
    Cut {
        circle: FieldStop,
        great_circle: Option<GreatCircle>,
    },
    /// The centre or a corner has no direction, so anything may cut the pixel.
    Unknown,
}

/// Sines of the elevations of a pixel's corners above a great circle. Within a pixel the circle is nearly straight.
struct GreatCircle {
    centre: PixelPoint,
    sines: [[f64; 2]; 2],
}

impl GreatCircle {
    fn sine(&self, point: PixelPoint) -> f64 {
        let (s, t) = (point.x - self.centre.x + 0.5, point.y - self.centre.y + 0.5);
        let [above, below] = self.sines.map(|[left, right]| left + (right - left) * s);
        above + (below - above) * t
    }
}

impl View {
    /// Returns the pixel in column `i` of row `j`; `None` if it shows nothing.
    ///
    /// A pixel that the rim or the lower arc cuts is weighted by its covered part, so both edges come out smooth.
    pub fn screen_pixel(&self, i: usize, j: usize) -> Option<ScreenPixel> {
        let centre = PixelPoint::centre(i, j);
        if self.is_beyond_circle(centre) {
            return None;
        }
        let footprint = self.pixel_footprint(centre);
        if footprint.is_none() && self.projection.ends_between_samples() && !self.has_corner(centre) {
            return None;
        }
        match footprint.as_ref().map_or(Side::Unknown, |footprint| self.side(centre, footprint)) {
            Side::Inside => footprint.map(|footprint| ScreenPixel { coverage: 1.0, footprint }),
            Side::Outside => None,
            Side::Cut { circle, great_circle } => self.cut_pixel(i as f64, j as f64, |sample| {
                circle.passes(self.grid.to_plane(sample), || None)
                    && great_circle.as_ref().is_none_or(|side| side.sine(sample) >= 0.0)
            }),
            Side::Unknown => self.cut_pixel(i as f64, j as f64, |sample| self.shows(sample)),
        }
    }

    /// Returns the direction of the centre of the pixel in column `i` of row `j`, with its derivatives per pixel.
    /// `None` if the centre shows nothing, even if a part of the pixel does.
    pub fn centre_footprint(&self, i: usize, j: usize) -> Option<Footprint> {
        let centre = PixelPoint::centre(i, j);
        if !self.shows(centre) {
            return None;
        }
        self.pixel_footprint(centre).or_else(|| self.footprint(centre))
    }

    /// Returns the footprint of a pixel around a point. Beside a steep rim it is measured from side to side, because
    /// derivatives would overestimate its length.
    fn pixel_footprint(&self, pixel: PixelPoint) -> Option<Footprint> {
        let footprint = self.footprint(pixel)?;
        if !self.projection.has_steep_rim() {
            return Some(footprint);
        }
        Some(Footprint { jacobian: self.texel(pixel)?, ..footprint })
    }

    /// Classifies a pixel without sub-samples where it cannot touch the edge: it reaches no further than its half
    /// diagonals.
    fn side(&self, centre: PixelPoint, footprint: &Footprint) -> Side {
        if self.ends_within(centre, footprint) {
            return Side::Unknown;
        }
        let (mut circle, mut great_circle) = (FieldStop::NONE, None);
        if let Some(radius) = self.stop.circle {
            let (distance, half_diagonal) = self.distance_from_axis(centre);
            if distance + half_diagonal > radius {
                circle = FieldStop::circle(radius);
            }
        }
        if let Some(side) = self.stop.half_space {
            let sine = side.dot(self.orientation.to_view(footprint.direction));
            // Twice the linear half diagonal: room for the mapping's curvature.
            let reach = footprint.jacobian.dx.length() + footprint.jacobian.dy.length();
            if sine < -reach {
                return Side::Outside;
            }
            if sine < reach {
                // Across a pixel of many degrees a great circle is not straight.
                great_circle = if reach < STRAIGHT { self.great_circle(side, centre) } else { None };
                if great_circle.is_none() {
                    return Side::Unknown;
                }
            }
        }
        if circle == FieldStop::NONE && great_circle.is_none() {
            Side::Inside
        } else {
            Side::Cut { circle, great_circle }
        }
    }

    /// Returns whether all of a rectangle of pixels is outside the limiting circle or the outline of an oval map.
    pub(crate) fn outline_hides(&self, PixelRect { left, top, right, bottom }: PixelRect) -> bool {
        if self.stop.circle.is_none() && !self.projection.is_oval() {
            return false;
        }
        let start = self.grid.to_plane(PixelPoint::new(left as f64, top as f64));
        let end = self.grid.to_plane(PixelPoint::new(right as f64, bottom as f64));
        let nearest = |a: f64, b: f64| if a * b <= 0.0 { 0.0 } else { a.abs().min(b.abs()) };
        let nearest = PlanePoint::new(nearest(start.x, end.x), nearest(start.y, end.y));
        self.stop.circle.is_some_and(|radius| nearest.x.hypot(nearest.y) > radius)
            || (self.projection.is_oval() && self.projection.unproject(nearest).is_none())
    }

    /// Returns whether all of a pixel is outside the limiting circle.
    fn is_beyond_circle(&self, centre: PixelPoint) -> bool {
        let (distance, half_diagonal) = self.distance_from_axis(centre);
        self.stop.circle.is_some_and(|radius| distance - half_diagonal > radius)
    }

    /// Returns the distance of a pixel's centre from the lens's axis, and of its corners from the centre, in plane
    /// units.
    fn distance_from_axis(&self, centre: PixelPoint) -> (f64, f64) {
        let (point, step) = (self.grid.to_plane(centre), self.grid.step());
        ((point.x * point.x + point.y * point.y).sqrt(), step.length() / 2.0)
    }

    /// Returns the elevations of a pixel's corners above a great circle.
    fn great_circle(&self, side: Direction, centre: PixelPoint) -> Option<GreatCircle> {
        let sine = |x: f64, y: f64| {
            let point = self.grid.to_plane(PixelPoint::new(centre.x + x, centre.y + y));
            self.projection.unproject(point).map(|direction| side.dot(direction))
        };
        let sines = [[sine(-0.5, -0.5)?, sine(0.5, -0.5)?], [sine(-0.5, 0.5)?, sine(0.5, 0.5)?]];
        Some(GreatCircle { centre, sines })
    }

    /// Returns whether any corner of a pixel shows something.
    fn has_corner(&self, centre: PixelPoint) -> bool {
        CORNERS.iter().any(|(x, y)| self.direction(PixelPoint::new(centre.x + x, centre.y + y)).is_some())
    }

    /// Returns whether the edge of the projection cuts a pixel, as the outline of an oval map does: a corner shows
    /// nothing.
    fn ends_within(&self, centre: PixelPoint, footprint: &Footprint) -> bool {
        let reach = footprint.jacobian.dx.length() + footprint.jacobian.dy.length();
        // A cylinder ends where its image does, and a row of samples on the very pole has whole pixels.
        self.projection.period().is_none()
            && self.margin(footprint.direction) < reach
            && CORNERS.iter().any(|(x, y)| self.direction(PixelPoint::new(centre.x + x, centre.y + y)).is_none())
    }

    fn cut_pixel(&self, x: f64, y: f64, is_inside: impl Fn(PixelPoint) -> bool) -> Option<ScreenPixel> {
        let (mut count, mut sum_x, mut sum_y) = (0usize, 0.0, 0.0);
        for b in 0..SUB_SAMPLES {
            for a in 0..SUB_SAMPLES {
                let offset = |k: usize| (k as f64 + 0.5) / SUB_SAMPLES as f64;
                let sample = PixelPoint::new(x + offset(a), y + offset(b));
                if is_inside(sample) {
                    count += 1;
                    sum_x += sample.x;
                    sum_y += sample.y;
                }
            }
        }
        if count == 0 {
            return None;
        }
        let centroid = PixelPoint::new(sum_x / count as f64, sum_y / count as f64);
        let footprint = self.pixel_footprint(centroid)?;
        Some(ScreenPixel { coverage: count as f64 / (SUB_SAMPLES * SUB_SAMPLES) as f64, footprint })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, OmnimaxCamera, WorldMapCamera};
    use crate::sphere::{Angle, Orientation};

    /// Returns the largest difference between the quick coverage and that of plain sub-samples, and the number of cut
    /// pixels.
    fn worst(view: &View) -> (f64, usize) {
        let (mut worst, mut cut) = (0f64, 0);
        for (j, i) in (0..view.height()).flat_map(|j| (0..view.width()).map(move |i| (j, i))) {
            let slow = view.cut_pixel(i as f64, j as f64, |sample| view.shows(sample));
            let [quick, slow] = [view.screen_pixel(i, j), slow].map(|pixel| pixel.map_or(0.0, |pixel| pixel.coverage));
            worst = worst.max((quick - slow).abs());
            cut += usize::from(slow > 0.0 && slow < 1.0);
        }
        (worst, cut)
    }

    #[test]
    fn outside_the_outline_of_a_map_no_pixel_shows_anything() {
        for frame in [WorldMapCamera::Hammer, WorldMapCamera::Mollweide, WorldMapCamera::Sinusoidal] {
            let view = CameraModel::WorldMap(frame).view(80, 40).expect("a map");
            // Tested also in a crop, which begins past the middle.
            for view in [view.clone(), View { grid: view.grid.window(50, 30, 40.3, 20.7), ..view }] {
                let (mut hidden, mut empty) = (0, 0);
                for (j, i) in (0..view.height()).flat_map(|j| (0..view.width()).map(move |i| (j, i))) {
                    let shows = view.cut_pixel(i as f64, j as f64, |sample| view.shows(sample)).is_some();
                    let is_hidden = view.outline_hides(PixelRect { left: i, top: j, right: i + 1, bottom: j + 1 });
                    assert!(!(shows && is_hidden), "{frame:?}: ({i}, {j})");
                    hidden += usize::from(is_hidden);
                    empty += usize::from(!shows);
                }
                assert!(hidden > 100 && hidden + 20 > empty, "{frame:?}: {hidden} of {empty}");
            }
        }
    }

    #[test]
    fn straight_great_circles_cut_as_the_stop_does() {
        let frame = CameraModel::Omnimax(OmnimaxCamera { axis: Angle::from_degrees(11.0), ..OmnimaxCamera::default() });
        let view = frame.view(491, 359).expect("an Omnimax frame");
        let turned = Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(20.0),
            Angle::from_degrees(-30.0),
            Angle::from_degrees(5.0),
        );
        for view in [view.clone(), View { orientation: turned, ..view }] {
            let (worst, cut) = worst(&view);
            assert!(cut > 500, "{cut} pixels are cut");
            // A row of sub-samples that just touches the circle may fall to either side.
            assert!(worst < 1.0 / SUB_SAMPLES as f64, "{worst}");
        }
    }
}
