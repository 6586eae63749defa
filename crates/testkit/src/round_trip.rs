use cosmorama::raster::Rgba;
use cosmorama::resample::{Filter, Plan, Resampler};
use cosmorama::sphere::Direction;
use cosmorama::world::{PixelPoint, View, World};
use glam::{DVec2, DVec3};

use crate::common_field::CommonField;
use crate::sky::whole;
use crate::{Form, light_by_direction};

/// What a world loses in another form: measured on what came back, where both forms show it and the other one has the finer
/// pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundTrip {
    /// The part of the pixels that was compared.
    pub compared: f64,
    /// The mean difference of a channel, of a contrast of one.
    pub mean_error: f64,
    /// By how many pixels a view came back displaced, its pixels together: of the views the one that moved most.
    pub shift: f64,
    /// By how many pixels the one pixel came back displaced that moved most.
    pub displacement: f64,
    /// The largest step between the errors of neighbours between which the other form has a seam; zero where it has none.
    pub across: f64,
    /// The largest step between all other neighbours.
    pub elsewhere: f64,
}

/// Fewer compared pixels tell nothing of a view.
const ENOUGH: usize = 100;

/// Waves of some thirty texels where there are 1500 in a steradian.
fn waves(direction: Direction) -> [f32; 3] {
    let d = direction.vector();
    let wave = |x: f64, y: f64| (0.5 + 0.25 * (x * 8.0).sin() + 0.25 * (y * 6.0 + x * 4.0).cos()) as f32;
    [wave(d.x, d.y), wave(d.y, d.z), wave(d.z, d.x)]
}

impl RoundTrip {
    /// Takes two worlds, one of waves and one whose colour is its direction, from one form to another and back; `None` where
    /// they have too little in common to tell.
    ///
    /// The waves tell what is lost and whether a seam is seen. What moved only the directions tell: in waves that a border cuts,
    /// or that are blurred more one way than the other, loss looks like a displacement of 0.01 pixel where there is none.
    ///
    /// # Panics
    /// With the reference filter, which records no weights.
    pub fn measure(from: &Form, through: &Form, filter: Filter) -> Option<Self> {
        let (first, second) = (from.world(), through.world());
        let (there, back) = (plans(&first, &through.views, filter), plans(&second, &from.views, filter));
        let travelled = |light: &[Rgba]| apply(&back, &apply(&there, light));
        let light = light_by_direction(&first, waves);
        let waves = travelled(&light);
        let directions = travelled(&light_by_direction(&first, |d| d.vector().to_array().map(|c| c as f32)));
        // What nothing was measured of is no number, not zero.
        let mut sums = Sums { shift: f64::NAN, ..Sums::default() };
        for source in first.sources() {
            let original = &light[source.texels()];
            let errors: Vec<[f64; 3]> =
                waves[source.texels()].iter().zip(original).map(|(a, b)| difference(a, b)).collect();
            let field = CommonField::new(&source.view, from.is_whole && through.is_whole, &second);
            sums.add(&source.view, &field, &errors);
            sums.add_directions(&source.view, &field, &directions[source.texels()]);
        }
        let shown = first.solid_angles().filter(|&solid_angle| solid_angle > 0.0).count();
        (sums.count >= ENOUGH).then(|| Self {
            compared: sums.count as f64 / shown as f64,
            mean_error: sums.error / sums.count as f64,
            shift: sums.shift,
            displacement: sums.displacement,
            across: sums.across,
            elsewhere: sums.elsewhere,
        })
    }
}

fn plans(world: &World, views: &[View], filter: Filter) -> Vec<Plan> {
    let plan = |target| Resampler { world, target, filter }.plan();
    views.iter().map(|view| plan(view).expect("a filter whose weights can be recorded")).collect()
}

fn apply(plans: &[Plan], light: &[Rgba]) -> Vec<Rgba> {
    plans.iter().flat_map(|plan| plan.apply(light).pixels().iter().map(whole).collect::<Vec<_>>()).collect()
}

fn difference(a: &Rgba, b: &Rgba) -> [f64; 3] {
    [0, 1, 2].map(|c| f64::from(a.0[c]) - f64::from(b.0[c]))
}

#[derive(Default)]
struct Sums {
    count: usize,
    error: f64,
    shift: f64,
    displacement: f64,
    across: f64,
    elsewhere: f64,
}

impl Sums {
    /// Adds what directions came back in a view.
    fn add_directions(&mut self, view: &View, field: &CommonField, found: &[Rgba]) {
        let (mut sum, mut count) = (DVec2::ZERO, 0usize);
        for (k, found) in found.iter().enumerate() {
            let (i, j) = (k % view.width(), k / view.width());
            let Some(footprint) = view.footprint(PixelPoint::centre(i, j)).filter(|_| field.counts(i, j)) else {
                continue;
            };
            let here = footprint.direction.vector();
            // What is averaged over a wide pixel gets shorter; that is no displacement.
            let moved =
                DVec3::new(found.0[0].into(), found.0[1].into(), found.0[2].into()).reject_from_normalized(here);
            let Some(pixels) = footprint.jacobian.pseudo_inverse(moved) else { continue };
            self.displacement = self.displacement.max(moved.length() / footprint.jacobian.solid_angle().sqrt());
            sum += pixels;
            count += 1;
        }
        if count >= ENOUGH {
            self.shift = self.shift.max((sum / count as f64).length());
        }
    }

    /// Adds a view's.
    fn add(&mut self, view: &View, field: &CommonField, errors: &[[f64; 3]]) {
        let width = view.width();
        for (k, error) in errors.iter().enumerate() {
            let (i, j) = (k % width, k / width);
            if !field.counts(i, j) {
                continue;
            }
            self.count += 1;
            self.error += error.iter().map(|e| e.abs()).sum::<f64>() / 3.0;
            for (next, place) in [(k + 1, (i + 1, j)), (k + width, (i, j + 1))] {
                if field.counts(place.0, place.1) {
                    let step = error.iter().zip(errors[next]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    let largest = if field.parts((i, j), place) { &mut self.across } else { &mut self.elsewhere };
                    *largest = largest.max(step);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::Rgba;
    use cosmorama::sphere::{Angle, Orientation};
    use cosmorama::world::{PixelPoint, View, World};

    use super::Sums;
    use crate::common_field::CommonField;
    use crate::equirect;

    #[test]
    fn a_known_displacement_is_found() {
        let (view, pixels) = (equirect(200), 0.01);
        let yaw = Angle::from_degrees(360.0 / 200.0 * pixels);
        let turned = View { orientation: Orientation::from_yaw_pitch_roll(yaw, Angle::ZERO, Angle::ZERO), ..view };
        let place =
            |k: usize| turned.direction(PixelPoint::centre(k % 200, k / 200)).expect("a panorama shows everything");
        let colour = |direction: [f64; 3]| Rgba::opaque(direction[0] as f32, direction[1] as f32, direction[2] as f32);
        let found: Vec<Rgba> = (0..200 * 100).map(|k| colour(place(k).vector().to_array())).collect();
        let finer = World::new([("finer".to_owned(), equirect(800))]).expect("one view");
        let mut sums = Sums::default();
        sums.add_directions(&view, &CommonField::new(&view, true, &finer), &found);
        assert!((sums.shift - pixels).abs() < 1e-5, "{}", sums.shift);
        // On the equator, where pixels are square.
        assert!((sums.displacement - pixels).abs() < 1e-5, "{}", sums.displacement);
    }
}
