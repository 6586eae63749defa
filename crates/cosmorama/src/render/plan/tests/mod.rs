mod at_once;
mod palettes;
mod runs;
mod sizes;
mod worlds;

use std::sync::Arc;

use fearless_simd::{Simd, dispatch};

use super::recorder::Maker;
use super::symmetry::{MirrorImage, Mirrors};
use super::window_format::{Place, Shape, SmallShapes};
use super::*;
use crate::camera::{FieldStop, View};
use crate::filter::taps::{Tap, TapList, average};
use crate::filter::{FilterKind, FilterSettings};
use crate::projection::ProjectionKind;
use crate::raster::{Channels, ColourChannel, Depth, EncodedImage, Encoder, RowLayout, Threads, ToneCurve, Transfer};
use crate::render::batch::window::Windows;
use crate::sphere::{CubeFace, Orientation};
use crate::world::{Blend, World, WorldView};
use worlds::*;

fn resampler<'a>(world: &'a World, target: &'a View) -> Resampler<'a> {
    Resampler { world, target, filter: FilterSettings::DEFAULT }
}

fn float(resampler: &Resampler) -> Compiled<FloatFormat> {
    Compiled::new((resampler, Sampling::default()), Level::new(), Watch::NONE)
}

fn fixed(resampler: &Resampler) -> Compiled<FixedFormat> {
    Compiled::new((resampler, Sampling::default()), Level::new(), Watch::NONE)
}

#[test]
fn mirrors_are_found_where_there_are_some() {
    for (world, target, images) in conversions() {
        let found = Mirrors::of::<FloatFormat>(&resampler(&world, &target));
        assert_eq!(found.images.len(), images, "{:?} of {:?}", target.projection, target.orientation);
        assert_eq!(found.columns * found.rows * images.min(4), target.width() * target.height());
    }
    // No symmetry that a missing face breaks: without the left face, then without the back face as well.
    let up = turned(0.0, 90.0, 0.0);
    let count = |world: &World, target: &View| Mirrors::of::<FloatFormat>(&resampler(world, target)).images.len();
    let mut faces: Vec<_> = CubeFace::ALL.into_iter().filter(|face| *face != CubeFace::Left).collect();
    assert_eq!(count(&cube(&faces, 64), &dome(64, up)), 2);
    faces.retain(|face| *face != CubeFace::Back);
    assert_eq!(count(&cube(&faces, 64), &dome(64, up)), 1);
    let off_centre = View { grid: dome(64, up).grid.window(64, 64, 0.25, 0.0), ..dome(64, up) };
    assert_eq!(count(&cube(&CubeFace::ALL, 64), &off_centre), 2);
    let (world, target) = (cube(&CubeFace::ALL, 64), dome(64, up));
    let filter = FilterSettings { kind: FilterKind::Point, ..FilterSettings::DEFAULT };
    let point = Resampler { filter, ..resampler(&world, &target) };
    assert_eq!(Mirrors::of::<FloatFormat>(&point).images.len(), 1);
}

#[test]
fn nothing_is_mirrored_that_is_not_alike() {
    let up = turned(0.0, 90.0, 0.0);
    let whole = |face: CubeFace| view(ProjectionKind::PERSPECTIVE, (64, 64), (1.0, 1.0), face.orientation());
    let alter = |change: &dyn Fn(CubeFace, &mut WorldView)| {
        let part = |face: CubeFace| {
            let mut part =
                WorldView { name: face.name().to_owned(), view: whole(face), blend: Blend::default(), mask: None };
            change(face, &mut part);
            part
        };
        let world = World::blended(CubeFace::ALL.map(part)).expect("six faces");
        Mirrors::of::<FloatFormat>(&resampler(&world, &dome(64, up))).images.len()
    };
    assert_eq!(alter(&|_, _| ()), 8);
    // One face of another size, one cut, one turned slightly, one with a field stop, one that overlaps others.
    let size = |face: CubeFace, part: &mut WorldView| {
        if face == CubeFace::Right {
            part.view = view(ProjectionKind::PERSPECTIVE, (66, 66), (1.0, 1.0), face.orientation());
        }
    };
    let cut = |face: CubeFace, part: &mut WorldView| {
        if face == CubeFace::Right {
            part.view.grid = part.view.grid.window(60, 64, 4.0, 0.0);
        }
    };
    let turn = |face: CubeFace, part: &mut WorldView| {
        if face == CubeFace::Right {
            part.view.orientation = turned(90.001, 0.0, 0.0);
        }
    };
    let stop = |face: CubeFace, part: &mut WorldView| {
        if face == CubeFace::Right {
            part.view.stop = FieldStop::circle(1.2);
        }
    };
    let wide = |face: CubeFace, part: &mut WorldView| {
        if face == CubeFace::Right {
            part.view = view(ProjectionKind::PERSPECTIVE, (64, 64), (1.1, 1.1), face.orientation());
        }
    };
    for change in [&size as &dyn Fn(CubeFace, &mut WorldView), &cut, &turn, &stop, &wide] {
        assert!(alter(change) <= 2, "left and right are no mirror images");
    }
}

#[test]
fn pictures_of_any_size_are_made() {
    let world = cube(&CubeFace::ALL, 40);
    for (width, height) in [(0, 0), (0, 5), (1, 1), (1, 7), (7, 1), (2, 2), (6, 34), (10, 3), (18, 66)] {
        let target = view(ProjectionKind::PERSPECTIVE, (width, height), (1.0, 1.0), Orientation::IDENTITY);
        let (light, resampler) = (light(&world), resampler(&world, &target));
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::opaque(1.0, 0.0, 1.0)).expect("sRGB has 8 bits");
        let (image, codes) = (resampler.render(&floats(&light)), resampler.render_fixed(&light, &codec));
        assert_eq!((image.pixels().len(), codes.pixels().len()), (width * height, width * height));
        assert!(image.pixels().iter().all(|pixel| pixel.alpha() > 0.999), "{width}x{height}");
        assert!(codes.pixels().iter().all(|codes| *codes != [255, 0, 255]), "{width}x{height}");
    }
}

#[test]
fn what_mirrors_show_is_what_would_be_computed() {
    for (world, target, _) in conversions() {
        let light = light(&world);
        let resampler = resampler(&world, &target);
        let layout = RowLayout::of(world.view_sizes(), FloatFormat::pitch);
        let alone = Mirrors::new([target.width(), target.height()], vec![MirrorImage::itself(&layout)]);
        let mut expected = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
        let texels = floats(&light);
        let (level, background) = (Level::new(), Rgba::TRANSPARENT);
        let arithmetic = FloatArithmetic { texels: &texels, background, pixels: Uncoded };
        let filter = BandFilter { level, mirrors: &alone, anti_ringing: true, arithmetic };
        each_band(
            (&resampler, Sampling::default()),
            &alone,
            (expected.pixels_mut(), background),
            (level, Watch::NONE),
            &filter,
        );
        let made = resampler.render(&texels);
        for (a, b) in made.pixels().iter().zip(expected.pixels()) {
            // Patches lie differently in the two pictures. A pixel of a patch may be a single pixel in the other, with
            // slightly different weights.
            assert!((0..4).all(|c| (a.0[c] - b.0[c]).abs() < 5e-3), "{a:?} is not {b:?}, {:?}", target.projection);
        }
    }
}

#[test]
fn samples_that_are_made_at_once_are_those_of_the_light() {
    for (world, target, _) in conversions() {
        let (texels, resampler) = (floats(&light(&world)), resampler(&world, &target));
        let plan = resampler.plan(Arithmetic::Float).expect("a plan");
        // The codes of a narrow curve are found by a search.
        let [curve, narrow] = [(0.0, 1.0), (0.4, 0.05)].map(|(least, range): (f32, f32)| {
            let table = |gamma: f32| (0..256).map(|at| least + range * (at as f32 / 255.0).powf(gamma)).collect();
            Transfer::Curve(Arc::new(ToneCurve::new([1.8, 2.2, 2.6].map(table)).expect("a curve")))
        });
        let blue = Rgba::opaque(0.2, 0.5, 0.9);
        for (background, transfer) in
            [(Rgba::BLACK, Transfer::Bt1886), (blue, Transfer::Srgb), (blue, curve), (Rgba::BLACK, narrow)]
        {
            let encoder = Encoder::new(Channels::Rgb, Depth::Eight, &transfer);
            assert!(plan.encodes(&encoder));
            let mut image = Image::filled(target.width(), target.height(), [9; 3]);
            plan.apply_encoded_into(&texels, background, &encoder, &mut image);
            let expected = encoder.encode(&plan.apply_over(&texels, background), Threads::All);
            assert!(EncodedImage::of_codes(image) == expected, "{:?}", target.projection);
        }
        assert!(!plan.encodes(&Encoder::new(Channels::Rgba, Depth::Eight, &Transfer::Srgb)));
        assert!(!plan.encodes(&Encoder::new(Channels::Rgb, Depth::Sixteen, &Transfer::Srgb)));
    }
}

#[test]
fn a_plan_makes_the_pixels_that_are_made_without() {
    for (world, target, _) in conversions() {
        let (light, resampler) = (light(&world), resampler(&world, &target));
        let (opaque, plan) = (floats(&light), resampler.plan(Arithmetic::Float).expect("a plan"));
        let veiled = opaque.iter().enumerate().map(|(at, texel)| *texel * (0.3 + (at % 8) as f32 * 0.1)).collect();
        for texels in [opaque, veiled] {
            let mut light_alone = resampler.render(&texels);
            assert!(plan.apply(&texels) == light_alone);
            let background = Rgba::opaque(0.25, 0.5, 0.0);
            light_alone.lay_over(background);
            assert!(plan.apply_over(&texels, background) == light_alone);
            let mut image = Image::filled(target.width(), target.height(), Rgba([7.0; 4]));
            plan.apply_into(&texels, background, &mut image);
            assert!(image == light_alone);
            assert!(resampler.render_over(&texels, background) == light_alone);
        }
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        let plan = resampler.plan(Arithmetic::Fixed).expect("a plan");
        let codes_alone = resampler.render_fixed(&light, &codec);
        assert!(plan.apply_fixed(&light, &codec) == codes_alone);
        // The image's old contents must not matter.
        let mut codes = Image::filled(target.width(), target.height(), [77; 3]);
        plan.apply_fixed_into(&light, &codec, &mut codes);
        assert!(codes == codes_alone);
    }
}

/// Format that keeps no window, so that each pixel is made singly.
#[derive(Clone, Debug, Default)]
struct NoWindows;

impl Format for NoWindows {
    const SMALL: SmallShapes = Shape::small([4, 5]);
    const TOGETHER: usize = 1;

    fn pitch(width: usize) -> usize {
        width
    }

    fn take<S: Simd>(&mut self, _: S, _: &Windows) -> bool {
        false
    }

    fn write(&self, _: &Windows, _: Place, _: &mut [u32; 2], _: &mut Vec<u32>) -> bool {
        false
    }
}

/// Maker of pixels from recorded bands alone.
struct ByBands<C>(C);

impl<F: Format, P: NoUninit, C: Fn(&Band<F>, &mut Canvas<P>) + Sync> Maker<F, P> for ByBands<C> {
    type Memory = ();

    fn fill(&self, band: &Band<F>, canvas: &mut Canvas<P>) {
        self.0(band, canvas);
    }

    fn put_at_once(&self, (): &mut (), _: ([usize; 2], u8), _: &Windows, _: &mut Canvas<P>) -> bool {
        false
    }
}

/// Returns the maker that calls a function with each band.
fn by_bands<F, P: NoUninit, C: Fn(&Band<F>, &mut Canvas<P>) + Sync>(function: C) -> ByBands<C> {
    ByBands(function)
}

/// Compares windows of all sizes, four texels at once, and single pixels in all mirror images at once, with lists of
/// texels one after the other.
#[test]
fn windows_of_floats_make_what_their_texels_make_one_by_one() {
    for (world, target, _) in conversions() {
        let texels = floats(&light(&world));
        for anti_ringing in [true, false] {
            let resampler = Resampler {
                filter: FilterSettings { anti_ringing, ..FilterSettings::DEFAULT },
                ..resampler(&world, &target)
            };
            let mut expected = Image::filled(target.width(), target.height(), Rgba::TRANSPARENT);
            let (mirrors, level) = (Mirrors::of::<NoWindows>(&resampler), Level::new());
            let background = Rgba::TRANSPARENT;
            let arithmetic = FloatArithmetic { texels: &texels, background, pixels: Uncoded };
            let mut one_by_one = expected.clone();
            let pixels = (one_by_one.pixels_mut(), background);
            let maker = by_bands(|band: &Band<NoWindows>, canvas| {
                dispatch!(level, simd => band.singles.fill(simd, &mirrors, (&arithmetic, anti_ringing), canvas));
            });
            each_band((&resampler, Sampling::default()), &mirrors, pixels, (level, Watch::NONE), &maker);
            let pixels = (expected.pixels_mut(), background);
            let maker = by_bands(|band: &Band<NoWindows>, canvas: &mut Canvas<Rgba>| {
                for single in band.singles.pixels() {
                    let taps = band.singles.taps(single, mirrors.images.len());
                    let at = [single.column as usize, usize::from(single.row)];
                    for index in 0..canvas.images_of(at).len() {
                        let texels_of = taps.texels.chunks(mirrors.images.len()).map(|texels| texels[index]);
                        let list = texels_of.zip(taps.weights).map(|(texel, &weight)| Tap { texel, weight });
                        let list = TapList { taps: &list.collect::<Vec<_>>(), under: taps.under, places: taps.places };
                        let colour = average(list, |texel| texels[texel as usize], anti_ringing);
                        let pixel = canvas.pixel(index, at);
                        *pixel = colour * single.coverage;
                    }
                }
            });
            each_band((&resampler, Sampling::default()), &mirrors, pixels, (level, Watch::NONE), &maker);
            assert!(one_by_one == expected, "to the last bit");
            for (made, expected) in resampler.render(&texels).pixels().iter().zip(expected.pixels()) {
                assert!((0..4).all(|c| (made.0[c] - expected.0[c]).abs() < 4e-6), "{made:?} is not {expected:?}");
            }
        }
    }
}

#[test]
fn all_levels_of_instructions_make_the_same_pixels() {
    for (world, target, _) in conversions() {
        let (light, resampler) = (light(&world), resampler(&world, &target));
        let texels = floats(&light);
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        let plan = fixed(&resampler);
        let made = |level| {
            let mut codes = Image::filled(target.width(), target.height(), codec.background());
            plan.fill(FixedArithmetic { light: &light, codec: &codec }, level, &mut codes);
            let arithmetic = FloatArithmetic { texels: &texels, background: Rgba::TRANSPARENT, pixels: Uncoded };
            (render((&resampler, Sampling::default()), arithmetic, level, Watch::NONE), codes)
        };
        let mut all = crate::filter::rim::simd_levels::levels().into_iter().map(made);
        let first = all.next().expect("at least the plain one");
        assert!(all.all(|made| made == first));
    }
}

#[test]
fn all_levels_of_instructions_make_the_same_plans() {
    for (world, target, _) in conversions() {
        let resampler = resampler(&world, &target);
        let made = |level| {
            let fixed = Compiled::<FixedFormat>::new((&resampler, Sampling::default()), level, Watch::NONE);
            let floats = Compiled::<FloatFormat>::new((&resampler, Sampling::default()), level, Watch::NONE);
            // Compared as text, which tells all numbers apart.
            (format!("{:?}", fixed.bands), format!("{:?}", floats.bands))
        };
        let mut all = crate::filter::rim::simd_levels::levels().into_iter().map(made);
        let first = all.next().expect("at least the plain one");
        assert!(all.all(|made| made == first), "{:?}", target.projection);
    }
}

/// Returns black and white in no order, for which sums in integers have the greatest errors.
fn black_and_white(world: &World) -> FixedLight {
    let mut light = light(world);
    let mut state = 1u64;
    for sample in light.texels_mut().flat_map(|texel| &mut texel[..3]) {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *sample = if state >> 63 == 0 { 0 } else { i16::MAX };
    }
    light
}

#[test]
fn integers_are_within_one_code_of_floats() {
    for (world, target, _) in conversions() {
        let (srgb, linear, steepest) = (Transfer::Srgb, Transfer::Linear, Transfer::Gamma(1.6));
        for (transfer, light, anti_ringing) in [
            (srgb.clone(), light(&world), true),
            (linear, light(&world), true),
            (srgb.clone(), light(&world), false),
            (srgb, black_and_white(&world), true),
            (steepest, black_and_white(&world), true),
        ] {
            let filter = FilterSettings { anti_ringing, ..FilterSettings::DEFAULT };
            let resampler = Resampler { filter, ..resampler(&world, &target) };
            let background = Rgba::opaque(0.25, 0.5, 0.0);
            let codec = FixedCodec::new(&transfer, background).expect("a codec");
            let made = resampler.render_fixed(&light, &codec);
            let exact = resampler.render(&floats(&light));
            let (mut equal, mut count) = (0, 0);
            for (a, b) in made.pixels().iter().zip(exact.pixels()) {
                let b = b.over(background);
                for c in 0..3 {
                    let code = transfer.encode(f64::from(b.0[c].clamp(0.0, 1.0)), ColourChannel::ALL[c]) * 255.0;
                    let error = (f64::from(a[c]) - code).abs();
                    // Half a code of this may be due to rounding alone.
                    assert!(error < 1.5, "{a:?} is not {b:?}: {error} in {:?}", target.projection);
                    equal += usize::from(f64::from(a[c]) == code.round());
                    count += 1;
                }
            }
            assert!(equal * 100 >= count * 97, "{equal} of {count} are equal, {:?} {transfer:?}", target.projection);
        }
    }
}

/// Checks that spreading from pixels to texels is the transpose of the plan, in all its mirror images.
#[test]
fn spreading_is_the_plan_the_other_way_round() {
    for (world, target, _) in conversions() {
        let filter = FilterSettings { anti_ringing: false, ..FilterSettings::DEFAULT };
        let plan = Resampler { world: &world, target: &target, filter }.plan(Arithmetic::Float).expect("a plan");
        let light = floats(&light(&world));
        // Divided by coverage, which is not part of the plan's weights.
        let average = |pixel: &Rgba| if pixel.alpha() > 0.0 { f64::from(pixel.0[0] / pixel.alpha()) } else { 0.0 };
        let made = plan.apply(&light);
        let values: Vec<f32> = (0..made.pixels().len()).map(|k| (k % 97) as f32 / 97.0).collect();
        let there: f64 =
            made.pixels().iter().zip(&values).map(|(pixel, value)| average(pixel) * f64::from(*value)).sum();
        let mut shares = vec![0.0; world.texel_count()];
        plan.spread(&values, &mut shares);
        // Equal to the last bit, however many threads divide the texels.
        for threads in [1, 3, 8, 11] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut again = vec![0.0; shares.len()];
            pool.install(|| plan.spread(&values, &mut again));
            assert!(again == shares, "{target:?} on {threads} threads");
        }
        let back: f64 = light.iter().zip(&shares).map(|(light, share)| f64::from(light.0[0]) * share).sum();
        assert!((there / back - 1.0).abs() < 1e-5, "{target:?}: {there}, not {back}");
    }
}

#[test]
#[should_panic(expected = "light of the world's views")]
fn light_of_as_many_texels_in_other_views_is_refused() {
    let (world, target) = (cube(&CubeFace::ALL, 32), dome(16, turned(0.0, 90.0, 0.0)));
    let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
    let light = FixedLight::black(world.view_sizes().map(|[width, height]| [2 * width, height / 2]));
    resampler(&world, &target).plan(Arithmetic::Fixed).expect("a plan").apply_fixed(&light, &codec);
}
