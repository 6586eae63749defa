//! Defaults of maps of light, which are smooth and therefore small.

use std::path::Path;

use cosmorama_io::{FacePattern, Format};
use cosmorama_spec::{Shape, Size, Spec};

use crate::settings::GeometrySettings;
use crate::source::Name;

/// Width of a panorama of light, and edge of a face, unless given.
const WIDTH: usize = 64;
const EDGE: usize = 32;

/// Width of a panorama that is the first level of a chain.
const CHAIN_WIDTH: usize = 512;

/// Edge of the faces of the first level of a chain of light, unless given.
pub const CHAIN_EDGE: usize = 256;

/// Completes the geometry of a map of light: a panorama, or a cube where the output has a name for each face, unless another
/// projection is given.
pub(crate) fn of_light(geometry: GeometrySettings, output: &Name, levels: usize) -> GeometrySettings {
    let is_cube = is_cube_of_light(geometry.to.as_ref(), output);
    let usual = || if is_cube { "cube" } else { "equirect:samples=centres" }.parse::<Spec>().ok();
    let to = geometry.to.or_else(usual);
    let width = match (is_cube, levels > 1) {
        (true, false) => EDGE,
        (false, false) => WIDTH,
        (true, true) => CHAIN_EDGE,
        (false, true) => CHAIN_WIDTH,
    };
    let size = geometry.size.or(Some(Size { width, height: None }));
    GeometrySettings { to, size, ..geometry }
}

/// Returns whether a map of light is a cube: as asked for, or else if the output has a name for each face or is a file of cubes.
pub fn is_cube_of_light(to: Option<&Spec>, output: &Name) -> bool {
    let is_cube_file = || Format::of_name(Path::new(output)).is_some_and(Format::is_cube_map);
    match to {
        Some(spec) => matches!(spec.shape, Shape::Cube(_)),
        None => is_cube_file() || FacePattern::parse(output).is_some(),
    }
}
