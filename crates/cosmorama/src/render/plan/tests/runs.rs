use super::*;
use crate::render::apply::output_region::PicturePart;

/// Checks that the ends of all runs of a plan are those of their windows. Returns how many runs lack a window at one
/// end.
fn cut_runs<W>(compiled: &Compiled<W>) -> usize {
    let mut cut = 0;
    for run in compiled.bands.iter().flat_map(|band| &band.runs) {
        let (corner, end) = (run.corner(), run.end());
        for (axis, size) in [run.width, run.height].into_iter().enumerate() {
            let offsets = || run.lanes().map(|lane| run.first(lane)[axis] as usize - corner[axis]);
            let expected = corner[axis] + offsets().max().expect("a lane") + usize::from(size);
            // Windows are kept from where their weights begin, which may be a texel later than in the lane beside.
            assert!((expected - 1..=expected).contains(&end[axis]), "{run:?} ends at {end:?}, not {expected}");
            assert_eq!(offsets().min(), Some(0), "{run:?}");
        }
        cut += usize::from(run.lanes().min() != Some(0) || run.lanes().max() != Some(SIDE - 1));
    }
    cut
}

#[test]
fn runs_end_where_their_windows_do() {
    let (mut floats, mut integers) = (0, 0);
    for (world, target, _) in conversions() {
        let resampler = resampler(&world, &target);
        floats += cut_runs(&float(&resampler));
        integers += cut_runs(&fixed(&resampler));
    }
    assert!(floats > 100 && integers > 100, "{floats} and {integers} runs lack windows at an end");
}

/// Checks that bands of pixels with many texels are spilled. Otherwise wider pictures would need more memory.
#[test]
fn bands_of_large_windows_are_made_before_they_are_all_there() {
    let (mut spilled, mut most) = (0, 0);
    for (world, target, _) in conversions() {
        let (resampler, level) = (resampler(&world, &target), Level::new());
        let (mirrors, table) = (Mirrors::of::<FloatFormat>(&resampler), KernelTable::new(&resampler.filter.kernel));
        let mut band = Band::<FloatFormat>::default();
        let spill = |band: &mut Band<FloatFormat>| {
            spilled += usize::from(band.weights.len() > 1 << 16);
            most = most.max(band.weights.len());
            band.clear();
        };
        record((&resampler, Sampling::default()), &mirrors, &table, 0..BAND.min(mirrors.rows), level, &mut band, spill);
        most = most.max(band.weights.len());
    }
    // The limit and one more patch, whose windows have a thousand texels each and some marks.
    assert!(spilled > 0 && most < (1 << 16) + (1 << 17), "{spilled} times, {most} numbers");
}

/// Checks that each pixel of a picture, in any mirror image, lies where its patch is said to be shown.
#[test]
fn patches_are_shown_where_their_pixels_are() {
    for (world, target, _) in conversions() {
        let mirrors = Mirrors::of::<FixedFormat>(&resampler(&world, &target));
        let size = [target.width(), target.height()];
        let mut picture: Vec<usize> = (0..size[0] * size[1]).collect();
        let mut times_made = vec![0; picture.len()];
        for (band, mut part) in PicturePart::all(&mut picture, size[0], BAND, &mirrors).into_iter().enumerate() {
            for row in 0..part.rows() {
                let top = (band * BAND + row) / SIDE * SIDE;
                for column in mirrors.first_column(top)..mirrors.columns {
                    let images = mirrors.images_of([column, band * BAND + row]);
                    for (index, image) in images.iter().enumerate() {
                        let shown = image.shown([column / SIDE * SIDE, top], size);
                        let at = part.beside(index, [column, row], 1)[0];
                        let (x, y) = (at % size[0], at / size[0]);
                        let is_shown = (shown.left..shown.right).contains(&x) && (shown.top..shown.bottom).contains(&y);
                        assert!(is_shown, "{column} {row} of {band} in {index} is {x} {y}, not in {shown:?}");
                        times_made[at] += 1;
                    }
                }
            }
        }
        assert!(times_made.iter().all(|times| *times == 1), "{:?} {size:?}", target.projection);
    }
}

#[test]
fn a_pixel_without_texels_has_none_in_any_mirror() {
    for (world, target, _) in conversions() {
        let mirrors = Mirrors::of::<FixedFormat>(&resampler(&world, &target));
        let mut singles = tap_lists::Singles::default();
        singles.push((&world, &mirrors), [0, 0], 1.0, &Taps::default(), &mut Vec::new());
        assert!(singles.taps(&singles.pixels()[0], mirrors.images.len()).texels.is_empty());
    }
}
