use crate::camera::PixelPoint;
use crate::explain::sheet::contour::Regions;
use crate::explain::sheet::drawing::{Paint, Rect};
use crate::explain::sheet::heading::sheet;
use crate::explain::sheet::net::Net;
use crate::explain::sheet::theme::{DARK, INK, PAPER, SMALL, colour};
use crate::sphere::{Angle, Direction};
use crate::world::{Source, World};

/// Draws figure 2 of Greene's World Projections (1986): what a reflection cone subtends in the images of a world, unfolded if they
/// are the faces of a cube. Also returns how many views it touches.
pub fn cone(world: &World, axis: Direction, half_angle: Angle) -> (String, usize) {
    let net = Net::of(world);
    let images = || world.sources().iter().zip(&net.images);
    let regions: Vec<_> = images().map(|(source, &frame)| region(source, frame, (axis, half_angle))).collect();
    let areas: Vec<Vec<Rect>> = regions.iter().map(|region| region.area(true)).collect();
    let (touched, count) = (areas.iter().filter(|area| !area.is_empty()).count(), areas.len());
    let part = 50.0 * (1.0 - half_angle.radians().cos());
    let views = if count == 1 { "view" } else { "views" };
    let subtitle = format!("A cone over {part:.1} % of the world. It touches {touched} of {count} {views}.");
    let mut drawing = sheet(net.size, "A reflection cone", &subtitle);
    for (index, (source, &frame)) in images().enumerate() {
        drawing.rect(frame, Paint::fill("#ffffff"));
        drawing.rects(&areas[index], Paint::fill(colour(index)));
        drawing.polylines(regions[index].edges().iter().map(|segment| &segment[..]), Paint::stroke(INK, 1.5));
        drawing.rect(frame, Paint::stroke(DARK, 1.5));
        drawing.label_on(&source.name, (frame.x + 8.0, frame.y + 8.0 + SMALL), SMALL, PAPER, INK);
    }
    (drawing.finish("A reflection cone"), touched)
}

/// Returns which points of an image lie in the cone.
fn region(source: &Source, frame: Rect, (axis, half_angle): (Direction, Angle)) -> Regions<impl Fn(f64, f64) -> bool> {
    let (columns, rows) = (source.view.width() as f64, source.view.height() as f64);
    let least = half_angle.radians().cos();
    let label = move |u: f64, v: f64| {
        let pixel = PixelPoint::new(u * columns, v * rows);
        source.shows(pixel) && source.view.direction(pixel).is_some_and(|direction| direction.dot(axis) > least)
    };
    Regions { frame, columns: frame.width.round() as usize / 2, rows: frame.height.round() as usize, label }
}
