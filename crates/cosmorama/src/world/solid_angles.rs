use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use rayon::prelude::*;

use crate::camera::View;

/// Solid angle of each texel of a view in steradians, row by row; zero for a texel that shows nothing.
///
/// Views that differ only in orientation, like the faces of a cube, share one list.
#[derive(Clone, PartialEq)]
pub struct SolidAngles(Arc<Vec<f32>>);

impl SolidAngles {
    /// Computes the solid angles of a view's texels, in its first `columns` columns; further ones have none.
    pub(crate) fn of(view: &View, columns: usize) -> Self {
        let (width, mut angles) = (view.width(), vec![0.0; view.width() * view.height()]);
        angles.par_chunks_mut(width).enumerate().for_each(|(j, row)| {
            view.row_solid_angles(j, &mut row[..columns]);
        });
        Self(Arc::new(angles))
    }

    /// Returns the address of the list, which views that share it have in common.
    pub(super) fn address(&self) -> usize {
        Arc::as_ptr(&self.0).addr()
    }

    /// Returns an empty list.
    pub(super) fn none() -> Self {
        Self(Arc::default())
    }

    /// Returns the list for changes; it is copied first if other views share it.
    pub(crate) fn make_mut(&mut self) -> &mut [f32] {
        Arc::<Vec<f32>>::make_mut(&mut self.0)
    }
}

impl Deref for SolidAngles {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        &self.0
    }
}

/// Prints only the number of texels, of which there may be millions.
impl fmt::Debug for SolidAngles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SolidAngles({})", self.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{CameraModel, CubeFaceCamera, Placement};
    use crate::sphere::CubeFace;
    use crate::world::{Blend, World, WorldView};

    #[test]
    fn faces_of_a_cube_share_them() {
        let front = Placement::new(CameraModel::CubeFace(CubeFaceCamera));
        let view = |face: CubeFace| {
            let placement = Placement { orientation: face.orientation(), ..front.clone() };
            (face.name().to_owned(), placement.view(8, 8).unwrap())
        };
        let world = World::new([CubeFace::Front, CubeFace::Right].map(view)).unwrap();
        let [front, right] = [0, 1].map(|index| &world.sources()[index].solid_angles);
        assert!(Arc::ptr_eq(&front.0, &right.0));
    }

    #[test]
    fn a_part_of_a_world_keeps_them() {
        let front = Placement::new(CameraModel::CubeFace(CubeFaceCamera)).view(8, 8).unwrap();
        let small = Placement::new(CameraModel::CubeFace(CubeFaceCamera)).view(4, 4).unwrap();
        let small = View { orientation: CubeFace::Right.orientation(), ..small };
        let part = |view| WorldView { name: "view".to_owned(), view, blend: Blend::default(), mask: None };
        let whole = World::blended([part(front.clone())]).unwrap();
        let known = whole.sources()[0].solid_angles.clone();
        let held = whole.with_views([part(small.clone()), part(front.clone())]).unwrap();
        assert_eq!(held.sources(), World::blended([part(small), part(front.clone())]).unwrap().sources());
        assert!(Arc::ptr_eq(&held.sources()[1].solid_angles.0, &known.0));
        // Where they are shared, each has a part of its own.
        let shared = World::blended([part(front.clone()), part(front.clone())]).unwrap();
        let alone = shared.with_views([part(front)]).unwrap();
        assert_eq!(alone.sources()[0].solid_angles, known);
    }
}
