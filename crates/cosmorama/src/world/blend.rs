use super::Source;
use crate::camera::{Footprint, PixelPoint, View};
use crate::projection::Projection;
use crate::sphere::{Angle, Direction, DirectionJacobian};

/// How a view takes part where others show the same directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Blend {
    /// A view of higher priority covers those of lower priority; those of the same one share.
    pub priority: i32,
    /// Over how wide a band at its border a view fades out, zero for not at all. Where no view fades, the finest one, which
    /// has most pixels for a solid angle, has it all.
    pub feather: Angle,
}

/// What a view has of one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Presence {
    /// Index of the view.
    pub(crate) index: usize,
    /// Where in its image.
    pub(crate) pixel: PixelPoint,
    /// One inside, falling to zero at a feathered border.
    weight: f64,
    /// Of a texel, in steradians.
    solid_angle: f64,
    blend: Blend,
}

impl Presence {
    /// Computes the presence of a view at a point of its image that shows something.
    pub(crate) fn at(index: usize, source: &Source, pixel: PixelPoint) -> Self {
        let (view, blend) = (&source.view, source.blend);
        let feather = blend.feather.radians();
        if feather > 0.0 {
            // Where any view fades, which one is the finest does not matter.
            let weight = smooth(border_distance(source, pixel) / feather);
            return Self { index, pixel, weight, solid_angle: f64::INFINITY, blend };
        }
        let solid_angle = view.solid_angle(pixel).unwrap_or(f64::INFINITY);
        Self { index, pixel, weight: 1.0, solid_angle, blend }
    }

    /// Computes the presence of a view in a direction; `None` where the view does not show it.
    pub(crate) fn of(index: usize, source: &Source, direction: Direction) -> Option<Self> {
        let pixel = source.view.wrapped(source.view.pixel(direction)?);
        source.shows(pixel).then(|| Self::at(index, source, pixel))
    }
}

/// The part that each of the views which show a direction has of it; the parts add to one.
///
/// Parts are continuous wherever borders are feathered: a view comes in with weight zero, and what it leaves goes to the
/// others.
pub(crate) fn parts(present: &[Presence]) -> Vec<f64> {
    let mut parts = vec![0.0; present.len()];
    let mut left = 1.0;
    let mut priorities: Vec<i32> = present.iter().map(|one| one.blend.priority).collect();
    priorities.sort_unstable_by_key(|priority| std::cmp::Reverse(*priority));
    priorities.dedup();
    for priority in priorities {
        let group = || present.iter().enumerate().filter(move |(_, one)| one.blend.priority == priority);
        let fades = group().any(|(_, one)| one.blend.feather.radians() > 0.0);
        let weigh = |one: &Presence| if fades { one.weight } else { finest(one, group().map(|(_, other)| other)) };
        let sum: f64 = group().map(|(_, one)| weigh(one)).sum();
        if sum > 0.0 {
            let covered = sum.min(1.0);
            group().for_each(|(at, one)| parts[at] = left * covered * weigh(one) / sum);
            left *= 1.0 - covered;
        }
    }
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 {
        parts.iter_mut().for_each(|part| *part /= sum);
    } else {
        // On the very border of all that are there.
        parts.fill((present.len() as f64).recip());
    }
    parts
}

/// One for the view whose texels are smallest, and for those that are as fine.
fn finest<'a>(one: &Presence, all: impl Iterator<Item = &'a Presence>) -> f64 {
    const AS_FINE: f64 = 1.000_001;
    let least = all.map(|other| other.solid_angle).fold(f64::INFINITY, f64::min);
    f64::from(u8::from(one.solid_angle <= least * AS_FINE))
}

/// From 0 to 1 without a kink at either end; for two views that overlap by their feather, the two add to one.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// About how far a point of an image is from where its picture ends, in radians.
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

/// Which edges of an image are where its picture ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Border {
    /// Left and right: not where the picture goes all the way round.
    sides: bool,
    /// The upper one: not where it is a pole.
    top: bool,
    /// The lower one.
    bottom: bool,
}

impl Border {
    /// Finds at which edges of its image a view's picture ends.
    pub(crate) fn of(view: &View) -> Self {
        Self {
            sides: view.period().is_none_or(|period| period > view.width()),
            top: !is_a_point(view, 0.0),
            bottom: !is_a_point(view, view.height() as f64),
        }
    }

    /// About how far a point of the image is from where the picture ends, in radians.
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

/// Whether a row of an image is a pole: the picture does not end there.
fn is_a_point(view: &View, y: f64) -> bool {
    let ends = [0.0, view.width() as f64 / 3.0].map(|x| view.direction(PixelPoint::new(x, y)));
    matches!(ends, [Some(a), Some(b)] if a.angle_to(b).radians() < 1e-6)
}

/// Computes about how far a point of the image is from the field stop, in radians.
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
