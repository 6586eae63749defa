use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Ratio of a step between two samples to its neighbours above which the table counts as torn. `LEAST_TEAR`, a
/// hundredth of a picture or of a radian, is the shortest tear.
const TEAR: f32 = 4.0;
const LEAST_TEAR: f32 = 0.01;

/// A quantity on a lattice of samples; sample (i, j) is at the middle (i + ½, j + ½) of its square.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Values, row by row; NaN where there is none.
    pub(crate) values: Vec<Vec3>,
}

/// Marks of valid samples, and of neighbours that are connected.
#[derive(Clone, Debug)]
pub(crate) struct Links {
    pub(crate) width: usize,
    pub(crate) height: usize,
    flags: Vec<u8>,
}

/// A value with its derivatives along the lattice, per sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    pub(crate) value: DVec3,
    pub(crate) dx: DVec3,
    pub(crate) dy: DVec3,
}

const VALID: u8 = 1;
/// Bit flags: connected to the sample to the right, and to the one below.
const RIGHT: u8 = 2;
const BELOW: u8 = 4;

impl Samples {
    fn get(&self, i: i64, j: i64) -> Option<Vec3> {
        let inside = (0..self.width as i64).contains(&i) && (0..self.height as i64).contains(&j);
        let value = inside.then(|| self.values[j as usize * self.width + i as usize])?;
        value.is_finite().then_some(value)
    }

    fn at(&self, i: i64, j: i64) -> DVec3 {
        self.values[j as usize * self.width + i as usize].as_dvec3()
    }

    /// Returns whether the step from (i, j) by `step` is similar to those before and after it, if there are any.
    fn is_continuous(&self, (i, j): (i64, i64), step: (i64, i64)) -> bool {
        let at = |k: i64| self.get(i + k * step.0, j + k * step.1);
        let length = |k: i64| at(k).zip(at(k + 1)).map(|(a, b)| a.distance(b));
        let Some(here) = length(0) else { return false };
        let beside = [length(-1), length(1)].into_iter().flatten().reduce(f32::max);
        here < LEAST_TEAR || beside.is_none_or(|beside| here <= TEAR * beside)
    }
}

impl Links {
    /// Returns the links between samples that are in all of `tables`, where none of the tables is torn.
    pub(crate) fn of(tables: &[&Samples]) -> Self {
        let (width, height) = (tables[0].width, tables[0].height);
        let joined = |at, step| tables.iter().all(|table| table.is_continuous(at, step));
        let flags_of = |i: i64, j: i64| {
            let valid = tables.iter().all(|table| table.get(i, j).is_some());
            let flag = |set: bool, flag: u8| if set { flag } else { 0 };
            flag(valid, VALID)
                | flag(valid && joined((i, j), (1, 0)), RIGHT)
                | flag(valid && joined((i, j), (0, 1)), BELOW)
        };
        let mut flags = vec![0; width * height];
        flags.par_chunks_exact_mut(width.max(1)).enumerate().for_each(|(j, row)| {
            row.iter_mut().enumerate().for_each(|(i, flags)| *flags = flags_of(i as i64, j as i64));
        });
        Self { width, height, flags }
    }

    fn has(&self, i: i64, j: i64, flag: u8) -> bool {
        let inside = (0..self.width as i64).contains(&i) && (0..self.height as i64).contains(&j);
        inside && self.flags[j as usize * self.width + i as usize] & flag != 0
    }

    /// Returns whether there is a sample.
    pub(crate) fn is_valid(&self, i: usize, j: usize) -> bool {
        self.has(i as i64, j as i64, VALID)
    }

    /// Returns whether the samples (i, j) to (i + 1, j + 1) are connected.
    pub(crate) fn is_whole(&self, i: i64, j: i64) -> bool {
        self.has(i, j, RIGHT) && self.has(i, j, BELOW) && self.has(i + 1, j, BELOW) && self.has(i, j + 1, RIGHT)
    }

    /// Interpolates a quantity at a point of the lattice, or up to `beyond` squares outside it. Between four connected
    /// samples it is bicubic (Catmull & Rom 1974). Elsewhere each sample's square is extrapolated from its connected
    /// neighbours. Nothing is interpolated across a tear, and the squares of the outermost samples are covered.
    pub(crate) fn jet(&self, samples: &Samples, x: f64, y: f64, beyond: f64) -> Option<Jet> {
        let (width, height) = (self.width as f64, self.height as f64);
        let inside = |at: f64, size: f64| (-beyond..=size + beyond).contains(&at);
        if !(inside(x, width) && inside(y, height)) {
            return None;
        }
        let (columns, rows) = (cells(x, width), cells(y, height));
        let either = [(columns[0], rows[0]), (columns[1], rows[0]), (columns[0], rows[1]), (columns[1], rows[1])];
        let &(i, j) = either.iter().find(|(i, j)| self.is_whole(*i as i64, *j as i64))?;
        Some(self.patch(samples, (i as i64, j as i64), (x - 0.5 - i, y - 0.5 - j)))
    }

    fn patch(&self, samples: &Samples, (i, j): (i64, i64), (a, b): (f64, f64)) -> Jet {
        let (along, down) = (cubic(a), cubic(b));
        // The value of a row, and its derivative along it.
        let row = |j: i64| {
            let inner = [samples.at(i, j), samples.at(i + 1, j)];
            let before = self.has(i - 1, j, RIGHT).then(|| samples.at(i - 1, j));
            let after = self.has(i + 1, j, RIGHT).then(|| samples.at(i + 2, j));
            let four = completed(before, inner, after);
            [weighed(&four, &along.weights), weighed(&four, &along.slopes)]
        };
        let joined = |j: i64| self.has(i, j, BELOW) && self.has(i + 1, j, BELOW);
        let before = (joined(j - 1) && self.has(i, j - 1, RIGHT)).then(|| row(j - 1));
        let after = (joined(j + 1) && self.has(i, j + 2, RIGHT)).then(|| row(j + 2));
        let inner = [row(j), row(j + 1)];
        let rows =
            [0, 1].map(|k| completed(before.map(|row| row[k]), [inner[0][k], inner[1][k]], after.map(|row| row[k])));
        Jet {
            value: weighed(&rows[0], &down.weights),
            dx: weighed(&rows[1], &down.weights),
            dy: weighed(&rows[0], &down.slopes),
        }
    }
}

/// Returns the two columns or rows of cells around the sample nearest to a point; the cell that holds it comes first.
fn cells(at: f64, size: f64) -> [f64; 2] {
    let nearest = at.floor().clamp(0.0, size - 1.0);
    let cell = (at - 0.5).floor();
    if cell >= nearest { [nearest, nearest - 1.0] } else { [nearest - 1.0, nearest] }
}

struct Cubic {
    weights: [f64; 4],
    slopes: [f64; 4],
}

/// Returns the weights of four samples at a point between the middle two, and their derivatives.
fn cubic(t: f64) -> Cubic {
    let (t2, t3) = (t * t, t * t * t);
    Cubic {
        weights: [
            (2.0 * t2 - t3 - t) / 2.0,
            (3.0 * t3 - 5.0 * t2 + 2.0) / 2.0,
            (4.0 * t2 - 3.0 * t3 + t) / 2.0,
            (t3 - t2) / 2.0,
        ],
        slopes: [
            (4.0 * t - 3.0 * t2 - 1.0) / 2.0,
            (9.0 * t2 - 10.0 * t) / 2.0,
            (8.0 * t - 9.0 * t2 + 1.0) / 2.0,
            (3.0 * t2 - 2.0 * t) / 2.0,
        ],
    }
}

/// Completes four samples in a row: missing outer ones are extrapolated by a parabola, or linearly.
fn completed(before: Option<DVec3>, [p, q]: [DVec3; 2], after: Option<DVec3>) -> [DVec3; 4] {
    let (far, near) = (after.unwrap_or(q * 2.0 - p), before.unwrap_or(p * 2.0 - q));
    [before.unwrap_or((p - q) * 3.0 + far), p, q, after.unwrap_or((q - p) * 3.0 + near)]
}

fn weighed(four: &[DVec3; 4], weights: &[f64; 4]) -> DVec3 {
    four[0] * weights[0] + four[1] * weights[1] + four[2] * weights[2] + four[3] * weights[3]
}
