//! That the conversions of these tests have windows of all sizes, so that what compares their pixels looks at each.

use super::*;
use crate::resample::plan::view_texels::ViewTexels;
use crate::resample::plan::{fixed_weights, float_shape};

/// How often windows of each size occur, those of any other after the small ones: from left to right, reversed, and turned.
type Counts = [[usize; 7]; 3];

const OTHER: usize = 6;

/// `window` tells from its header of which size one of a run is, and how many numbers follow.
fn count<'a, W>(
    compiled: &'a Compiled<W>,
    numbers: impl Fn(&'a W) -> &'a [u32],
    window: impl Fn(u32, &Run) -> (usize, usize),
    counts: &mut Counts,
) {
    for band in &compiled.bands {
        for run in &band.runs {
            let ways = compiled.mirrors.ways(usize::from(run.view));
            let mut numbers = &numbers(&band.weights)[run.weights as usize..];
            for _ in run.lanes() {
                let (size, length) = window(numbers[0], run);
                numbers = &numbers[1 + length..];
                counts[0][size] += ways.forward;
                counts[1][size] += ways.count - ways.turned - ways.forward;
                counts[2][size] += ways.turned;
            }
        }
    }
}

#[test]
fn windows_of_floats_are_of_all_sizes() {
    let window = |header: u32, run: &Run| {
        let index = float_shape::Header(header).index() as usize;
        let large = float_shape::Shape { width: usize::from(run.width), height: usize::from(run.height) };
        let marks = run.rows_under().len() * float_shape::mark_words(large.width);
        let small = float_shape::Small::ALL.get(index);
        small.map_or((OTHER, marks + large.area()), |small| (index, small.shape.area()))
    };
    let mut counts = Counts::default();
    for (world, target, _) in conversions() {
        let Plan(plan) = resampler(&world, &target).plan().expect("a plan");
        count(&plan, |weights| &weights.numbers, window, &mut counts);
    }
    assert!(counts.as_flattened().iter().all(|count| *count > 0), "{counts:?}");
}

#[test]
fn windows_of_integers_are_of_all_sizes() {
    let window = |header: u32, run: &Run| {
        let index = fixed_weights::Header(header).shape() as usize;
        let (pairs, height) = (usize::from(run.width).div_ceil(2), usize::from(run.height));
        let marks = run.rows_under().len() * fixed_weights::mark_words(pairs);
        let small = fixed_weights::Shape::SMALL.get(index);
        small.map_or((OTHER, marks + pairs * height), |small| (index, small.pairs * small.height))
    };
    let mut counts = Counts::default();
    for (world, target, _) in conversions() {
        let FixedPlan(plan) = resampler(&world, &target).fixed_plan().expect("a plan");
        count(&plan, |weights| &weights.numbers, window, &mut counts);
    }
    assert!(counts.as_flattened().iter().all(|count| *count > 0), "{counts:?}");
}

#[test]
fn mirrors_are_gone_through_together_and_one_by_one() {
    let (mut eight, mut turned, mut four, mut two, mut one_by_one) = (0, 0, 0, 0, [0, 0]);
    for (world, target, _) in conversions() {
        let mirrors = Mirrors::of::<FloatWeights>(&resampler(&world, &target));
        let texels = vec![0f32; 4 * world.texel_count()];
        for view in ViewTexels::all(&mirrors, &texels) {
            match view {
                ViewTexels::Eight(_) => eight += 1,
                ViewTexels::Turned(_) => turned += 1,
                ViewTexels::Four(_) => four += 1,
                ViewTexels::Two(_) => two += 1,
                ViewTexels::OneByOne { forward, reversed } => {
                    one_by_one[0] += usize::from(forward.len() > 1);
                    one_by_one[1] += reversed.len();
                }
            }
        }
    }
    assert!(eight > 0 && turned > 0);
    assert!(four > 0 && two > 0 && one_by_one[0] > 0 && one_by_one[1] > 0, "{four} {two} {one_by_one:?}");
}
