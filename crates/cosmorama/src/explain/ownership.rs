//! Figure 4: which view gives which pixel.

use super::sheet::contour::Regions;
use super::sheet::drawing::{Paint, Rect};
use super::sheet::heading::{sheet, size_text};
use super::sheet::theme::{DARK, HEADER, INK, LABEL, MARGIN, PAPER, SMALL, colour};
use crate::camera::{PixelPoint, View};
use crate::world::World;

/// Longer side of the frame on the sheet.
const LONGER: f64 = 960.0;

/// Content of a point of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    /// Outside the lens.
    Outside,
    /// A direction that no view shows.
    Uncovered,
    /// A direction of the view with this index.
    View(usize),
}

pub(crate) fn draw(world: &World, target: &View) -> String {
    let (width, height) = (target.width() as f64, target.height() as f64);
    let scale = LONGER / width.max(height);
    let frame = Rect { x: MARGIN, y: HEADER, width: width * scale, height: height * scale };
    let size = size_text((target.width(), target.height()));
    let sheet_size = (frame.width.max(420.0) + 2.0 * MARGIN, frame.height + HEADER + MARGIN);
    let subtitle = format!("The target, {size} pixels. Dark: outside the field of view");
    let mut drawing = sheet(sheet_size, "Which view gives which pixel", &subtitle);
    let content = |u: f64, v: f64| content(world, target, PixelPoint::new(u * width, v * height));
    let (columns, rows) = ((frame.width / 4.0).ceil() as usize, frame.height.round().max(1.0) as usize);
    let regions = Regions { frame, columns, rows, label: content };
    drawing.rect(frame, Paint::fill(DARK));
    for index in 0..world.sources().len() {
        drawing.rects(&regions.area(Content::View(index)), Paint::fill(colour(index)));
    }
    drawing.rects(&regions.area(Content::Uncovered), Paint::fill("#d1303a"));
    drawing.polylines(regions.edges().iter().map(|segment| &segment[..]), Paint::stroke(INK, 2.0));
    for (index, source) in world.sources().iter().enumerate() {
        if let Some((place, _)) = regions.middle(Content::View(index)) {
            drawing.plaque(&[(&source.name, LABEL)], place, frame, PAPER, INK);
        }
    }
    if let Some((place, _)) = regions.middle(Content::Uncovered) {
        drawing.plaque(&[("no view", SMALL)], place, frame, PAPER, INK);
    }
    drawing.rect(frame, Paint::stroke(INK, 1.5));
    drawing.finish("Which view gives which pixel")
}

fn content(world: &World, target: &View, pixel: PixelPoint) -> Content {
    if !target.shows(pixel) {
        return Content::Outside;
    }
    let Some(direction) = target.direction(pixel) else { return Content::Outside };
    world.owner(direction).map_or(Content::Uncovered, |(index, _)| Content::View(index))
}
