use rayon::prelude::*;

use super::grid::Channels;
use crate::lighting::prefilter::{LitTexels, LitView};
use crate::raster::Rgba;
use crate::sphere::Direction;

/// Suns and lamps: the brightest texels of a world, which lobes weigh one by one. What remains is so even that few bands hold it.
pub(super) struct BrightPoints {
    /// Points of light: a texel, or the middle of a few that lie close together.
    pub(super) points: Vec<Point>,
    /// Texels that are in points: by view, then by their number in it, rising.
    pub(super) taken: Vec<Vec<usize>>,
    /// Light that the bands must have in place of those texels: their opacity, and what several are more than their point.
    pub(super) corrections: Vec<Point>,
}

/// Light from one direction: radiance times solid angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) direction: Direction,
    pub(super) light: Channels,
}

/// Sums over all of a world's light.
#[derive(Clone, Debug)]
pub(super) struct Totals {
    /// Solid angle in which something is shown.
    pub(super) shown: f64,
    /// Light that all texels have at least, by channel, where all are opaque; none where some are not. Only what is above it is
    /// summed, so that an even world has nothing to sum, and stays even to the last digit. Its opacity is zero.
    pub(super) least: Channels,
    /// Whether any light above that is negative.
    pub(super) has_negative: bool,
    /// Mean radiance, all colours added.
    pub(super) mean: f64,
    /// Bound of the radiance of each row's texels, all colours added, by view.
    brightest: Vec<Vec<f32>>,
}

/// Most points.
const MOST: usize = 128;

/// Multiple of the mean radiance from which on a texel is bright.
const BRIGHT: f64 = 16.0;

/// Cells along a radian in each of which bright texels become one point: a third of a degree.
const CELLS: f64 = 180.0;

impl Totals {
    /// Sums over a world's texels.
    pub(super) fn of(lit: &LitTexels) -> Self {
        let rows: Vec<Vec<RowTotals>> = lit.views().map(|view| RowTotals::all(view)).collect();
        let all = || rows.iter().flatten();
        let shown: f64 = all().map(|row| f64::from(row.sum[3])).sum();
        let light: f64 = all().map(RowTotals::light).sum();
        let [red, green, blue, alpha] = all().map(|row| row.least).reduce(lesser).unwrap_or_default();
        let least = if alpha == 1.0 { [red, green, blue, 0.0] } else { [0.0; 4] };
        Self {
            shown,
            least,
            has_negative: alpha != 1.0 && [red, green, blue].iter().any(|least| *least < 0.0),
            mean: if shown > 0.0 { light / shown } else { 0.0 },
            brightest: rows.iter().map(|rows| rows.iter().map(|row| brightness(row.most)).collect()).collect(),
        }
    }
}

/// Sums over a row of texels, by channel.
#[derive(Clone, Copy, Debug)]
struct RowTotals {
    /// Light and opacity times solid angle.
    sum: Channels,
    least: Channels,
    most: Channels,
}

impl RowTotals {
    fn all(view: LitView) -> Vec<Self> {
        (0..view.size().1).into_par_iter().map(|j| Self::of(view, j)).collect()
    }

    fn of(view: LitView, j: usize) -> Self {
        let (texels, angles) = view.row(j);
        let mut totals = Self { sum: [0.0; 4], least: [f32::INFINITY; 4], most: [0.0; 4] };
        let Self { sum, least, most } = &mut totals;
        for (Rgba(texel), angle) in texels.iter().zip(angles) {
            for channel in 0..4 {
                sum[channel] += texel[channel] * angle;
                least[channel] = least[channel].min(texel[channel]);
                most[channel] = most[channel].max(texel[channel]);
            }
        }
        totals
    }

    /// Returns the light of all colours.
    fn light(&self) -> f64 {
        self.sum[..3].iter().map(|sum| f64::from(*sum)).sum()
    }
}

/// A bright texel.
struct Candidate {
    /// Cell of directions, by axis.
    cell: [i32; 3],
    view: usize,
    texel: usize,
    direction: Direction,
    light: Channels,
}

impl BrightPoints {
    /// Finds the points of a world's light.
    pub(super) fn of(lit: &LitTexels, totals: &Totals) -> Self {
        let mut candidates = candidates(lit, totals);
        candidates.sort_by_key(|candidate| (candidate.cell, candidate.view, candidate.texel));
        let mut groups: Vec<&[Candidate]> = candidates.chunk_by(|a, b| a.cell == b.cell).collect();
        let energy = |group: &[Candidate]| -> f32 { group.iter().map(|candidate| brightness(candidate.light)).sum() };
        // The sort keeps the order of equals.
        groups.sort_by(|a, b| energy(b).total_cmp(&energy(a)));
        groups.truncate(MOST);
        let mut bright = Self { points: Vec::new(), taken: vec![Vec::new(); lit.count()], corrections: Vec::new() };
        groups.into_iter().for_each(|group| bright.take(group));
        bright.taken.iter_mut().for_each(|taken| taken.sort_unstable());
        bright
    }

    fn take(&mut self, group: &[Candidate]) {
        let mut light = [0.0; 4];
        let mut middle = glam::DVec3::ZERO;
        for candidate in group {
            (0..3).for_each(|channel| light[channel] += candidate.light[channel]);
            middle += candidate.direction.vector() * f64::from(brightness(candidate.light));
        }
        let direction = if group.len() == 1 { Some(group[0].direction) } else { Direction::new(middle) };
        let Some(direction) = direction else { return };
        let point = Point { direction, light };
        for Candidate { view, texel, direction, light, .. } in group {
            self.taken[*view].push(*texel);
            let [red, green, blue, alpha] = *light;
            let light = if group.len() == 1 { [0.0, 0.0, 0.0, alpha] } else { [red, green, blue, alpha] };
            self.corrections.push(Point { direction: *direction, light });
        }
        if group.len() > 1 {
            self.corrections.push(Point { light: light.map(|channel| -channel), ..point });
        }
        self.points.push(point);
    }
}

/// Finds the bright texels, view by view.
fn candidates(lit: &LitTexels, totals: &Totals) -> Vec<Candidate> {
    let least = (BRIGHT * totals.mean) as f32;
    let of_row = |(index, view, j): (usize, LitView, usize)| {
        let (width, (texels, angles)) = (view.size().0, view.row(j));
        let is_bright = |i: &usize| angles[*i] > 0.0 && brightness(texels[*i].0) > least;
        let found = (0..width).filter(is_bright).filter_map(|i| {
            let mut direction = None;
            view.source.view.row_directions(j, i..i + 1, |_, at| direction = Some(at));
            let direction = direction?;
            let cell = direction.vector().to_array().map(|part| (part * CELLS).floor() as i32);
            let light = std::array::from_fn(|channel| (texels[i].0[channel] - totals.least[channel]) * angles[i]);
            Some(Candidate { cell, view: index, texel: j * width + i, direction, light })
        });
        found.collect::<Vec<_>>()
    };
    let rows = totals.brightest.iter().enumerate().flat_map(|(index, rows)| {
        let bright = rows.iter().enumerate().filter(|(_, most)| **most > least);
        bright.map(move |(j, _)| (index, lit.view(index), j))
    });
    let rows: Vec<_> = rows.collect();
    rows.into_par_iter().flat_map_iter(of_row).collect()
}

/// Returns the lesser of two numbers, by channel.
fn lesser(a: Channels, b: Channels) -> Channels {
    std::array::from_fn(|channel| a[channel].min(b[channel]))
}

/// Returns all colours added. Negative light is dark.
pub(super) fn brightness([red, green, blue, _]: Channels) -> f32 {
    red.max(0.0) + green.max(0.0) + blue.max(0.0)
}
