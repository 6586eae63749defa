//! Cubes whose faces lie in one image, told by the borders of their faces.

use cosmorama::layout::LayoutKind;
use cosmorama::raster::{Image, Rgba};
use cosmorama_io::EnvMap;
use cosmorama_spec::{Cube, Spec};

use crate::detect::{Continuity, GivenFaces};

/// Least confidence for taking an image for a cube on the evidence of its shape and its borders alone.
const SURE: f64 = 0.99;

/// Judges the faces of an image that holds one of these cubes. Of several, the one that fits is returned.
pub(crate) fn judged(cubes: &[Cube], envmap: Option<EnvMap>, picture: &Image<Rgba>) -> Option<Continuity> {
    let judge = |cube: &Cube| GivenFaces::of_image(cube, envmap)?.judge_image(picture);
    best(cubes.iter().filter_map(judge).collect())
}

/// Judges an image that has the shape of these layouts, but may hold anything else. `None` if its borders do not tell.
pub(crate) fn among(layouts: &[LayoutKind], picture: &Image<Rgba>) -> Option<Continuity> {
    let judge = |kind: &LayoutKind| {
        let found = GivenFaces::of_image(&Cube::from(*kind), None)?.judge_image(picture)?;
        Some(if found.fits? { named(found, *kind) } else { found })
    };
    best(layouts.iter().filter_map(judge).collect())
}

/// Returns the cube that an image surely holds, by findings of [`among`].
pub(crate) fn sure(found: &Continuity) -> Option<Spec> {
    let is_sure = found.fits == Some(true) && found.confidence.is_some_and(|confidence| confidence >= SURE);
    found.spec.clone().filter(|_| is_sure)
}

fn best(mut found: Vec<Continuity>) -> Option<Continuity> {
    found.sort_by_key(|judged| judged.fits != Some(true));
    found.into_iter().next()
}

/// Adds the layout in which the faces fit.
fn named(found: Continuity, kind: LayoutKind) -> Continuity {
    let spec = Spec::from(Cube::from(kind));
    Continuity { told: found.told.after(&format!("as {spec}, ")), spec: Some(spec), ..found }
}
