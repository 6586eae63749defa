use glam::{DMat2, DVec2};

use crate::camera::View;
use crate::explain::sheet::drawing::{Anchor, Paint, Rect};
use crate::explain::sheet::heading::sheet;
use crate::explain::sheet::theme::{CURVE, FAINT, HEADER, INK, LABEL, MARGIN, SMALL};
use crate::filter::{Ellipse, semi_axes};
use crate::world::World;

/// Side of a texel on the sheet, and texels along the sheet's sides.
const TEXEL: f64 = 34.0;
const COLUMNS: usize = 17;
const ROWS: usize = 13;

/// Contours between the middle and Q = F.
const CONTOURS: usize = 4;

/// Major semi-axis of the ellipse that is drawn, in texels.
const MAJOR: f64 = 6.0;

/// Draws figure 8 of Greene & Heckbert 1986: contours of the paraboloid Q of a target's pixel, enlarged to a few texels, and the
/// box around Q = F. Dots are centres of texels: dark ones are inside. `None` if no view shows the pixel.
pub fn paraboloid(world: &World, target: &View, (i, j): (usize, usize)) -> Option<String> {
    let footprint = target.screen_pixel(i, j)?.footprint;
    let (view, _) = world.owner(footprint.direction)?;
    let (_, jacobian) = world.sources()[view].view.texel_footprint(&footprint)?;
    let [major, _] = semi_axes(jacobian);
    Some(drawn(jacobian * (MAJOR / major)))
}

/// Draws the contours of a footprint with these derivatives, in texels.
fn drawn(jacobian: DMat2) -> String {
    let (width, height) = (COLUMNS as f64 * TEXEL, ROWS as f64 * TEXEL);
    let middle = DVec2::new(MARGIN + width / 2.0, HEADER + height / 2.0);
    let ellipse = Ellipse::new(jacobian, 1.0);
    let (major, minor, angle) = ellipse.axes();
    let subtitle = "Q = A U² + B U V + C V²; the outer contour is Q = F. Dots are centres of texels.";
    let mut drawing = sheet((width + 2.0 * MARGIN, height + HEADER + MARGIN), "Contours of Q", subtitle);
    let half = ellipse.half_extent(1.0) * TEXEL;
    let around = Rect { x: middle.x - half.x, y: middle.y - half.y, width: 2.0 * half.x, height: 2.0 * half.y };
    drawing.rect(around, Paint { stroke: INK, stroke_width: 1.2, ..Paint::fill("#ffffff") });
    for contour in (1..=CONTOURS).rev() {
        // Q is parabolic: a contour at a part of F lies at the root of that part of the radius.
        let part = (contour as f64 / CONTOURS as f64).sqrt() * TEXEL;
        let paint = Paint { stroke: INK, stroke_width: 1.5, ..Paint::fill(CURVE).opacity(0.25) };
        drawing.ellipse((middle.x, middle.y), (major * part, minor * part), angle, paint);
    }
    // The middle lies between texels, as a pixel's does.
    let offset = DVec2::new(0.3, -0.2);
    for (i, j) in (0..ROWS).flat_map(|j| (0..COLUMNS).map(move |i| (i, j))) {
        let texel = DVec2::new(i as f64 - (COLUMNS / 2) as f64, j as f64 - (ROWS / 2) as f64) + offset;
        let at = middle + texel * TEXEL;
        let colour = if ellipse.distance_squared(texel) < 1.0 { INK } else { FAINT };
        drawing.ellipse((at.x, at.y), (2.6, 2.6), 0.0, Paint::fill(colour));
    }
    drawing.label("Q = F", (around.x + around.width + 8.0, middle.y), LABEL, Anchor::Start, INK);
    drawing.label("U", (MARGIN + width - 14.0, middle.y - 6.0), SMALL, Anchor::Start, INK);
    drawing.label("V", (middle.x + 6.0, HEADER + height - 4.0), SMALL, Anchor::Start, INK);
    drawing.polylines(
        [&[(MARGIN, middle.y), (MARGIN + width, middle.y)][..], &[(middle.x, HEADER), (middle.x, HEADER + height)][..]],
        Paint::stroke(FAINT, 1.0),
    );
    drawing.finish("Contours of Q")
}
