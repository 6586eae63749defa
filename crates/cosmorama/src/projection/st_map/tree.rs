use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

use super::lattice::{Jet, Links, Samples};
use super::piece::{Leaf, Piece};

/// Limit of Newton steps. From the nearest sample, four suffice where a table is smooth.
const STEPS: usize = 16;

/// Distance outside a table, in squares, to which its leaves' boxes extend.
pub(crate) const MOST_BEYOND: f64 = 3.0;

/// Precision to which a point is found, in squares of the lattice.
const FOUND: f64 = 1e-9;

/// Step after which the iteration stops: the next step, quadratic in this one, would be shorter than [`FOUND`].
const LAST_STEP: f64 = 1e-5;

/// Step, in squares, below which the iteration converges.
const CONVERGING: f64 = 0.25;

/// A box of values; it is empty if its sides are crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Bounds {
    const NOTHING: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    fn with(self, value: Vec3) -> Self {
        Self { min: self.min.min(value), max: self.max.max(value) }
    }

    fn widened(self, room: f32) -> Self {
        Self { min: self.min - room, max: self.max + room }
    }
}

/// Index of values in a table: an R-tree of boxes around the pieces of its lattice.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    boxes: Vec<Bounds>,
    index: RTree<GeomWithData<Rectangle<[f32; 3]>, usize>>,
}

impl Tree {
    /// Creates the tree of the boxes around pieces of a table, extended by up to `beyond` squares outside it.
    pub(crate) fn new(samples: &Samples, links: &Links, pieces: &[Piece], beyond: f64) -> Self {
        let boxes: Vec<Bounds> = pieces.par_iter().map(|piece| bounds(samples, links, piece, beyond)).collect();
        let entry = |(number, held): (usize, &Bounds)| {
            GeomWithData::new(Rectangle::from_corners(held.min.to_array(), held.max.to_array()), number)
        };
        let index = RTree::bulk_load(boxes.iter().enumerate().map(entry).collect());
        Self { boxes, index }
    }

    /// Returns the box around a piece.
    pub(crate) fn bounds(&self, piece: usize) -> Bounds {
        self.boxes[piece]
    }

    /// Returns the numbers of all pieces that may hold a value within `reach` of a value.
    pub(crate) fn within(&self, value: Vec3, reach: f32) -> impl Iterator<Item = usize> {
        self.index.locate_within_distance(value.to_array(), reach * reach).map(|entry| entry.data)
    }

    /// Finds the point of the lattice at which the table has this value, in the first piece that holds it. The point
    /// may lie up to `beyond` squares outside, at most [`MOST_BEYOND`].
    pub(crate) fn find(
        &self,
        (samples, links, leaves): (&Samples, &Links, &[Leaf]),
        value: DVec3,
        beyond: f64,
    ) -> Option<(f64, f64)> {
        let mut first: Option<(usize, (f64, f64))> = None;
        for entry in self.index.locate_all_at_point(value.as_vec3().to_array()) {
            if first.is_none_or(|(piece, _)| entry.data < piece) {
                let found = find_in_leaf(samples, links, leaves[entry.data], value, beyond);
                first = found.map(|at| (entry.data, at)).or(first);
            }
        }
        first.map(|(_, at)| at)
    }
}

/// Returns the box around a piece's samples. It includes the overshoot of cubics, the half squares beside the outermost
/// samples, and the surroundings of the table.
fn bounds(samples: &Samples, links: &Links, piece: &Piece, beyond: f64) -> Bounds {
    let value = |i: usize, j: usize| samples.values[j * samples.width + i];
    let (mut bounds, mut longest) = (Bounds::NOTHING, 0f32);
    for (i, j) in piece.cells(samples.width, samples.height) {
        let [a, b, c, d] = [value(i, j), value(i + 1, j), value(i, j + 1), value(i + 1, j + 1)];
        bounds = [a, b, c, d].into_iter().fold(bounds, Bounds::with);
        let steps = [a.distance_squared(b), a.distance_squared(c), d.distance_squared(b), d.distance_squared(c)];
        longest = steps.into_iter().fold(longest, f32::max);
    }
    let mut longest = longest.sqrt();
    let is_outer = piece.leaf.is_outer(samples);
    if is_outer && beyond > 0.0 {
        let [(left, top), (right, bottom)] = piece.leaf.rectangle_with(samples, beyond);
        let (columns, rows) = ((right - left) as usize, (bottom - top) as usize);
        for (i, j) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))) {
            let Some(jet) = links.jet(samples, left + i as f64, top + j as f64, beyond) else { continue };
            bounds = bounds.with(jet.value.as_vec3());
            longest = longest.max(jet.dx.as_vec3().length()).max(jet.dy.as_vec3().length());
        }
    }
    // Beyond its samples a table continues as a parabola, on which half a square may be as long as two others.
    let room = if piece.is_whole() && !is_outer { 0.5 } else { 2.0 };
    bounds.widened(room * longest + 1e-6)
}

/// Uses Newton's method from the leaf's nearest sample.
fn find_in_leaf(samples: &Samples, links: &Links, leaf: Leaf, value: DVec3, beyond: f64) -> Option<(f64, f64)> {
    let [(left, top), (right, bottom)] = leaf.rectangle_with(samples, beyond);
    let (width, height) = (samples.width as f64, samples.height as f64);
    let is_within =
        |(x, y): (f64, f64), room: f64| x >= left - room && x <= right + room && y >= top - room && y <= bottom + room;
    // Not far beyond the leaf, where other leaves are better.
    let moved = |at: f64, step: f64, [least, greatest]: [f64; 2], size: f64| {
        (at + step.clamp(-4.0, 4.0)).clamp(least - 1.0, greatest + 1.0).clamp(-beyond, size + beyond)
    };
    let mut at = nearest(samples, links, leaf, value.as_vec3())?;
    for _ in 0..STEPS {
        let step = solve(&links.jet(samples, at.0, at.1, beyond)?, value)?;
        let length = step.0.abs().max(step.1.abs());
        let next = (moved(at.0, step.0, [left, right], width), moved(at.1, step.1, [top, bottom], height));
        let is_held = (next.0 - at.0).abs().max((next.1 - at.1).abs()) < FOUND;
        at = next;
        if length < LAST_STEP {
            return is_within(at, 2.0 * FOUND).then_some(at);
        }
        // At a border, while the value is beyond it; or on the way to a place beyond it.
        if is_held || (length < CONVERGING && !is_within(at, length)) {
            return None;
        }
    }
    None
}

/// Returns the middle of the square of the sample nearest to a value.
fn nearest(samples: &Samples, links: &Links, leaf: Leaf, value: Vec3) -> Option<(f64, f64)> {
    let [(left, top), (right, bottom)] = leaf.rectangle(samples);
    let mut best: Option<(f32, usize, usize)> = None;
    for j in top as usize..bottom as usize {
        for i in left as usize..right as usize {
            let distance = samples.values[j * samples.width + i].distance_squared(value);
            if best.is_none_or(|(least, ..)| distance < least) && links.is_valid(i, j) {
                best = Some((distance, i, j));
            }
        }
    }
    best.map(|(_, i, j)| (i as f64 + 0.5, j as f64 + 0.5))
}

/// Returns the step along the lattice that comes nearest to a value; the part outside the table's surface is ignored.
fn solve(jet: &Jet, value: DVec3) -> Option<(f64, f64)> {
    let tangent = value - jet.value;
    let normal = jet.dx.cross(jet.dy);
    let determinant = normal.length_squared();
    if determinant <= 1e-24 * jet.dx.length_squared() * jet.dy.length_squared() {
        return None;
    }
    let (x, y) = (tangent.cross(jet.dy).dot(normal), jet.dx.cross(tangent).dot(normal));
    Some((x / determinant, y / determinant))
}
