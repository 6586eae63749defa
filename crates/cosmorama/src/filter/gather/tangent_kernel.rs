use glam::{DMat2, DVec2, DVec3};

use super::cap_chain::CapChain;
use super::ellipse::Ellipse;
use crate::camera::{Footprint, PixelPoint};
use crate::filter::Kernel;
use crate::sphere::Direction;
use crate::world::Source;

/// Factor on the kernel's floor where the field of view ends under a pixel. Up to half a texel beyond the last texel,
/// the kernel must reach four rows of texels: three do not tell a slope from an edge that a renderer smoothed.
pub(crate) const RIM_FLOOR: f64 = 1.7;

/// A kernel among the texels of one view, in the plane tangent to the sphere at a footprint. Near a pole, a horizon or
/// a rim, where an ellipse of texels would be wrong, it weighs each texel by its direction.
pub(crate) struct TangentKernel {
    direction: Direction,
    among_texels: AmongTexels,
    /// Axes that tell offsets in screen pixels.
    screen: [DVec3; 2],
    /// Share of the coarse cross-section.
    pub(crate) coarseness: f32,
    beyond: Option<BeyondSeam>,
    /// Caps of the sphere that together contain the kernel. Texels outside of them need no test.
    pub(crate) reach: CapChain,
}

/// Part of a kernel beyond a seam of the projection, where texels are oriented differently. The near side's ellipse, if
/// thin, might miss all of them.
struct BeyondSeam {
    /// Step from the footprint to the corresponding place on the other side.
    across: DVec3,
    among_texels: AmongTexels,
    /// Nearness to the seam: one on it, falling to zero where the kernel ends.
    nearness: f64,
}

/// A kernel's ellipse among texels, which lie in the tangent plane.
struct AmongTexels {
    /// Axes that tell offsets in texels.
    axes: [DVec3; 2],
    ellipse: Ellipse,
}

impl AmongTexels {
    /// Returns the square of a distance from the kernel's centre, in the kernel's unit.
    #[inline]
    fn distance_squared(&self, from_centre: DVec3) -> f64 {
        self.ellipse.distance_squared(in_plane(&self.axes, from_centre))
    }
}

/// Returns the offset that axes of the tangent plane tell.
#[inline]
fn in_plane(axes: &[DVec3; 2], from_centre: DVec3) -> DVec2 {
    DVec2::new(axes[0].dot(from_centre), axes[1].dot(from_centre))
}

/// Returns axes that tell offsets after a linear map.
fn mapped(map: DMat2, axes: &[DVec3; 2]) -> [DVec3; 2] {
    let [x, y] = [map.row(0), map.row(1)];
    [axes[0] * x.x + axes[1] * x.y, axes[0] * y.x + axes[1] * y.y]
}

impl TangentKernel {
    /// Makes the kernel of a footprint, with a radius of at most `radius` radians and a unit of at least `floor`
    /// texels. `around` widens the caps that hold the kernel, in radians.
    pub(crate) fn new(
        kernel: &Kernel,
        source: &Source,
        footprint: &Footprint,
        (radius, floor, around): (f64, f64, f64),
    ) -> Self {
        let here = footprint.direction.vector();
        let (right, up) = here.any_orthonormal_pair();
        // Their length is 1 over the view's largest texel.
        let axes = [right, up].map(|axis| axis / source.texel_pitch);
        let tangent = DMat2::from_cols(in_plane(&axes, footprint.jacobian.dx), in_plane(&axes, footprint.jacobian.dy));
        let to_screen = tangent.inverse();
        // Footprint in texels; where these are not defined, as on the very pole, in texels of the largest size.
        let jacobian = footprint_among_texels(source, footprint).unwrap_or(tangent);
        let to_texels = jacobian * to_screen;
        let coarseness = kernel.coarseness(jacobian.determinant().abs().sqrt()) as f32;
        let beyond = source.view.beyond_seam(footprint.direction).and_then(|direction| {
            let (_, jacobian) = source.view.texel_footprint(&Footprint { direction, ..*footprint })?;
            // If the seam is farther away, no texel beyond it counts, and its ellipse may be degenerate.
            let across = direction.vector() - here;
            (across.length() < 2.0 * radius).then_some((across, jacobian))
        });
        // On a seam the lattices of both sides mirror each other, and a quarter of the kernel's disc may be empty in
        // both.
        let nearness = beyond.map_or(0.0, |(across, _)| 1.0 - 0.5 * across.length() / radius);
        let widening = 1.0 + (RIM_FLOOR - 1.0) * nearness;
        let ellipse = |jacobian: DMat2| Ellipse::new(jacobian * kernel.scale, floor * widening);
        let beyond = beyond.map(|(across, jacobian)| (across, ellipse(jacobian), jacobian * to_screen));
        let ellipse = ellipse(jacobian);
        let (major, minor) = ellipse.semi_axes_in(to_texels);
        let unit = kernel.radius() * source.texel_pitch;
        let reach = match &beyond {
            None => {
                let major = (right * major.x + up * major.y) * unit;
                let longer = 1.0 + around / major.length();
                CapChain::around(footprint.direction, major * longer, minor * unit + around)
            }
            Some((_, ellipse, to_texels)) => {
                let other = ellipse.semi_axes_in(*to_texels).0.length();
                CapChain::of(footprint.direction, major.length().max(other) * unit + around)
            }
        };
        let among = |ellipse: Ellipse, to_texels: DMat2| AmongTexels { axes: mapped(to_texels, &axes), ellipse };
        let beyond = beyond.map(|(across, ellipse, to_texels)| {
            let among_texels = among(ellipse, to_texels);
            BeyondSeam { across, among_texels, nearness }
        });
        let (among_texels, screen) = (among(ellipse, to_texels), mapped(to_screen, &axes));
        Self { direction: footprint.direction, among_texels, screen, coarseness, beyond, reach }
    }

    /// Returns the square of a texel's distance from the centre, in the kernel's unit, and its offset in screen pixels.
    /// `None` for a texel more than a right angle away, or whose squared distance is not below `reach`.
    #[inline]
    pub(crate) fn place(&self, texel: Direction, reach: f64) -> Option<(f64, DVec2)> {
        let from = texel.vector() - self.direction.vector();
        let here = self.among_texels.distance_squared(from);
        let q = self.beyond.as_ref().map_or(here, |BeyondSeam { across, among_texels, nearness }| {
            let there = among_texels.distance_squared(from);
            let (own, other) = if across.dot(texel.vector()) > 0.0 { (there, here) } else { (here, there) };
            // On the seam itself, the ellipse of each side alone may reach along the seam one way only, and both the
            // same way.
            own.min(other / (nearness * nearness))
        });
        (q < reach && texel.dot(self.direction) > 0.0).then(|| (q, in_plane(&self.screen, from)))
    }
}

/// Returns the footprint in texels. Between the outermost row of a panorama and the pole, that row's texels are the
/// unit: the narrower ones that the formula gives do not exist.
fn footprint_among_texels(source: &Source, footprint: &Footprint) -> Option<DMat2> {
    let Some((centre, jacobian)) = source.view.texel_footprint(footprint) else {
        return footprint_on_border(source, footprint);
    };
    if source.period.is_none() {
        return Some(jacobian);
    }
    let height = source.view.height() as f64;
    let row = |inset: f64| {
        // An image of one row has its outermost row in the middle.
        let inset = inset.min(height / 2.0);
        PixelPoint::new(centre.x, centre.y.clamp(inset, height - inset))
    };
    // With samples on the image's edges, the outermost row is the pole itself. Half a texel from the pole is then at 1,
    // not 0.5.
    let is_pole = |at| source.view.direction(at).is_some_and(|d| source.view.margin(d) < 0.25 * source.texel_pitch);
    let nearest = if is_pole(row(0.5)) { row(1.0) } else { row(0.5) };
    if nearest == centre {
        return Some(jacobian);
    }
    let there = Footprint { direction: source.view.direction(nearest)?, ..*footprint };
    source.view.texel_footprint(&there).map(|(_, jacobian)| jacobian)
}

/// Greatest size of the texels on a wide camera's border for them to be used, as a part of its largest texel.
const FINE_BORDER: f64 = 0.25;

/// Returns the footprint in the texels of the border, for directions beyond a camera's horizon. `None` unless these are
/// far smaller than the largest texels, in which the kernel would hold most of the picture.
fn footprint_on_border(source: &Source, footprint: &Footprint) -> Option<DMat2> {
    let direction = source.view.border_towards(footprint.direction)?;
    let texel = source.view.footprint(source.view.pixel(direction)?)?.jacobian;
    let is_fine = texel.dx.length().max(texel.dy.length()) < FINE_BORDER * source.texel_pitch;
    let there = Footprint { direction, ..*footprint };
    is_fine.then(|| source.view.texel_footprint(&there)).flatten().map(|(_, jacobian)| jacobian)
}
