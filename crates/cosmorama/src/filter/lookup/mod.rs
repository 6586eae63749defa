//! Look-up of a single direction: the nearest texel, or the four around it, across the edges of views.

mod bilinear;
mod feline;
pub(crate) mod labels;
mod point;

pub use bilinear::Bilinear;
pub use feline::Feline;
pub use labels::{LabelRule, Labels};
pub use point::Point;

use crate::camera::PixelPoint;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Calls `tap` with the texel nearest to a direction and weight 1, or not at all where no view shows the direction.
pub(crate) fn nearest(world: &World, direction: Direction, mut tap: impl FnMut(u32, f64)) {
    let Some((index, pixel)) = world.owner(direction) else { return };
    let source = &world.sources()[index];
    let (i, j) = (pixel.x.floor() as i64, pixel.y.floor() as i64);
    // At a rim the texel's own centre may be outside the field of view though the direction is inside.
    let around = [(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];
    let texel = around.iter().find_map(|(di, dj)| owned_texel(source, clamp(source, i, j), *di, *dj));
    if let Some(texel) = texel {
        tap(texel, 1.0);
    }
}

/// Calls `tap` with the four texels around a direction and their bilinear weights.
///
/// At the edge of a view some of the four lie outside of its image. Each of these is looked up in the view that shows
/// it, again bilinearly. If no view shows it, `tap` is not called for it, and the weights add up to less than 1.
pub(crate) fn bilinear(world: &World, direction: Direction, mut tap: impl FnMut(u32, f64)) {
    world.for_each_holder(direction, |index, pixel, part| {
        let source = &world.sources()[index];
        for (i, j, weight) in corners(pixel) {
            match source.column(i).and_then(|i| owned_texel(source, (i, j), 0, 0)) {
                Some(texel) => tap(texel, weight * part),
                None => beyond_edge(world, source, (i, j), weight * part, &mut tap),
            }
        }
    });
}

/// Returns the number of texels that [`bilinear`] reads.
pub(crate) fn reads(world: &World, direction: Direction) -> usize {
    let mut count = 0;
    bilinear(world, direction, |_, _| count += 1);
    count
}

fn beyond_edge(world: &World, source: &Source, (i, j): (i64, i64), weight: f64, tap: &mut impl FnMut(u32, f64)) {
    let centre = PixelPoint::new(i as f64 + 0.5, j as f64 + 0.5);
    let Some(direction) = source.view.direction(centre) else { return };
    let Some((index, pixel)) = world.owner(direction) else { return };
    let neighbour = &world.sources()[index];
    for (i, j, part) in corners(pixel) {
        if let Some(texel) = owned_texel(neighbour, clamp(neighbour, i, j), 0, 0) {
            tap(texel, weight * part);
        }
    }
}

/// Returns the 2×2 texels around a point with their bilinear weights.
fn corners(pixel: PixelPoint) -> [(i64, i64, f64); 4] {
    let (x, y) = (pixel.x - 0.5, pixel.y - 0.5);
    let (i, j) = (x.floor(), y.floor());
    let (fx, fy) = (x - i, y - j);
    let (i, j) = (i as i64, j as i64);
    [(i, j, (1.0 - fx) * (1.0 - fy)), (i + 1, j, fx * (1.0 - fy)), (i, j + 1, (1.0 - fx) * fy), (i + 1, j + 1, fx * fy)]
}

fn clamp(source: &Source, i: i64, j: i64) -> (i64, i64) {
    let i = source.column(i).unwrap_or_else(|| i.clamp(0, source.view.width() as i64 - 1));
    (i, j.clamp(0, source.view.height() as i64 - 1))
}

fn owned_texel(source: &Source, (i, j): (i64, i64), di: i64, dj: i64) -> Option<u32> {
    let i = source.column(i + di)?;
    let j = usize::try_from(j + dj).ok().filter(|&j| j < source.view.height())?;
    let texel = j * source.view.width() + i as usize;
    (source.solid_angles[texel] > 0.0).then_some((source.offset + texel) as u32)
}
