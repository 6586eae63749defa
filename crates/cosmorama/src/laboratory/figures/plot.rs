use crate::explain::sheet::drawing::{Anchor, Paint, Point, Rect};
use crate::explain::sheet::heading::sheet;
use crate::explain::sheet::theme::{FAINT, HEADER, INK, LABEL, MARGIN, SMALL, colour};

/// A curve over one axis.
pub(super) struct Plot<'a> {
    pub(super) title: &'a str,
    /// Line under the title.
    pub(super) subtitle: &'a str,
    /// Meaning of the axes: across, and upwards.
    pub(super) axes: [&'a str; 2],
    /// Points, from left to right.
    pub(super) points: &'a [Point],
}

/// Size of the field of the curve on the sheet, and room for numbers around it.
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 320.0;
const LEFT: f64 = 56.0;
const BELOW: f64 = 48.0;

impl Plot<'_> {
    /// Draws the curve. Axes span all points, to round numbers.
    pub(super) fn svg(&self) -> String {
        let points = || self.points.iter();
        let (across, up) = (Ticks::of(points().map(|point| point.0)), Ticks::of(points().map(|point| point.1)));
        let size = (LEFT + WIDTH + 2.0 * MARGIN, HEADER + HEIGHT + BELOW + MARGIN);
        let mut drawing = sheet(size, self.title, self.subtitle);
        let frame = Rect { x: MARGIN + LEFT, y: HEADER, width: WIDTH, height: HEIGHT };
        drawing.rect(frame, Paint::fill("#ffffff"));
        let place =
            |(x, y): Point| (frame.x + across.part(x) * frame.width, frame.y + (1.0 - up.part(y)) * frame.height);
        for tick in across.all() {
            let (x, _) = place((tick, up.first));
            drawing.polylines([&[(x, frame.y), (x, frame.y + HEIGHT)][..]], Paint::stroke(FAINT, 0.7));
            drawing.label(&across.text(tick), (x, frame.y + HEIGHT + 16.0), SMALL, Anchor::Middle, INK);
        }
        for tick in up.all() {
            let (_, y) = place((across.first, tick));
            drawing.polylines([&[(frame.x, y), (frame.x + WIDTH, y)][..]], Paint::stroke(FAINT, 0.7));
            drawing.label(&up.text(tick), (MARGIN, y + SMALL / 2.0), SMALL, Anchor::Start, INK);
        }
        let line: Vec<Point> = points().map(|&point| place(point)).collect();
        drawing.polylines([&line[..]], Paint::stroke(colour(0), 2.0));
        let below = (frame.x + WIDTH / 2.0, frame.y + HEIGHT + 38.0);
        drawing.label(self.axes[0], below, LABEL * 0.8, Anchor::Middle, INK);
        drawing.label(self.axes[1], (frame.x, frame.y - 6.0), SMALL, Anchor::Start, INK);
        drawing.rect(frame, Paint::stroke(INK, 1.2));
        drawing.finish(self.title)
    }
}

/// Round numbers along an axis.
struct Ticks {
    first: f64,
    last: f64,
    step: f64,
}

impl Ticks {
    /// Chooses some four to ten steps of 1, 2 or 5 times a power of ten.
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (least, most) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
        if most <= least || least.is_infinite() {
            let only = if least.is_finite() { least } else { 0.0 };
            return Self { first: only - 1.0, last: only + 1.0, step: 1.0 };
        }
        let power = 10f64.powf(((most - least) / 5.0).log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| (most - least) / step <= 8.0);
        let step = step.unwrap_or(10.0 * power);
        Self { first: (least / step).floor() * step, last: (most / step).ceil() * step, step }
    }

    fn part(&self, value: f64) -> f64 {
        (value - self.first) / (self.last - self.first)
    }

    fn all(&self) -> impl Iterator<Item = f64> + '_ {
        let count = ((self.last - self.first) / self.step).round() as usize;
        (0..=count).map(|k| self.first + k as f64 * self.step)
    }

    fn text(&self, value: f64) -> String {
        let decimals = (-self.step.log10()).ceil().max(0.0) as usize;
        // Adding zero turns −0 into 0.
        format!("{:.decimals$}", value + 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_round_numbers() {
        let ticks = Ticks::of([0.03, 0.97].into_iter());
        assert_eq!(
            ticks.all().map(|tick| ticks.text(tick)).collect::<Vec<_>>(),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        let ticks = Ticks::of([-63.0, -4.0].into_iter());
        assert_eq!((ticks.first, ticks.last, ticks.step), (-70.0, 0.0, 10.0));
        assert_eq!(Ticks::of([2.0].into_iter()).all().count(), 3);
    }
}
