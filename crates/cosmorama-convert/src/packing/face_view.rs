use cosmorama::camera::{Canvas, Mirror, Placement};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
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
    // A picture that has to be turned clockwise was taken by a camera that was itself turned clockwise.
    let turn = Angle::from_degrees(90.0 * f64::from(lies.quarter_turns));
    let rolled = Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::ZERO, turn);
    Placement {
        frame: cube.frame(),
        orientation: rolled.within(face.orientation()).within(cube.orientation).within(outer),
        mirror: Mirror { x: cube.mirror.x != lies.mirrored, y: cube.mirror.y },
        canvas,
    }
}
