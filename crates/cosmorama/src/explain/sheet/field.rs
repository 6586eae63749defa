use super::contour::Regions;
use super::drawing::Rect;
use crate::camera::{PixelPoint, View};
use crate::world::Source;

/// Returns which points of a view's image a target shows. `frame` is the image's place on the sheet. The region extends
/// `beyond` it on all sides, in the sheet's units, because the view's plane continues there.
pub(crate) fn shown<'a>(
    source: &'a Source,
    (frame, beyond): (Rect, f64),
    target: &'a View,
) -> Regions<impl Fn(f64, f64) -> bool + 'a> {
    let Rect { x, y, width, height } = frame;
    let (columns, rows) = (source.view.width() as f64, source.view.height() as f64);
    let along = move |t: f64, size: f64| (t * (size + 2.0 * beyond) - beyond) / size;
    let label = move |u: f64, v: f64| {
        let pixel = PixelPoint::new(along(u, width) * columns, along(v, height) * rows);
        source.view.stop_passes(pixel) && source.view.direction(pixel).is_some_and(|direction| target.sees(direction))
    };
    let area = Rect { x: x - beyond, y: y - beyond, width: width + 2.0 * beyond, height: height + 2.0 * beyond };
    Regions { frame: area, columns: area.width.round() as usize / 2, rows: area.height.round() as usize, label }
}
