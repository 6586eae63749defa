//! Figure 3: the unfolded world with the field of view marked.

use super::sheet::drawing::{Anchor, Drawing, Paint, Rect};
use super::sheet::field::shown;
use super::sheet::heading::{sheet, size_text};
use super::sheet::net::Net;
use super::sheet::theme::{CURVE, DARK, FAINT, INK, LABEL, PAPER, SMALL, colour};
use crate::camera::{PixelRect, View};
use crate::render::{Need, Needs};
use crate::world::{Source, World};

/// Approximate half width of a name.
const ROOM: f64 = 34.0;

/// A picture of a view that lies under a figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Underlay {
    /// Index of the view in the world.
    pub view: usize,
    /// Address of its picture, or a data URI like `data:image/png;base64,…`. It is stretched over the view.
    pub href: String,
}

/// Opacity of the veil over parts that are not needed.
const VEIL: f64 = 0.74;

pub(crate) fn draw(world: &World, target: &View, needs: &Needs, underlays: &[Underlay]) -> String {
    let net = Net::of(world);
    let subtitle = format!(
        "Bright: what a target of {} pixels needs. Yellow: the edge of its field of view.",
        size_text((target.width(), target.height()))
    );
    let mut drawing = sheet(net.size, "The unfolded world and the field of view", &subtitle);
    for (face, cell) in &net.lacking {
        draw_lacking(&mut drawing, face.name(), *cell);
    }
    for (index, source) in world.sources().iter().enumerate() {
        let picture = underlays.iter().find(|underlay| underlay.view == index);
        draw_image(&mut drawing, source, index, net.images[index], target, picture);
    }
    // Curves and letters lie over all images, so that no image cuts an edge at its border.
    for (source, &frame) in world.sources().iter().zip(&net.images) {
        draw_curve(&mut drawing, source, net.outset(frame), target);
    }
    for ((source, need), &frame) in world.sources().iter().zip(&needs.views).zip(&net.images) {
        draw_names(&mut drawing, source, need, frame, target);
    }
    drawing.finish("The unfolded world and the field of view")
}

fn draw_lacking(drawing: &mut Drawing, name: &str, cell: Rect) {
    drawing.rect(cell, Paint::stroke(FAINT, 1.5).dashed());
    let middle = (cell.x + cell.width / 2.0, cell.y + cell.height / 2.0);
    drawing.label(name, middle, LABEL, Anchor::Middle, FAINT);
    drawing.label("not given", (middle.0, middle.1 + 2.0 * LABEL), SMALL, Anchor::Middle, FAINT);
}

fn draw_image(
    drawing: &mut Drawing,
    source: &Source,
    index: usize,
    frame: Rect,
    target: &View,
    picture: Option<&Underlay>,
) {
    match picture {
        Some(underlay) => drawing.image(frame, &underlay.href),
        None => drawing.rect(frame, Paint::fill(colour(index))),
    }
    let veil = if picture.is_some() { VEIL } else { 0.9 };
    drawing.rects(&shown(source, (frame, 0.0), target).area(false), Paint::fill(DARK).opacity(veil));
    drawing.rect(frame, Paint::stroke(INK, 1.5));
}

fn draw_curve(drawing: &mut Drawing, source: &Source, area: (Rect, f64), target: &View) {
    let edges = shown(source, area, target).edges();
    for paint in [Paint::stroke(INK, 5.0), Paint::stroke(CURVE, 2.5)] {
        drawing.polylines(edges.iter().map(|segment| &segment[..]), paint);
    }
}

fn draw_names(drawing: &mut Drawing, source: &Source, need: &Need, frame: Rect, target: &View) {
    let middle = (frame.x + frame.width / 2.0, frame.y + frame.height / 2.0);
    let size = size_text((source.view.width(), source.view.height()));
    let Some(needed) = need.seen.and(need.read) else {
        drawing.label(&source.name, middle, LABEL, Anchor::Middle, PAPER);
        drawing.label("not needed", (middle.0, middle.1 + 2.0 * LABEL), SMALL, Anchor::Middle, PAPER);
        return;
    };
    let regions = shown(source, (frame, 0.0), target);
    let lines = [(source.name.as_str(), LABEL), (&needed_text(&needed, source, &size), SMALL)];
    match (regions.middle(true), regions.middle(false)) {
        (Some((place, room)), _) if room >= ROOM => drawing.plaque(&lines, place, frame, PAPER, INK),
        // On a small region its name would hide it, so the name goes to the part that is not needed.
        (_, Some((place, _))) => drawing.plaque(&lines, place, frame, DARK, PAPER),
        _ => drawing.plaque(&lines, middle, frame, PAPER, INK),
    }
}

/// Describes the needed part of an image: all of it, or a window in the usual notation.
fn needed_text(needed: &PixelRect, source: &Source, size: &str) -> String {
    let is_whole = (needed.width(), needed.height()) == (source.view.width(), source.view.height());
    if is_whole {
        format!("all of {size}")
    } else {
        format!("{}×{}+{}+{}", needed.width(), needed.height(), needed.left, needed.top)
    }
}
