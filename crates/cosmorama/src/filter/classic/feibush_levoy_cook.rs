use glam::{DMat2, DMat3, DVec2, DVec3};

use super::weighing::{Region, ScreenKernel, Seen, columns_at};
use crate::camera::View;
use crate::filter::Kernel;

/// Texels in the quadrilateral around the kernel, each mapped to the screen and weighed there by a table (Feibush, Levoy &
/// Cook 1980).
///
/// The screen is the plane that touches the sphere in the footprint's middle. Texels of a pinhole view are mapped to it by
/// three additions and a division along a row; those of other views, one by one. Footprints under a texel are widened.
pub(super) struct FeibushLevoyCook(pub(super) ScreenKernel);

impl Region for FeibushLevoyCook {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let widened = seen.widened();
        let radius = self.0.radius();
        let corners = if widened == seen.jacobian { seen.corners(radius) } else { seen.parallelogram(widened, radius) };
        let within = seen.texels_within(seen.reach_of(corners));
        let to_screen = ToScreen::of(seen, widened);
        for j in within.rows {
            let inside = columns_at(corners, j);
            let columns = *inside.start().max(within.columns.start())..=*inside.end().min(within.columns.end());
            to_screen.row(j, columns, |i, at| {
                let weight = self.0.weight(at.length_squared());
                if weight > 0.0 {
                    visit([i, j], weight);
                }
            });
        }
    }

    fn kernel(&self) -> Option<Kernel> {
        Some(self.0.kernel())
    }
}

/// Mapping from the texels of a view to the screen, in pixels from the footprint's middle.
enum ToScreen<'a> {
    /// A matrix from (x, y, 1) of the image to a place on the screen, times a depth.
    Projective(DMat3),
    /// A matrix from a direction to a place on the screen, times a depth.
    Directions(&'a View, DMat3),
}

impl<'a> ToScreen<'a> {
    fn of(seen: &'a Seen, widened: DMat2) -> Self {
        let screen = if widened == seen.jacobian { seen.screen() } else { None };
        let view = &seen.source.view;
        match (screen, view.rays()) {
            (Some(screen), Some(rays)) => Self::Projective(screen * rays),
            (Some(screen), None) => Self::Directions(view, screen),
            // What is widened has no exact mapping.
            (None, _) => Self::Projective(affine(seen.place, widened.inverse())),
        }
    }

    /// Calls `visit` with the columns of a row, and where their texels lie on the screen.
    fn row(&self, j: i64, columns: std::ops::RangeInclusive<i64>, mut visit: impl FnMut(i64, DVec2)) {
        let mut visit = |i: i64, at: DVec3| {
            if at.z > 0.0 {
                visit(i, at.truncate() / at.z);
            }
        };
        match self {
            Self::Projective(matrix) => {
                let mut at = *matrix * DVec3::new(*columns.start() as f64 + 0.5, j as f64 + 0.5, 1.0);
                for i in columns {
                    visit(i, at);
                    at += matrix.x_axis;
                }
            }
            Self::Directions(view, screen) => {
                for i in columns {
                    if let Some(direction) = view.direction(Seen::centre([i, j])) {
                        visit(i, *screen * direction.vector());
                    }
                }
            }
        }
    }
}

/// Returns the matrix of a mapping that is linear around a place.
fn affine(place: DVec2, linear: DMat2) -> DMat3 {
    let offset = -(linear * place);
    DMat3::from_cols(linear.x_axis.extend(0.0), linear.y_axis.extend(0.0), offset.extend(1.0))
}
