use cosmorama::camera::{Canvas, Mirror, Placement};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama_io::FacePlacement;
use cosmorama_spec::Cube;

/// Returns the placement of a face's picture in the world.
pub fn face_placement(
    cube: &Cube,
    face: CubeFace,
    lies: FacePlacement,
    canvas: Option<Canvas>,
    outer: Orientation,
) -> Placement {
    Placement {
        frame: cube.frame(),
        orientation: lies.orientation(face).within(cube.orientation).within(outer),
        mirror: Mirror { x: cube.mirror.x != lies.mirrored, y: cube.mirror.y },
        canvas,
    }
}
