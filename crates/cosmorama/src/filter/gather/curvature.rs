use glam::{DMat2, DVec2, DVec3};

use crate::camera::{PixelPoint, View};
use crate::projection::Projection;
use crate::sphere::Direction;

/// Second-order correction to the places of texels on the sphere around a point. Rows and columns of texels are curves
/// there, and their spacing changes.
///
/// In the plane tangent to the sphere, measured in the texels at that point, the texel at offset Δ = (ΔU, ΔV) lies at Δ
/// + ½(uu ΔU² + 2 uv ΔU ΔV + vv ΔV²). The coefficients are the sphere's Christoffel symbols in the view's coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bend {
    pub(crate) uu: DVec2,
    pub(crate) uv: DVec2,
    pub(crate) vv: DVec2,
}

impl Bend {
    /// Measures how a view's texels bend around a point of its image; `None` where the point has no direction.
    pub(crate) fn around(view: &View, at: PixelPoint) -> Option<Self> {
        // Measured in the view's own coordinates, since the orientation does not change the result.
        let plane = |u: f64, v: f64| view.grid.to_plane(PixelPoint::new(at.x + u, at.y + v));
        let look = |u: f64, v: f64| view.projection.unproject(plane(u, v)).map(Direction::vector);
        let here = look(0.0, 0.0)?;
        let [left, right, above, below] = [look(-1.0, 0.0)?, look(1.0, 0.0)?, look(0.0, -1.0)?, look(0.0, 1.0)?];
        let diagonal = look(1.0, 1.0)? + look(-1.0, -1.0)?;
        let (du, dv) = ((right - left) / 2.0, (below - above) / 2.0);
        let (uu, vv) = (left + right - 2.0 * here, above + below - 2.0 * here);
        let uv = (diagonal - 2.0 * here - uu - vv) / 2.0;
        // Component of a vector in the plane of du and dv, as multiples of du and dv.
        let gram = DMat2::from_cols_array(&[du.dot(du), du.dot(dv), du.dot(dv), dv.dot(dv)]);
        let inverse = gram.inverse();
        let in_texels = |vector: DVec3| inverse * DVec2::new(du.dot(vector), dv.dot(vector));
        let bend = Self { uu: in_texels(uu), uv: in_texels(uv), vv: in_texels(vv) };
        (bend.uu + bend.uv + bend.vv).is_finite().then_some(bend)
    }

    /// Computes the correction by the projection's closed form, many times as fast; `None` if the projection has none.
    pub(crate) fn in_closed_form(view: &View, at: PixelPoint) -> Option<Self> {
        let [xx, xy, yy] = view.projection.curvature(view.grid.to_plane(at))?;
        // From the plane's unit to texels, whose y axis points down.
        let step = view.grid.step() * DVec2::new(1.0, -1.0);
        let scaled = |curvature: DVec2, by: f64| curvature * by / step;
        Some(Self { uu: scaled(xx, step.x * step.x), uv: scaled(xy, step.x * step.y), vv: scaled(yy, step.y * step.y) })
    }

    /// Returns the place at which the texel at an offset appears.
    pub(crate) fn of(&self, offset: DVec2) -> DVec2 {
        let DVec2 { x: u, y: v } = offset;
        offset + (self.uu * (u * u) + self.uv * (2.0 * u * v) + self.vv * (v * v)) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::PixelGrid;
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
    use crate::world::panorama;

    #[test]
    fn parallels_bend_as_the_formula_says() {
        // On the sphere a parallel curves to its pole by sin φ cos φ, and meridians converge by tan φ.
        let (width, height) = (4000, 1000);
        let view = panorama(width, height);
        let (across, down) = (std::f64::consts::TAU / width as f64, std::f64::consts::PI / height as f64);
        for row in [200.0, 500.0, 870.0] {
            let latitude = std::f64::consts::FRAC_PI_2 - row * down;
            let bend = Bend::around(&view, PixelPoint::new(1234.0, row)).expect("a panorama looks everywhere");
            let (sin, cos) = latitude.sin_cos();
            let expected = Bend {
                uu: DVec2::new(0.0, -sin * cos * across * across / down),
                uv: DVec2::new(sin / cos * down, 0.0),
                vv: DVec2::ZERO,
            };
            for (found, expected) in [(bend.uu, expected.uu), (bend.uv, expected.uv), (bend.vv, expected.vv)] {
                assert!(found.distance(expected) < 1e-2 * across, "row {row}: {bend:?}, not {expected:?}");
            }
        }
    }

    #[test]
    fn closed_forms_are_what_differences_come_to() {
        let rect = PlaneRect { min: PlanePoint::new(-1.0, -0.7), max: PlanePoint::new(1.2, 0.8) };
        let grid = PixelGrid::spanning(400, 300, rect);
        let pinhole = View { projection: ProjectionKind::PERSPECTIVE, grid, ..panorama(4, 2) };
        for view in [pinhole, panorama(4000, 3000)] {
            for (x, y) in [(0.01, 0.97), (0.5, 0.5), (0.98, 0.07)] {
                let at = PixelPoint::new(x * view.width() as f64, y * view.height() as f64);
                let [exact, found] = [Bend::in_closed_form(&view, at), Bend::around(&view, at)].map(Option::unwrap);
                for (exact, found) in [(exact.uu, found.uu), (exact.uv, found.uv), (exact.vv, found.vv)] {
                    assert!(exact.distance(found) < 1e-6, "{exact} is not {found} at {at:?}");
                }
            }
        }
        let ball = View { projection: ProjectionKind::MIRROR_BALL, ..panorama(4, 2) };
        assert_eq!(Bend::in_closed_form(&ball, PixelPoint::new(1.0, 1.0)), None);
    }

    #[test]
    fn a_bent_offset_is_where_the_texel_is_seen() {
        let view = panorama(400, 200);
        let at = PixelPoint::new(57.3, 41.6);
        let look = |u: f64, v: f64| view.direction(PixelPoint::new(at.x + u, at.y + v)).expect("everywhere").vector();
        let bend = Bend::around(&view, at).expect("everywhere");
        let (du, dv) = ((look(1e-4, 0.0) - look(-1e-4, 0.0)) / 2e-4, (look(0.0, 1e-4) - look(0.0, -1e-4)) / 2e-4);
        for (u, v) in [(2.0, 0.0), (2.0, -1.0), (1.5, 1.5), (-1.0, 2.0)] {
            let seen = look(u, v) - look(0.0, 0.0);
            let offset = bend.of(DVec2::new(u, v));
            let tangential = |vector: DVec3| DVec2::new(du.dot(vector), dv.dot(vector)) / du.length();
            let error = tangential(seen - du * offset.x - dv * offset.y).length() / du.length();
            let straight = tangential(seen - du * u - dv * v).length() / du.length();
            assert!(error < 0.1 * straight, "({u}, {v}): {error}, and {straight} without");
        }
    }
}
