//! Figure of a camera's path over the unfolded world.

use crate::camera::{PixelPoint, View};
use crate::explain::magnification::central_footprint;
use crate::explain::sheet::contour::Regions;
use crate::explain::sheet::drawing::{Anchor, Drawing, Paint, Point, Rect};
use crate::explain::sheet::field::shown;
use crate::explain::sheet::heading::sheet;
use crate::explain::sheet::net::Net;
use crate::explain::sheet::theme::{CURVE, DARK, INK, LABEL, PAPER, colour};
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Greatest number of frames whose fields of view are searched; of more, as many are taken at even steps.
const FRAMES: usize = 120;

/// Radii of the dots of frames, and of the first and last one.
const DOT: f64 = 2.2;
const END: f64 = 5.0;

/// Draws the unfolded world: bright where some frame looks, with the way of the picture's centre, and the fields of view of the
/// first and the last frame.
pub(crate) fn draw(world: &World, frames: &[Vec<View>]) -> String {
    const TITLE: &str = "The path of the camera over the unfolded world";
    let net = Net::of(world);
    let subtitle = format!(
        "Bright: what {} frames see. Dots: the middle of each frame. Yellow: the fields of view of the first and the last.",
        frames.len()
    );
    let mut drawing = sheet(net.size, TITLE, &subtitle);
    let step = frames.len().div_ceil(FRAMES).max(1);
    let some: Vec<&View> = frames.iter().step_by(step).chain(frames.last()).flatten().collect();
    for (index, (source, &frame)) in world.sources().iter().zip(&net.images).enumerate() {
        drawing.rect(frame, Paint::fill(colour(index)));
        drawing.rects(&seen_by_any(source, frame, &some).area(false), Paint::fill(DARK).opacity(0.9));
        drawing.rect(frame, Paint::stroke(INK, 1.5));
    }
    let ends: Vec<&View> = frames.first().into_iter().chain(frames.last()).flatten().collect();
    for (source, &frame) in world.sources().iter().zip(&net.images) {
        for target in &ends {
            let edges = shown(source, net.outset(frame), target).edges();
            for paint in [Paint::stroke(INK, 5.0), Paint::stroke(CURVE, 2.5)] {
                drawing.polylines(edges.iter().map(|segment| &segment[..]), paint);
            }
        }
    }
    draw_way(&mut drawing, world, &net, frames);
    for (source, frame) in world.sources().iter().zip(&net.images) {
        let corner = (frame.x + LABEL, frame.y + 1.5 * LABEL);
        drawing.label(&source.name, corner, LABEL, Anchor::Start, PAPER);
    }
    drawing.finish(TITLE)
}

/// Returns which points of a view's image some target shows.
fn seen_by_any<'a>(source: &'a Source, frame: Rect, targets: &'a [&View]) -> Regions<impl Fn(f64, f64) -> bool + 'a> {
    let (columns, rows) = (source.view.width() as f64, source.view.height() as f64);
    let label = move |u: f64, v: f64| {
        let pixel = PixelPoint::new(u * columns, v * rows);
        let direction = source.view.direction(pixel).filter(|_| source.view.stop_passes(pixel));
        direction.is_some_and(|direction| targets.iter().any(|target| target.sees(direction)))
    };
    Regions { frame, columns: frame.width.round() as usize / 2, rows: frame.height.round() as usize / 2, label }
}

/// Draws the way of the first picture's centre, with a dot for each frame.
fn draw_way(drawing: &mut Drawing, world: &World, net: &Net, frames: &[Vec<View>]) {
    let centres = frames.iter().filter_map(|views| Some(central_footprint(views.first()?)?.direction));
    let places: Vec<(usize, Point)> = centres.filter_map(|direction| place(world, net, direction)).collect();
    let segments: Vec<[Point; 2]> =
        places.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| [pair[0].1, pair[1].1]).collect();
    let is_near = |segment: &&[Point; 2]| (segment[0].0 - segment[1].0).hypot(segment[0].1 - segment[1].1) < 200.0;
    for paint in [Paint::stroke(PAPER, 3.5), Paint::stroke(INK, 1.5)] {
        // A way that jumps across the sheet leaves a panorama at one side and comes back at the other.
        drawing.polylines(segments.iter().filter(is_near).map(|segment| &segment[..]), paint);
    }
    for (_, place) in &places {
        drawing.ellipse(*place, (DOT, DOT), 0.0, Paint::fill(INK));
    }
    for (paint, end) in [(CURVE, places.first()), (PAPER, places.last())] {
        if let Some((_, place)) = end {
            drawing.ellipse(*place, (END, END), 0.0, Paint { fill: paint, ..Paint::stroke(INK, 2.0) });
        }
    }
}

/// Returns the view that shows a direction, and the direction's place on the sheet.
fn place(world: &World, net: &Net, direction: Direction) -> Option<(usize, Point)> {
    let (index, _) = world.owner(direction)?;
    let (view, frame) = (&world.sources()[index].view, net.images[index]);
    let pixel = view.pixel(direction)?;
    let along = |at: f64, size: usize| at / size as f64;
    let (u, v) = (along(pixel.x, view.width()), along(pixel.y, view.height()).clamp(0.0, 1.0));
    let u = if view.period().is_some() { u.rem_euclid(1.0) } else { u.clamp(0.0, 1.0) };
    Some((index, (frame.x + u * frame.width, frame.y + v * frame.height)))
}
