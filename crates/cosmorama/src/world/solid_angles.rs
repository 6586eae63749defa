use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use rayon::prelude::*;

use super::View;

/// Solid angle of each texel of a view in steradians, row by row; zero for one that shows nothing.
///
/// Views that are alike but for where they look, as the faces of a cube are, share one list.
#[derive(Clone, PartialEq)]
pub struct SolidAngles(Arc<Vec<f32>>);

impl SolidAngles {
    /// Those of a view of which so many columns count.
    pub(crate) fn of(view: &View, columns: usize) -> Self {
        let (width, mut angles) = (view.width(), vec![0.0; view.width() * view.height()]);
        angles.par_chunks_mut(width).enumerate().for_each(|(j, row)| {
            view.row_solid_angles(j, &mut row[..columns]);
        });
        Self(Arc::new(angles))
    }

    /// To change them for one view, whatever others have.
    pub(super) fn make_mut(&mut self) -> &mut [f32] {
        Arc::<Vec<f32>>::make_mut(&mut self.0)
    }
}

impl Deref for SolidAngles {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        &self.0
    }
}

/// How many they are: all of them would be millions.
impl fmt::Debug for SolidAngles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SolidAngles({})", self.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::CubeFace;
    use crate::world::{CubeFaceFrame, Frame, Placement, World};

    #[test]
    fn faces_of_a_cube_share_them() {
        let front = Placement::new(Frame::CubeFace(CubeFaceFrame));
        let view = |face: CubeFace| {
            let placement = Placement { orientation: face.orientation(), ..front };
            (face.name().to_owned(), placement.view(8, 8).unwrap())
        };
        let world = World::new([CubeFace::Front, CubeFace::Right].map(view)).unwrap();
        let [front, right] = [0, 1].map(|index| &world.sources()[index].solid_angles);
        assert!(Arc::ptr_eq(&front.0, &right.0));
    }
}
