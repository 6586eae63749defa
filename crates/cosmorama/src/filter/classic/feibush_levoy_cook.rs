use super::region::{Region, Seen};
use super::screen_kernel::ScreenKernel;

/// Texels under the box around the kernel, each mapped to the screen and weighed there by a table (Feibush, Levoy & Cook
/// 1980).
///
/// The mapping is the exact one: a texel's direction, seen from the footprint's middle. Footprints under a texel are
/// widened.
pub(super) struct FeibushLevoyCook(pub(super) ScreenKernel);

impl Region for FeibushLevoyCook {
    fn texels(&self, seen: &Seen, mut visit: impl FnMut([i64; 2], f64)) {
        let widened = seen.widened();
        let narrower = (widened != seen.jacobian).then(|| widened.inverse());
        let half = glam::DVec2::new(widened.row(0).length(), widened.row(1).length());
        let within = seen.texels_within(half * ScreenKernel::RADIUS);
        for j in within.rows {
            for i in within.columns.clone() {
                let on_screen = match narrower {
                    // What is widened has no exact mapping.
                    Some(to_screen) => Some(to_screen * seen.offset([i, j])),
                    None => on_screen(seen, [i, j]),
                };
                let Some(at) = on_screen else { continue };
                let weight = self.0.weight(at.length_squared());
                if weight > 0.0 {
                    visit([i, j], weight);
                }
            }
        }
    }
}

/// Returns where a texel lies on the screen, in pixels from the footprint's middle.
fn on_screen(seen: &Seen, texel: [i64; 2]) -> Option<glam::DVec2> {
    let direction = seen.source.view.direction(Seen::centre(texel))?;
    let middle = seen.footprint.direction;
    let cosine = direction.dot(middle);
    if cosine <= 0.0 {
        return None;
    }
    // Onto the tangent plane, with the angle kept as the distance there.
    let aside = direction.vector() - middle.vector() * cosine;
    let sine = aside.length();
    let scale = if sine > 0.0 { sine.atan2(cosine) / sine } else { 1.0 };
    seen.footprint.jacobian.pseudo_inverse(aside * scale)
}
