use super::Source;
use crate::camera::{Footprint, PixelPoint, View};
use crate::projection::Projection;
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// Blending of a view with others that show the same directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Blend {
    /// Priority: a view covers those of lower priority, and shares with those of the same.
    pub priority: i32,
    /// Width of the band at its border over which a view fades out; zero for no fading. Where no view fades, the finest
    /// one, with the most pixels per solid angle, is used alone.
    pub feather: Angle,
}

/// A view's share in one direction, before it is divided among all views.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Presence {
    /// Index of the view.
    pub(crate) index: usize,
    /// Place of the direction in its image.
    pub(crate) pixel: PixelPoint,
    /// Weight: one inside, falling to zero at a feathered border.
    weight: f64,
    /// Solid angle of a texel, in steradians.
    solid_angle: f64,
    blend: Blend,
}

impl Presence {
    /// Computes the presence of a view at a point of its image that shows something.
    pub(crate) fn at(index: usize, source: &Source, pixel: PixelPoint) -> Self {
        let (view, blend) = (&source.view, source.blend);
        let feather = blend.feather.radians();
        if feather > 0.0 {
            // If any view fades, the finest view is not needed.
            let weight = smooth(border_distance(source, pixel) / feather);
            return Self { index, pixel, weight, solid_angle: f64::INFINITY, blend };
        }
        let solid_angle = view.solid_angle(pixel).unwrap_or(f64::INFINITY);
        Self { index, pixel, weight: 1.0, solid_angle, blend }
    }

    /// Computes the presence of a view in a direction; `None` where the view does not show it.
    pub(crate) fn of(index: usize, source: &Source, direction: Direction) -> Option<Self> {
        // Of many views that overlap, most show other parts of what they share.
        if !source.may_hold(direction) {
            return None;
        }
        let pixel = source.view.wrapped(source.view.pixel(direction)?);
        source.shows(pixel).then(|| Self::at(index, source, pixel))
    }

    /// Returns whether its texels are as small as the smallest of all, whose solid angle is `least`.
    fn is_as_fine(&self, least: f64) -> bool {
        const ROUNDING: f64 = 1.000_001;
        self.solid_angle <= least * ROUNDING
    }
}

/// Returns the share of each view that shows a direction; the shares add to one.
///
/// Shares are continuous wherever borders are feathered: a view's weight is zero where it begins, and goes over to
/// other views where it ends.
pub(crate) fn parts(present: &[Presence]) -> Vec<f64> {
    let mut parts = vec![0.0; present.len()];
    let mut left = 1.0;
    let mut order: Vec<usize> = (0..present.len()).collect();
    order.sort_by_key(|at| std::cmp::Reverse(present[*at].blend.priority));
    for group in order.chunk_by(|a, b| present[*a].blend.priority == present[*b].blend.priority) {
        let all = || group.iter().map(|at| &present[*at]);
        let fades = all().any(|one| one.blend.feather.radians() > 0.0);
        let least = all().map(|one| one.solid_angle).fold(f64::INFINITY, f64::min);
        let weigh = |one: &Presence| if fades { one.weight } else { f64::from(u8::from(one.is_as_fine(least))) };
        let sum: f64 = all().map(weigh).sum();
        if sum > 0.0 {
            let covered = sum.min(1.0);
            group.iter().for_each(|at| parts[*at] = left * covered * weigh(&present[*at]) / sum);
            left *= 1.0 - covered;
        }
    }
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 {
        parts.iter_mut().for_each(|part| *part /= sum);
    } else {
        // The direction is on the very border of all views that show it.
        parts.fill((present.len() as f64).recip());
    }
    parts
}

/// Returns a smooth step from 0 to 1 without a kink at either end. For two views that overlap by their feather the
/// weights add to one.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the approximate distance of a point of an image to the border of its picture, in radians.
fn border_distance(source: &Source, pixel: PixelPoint) -> f64 {
    let view = &source.view;
    let Some(footprint) = view.footprint(pixel) else { return 0.0 };
    let mut distance = source.border.distance(view, pixel, &footprint);
    if let Some(mask) = &source.mask {
        let DirectionJacobian { dx, dy } = footprint.jacobian;
        distance = distance.min(mask.depth(pixel) * dx.length().min(dy.length()));
    }
    distance
}

/// Edges of an image at which its picture ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Border {
    /// Left and right edges; false if the picture goes all the way round.
    sides: bool,
    /// Upper edge; false if it is a pole.
    top: bool,
    /// Lower edge; false if it is a pole.
    bottom: bool,
}

impl Border {
    /// Finds the edges at which a view's picture ends.
    pub(crate) fn of(view: &View) -> Self {
        Self {
            sides: view.period().is_none_or(|period| period > view.width()),
            top: !is_a_point(view, 0.0),
            bottom: !is_a_point(view, view.height() as f64),
        }
    }

    /// Returns the approximate distance of a point of the image to the picture's border, in radians.
    fn distance(self, view: &View, pixel: PixelPoint, footprint: &Footprint) -> f64 {
        let DirectionJacobian { dx, dy } = footprint.jacobian;
        let (right, bottom) = (view.width() as f64, view.height() as f64);
        let mut distance = f64::INFINITY;
        if self.sides {
            distance = distance.min(pixel.x.min(right - pixel.x) * dx.length());
        }
        for (edge, ends) in [(pixel.y, self.top), (bottom - pixel.y, self.bottom)] {
            if ends {
                distance = distance.min(edge * dy.length());
            }
        }
        if view.projection.ends_at_cone() {
            distance = distance.min(view.margin(footprint.direction));
        }
        distance.max(0.0).min(stop_distance(view, pixel, &footprint.jacobian))
    }
}

/// Returns whether a row of an image is a pole, where the picture does not end.
fn is_a_point(view: &View, y: f64) -> bool {
    let ends = [0.0, view.width() as f64 / 3.0].map(|x| view.direction(PixelPoint::new(x, y)));
    matches!(ends, [Some(a), Some(b)] if a.angle_to(b).radians() < 1e-6)
}

/// Returns the approximate distance of a point of the image to the field stop, in radians.
fn stop_distance(view: &View, pixel: PixelPoint, jacobian: &DirectionJacobian) -> f64 {
    let mut distance = f64::INFINITY;
    if let Some(radius) = view.stop.circle {
        let point = view.grid.to_plane(pixel);
        let texel = jacobian.dx.length().min(jacobian.dy.length()) / view.grid.step().abs().min_element();
        distance = distance.min((radius - point.x.hypot(point.y)) * texel);
    }
    if let (Some(side), Some(direction)) = (view.stop.half_space, view.direction(pixel)) {
        distance = distance.min(side.dot(view.orientation.to_view(direction)).asin());
    }
    distance.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn presence(priority: i32, feather: f64, weight: f64, solid_angle: f64) -> Presence {
        let blend = Blend { priority, feather: Angle::from_degrees(feather) };
        Presence { index: 0, pixel: PixelPoint::new(0.0, 0.0), weight, solid_angle, blend }
    }

    #[test]
    fn without_feather_the_finest_has_all_and_equals_share() {
        assert_eq!(parts(&[presence(0, 0.0, 1.0, 2.0), presence(0, 0.0, 1.0, 1.0)]), [0.0, 1.0]);
        assert_eq!(parts(&[presence(0, 0.0, 1.0, 1.0), presence(0, 0.0, 1.0, 1.0)]), [0.5, 0.5]);
        assert_eq!(parts(&[presence(1, 0.0, 1.0, 2.0), presence(0, 0.0, 1.0, 1.0)]), [1.0, 0.0]);
    }

    #[test]
    fn a_fading_view_leaves_the_rest_to_the_others() {
        assert_eq!(parts(&[presence(1, 3.0, 0.25, 1.0), presence(0, 0.0, 1.0, 1.0)]), [0.25, 0.75]);
        assert_eq!(parts(&[presence(0, 3.0, 0.25, 1.0), presence(0, 3.0, 0.75, 1.0)]), [0.25, 0.75]);
        assert_eq!(parts(&[presence(0, 3.0, 0.25, 1.0)]), [1.0]);
        assert_eq!(parts(&[presence(0, 3.0, 0.0, 1.0), presence(0, 3.0, 0.0, 1.0)]), [0.5, 0.5]);
    }
}
