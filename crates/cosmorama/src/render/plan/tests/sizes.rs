//! That the conversions of these tests have windows of all sizes, so that what compares their pixels looks at each.

use super::*;
use crate::render::apply::fixed::view_texels::ViewTexels;
use crate::render::apply::fixed::weights as fixed_weights;
use crate::render::apply::float::shape as float_shape;
use crate::render::plan::window_order::{Place, Told};

/// How often windows of each size occur, those of any other after the small ones: from left to right, reversed, and turned.
type Counts = [[usize; 7]; 3];

const OTHER: usize = 6;

/// `told` is what a header tells of a run's window.
fn count<'a, W: Weights>(
    compiled: &'a Compiled<W>,
    numbers: impl Fn(&'a W) -> &'a [u32],
    told: impl Fn(u32, &Run) -> Told,
    counts: &mut Counts,
) {
    let groups = compiled.bands.iter().flat_map(|band| band.groups().map(|group| (&band.weights, group)));
    for (weights, group) in groups {
        let ways = compiled.mirrors.ways(usize::from(group[0].view));
        let mut numbers = &numbers(weights)[group[0].weights as usize..];
        let mut last = 0;
        for _ in group.iter().flat_map(Run::lanes) {
            let Told { shape, length } = told(numbers[0], &group[Place::of(numbers[0]).run]);
            assert!(shape >= last, "one shape comes after the other");
            last = shape;
            numbers = &numbers[length..];
            let size = OTHER.min(shape as usize);
            counts[0][size] += ways.forward;
            counts[1][size] += ways.count - ways.turned - ways.forward;
            counts[2][size] += ways.turned;
        }
    }
}

#[test]
fn windows_of_floats_are_of_all_sizes() {
    let mut counts = Counts::default();
    for (world, target, _) in conversions() {
        let plan = float(&resampler(&world, &target));
        count(&plan, |weights| &weights.numbers, |header, run| float_shape::Header(header).told(run), &mut counts);
    }
    assert!(counts.as_flattened().iter().all(|count| *count > 0), "{counts:?}");
}

#[test]
fn windows_of_integers_are_of_all_sizes() {
    let mut counts = Counts::default();
    for (world, target, _) in conversions() {
        let plan = fixed(&resampler(&world, &target));
        count(&plan, |weights| &weights.numbers, |header, run| fixed_weights::Header(header).told(run), &mut counts);
    }
    assert!(counts.as_flattened().iter().all(|count| *count > 0), "{counts:?}");
}

/// Checks sums of weights; the last may lack one unit, since a weight of one does not fit in 16 bits.
#[test]
fn weights_in_integers_add_to_one() {
    for (world, target, _) in conversions() {
        let plan = fixed(&resampler(&world, &target));
        for (weights, group) in plan.bands.iter().flat_map(|band| band.groups().map(|group| (&band.weights, group))) {
            let mut numbers = &weights.numbers[group[0].weights as usize..];
            for _ in group.iter().flat_map(Run::lanes) {
                let header = fixed_weights::Header(numbers[0]);
                let run = &group[Place::of(numbers[0]).run];
                let Told { length, .. } = header.told(run);
                let shape = fixed_weights::Shape::SMALL.get(header.shape() as usize).copied();
                let shape = shape.unwrap_or_else(|| fixed_weights::Shape::of_run(run));
                let pairs = &numbers[length - shape.pairs * shape.height..length];
                let sum: i32 = pairs.iter().map(|pair| i32::from(*pair as i16) + i32::from((*pair >> 16) as i16)).sum();
                let missing = (1 << header.bits()) - sum;
                assert!(missing == 0 || missing == 1 && pairs.contains(&0x7fff), "{missing} is missing of {pairs:?}");
                numbers = &numbers[length..];
            }
        }
    }
}

/// Texels of the largest window.
fn largest<W>(compiled: &Compiled<W>) -> usize {
    let runs = compiled.bands.iter().flat_map(|band| &band.runs);
    runs.map(|run| usize::from(run.width) * usize::from(run.height)).max().unwrap_or(0)
}

#[test]
fn some_windows_are_nearly_as_large_as_any() {
    let (mut mirrored, mut single) = (0, 0);
    for (world, target, images) in conversions() {
        let resampler = resampler(&world, &target);
        let (floats, integers) = (float(&resampler), fixed(&resampler));
        let most = if images == 1 { &mut single } else { &mut mirrored };
        *most = largest(&floats).min(largest(&integers)).max(*most);
    }
    assert!(single > 800 && mirrored > 800, "{single} {mirrored}");
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
