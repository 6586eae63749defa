//! Regions of a picture, distinguished by labels: their areas as runs, and the curves between them.

use super::drawing::{Point, Rect};

/// Number of bisections of the interval in which a label changes. Eight find the change to 1/256 of a step.
const HALVINGS: usize = 8;

/// Nodes along each side of the grid that is searched for a name's place.
const STEPS: usize = 64;

/// Labels of the points of a rectangle, sampled at `columns`×`rows` steps.
pub(crate) struct Regions<F> {
    pub(crate) frame: Rect,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Returns the label of a point (x, y) in the frame, both from 0 to 1.
    pub(crate) label: F,
}

impl<L: Copy + PartialEq, F: Fn(f64, f64) -> L> Regions<F> {
    /// Returns the area of one label, as a strip for each run of each row.
    pub(crate) fn area(&self, wanted: L) -> Vec<Rect> {
        let row_height = self.frame.height / self.rows as f64;
        let mut strips = Vec::new();
        for row in 0..self.rows {
            let v = (row as f64 + 0.5) / self.rows as f64;
            for (start, end) in self.runs(v, wanted) {
                strips.push(Rect {
                    x: self.frame.x + start * self.frame.width,
                    y: self.frame.y + row as f64 * row_height,
                    width: (end - start) * self.frame.width,
                    // Strips overlap slightly: between two that just touch, the background would shine through.
                    height: if row + 1 < self.rows { row_height + 0.3 } else { row_height },
                });
            }
        }
        strips
    }

    fn runs(&self, v: f64, wanted: L) -> Vec<(f64, f64)> {
        let is_wanted = |u: f64| (self.label)(u, v) == wanted;
        let at = |column: usize| (column as f64 + 0.5) / self.columns as f64;
        let (mut runs, mut start) = (Vec::new(), is_wanted(at(0)).then_some(0.0));
        for column in 1..self.columns {
            let inside = is_wanted(at(column));
            if inside == start.is_some() {
                continue;
            }
            let edge = bisect(|t| is_wanted(at(column - 1) + t / self.columns as f64) == inside);
            let edge = at(column - 1) + edge / self.columns as f64;
            match start.take() {
                Some(start) => runs.push((start, edge)),
                None => start = Some(edge),
            }
        }
        runs.extend(start.map(|start| (start, 1.0)));
        runs
    }

    /// Returns the curves where the label changes, as short segments (marching squares, with crossings found by
    /// bisection).
    pub(crate) fn edges(&self) -> Vec<[Point; 2]> {
        let node = |i: usize, j: usize| (i as f64 / self.columns as f64, j as f64 / self.rows as f64);
        let label = |(u, v): Point| (self.label)(inset(u), inset(v));
        let row_of = |j: usize| (0..=self.columns).map(|i| label(node(i, j))).collect::<Vec<_>>();
        let (mut segments, mut above) = (Vec::new(), row_of(0));
        for j in 0..self.rows {
            let below = row_of(j + 1);
            for i in 0..self.columns {
                let corners = [
                    (node(i, j), above[i]),
                    (node(i + 1, j), above[i + 1]),
                    (node(i + 1, j + 1), below[i + 1]),
                    (node(i, j + 1), below[i]),
                ];
                self.segments_of(&corners, &label, &mut segments);
            }
            above = below;
        }
        segments
    }

    fn segments_of(&self, corners: &[(Point, L); 4], label: &impl Fn(Point) -> L, segments: &mut Vec<[Point; 2]>) {
        if corners.iter().all(|corner| corner.1 == corners[0].1) {
            return;
        }
        let mut crossings = Vec::with_capacity(4);
        for side in 0..4 {
            let ((a, at_a), (b, at_b)) = (corners[side], corners[(side + 1) % 4]);
            if at_a != at_b {
                let along = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                crossings.push(self.placed(along(bisect(|t| label(along(t)) != at_a))));
            }
        }
        if let [a, b] = crossings[..] {
            segments.push([a, b]);
            return;
        }
        // Three regions or more meet in this square: their edges meet in its middle.
        let middle = self.placed(((corners[0].0.0 + corners[2].0.0) / 2.0, (corners[0].0.1 + corners[2].0.1) / 2.0));
        segments.extend(crossings.into_iter().map(|crossing| [crossing, middle]));
    }

    fn placed(&self, (u, v): Point) -> Point {
        (self.frame.x + u * self.frame.width, self.frame.y + v * self.frame.height)
    }

    /// Returns a point in a label's region with nearly the most room around it, for its name, and its distance from the
    /// region's edges. `None` if the region is very small.
    pub(crate) fn middle(&self, wanted: L) -> Option<(Point, f64)> {
        let at = |k: usize| (k as f64 + 0.5) / STEPS as f64;
        let nodes = || (0..STEPS).flat_map(|j| (0..STEPS).map(move |i| (i, j)));
        let inside: Vec<bool> = nodes().map(|(i, j)| (self.label)(at(i), at(j)) == wanted).collect();
        let place = |(i, j): (usize, usize)| (at(i) * self.frame.width, at(j) * self.frame.height);
        let outside: Vec<Point> = nodes().filter(|&node| is_just_outside(&inside, node)).map(place).collect();
        let room = |(x, y): Point| {
            let to_frame = x.min(y).min(self.frame.width - x).min(self.frame.height - y);
            outside.iter().fold(to_frame, |least, other| least.min((x - other.0).hypot(y - other.1)))
        };
        let places = nodes().zip(&inside).filter(|(_, inside)| **inside).map(|(node, _)| place(node));
        let roomy: Vec<(Point, f64)> = places.map(|place| (place, room(place))).collect();
        let most = roomy.iter().fold(0.0, |most: f64, (_, room)| most.max(*room));
        // Of many places with as much room, the one nearest to the region's mean looks best.
        let (count, sum) =
            (roomy.len() as f64, roomy.iter().fold((0.0, 0.0), |sum, (p, _)| (sum.0 + p.0, sum.1 + p.1)));
        let from_mean = |(x, y): Point| (x - sum.0 / count).hypot(y - sum.1 / count);
        let good = roomy.into_iter().filter(|(_, room)| *room >= 0.85 * most);
        let best = good.min_by(|(a, _), (b, _)| from_mean(*a).total_cmp(&from_mean(*b)));
        best.map(|((x, y), room)| ((self.frame.x + x, self.frame.y + y), room))
    }
}

/// Returns whether a node of the grid is outside a region, next to it.
fn is_just_outside(inside: &[bool], (i, j): (usize, usize)) -> bool {
    let neighbours = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
    let is_inside = |(i, j): (usize, usize)| i < STEPS && j < STEPS && inside[j * STEPS + i];
    !inside[j * STEPS + i] && neighbours.into_iter().any(is_inside)
}

/// Moves a position on the border slightly inside it.
fn inset(value: f64) -> f64 {
    value.clamp(1e-5, 1.0 - 1e-5)
}

/// Finds where a condition that is false at 0 and true at 1 becomes true.
fn bisect(is_after: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        if is_after(middle) { high = middle } else { low = middle }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc() -> Regions<impl Fn(f64, f64) -> bool> {
        let frame = Rect { x: 10.0, y: 20.0, width: 100.0, height: 100.0 };
        Regions { frame, columns: 50, rows: 50, label: |u: f64, v: f64| (u - 0.5).hypot(v - 0.5) < 0.3 }
    }

    #[test]
    fn the_area_of_a_disc() {
        let area: f64 = disc().area(true).iter().map(|strip| strip.width * 2.0).sum();
        assert!((area - std::f64::consts::PI * 900.0).abs() < 10.0, "{area}");
        let ((x, y), room) = disc().middle(true).expect("a disc");
        assert!((x - 60.0).abs() < 2.0 && (y - 70.0).abs() < 2.0 && (room - 30.0).abs() < 5.0, "{x} {y} {room}");
    }

    #[test]
    fn the_edge_of_a_disc_lies_on_its_circle() {
        let edges = disc().edges();
        let length: f64 = edges.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
        assert!((length - std::f64::consts::TAU * 30.0).abs() < 1.0, "{length}");
        for point in edges.iter().flatten() {
            assert!(((point.0 - 60.0).hypot(point.1 - 70.0) - 30.0).abs() < 0.02, "{point:?}");
        }
    }
}
