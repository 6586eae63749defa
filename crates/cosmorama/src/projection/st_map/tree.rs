use glam::{DVec3, Vec3};

use super::lattice::{Jet, Links, Samples};

/// Squares of the lattice along the side of a leaf.
const LEAF: usize = 8;

/// Steps of Newton's method. From the nearest sample, four are enough where a table is smooth.
const STEPS: usize = 16;

/// How far outside a table its leaves' boxes reach, in squares.
pub(super) const MOST_BEYOND: f64 = 3.0;

/// A part of a square of the lattice to which a point is found.
const FOUND: f64 = 1e-9;

/// A box of values; nothing, where its sides are crossed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) min: Vec3,
    pub(super) max: Vec3,
}

impl Bounds {
    const NOTHING: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The distance of a point.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        (self.min - point).max(point - self.max).max(Vec3::ZERO).length()
    }
}

/// Where in a table a value is: boxes around blocks of samples, and around four such boxes, and so on.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// From the leaves to the root: columns, rows, boxes.
    levels: Vec<(usize, usize, Vec<Bounds>)>,
}

/// A block of the lattice: columns and rows from its corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Leaf {
    pub(super) column: usize,
    pub(super) row: usize,
}

impl Leaf {
    /// Its squares' corners, least and greatest.
    pub(super) fn rectangle(self, samples: &Samples) -> [(f64, f64); 2] {
        let (left, top) = (self.column * LEAF, self.row * LEAF);
        let (right, bottom) = ((left + LEAF).min(samples.width), (top + LEAF).min(samples.height));
        [(left as f64, top as f64), (right as f64, bottom as f64)]
    }

    /// The same with what lies beyond the table beside it.
    fn rectangle_with(self, samples: &Samples, beyond: f64) -> [(f64, f64); 2] {
        let [(left, top), (right, bottom)] = self.rectangle(samples);
        let low = |at: f64| if at == 0.0 { -beyond } else { at };
        let high = |at: f64, size: usize| if at == size as f64 { at + beyond } else { at };
        [(low(left), low(top)), (high(right, samples.width), high(bottom, samples.height))]
    }
}

impl Tree {
    pub(super) fn new(samples: &Samples, links: &Links) -> Self {
        let (columns, rows) = (samples.width.div_ceil(LEAF), samples.height.div_ceil(LEAF));
        let leaf = |k: usize| leaf_bounds(samples, links, Leaf { column: k % columns, row: k / columns });
        let mut levels = vec![(columns, rows, (0..columns * rows).map(leaf).collect::<Vec<_>>())];
        while let Some((columns, rows, below)) = levels.last().filter(|(columns, rows, _)| columns * rows > 1) {
            let (wide, high) = (columns.div_ceil(2), rows.div_ceil(2));
            let parent = |k: usize| {
                let children = children(k % wide, k / wide, *columns, *rows);
                children.map(|(i, j)| below[j * columns + i]).fold(Bounds::NOTHING, Bounds::union)
            };
            let boxes = (0..wide * high).map(parent).collect();
            levels.push((wide, high, boxes));
        }
        Self { levels }
    }

    /// The box around what a leaf holds.
    pub(super) fn bounds(&self, leaf: Leaf) -> Bounds {
        let (columns, _, boxes) = &self.levels[0];
        boxes[leaf.row * columns + leaf.column]
    }

    /// Gives every leaf whose box is within `reach` of a value, until one is taken.
    pub(super) fn search<T>(&self, value: Vec3, reach: f32, mut visit: impl FnMut(Leaf) -> Option<T>) -> Option<T> {
        self.descend(self.levels.len() - 1, (0, 0), value, reach, &mut visit)
    }

    fn descend<T>(
        &self,
        level: usize,
        (i, j): (usize, usize),
        value: Vec3,
        reach: f32,
        visit: &mut impl FnMut(Leaf) -> Option<T>,
    ) -> Option<T> {
        let (columns, _, boxes) = &self.levels[level];
        if boxes[j * columns + i].distance(value) > reach {
            return None;
        }
        if level == 0 {
            return visit(Leaf { column: i, row: j });
        }
        let (columns, rows, _) = &self.levels[level - 1];
        children(i, j, *columns, *rows).find_map(|child| self.descend(level - 1, child, value, reach, visit))
    }

    /// The first point of the lattice, in the order of leaves, at which a table has this value; up to `beyond` squares outside
    /// it, at most [`MOST_BEYOND`].
    pub(super) fn find(&self, samples: &Samples, links: &Links, value: DVec3, beyond: f64) -> Option<(f64, f64)> {
        self.search(value.as_vec3(), 0.0, |leaf| find_in_leaf(samples, links, leaf, value, beyond))
    }
}

/// The up to four boxes below one.
fn children(i: usize, j: usize, columns: usize, rows: usize) -> impl Iterator<Item = (usize, usize)> {
    let column = move |j| (2 * i..columns.min(2 * i + 2)).map(move |i| (i, j));
    (2 * j..rows.min(2 * j + 2)).flat_map(column)
}

/// Around a leaf's samples and their neighbours, between which its squares are, with room for what cubics overshoot and
/// for the half squares at the table's border.
fn leaf_bounds(samples: &Samples, links: &Links, leaf: Leaf) -> Bounds {
    let mut bounds = Bounds::NOTHING;
    let (left, top) = (leaf.column * LEAF, leaf.row * LEAF);
    for j in top.saturating_sub(1)..(top + LEAF + 1).min(samples.height) {
        for i in left.saturating_sub(1)..(left + LEAF + 1).min(samples.width) {
            if links.is_valid(i, j) {
                let value = samples.values[j * samples.width + i];
                bounds = bounds.union(Bounds { min: value, max: value });
            }
        }
    }
    let is_outer = left == 0 || top == 0 || left + LEAF >= samples.width || top + LEAF >= samples.height;
    // The longest side, for all: a table that runs along one axis alone bulges along the others.
    let extent = (bounds.max - bounds.min).max_element();
    // A leaf at the border may hold one row of squares only.
    let part = if is_outer { MOST_BEYOND as f32 } else { 0.25 };
    let room = Vec3::splat(extent * part + 1e-6);
    Bounds { min: bounds.min - room, max: bounds.max + room }
}

/// Newton's method from the leaf's nearest sample.
fn find_in_leaf(samples: &Samples, links: &Links, leaf: Leaf, value: DVec3, beyond: f64) -> Option<(f64, f64)> {
    let [(left, top), (right, bottom)] = leaf.rectangle_with(samples, beyond);
    let (width, height) = (samples.width as f64, samples.height as f64);
    // Not far out of the leaf: there other samples tell.
    let moved = |at: f64, step: f64, [least, greatest]: [f64; 2], size: f64| {
        (at + step.clamp(-4.0, 4.0)).clamp(least - 1.0, greatest + 1.0).clamp(-beyond, size + beyond)
    };
    let (mut x, mut y) = nearest(samples, links, leaf, value.as_vec3())?;
    for _ in 0..STEPS {
        let step = solve(&links.jet(samples, x, y, beyond)?, value)?;
        let next = (moved(x, step.0, [left, right], width), moved(y, step.1, [top, bottom], height));
        let is_held = (next.0 - x).abs().max((next.1 - y).abs()) < FOUND;
        (x, y) = next;
        if step.0.abs().max(step.1.abs()) < FOUND {
            let room = 2.0 * FOUND;
            let inside = x >= left - room && x <= right + room && y >= top - room && y <= bottom + room;
            return inside.then_some((x, y));
        }
        // At a border, while the value is beyond it.
        if is_held {
            return None;
        }
    }
    None
}

/// The middle of the square of the sample nearest to a value.
fn nearest(samples: &Samples, links: &Links, leaf: Leaf, value: Vec3) -> Option<(f64, f64)> {
    let [(left, top), (right, bottom)] = leaf.rectangle(samples);
    let mut best: Option<(f32, usize, usize)> = None;
    for j in top as usize..bottom as usize {
        for i in left as usize..right as usize {
            let distance = samples.values[j * samples.width + i].distance_squared(value);
            if links.is_valid(i, j) && best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, i, j));
            }
        }
    }
    best.map(|(_, i, j)| (i as f64 + 0.5, j as f64 + 0.5))
}

/// The step along the lattice that comes nearest to a value; what sticks out of the table's surface is left out.
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
