use std::fmt::{Display, Formatter};

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
        let seen_in = |views: &Vec<View>| -> Vec<bool> {
            directions.iter().map(|direction| views.iter().any(|view| view.sees(*direction))).collect()
        };
        let share = |seen: &[bool]| seen.iter().filter(|seen| **seen).count() as f64 / DIRECTIONS as f64;
        let nothing = || (vec![false; DIRECTIONS], [1.0_f64, 0.0_f64]);
        let (seen, at_once) = frames
            .par_iter()
            .map(|views| {
                let seen = seen_in(views);
                let share = share(&seen);
                (seen, [share, share])
            })
            .reduce(nothing, |(mut seen, range), (more, other)| {
                seen.iter_mut().zip(more).for_each(|(seen, more)| *seen |= more);
                (seen, [range[0].min(other[0]), range[1].max(other[1])])
            });
        let centres: Vec<_> = frames.iter().flatten().filter_map(central_footprint).collect();
        let finest = centres.iter().min_by(|a, b| a.jacobian.solid_angle().total_cmp(&b.jacobian.solid_angle()));
        let advice = |source: &crate::world::Source| {
            let size = FaceSize::of(&source.view, finest?)?;
            Some((source.name.clone(), size))
        };
        Self {
            frames: frames.len(),
            seen: share(&seen),
            at_once,
            advised: world.sources().iter().filter_map(advice).collect(),
        }
    }
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
