use crate::camera::View;
use crate::explain::sheet::drawing::{Paint, Rect};
use crate::explain::sheet::heading::sheet;
use crate::explain::sheet::theme::{DARK, HEADER, INK, MARGIN};

/// Longer side of the picture on the sheet, and pixels drawn along it.
const LONGER: f64 = 640.0;
const COUNT: usize = 25;

/// Draws the left half of figure 7 of Greene & Heckbert 1986: round pixels on the screen, a few of them, enlarged, with their
/// centres as dots. [`Figures::footprints`](crate::explain::Figures::footprints) draws the right half.
pub fn circles(target: &View) -> String {
    let longer = target.width().max(target.height());
    let (scale, every) = (LONGER / longer as f64, (longer / COUNT).max(1));
    let size = (target.width() as f64 * scale, target.height() as f64 * scale);
    let frame = Rect { x: MARGIN, y: HEADER, width: size.0, height: size.1 };
    let subtitle = format!("One pixel in {every} along rows and columns, drawn {every} times as large.");
    let mut drawing = sheet((size.0 + 2.0 * MARGIN, size.1 + HEADER + MARGIN), "Pixels on the screen", &subtitle);
    drawing.rect(frame, Paint::fill("#ffffff"));
    let radius = 0.5 * every as f64 * scale;
    let places = |size: usize| (every / 2..size).step_by(every);
    for (i, j) in places(target.height()).flat_map(|j| places(target.width()).map(move |i| (i, j))) {
        if target.screen_pixel(i, j).is_some() {
            let at = (frame.x + (i as f64 + 0.5) * scale, frame.y + (j as f64 + 0.5) * scale);
            drawing.ellipse(at, (radius, radius), 0.0, Paint::stroke(INK, 0.8));
            drawing.ellipse(at, (1.2, 1.2), 0.0, Paint::fill(INK));
        }
    }
    drawing.rect(frame, Paint::stroke(DARK, 1.5));
    drawing.finish("Pixels on the screen")
}
