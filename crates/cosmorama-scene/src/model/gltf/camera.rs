use cosmorama::sphere::{Angle, Direction, Orientation};
use glam::{DMat4, DVec3};
use gltf::Node;
use gltf::camera::Projection;

use crate::model::{ModelCamera, ModelLens};

/// Returns the camera of a node: it looks along −Z, its upper side is +Y.
pub(super) fn camera(node: &Node, place: &DMat4) -> Option<ModelCamera> {
    let camera = node.camera()?;
    let axis = |axis: DVec3| place.transform_vector3(axis);
    // Of places that shear or mirror, the direction and the upper side.
    let (ahead, up) = (axis(DVec3::NEG_Z), axis(DVec3::Y));
    let right = Direction::new(ahead.cross(up))?;
    let ahead = Direction::new(ahead)?;
    let orientation = Orientation::from_axes(right, Direction::new(right.vector().cross(ahead.vector()))?, ahead);
    let lens = match camera.projection() {
        Projection::Perspective(lens) => ModelLens::Perspective {
            height: Angle::from_radians(lens.yfov().into()),
            aspect: lens.aspect_ratio().map(f64::from),
        },
        Projection::Orthographic(lens) => ModelLens::Orthographic {
            height: 2.0 * f64::from(lens.ymag()),
            aspect: Some(f64::from(lens.xmag() / lens.ymag())),
        },
    };
    let name = camera.name().or(node.name()).unwrap_or_default().to_owned();
    Some(ModelCamera { name, eye: place.transform_point3(DVec3::ZERO), orientation, lens })
}
