use std::f64::consts::PI;
use std::fmt::{Display, Formatter};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::View;
use crate::explain::magnification::central_footprint;
use crate::explain::{FaceSize, Percent};
use crate::sphere::Direction;
use crate::world::World;

/// Directions that are tested, evenly over the sphere: the share that is seen is right to a few thousandths.
const DIRECTIONS: usize = 20_000;

/// Share of a world that a moving camera sees, and the sizes of images that suit it.
///
/// ```
/// use cosmorama::explain::PathReport;
/// use cosmorama::prelude::*;
///
/// let (world, _) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0)))?;
/// let camera = PerspectiveCamera::new(FieldOfView::Vertical(Angle::from_degrees(45.0)));
/// let view = CameraModel::from(camera).view(640, 480)?;
/// let report = PathReport::of(&world, &[vec![view]]);
/// // "About six percent" (Greene 1986).
/// assert!((report.seen - 0.059).abs() < 0.003);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PathReport {
    /// Number of frames.
    pub frames: usize,
    /// Fraction of all directions that some frame shows, 0 to 1.
    pub seen: f64,
    /// Least and greatest fraction of all directions that one frame shows.
    pub at_once: [f64; 2],
    /// Sizes for each view of the world, by its name: those that suit the frame with the finest pixels.
    pub advised: Vec<(String, FaceSize)>,
}

impl PathReport {
    /// Computes the report of a camera whose frames have these views each.
    pub fn of(world: &World, frames: &[Vec<View>]) -> Self {
        let directions: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
        let share = |seen: usize| seen as f64 / DIRECTIONS as f64;
        let (mut shapes, mut at_once) = (Vec::new(), [1.0_f64, 0.0_f64]);
        for (index, views) in frames.iter().enumerate() {
            if !shapes.last().is_some_and(|(_, shape): &(usize, Shape)| shape.is_of(views)) {
                let shape = Shape::of(views, &directions);
                at_once = [at_once[0].min(share(shape.seen)), at_once[1].max(share(shape.seen))];
                shapes.push((index, shape));
            }
        }
        let seen: Vec<AtomicBool> = directions.iter().map(|_| AtomicBool::new(false)).collect();
        frames.par_iter().enumerate().for_each(|(index, views)| {
            let shape = &shapes[shapes.partition_point(|(first, _)| *first <= index) - 1].1;
            let near = shape.cap(views);
            for (direction, seen) in directions.iter().zip(&seen) {
                if !seen.load(Relaxed) && near(*direction) && sees(views, *direction) {
                    seen.store(true, Relaxed);
                }
            }
        });
        let seen = seen.into_iter().filter(|seen| seen.load(Relaxed)).count();
        let centres: Vec<_> = frames.iter().flatten().filter_map(central_footprint).collect();
        let finest = centres.iter().min_by(|a, b| a.jacobian.solid_angle().total_cmp(&b.jacobian.solid_angle()));
        let advice = |source: &crate::world::Source| {
            let size = FaceSize::of(&source.view, finest?)?;
            Some((source.name.clone(), size))
        };
        Self {
            frames: frames.len(),
            seen: share(seen),
            at_once,
            advised: world.sources().iter().filter_map(advice).collect(),
        }
    }
}

/// Views of a frame, but for how they are turned together, and what they show.
struct Shape<'a> {
    views: &'a [View],
    /// Number of directions that they show.
    seen: usize,
    /// Middle of these in the frame of the first view, and cosine of an angle within which all that is shown lies; `None` if it is not known.
    cap: Option<(DVec3, f64)>,
}

impl<'a> Shape<'a> {
    fn of(views: &'a [View], directions: &[Direction]) -> Self {
        let seen: Vec<DVec3> = directions
            .par_iter()
            .filter(|direction| sees(views, **direction))
            .map(|direction| direction.vector())
            .collect();
        // Of thin views, too few directions tell how far they reach.
        let views_middle = seen.iter().sum::<DVec3>().try_normalize().filter(|_| seen.len() >= ENOUGH);
        let cap = views_middle.zip(views.first()).map(|(middle, view)| {
            let farthest = seen.iter().map(|direction| direction.dot(middle)).fold(1.0, f64::min);
            // Between directions that are tested, some may lie farther out.
            let cosine = (farthest.clamp(-1.0, 1.0).acos() + 2.0 * SPACING).min(PI).cos();
            (view.orientation.vector_to_view(middle), cosine)
        });
        Self { views, seen: seen.len(), cap }
    }

    /// Returns whether other views differ from these by one turn of all.
    fn is_of(&self, others: &[View]) -> bool {
        let within = |views: &[View], view: &View| view.orientation.within(views[0].orientation.inverse());
        self.views.len() == others.len()
            && self.views.iter().zip(others).all(|(one, other)| {
                let (placed, other_placed) = (within(self.views, one), within(others, other));
                one.is_alike(other) && placed.angle_to(&other_placed).radians() < SAME
            })
    }

    /// Returns whether such views, which may be turned, may show a direction.
    fn cap(&self, views: &[View]) -> impl Fn(Direction) -> bool + use<> {
        let turned = self.cap.zip(views.first());
        let turned = turned.map(|((middle, cosine), view)| (view.orientation.vector_to_world(middle), cosine));
        move |direction| turned.is_none_or(|(middle, cosine)| direction.vector().dot(middle) >= cosine)
    }
}

/// Angle between neighbours of the directions that are tested, in radians.
const SPACING: f64 = 0.025;

/// Number of directions that tell where a view ends.
const ENOUGH: usize = 100;

/// Angle in radians between turns that count as the same.
const SAME: f64 = 1e-6;

fn sees(views: &[View], direction: Direction) -> bool {
    views.iter().any(|view| view.sees(direction))
}

impl Display for PathReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [least, most] = self.at_once;
        let plural = if self.frames == 1 { "frame sees" } else { "frames see" };
        write!(f, "path     {} {plural} {} of the world, ", self.frames, Percent(self.seen))?;
        if most - least < 5e-4 {
            writeln!(f, "{} at once", Percent(most))?;
        } else {
            writeln!(f, "{} to {} at once", Percent(least), Percent(most))?;
        }
        let mut told = Vec::new();
        for (name, size) in &self.advised {
            if !told.contains(&size.parity) {
                told.push(size.parity);
                let (width, height) = size.parity;
                writeln!(
                    f,
                    "parity   {width}x{height} for {name}: one texel a pixel at the centre of the finest frame"
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, FieldOfView, PerspectiveCamera};
    use crate::raster::{Image, Rgba};
    use crate::sphere::{Angle, Orientation};

    fn turned(view: &View, [yaw, pitch, roll]: [f64; 3]) -> View {
        view.turned(Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(yaw),
            Angle::from_degrees(pitch),
            Angle::from_degrees(roll),
        ))
    }

    fn perspective(degrees: f64) -> View {
        let camera = PerspectiveCamera::new(FieldOfView::Vertical(Angle::from_degrees(degrees)));
        CameraModel::from(camera).view(640, 480).unwrap()
    }

    /// Compares with testing all directions in all frames, without caps and shapes.
    #[test]
    fn what_a_path_sees_is_what_its_frames_see() {
        let (near, far, white) =
            (perspective(45.0), perspective(80.0), Image::filled(64, 32, Rgba::opaque(1.0, 1.0, 1.0)));
        let (world, _) = World::from_panorama(white).unwrap();
        let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(40.0)));
        let strip = CameraModel::from(camera).view(800, 8).unwrap();
        let turns = |k: usize| [7.0 * k as f64, 20.0 * (0.4 * k as f64).sin(), 3.0 * k as f64];
        let one = |k: usize| vec![turned(if k < 9 { &near } else { &far }, turns(k))];
        // Two cameras that part: their shares differ though each is alike.
        let two = |k: usize| vec![turned(&near, turns(k)), turned(&near, [9.0 * k as f64, 0.0, 0.0])];
        let thin = |k: usize| vec![turned(&strip, [33.0, 4.0 * k as f64, 0.0])];
        let none = |_: usize| Vec::new();
        let makers: [&dyn Fn(usize) -> Vec<View>; 4] = [&one, &two, &thin, &none];
        for make in makers {
            let frames: Vec<Vec<View>> = (0..20).map(make).collect();
            let found = PathReport::of(&world, &frames);
            let directions: Vec<Direction> = Direction::spread(DIRECTIONS).collect();
            let share = |frames: &[Vec<View>]| {
                let seen = directions.iter().filter(|direction| frames.iter().any(|views| sees(views, **direction)));
                seen.count() as f64 / DIRECTIONS as f64
            };
            assert_eq!(found.seen, share(&frames));
            let shares: Vec<f64> = frames.iter().map(|views| share(std::slice::from_ref(views))).collect();
            let ends = [shares.iter().copied().fold(1.0, f64::min), shares.iter().copied().fold(0.0, f64::max)];
            for (found, expected) in found.at_once.iter().zip(ends) {
                assert!((found - expected).abs() < 2e-3, "{found} instead of {expected}");
            }
        }
    }
}
