use cosmorama::camera::{Covariance, Footprint};

use super::glass::split;
use crate::material::Material;
use crate::ray::{Normal, Ray};
use crate::shape::Solid;

/// A part of a pixel's light: what a ray sees of the world, weighed by colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    pub(crate) weight: [f64; 3],
    pub(crate) ray: Ray,
}

/// Change of direction over a cell, in radians, from which a beam grazes an outline, and the longest that then counts.
/// Such cells are small, and what they see is crowded.
const GRAZING: f64 = 0.1;
const LONGEST: f64 = 0.5;

/// Length of a grazing beam's footprint over its least breadth, which bounds the texels that it takes.
const ECCENTRICITY: f64 = 8.0;

/// Part of the light from which a beam's width counts in full.
const HEAVY: f64 = 0.25;

impl Beam {
    /// Lists the beams that a surface sends on: the mirrored one, or those of glass. Their weights add up to one for each
    /// colour, less what glass absorbs.
    pub(crate) fn of(met: &Ray, normal: &Normal, material: &Material, solid: &dyn Solid) -> Vec<Self> {
        let mut beams = Vec::new();
        if material.reflects() {
            match &material.glass {
                None => beams.push(Self { weight: [1.0; 3], ray: met.reflected(&normal.facing(met)) }),
                Some(glass) => split(&mut beams, (met, normal), solid, glass),
            }
        }
        beams
    }

    /// Returns the part of the world that the beam sees. That of a grazing beam is bounded.
    pub(super) fn footprint(&self) -> Footprint {
        let widest = self.ray.widest();
        if widest < GRAZING {
            return self.ray.footprint();
        }
        let longest = widest.min(LONGEST);
        let part = longest / widest;
        let footprint = self.ray.scaled(part).footprint();
        // A footprint is two standard deviations long.
        let breadth = longest / (2.0 * ECCENTRICITY);
        footprint.widened_by(Covariance::round(footprint.direction, breadth * breadth))
    }

    /// Returns the longest change of direction over a pixel; that of faint beams, of which a surface reflects only a part,
    /// counts by their part of the light.
    pub(crate) fn widest(beams: &[Self], reflected: f64) -> f64 {
        let counted = |beam: &Self| beam.ray.widest() * (beam.heaviest() * reflected / HEAVY).min(1.0);
        beams.iter().map(counted).fold(0.0, f64::max)
    }

    /// Returns the greatest part of any colour's light.
    fn heaviest(&self) -> f64 {
        self.weight.into_iter().fold(0.0, f64::max)
    }
}
