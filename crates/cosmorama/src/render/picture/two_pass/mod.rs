//! Pictures by two passes of one dimension each, per view (Catmull & Smith 1980).
//!
//! Take the screen's columns as the lines that the second pass follows; rows are the same, turned by 90°. Each pixel of a
//! column has its place (u, v) in a view. Along the column, u is a function of v: the intermediate function. The first
//! pass averages the view's row v around u(v), with the pixel's width there, and the second pass averages those means along
//! the column. All pixels of the column share the means: this is what two passes save.
//!
//! - **Bottleneck.** Of the four ways (columns or rows of the screen, u or v first) each pixel goes the one that loses least
//!   (`filter/classic/two_pass.rs`). So a picture is made of pieces that went different ways, as Catmull & Smith turn a
//!   picture by 90° where it would collapse.
//! - **Fold-over.** Where v turns back, jumps, or another way begins, a branch ends and another begins: each has means of its
//!   own, so that nothing is folded onto anything (`branch.rs`).
//! - **Intermediate functions** are cubics, fitted by least squares to the pixels' places and slopes, as many as it takes
//!   (`curve.rs`; Fraser, Schowengerdt & Briggs 1985 fit theirs, too).
//! - **Across views.** Each view gives its sum and its share of the weight; shares add up where views meet.

mod branch;
mod curve;
mod knot;
mod line;
mod sweep;

use rayon::prelude::*;

use crate::camera::View;
use crate::filter::reference::look;
use crate::filter::{Kernel, TwoPass};
use crate::raster::{Image, Rgba};
use crate::render::progress::Watch;
use crate::world::World;
use line::Line;
use sweep::{Sum, Sweep};

/// Columns of the screen that are made at once. Pixels lie in rows, so that a column's are added one by one.
const COLUMNS: usize = 64;

/// Renders a picture, transparent outside the lens.
pub(in crate::render) fn render(
    (world, target): (&World, &View),
    kernel: &Kernel,
    light: &[Rgba],
    watch: Watch,
) -> Image<Rgba> {
    let sweep = Sweep { world, target, light, kernel: TwoPass::of(kernel) };
    let (width, height) = (target.width(), target.height());
    let mut sums = Image::filled(width, height, Sum::default());
    let parts = watch.parts(width + height);
    for first in (0..width).step_by(COLUMNS) {
        let columns = (first..width.min(first + COLUMNS)).into_par_iter();
        let made: Vec<_> = columns.filter_map(|i| Some((i, parts.part(|| sweep.line(Line::Column(i)))?))).collect();
        for (i, column) in made {
            sums.pixels_mut().iter_mut().skip(i).step_by(width).zip(column).for_each(|(sum, more)| *sum += more);
        }
    }
    let mut image = Image::filled(width, height, Rgba::TRANSPARENT);
    let rows = image.pixels_mut().par_chunks_mut(width.max(1)).zip(sums.pixels().par_chunks(width.max(1)));
    rows.enumerate().for_each(|(j, (row, sums))| {
        parts.part(|| sweep.finish(j, row, sums));
    });
    image
}

/// Returns the number of bytes that a picture needs beside itself.
pub(in crate::render) fn bytes(target: &View) -> usize {
    target.width().saturating_mul(target.height()).saturating_mul(size_of::<Sum>())
}

impl Sweep<'_> {
    /// Makes a row of the picture: adds what its own passes give to what columns gave.
    fn finish(&self, j: usize, row: &mut [Rgba], sums: &[Sum]) {
        let made = self.line(Line::Row(j));
        for (i, ((pixel, more), sum)) in row.iter_mut().zip(made).zip(sums).enumerate() {
            let Some(screen) = self.target.screen_pixel(i, j) else { continue };
            let mut sum = *sum;
            sum += more;
            let light = if sum.share > 0.0 {
                Rgba((sum.light / sum.share).as_vec4().to_array())
            } else {
                look(self.world, screen.footprint.direction, self.light).unwrap_or_default()
            };
            *pixel = light * screen.coverage as f32;
        }
    }
}
