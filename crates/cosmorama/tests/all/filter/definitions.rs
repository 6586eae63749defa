//! Every filter against its own definition, on a mapping that is all but affine: averages of noise, and impulses.
//!
//! A definition is the weight of each texel under a footprint, up to a common factor, in closed form.

use cosmorama::camera::{Footprint, PixelPoint, View};
use cosmorama::filter::{Bilinear, Classic, CrossSection, Ewa, Filter, Kernel, MipChoice, Point, PrepareError};
use cosmorama::raster::Rgba;
use cosmorama::world::{Light, World};
use glam::{DMat2, DVec2};
use testkit::{light_by_texel, perspective};

const SIDE: usize = 128;

/// A view so narrow that its mapping is affine to 10⁻⁵, as a world.
fn narrow() -> World {
    World::new([("narrow".to_owned(), perspective(SIDE, SIDE, 0.5, 0.0, 0.0, 0.0))]).expect("one view")
}

fn noise_at(i: usize, j: usize) -> f64 {
    ((i * 7919 + j * 104_729 + i * j * 31) % 997) as f64 / 996.0
}

/// A footprint in texels: its middle, and its derivatives by screen x and y.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    middle: DVec2,
    sides: DMat2,
}

impl Pixel {
    fn footprint(self, view: &View) -> Footprint {
        let here = view.footprint(PixelPoint::new(self.middle.x, self.middle.y)).expect("inside");
        let along = |texels: DVec2| here.jacobian.dx * texels.x + here.jacobian.dy * texels.y;
        Footprint::new(here.direction, along(self.sides.x_axis), along(self.sides.y_axis))
    }

    /// Offset of a texel's centre on the screen.
    fn on_screen(self, i: usize, j: usize) -> DVec2 {
        self.sides.inverse() * (DVec2::new(i as f64 + 0.5, j as f64 + 0.5) - self.middle)
    }

    /// Half the size of the box around the parallelogram.
    fn half_box(self) -> DVec2 {
        (self.sides.x_axis.abs() + self.sides.y_axis.abs()) / 2.0
    }

    /// Pixels all over the image, of two texels to eight, in any orientation; those of the second half are mirrored.
    fn all() -> impl Iterator<Item = Self> {
        (0..24).map(|k| {
            let middle = DVec2::new(42.0 + 1.93 * f64::from(k), 86.0 - 1.87 * f64::from(k));
            let angle = 0.7 * f64::from(k);
            let (long, short) = (3.0 + f64::from(k % 6), 2.2 + 0.4 * f64::from(k % 4));
            let turn = if k < 12 { 1.3 } else { -1.1 };
            let sides = DMat2::from_cols(DVec2::from_angle(angle) * long, DVec2::from_angle(angle + turn) * short);
            Self { middle, sides }
        })
    }
}

/// Weight of a texel under a pixel.
type Weight = fn(Pixel, usize, usize) -> f64;

/// Every filter with one definition.
fn definitions() -> Vec<(&'static str, Box<dyn Filter>, Weight)> {
    let gaussian = Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 });
    let classic = |classic: Classic| -> Box<dyn Filter> { Box::new(classic) };
    vec![
        ("point", Box::new(Point), |pixel, i, j| squares(pixel.middle, 0, i, j)),
        ("bilinear", Box::new(Bilinear), |pixel, i, j| tents(pixel.middle, 0, i, j)),
        ("mipmap, nearest", classic(Classic::MipMap(MipChoice::Nearest)), |pixel, i, j| {
            squares(pixel.middle, level(pixel).round() as u32, i, j)
        }),
        ("mipmap", classic(Classic::MipMap(MipChoice::Trilinear)), |pixel, i, j| {
            let (finer, part) = (level(pixel).floor(), level(pixel).fract());
            let at = |level: f64| tents(pixel.middle, level as u32, i, j);
            at(finer) * (1.0 - part) + at(finer + 1.0) * part
        }),
        ("summed-area", classic(Classic::SummedArea), |pixel, i, j| {
            let half = pixel.half_box();
            let part = |at: usize, middle: f64, half: f64| overlap(at as f64, middle - half, middle + half);
            part(i, pixel.middle.x, half.x) * part(j, pixel.middle.y, half.y)
        }),
        ("repeated-integration", classic(Classic::RepeatedIntegration { order: 2 }), |pixel, i, j| {
            splines(pixel, 2, i, j)
        }),
        ("of order 3", classic(Classic::RepeatedIntegration { order: 3 }), |pixel, i, j| splines(pixel, 3, i, j)),
        ("catmull", classic(Classic::Catmull), area),
        ("blinn-newell", classic(Classic::BlinnNewell), |pixel, i, j| {
            let at = pixel.on_screen(i, j);
            (1.0 - at.x.abs()).max(0.0) * (1.0 - at.y.abs()).max(0.0)
        }),
        ("feibush-levoy-cook", classic(Classic::FeibushLevoyCook), round),
        ("gangnet", classic(Classic::Gangnet), samples),
        ("ewa:paper", classic(Classic::EwaPaper), round),
        ("ewa:integer", classic(Classic::EwaInteger), round),
        ("two-pass", classic(Classic::TwoPass), two_passes),
        ("ewa", Box::new(Ewa { kernel: gaussian, anti_ringing: false }), round),
    ]
}

/// The paper's Gaussian.
fn gaussian(square: f64) -> f64 {
    if square < 1.0 { (-2.0 * square).exp() } else { 0.0 }
}

fn round(pixel: Pixel, i: usize, j: usize) -> f64 {
    gaussian(pixel.on_screen(i, j).length_squared())
}

/// Level of a mip map whose texels are as wide as the longer derivative.
fn level(pixel: Pixel) -> f64 {
    pixel.sides.x_axis.length().max(pixel.sides.y_axis.length()).log2()
}

/// One square of a level.
fn squares(middle: DVec2, level: u32, i: usize, j: usize) -> f64 {
    let square = |at: f64| at as usize >> level;
    f64::from(u8::from(i >> level == square(middle.x) && j >> level == square(middle.y)))
}

/// Four squares of a level, interpolated.
fn tents(middle: DVec2, level: u32, i: usize, j: usize) -> f64 {
    let side = f64::from(1 << level);
    let tent = |at: usize, middle: f64| (1.0 - ((at >> level) as f64 + 0.5 - middle / side).abs()).max(0.0);
    tent(i, middle.x) * tent(j, middle.y) / (side * side)
}

/// Length of a texel between two places.
fn overlap(texel: f64, from: f64, to: f64) -> f64 {
    (to.min(texel + 1.0) - from.max(texel)).max(0.0)
}

/// Area of a texel under the parallelogram, by lines on which the lengths are exact.
fn area(pixel: Pixel, i: usize, j: usize) -> f64 {
    const LINES: usize = 400;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
        .map(|(x, y)| pixel.middle + pixel.sides * DVec2::new(x, y));
    let length = |line: usize| {
        let y = j as f64 + (line as f64 + 0.5) / LINES as f64;
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for (a, b) in (0..4).map(|k| (corners[k], corners[(k + 1) % 4])) {
            if (a.y < y) != (b.y < y) {
                let x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
                (from, to) = (from.min(x), to.max(x));
            }
        }
        overlap(i as f64, from, to)
    };
    (0..LINES).map(length).sum::<f64>() / LINES as f64
}

/// Boxes of whole texels, applied so many times, interpolated between places and between widths.
fn splines(pixel: Pixel, order: usize, i: usize, j: usize) -> f64 {
    let half = pixel.half_box();
    spline(i, pixel.middle.x, 2.0 * half.x, order) * spline(j, pixel.middle.y, 2.0 * half.y, order)
}

fn spline(texel: usize, middle: f64, width: f64, order: usize) -> f64 {
    let of_width = |width: usize| {
        let mut weights = vec![1.0];
        for _ in 0..order {
            let mut wider = vec![0.0; weights.len() + width - 1];
            weights.iter().enumerate().for_each(|(at, w)| (at..at + width).for_each(|k| wider[k] += w / width as f64));
            weights = wider;
        }
        // The first texel of the boxes, so that their middle is the pixel's; between texels, both around.
        let first = middle - weights.len() as f64 / 2.0;
        let weight = |first: f64| weights.get((texel as f64 - first) as usize).filter(|_| texel as f64 >= first);
        let part = first - first.floor();
        weight(first.floor()).map_or(0.0, |w| w * (1.0 - part)) + weight(first.floor() + 1.0).map_or(0.0, |w| w * part)
    };
    let part = width - width.floor();
    of_width(width as usize) * (1.0 - part) + of_width(width as usize + 1) * part
}

/// Samples of the screen, as fine as texels along the longer axis, interpolated.
fn samples(pixel: Pixel, i: usize, j: usize) -> f64 {
    let square = pixel.sides.transpose() * pixel.sides;
    let (mean, half) = ((square.x_axis.x + square.y_axis.y) / 2.0, (square.x_axis.x - square.y_axis.y) / 2.0);
    let count = (mean + half.hypot(square.x_axis.y)).sqrt().ceil() as i32;
    let at = |k: i32| f64::from(k) / f64::from(count);
    let places = (-count..=count).flat_map(|b| (-count..=count).map(move |a| DVec2::new(at(a), at(b))));
    places.map(|at| gaussian(at.length_squared()) * tents(pixel.middle + pixel.sides * at, 0, i, j)).sum()
}

/// Rows of texels averaged around a line, and the line averaged: whichever of four ways has the widest bottleneck.
fn two_passes(pixel: Pixel, i: usize, j: usize) -> f64 {
    let entries = [pixel.sides.x_axis, pixel.sides.y_axis].map(|axis| [axis.x.abs(), axis.y.abs()]);
    let largest = entries.iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
    let axis = if entries[1].contains(&largest) { pixel.sides.y_axis } else { pixel.sides.x_axis };
    let swapped = axis.x.abs() == largest;
    let turned = |at: DVec2| if swapped { DVec2::new(at.y, at.x) } else { at };
    let (axis, middle) = (turned(axis), turned(pixel.middle));
    let at = turned(DVec2::new(i as f64 + 0.5, j as f64 + 0.5));
    let unit = pixel.sides.determinant() / axis.y;
    let line = middle.x + axis.x / axis.y * (at.y - middle.y);
    let first = |x: f64| gaussian(((x - line) / unit).powi(2));
    let row: f64 = (0..SIDE).map(|k| first(k as f64 + 0.5)).sum();
    if row > 0.0 { gaussian(((at.y - middle.y) / axis.y).powi(2)) * first(at.x) / row } else { 0.0 }
}

fn prepared<R>(
    filter: &dyn Filter,
    value: impl Fn(usize, usize) -> f64,
    with: impl FnOnce(&dyn Fn(Pixel) -> f64) -> R,
) -> R {
    let world = narrow();
    let texels = light_by_texel(&world, |_, i, j, _| {
        let value = value(i, j) as f32;
        Rgba::opaque(value, value, value)
    });
    let light = Light::new(&world, texels).expect("a texel for each");
    let prepared = filter.prepare(&world, &light).expect("light of the world");
    with(&|pixel| f64::from(prepared.average(&pixel.footprint(&world.sources()[0].view)).0[1]))
}

#[test]
fn averages_are_those_of_the_definitions() {
    for (name, filter, weight) in definitions() {
        prepared(&*filter, noise_at, |average| {
            for pixel in Pixel::all() {
                let (mut sum, mut whole) = (0.0, 0.0);
                for (i, j) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j))) {
                    let weight = weight(pixel, i, j);
                    sum += weight * noise_at(i, j);
                    whole += weight;
                }
                let (found, expected) = (average(pixel), sum / whole);
                assert!((found - expected).abs() < 1e-4, "{name}, {pixel:?}: {found} for {expected}");
            }
        });
    }
}

#[test]
fn an_impulse_shows_a_weight_and_a_constant_stays() {
    const IMPULSE: (usize, usize) = (64, 64);
    for (name, filter, weight) in definitions() {
        prepared(
            &*filter,
            |i, j| f64::from(u8::from((i, j) == IMPULSE)),
            |average| {
                for (k, pixel) in Pixel::all().enumerate() {
                    let aside = DVec2::from_angle(k as f64) * (0.013 + 0.17 * k as f64);
                    let pixel = Pixel { middle: DVec2::new(64.5, 64.5) + aside, ..pixel };
                    let texels = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j)));
                    let whole: f64 = texels.map(|(i, j)| weight(pixel, i, j)).sum();
                    let (found, expected) = (average(pixel), weight(pixel, IMPULSE.0, IMPULSE.1) / whole);
                    assert!((found - expected).abs() < 1e-4, "{name}, {pixel:?}: {found} for {expected}");
                }
            },
        );
        prepared(
            &*filter,
            |_, _| 0.7,
            |average| {
                for pixel in Pixel::all() {
                    assert!((average(pixel) - f64::from(0.7f32)).abs() < 2e-6, "{name}: {}", average(pixel));
                }
            },
        );
    }
}

/// Orders that there are not are refused, before anything is divided by them.
#[test]
fn integrals_have_orders_from_one_to_four() {
    let world = narrow();
    let light = Light::by_direction(&world, |_| Rgba::BLACK);
    for order in [0, 1, 4, 5, u32::MAX] {
        let integrals = Classic::RepeatedIntegration { order };
        let expected = if (1..=4).contains(&order) { None } else { Some(PrepareError::NoSuchOrder { found: order }) };
        assert_eq!(integrals.check(&world).err(), expected);
        assert_eq!(integrals.prepare(&world, &light).err(), expected);
    }
}
