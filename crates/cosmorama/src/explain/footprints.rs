//! Figure 7: a grid of footprints in texture space.

use glam::{DMat2, DVec2};

use super::magnification::central_footprint;
use super::sheet::drawing::{Anchor, Drawing, Paint, Rect};
use super::sheet::field;
use super::sheet::heading::{sheet, size_text};
use super::sheet::net::Net;
use super::sheet::theme::{DARK, FAINT, INK, LABEL, PAPER, SMALL, colour};
use crate::camera::{PixelPoint, ScreenPixel, View};
use crate::filter::Ellipse;
use crate::projection::PlanePoint;
use crate::world::{Source, World};

/// Distance between footprints on the sheet at the target's centre, as a fraction of the square root of the image's
/// width there: 9 on a face, 18 on a single image.
const SPACING: f64 = 0.58;

/// Narrowest footprint that is drawn; a smaller one would be all outline.
const NARROWEST: f64 = 0.75;

/// Width of a footprint, as a fraction of the distance between two, on the target.
const WIDTH: f64 = 0.8;

pub(crate) fn draw(world: &World, target: &View) -> String {
    let net = Net::of(world);
    let every = spacing(world, target, &net);
    let enlarged = (WIDTH * every as f64).max(1.0);
    let subtitle = format!(
        "Round pixels of the target ({}), one in {every} along rows and columns, drawn {enlarged:.0} times as large.",
        size_text((target.width(), target.height()))
    );
    let mut drawing = sheet(net.size, "Footprints in texture space", &subtitle);
    for (face, cell) in &net.lacking {
        drawing.rect(*cell, Paint::stroke(FAINT, 1.5).dashed());
        drawing.label(face.name(), (cell.x + 12.0, cell.y + 12.0 + LABEL), LABEL, Anchor::Start, FAINT);
    }
    for (source, &frame) in world.sources().iter().zip(&net.images) {
        drawing.rect(frame, Paint::fill("#ffffff"));
        let edges = field::shown(source, net.outset(frame), target).edges();
        drawing.polylines(edges.iter().map(|segment| &segment[..]), Paint::stroke(FAINT, 1.5));
    }
    for screen in grid_of_pixels(target, every) {
        draw_footprint(&mut drawing, world, &net, &screen, enlarged);
    }
    for (source, &frame) in world.sources().iter().zip(&net.images) {
        drawing.rect(frame, Paint::stroke(DARK, 1.5));
        drawing.label_on(&source.name, (frame.x + 8.0, frame.y + 8.0 + SMALL), SMALL, PAPER, INK);
    }
    drawing.finish("Footprints in texture space")
}

/// Returns the number of pixels between two footprints.
fn spacing(world: &World, target: &View, net: &Net) -> usize {
    let longer = target.width().max(target.height());
    let on_sheet = central_footprint(target).and_then(|footprint| {
        let (index, _) = world.owner(footprint.direction)?;
        let source = &world.sources()[index];
        let (_, jacobian) = source.view.texel_footprint(&footprint)?;
        let frame = net.images[index];
        let pixel = (DMat2::from_diagonal(texel_size(source, frame)) * jacobian).determinant().abs().sqrt();
        Some(SPACING * frame.width.sqrt() / pixel)
    });
    // Without a view at the centre, a number that looks well in a picture of any size.
    let every = on_sheet.unwrap_or(longer as f64 / 40.0);
    (every.round() as usize).clamp(1, (longer / 16).max(1))
}

/// Returns every `every`th pixel in both directions, counted from the axis of the lens so that the grid is symmetric.
fn grid_of_pixels(target: &View, every: usize) -> impl Iterator<Item = ScreenPixel> + '_ {
    let axis = target.grid.to_pixel(PlanePoint::new(0.0, 0.0));
    let indices = move |size: usize, origin: f64| {
        let first = if origin.is_finite() { (origin.floor() as i64).rem_euclid(every as i64) as usize } else { 0 };
        (first..size).step_by(every)
    };
    let columns = indices(target.width(), axis.x);
    indices(target.height(), axis.y)
        .flat_map(move |j| columns.clone().map(move |i| (i, j)))
        .filter_map(|(i, j)| target.screen_pixel(i, j))
}

fn draw_footprint(drawing: &mut Drawing, world: &World, net: &Net, screen: &ScreenPixel, enlarged: f64) {
    let Some((index, _)) = world.owner(screen.footprint.direction) else { return };
    let source = &world.sources()[index];
    let Some((centre, jacobian)) = source.view.texel_footprint(&screen.footprint) else { return };
    let (frame, centre) = (net.images[index], source.view.wrapped(centre));
    let scale = texel_size(source, frame);
    // On the sheet a texel of a 1024×960 face is not square, so the ellipse is that of a stretched matrix.
    let ellipse = Ellipse::new(DMat2::from_diagonal(scale) * jacobian * (enlarged / 2.0), 0.0);
    let (major, minor, angle) = ellipse.axes();
    // Around a pole of the source an ellipse means nothing any more, and around a pole of the target there are too
    // many.
    if major.is_nan() || major >= frame.width / 2.0 || minor < NARROWEST {
        return;
    }
    let place = placed(frame, scale, centre);
    drawing.ellipse(
        place,
        (major, minor),
        angle,
        Paint { stroke: INK, stroke_width: 0.7, ..Paint::fill(colour(index)) },
    );
}

fn texel_size(source: &Source, frame: Rect) -> DVec2 {
    DVec2::new(frame.width / source.view.width() as f64, frame.height / source.view.height() as f64)
}

fn placed(frame: Rect, scale: DVec2, texel: PixelPoint) -> (f64, f64) {
    (frame.x + texel.x * scale.x, frame.y + texel.y * scale.y)
}
