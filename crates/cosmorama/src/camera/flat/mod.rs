//! Camera models with a flat picture: perspective views, faces of cubes, Pannini.

pub(crate) mod cube_face;
pub(crate) mod field_of_view;
pub(crate) mod layout_face;
pub(crate) mod pannini;
pub(crate) mod perspective;
