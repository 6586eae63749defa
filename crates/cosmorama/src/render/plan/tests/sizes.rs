//! Tests that these conversions have windows of all sizes, so that tests that compare their pixels cover each.

use super::*;
use crate::render::apply::fixed::weights::bits;
use crate::render::apply::view_texels::ViewTexels;
use crate::render::plan::window_format::Kept;

/// Counts of windows by size, with all that are not small in the last place: from left to right, reversed, and
/// transposed.
type Counts = [[usize; 7]; 3];

const OTHER: usize = 6;

fn counts<F: Format>() -> Counts {
    let mut counts = Counts::default();
    for (world, target, _) in conversions() {
        let compiled =
            Compiled::<F>::new((&resampler(&world, &target), Sampling::default()), Level::new(), Watch::NONE);
        let groups = compiled.bands.iter().flat_map(|band| band.groups().map(|group| (&band.weights, group)));
        for (weights, group) in groups {
            let ways = compiled.mirrors.ways(usize::from(group[0].view));
            let mut last = 0;
            for (_, header, _) in weights.windows(group) {
                let shape = header.shape();
                assert!(shape >= last, "one shape comes after the other");
                last = shape;
                let size = OTHER.min(shape as usize);
                counts[0][size] += ways.forward;
                counts[1][size] += ways.count - ways.turned - ways.forward;
                counts[2][size] += ways.turned;
            }
        }
    }
    counts
}

#[test]
fn windows_are_of_all_sizes() {
    for counts in [counts::<FloatFormat>(), counts::<FixedFormat>()] {
        assert!(counts.as_flattened().iter().all(|count| *count > 0), "{counts:?}");
    }
}

/// Checks sums of weights; the last may lack one unit, since a weight of one does not fit in 16 bits.
#[test]
fn weights_in_integers_add_to_one() {
    for (world, target, _) in conversions() {
        let plan = fixed(&resampler(&world, &target));
        for (weights, group) in plan.bands.iter().flat_map(|band| band.groups().map(|group| (&band.weights, group))) {
            for (_, header, Kept { weights: pairs, .. }) in weights.windows(group) {
                let sum: i32 = pairs.iter().map(|pair| i32::from(*pair as i16) + i32::from((*pair >> 16) as i16)).sum();
                let missing = (1 << bits(header)) - sum;
                assert!(missing == 0 || missing == 1 && pairs.contains(&0x7fff), "{missing} is missing of {pairs:?}");
            }
        }
    }
}

/// Returns the number of texels in the largest window.
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
        let mirrors = Mirrors::of::<FloatFormat>(&resampler(&world, &target));
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
