//! Every filter against its own definition, on a mapping that is all but affine: averages of noise, and impulses.
//!
//! A definition is the weight of each texel under a footprint, up to a common factor, in closed form.

use cosmorama::filter::{Bilinear, Classic, CrossSection, Ewa, Filter, IntegrationOrder, Kernel, Point};
use glam::DVec2;

use super::narrow::{Pixel, SIDE, grey, narrow, noise_at};

/// Weight of a texel under a pixel.
type Weight = fn(Pixel, usize, usize) -> f64;

/// Every filter with its definition.
fn definitions() -> Vec<(String, Box<dyn Filter>, Weight)> {
    let gaussian = Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 });
    let mut all: Vec<(String, Box<dyn Filter>, Weight)> = vec![
        ("point".to_owned(), Box::new(Point), |pixel, i, j| squares(pixel.middle, 0, i, j)),
        ("bilinear".to_owned(), Box::new(Bilinear), |pixel, i, j| tents(pixel.middle, 0, i, j)),
        ("ewa".to_owned(), Box::new(Ewa { kernel: gaussian, anti_ringing: false }), round),
    ];
    let of_order = |order| Classic::RepeatedIntegration(IntegrationOrder::new(order).expect("an order"));
    for classic in Classic::ALL.iter().copied().chain([of_order(1), of_order(3)]) {
        all.push((format!("{classic:?}"), Box::new(classic), definition(classic)));
    }
    all
}

/// A filter of the table needs a line here.
fn definition(classic: Classic) -> Weight {
    match classic {
        Classic::NearestMipMap => |pixel, i, j| squares(pixel.middle, level(pixel).round() as u32, i, j),
        Classic::MipMap => |pixel, i, j| {
            let (finer, part) = (level(pixel).floor(), level(pixel).fract());
            let at = |level: f64| tents(pixel.middle, level as u32, i, j);
            at(finer) * (1.0 - part) + at(finer + 1.0) * part
        },
        Classic::SummedArea => |pixel, i, j| {
            let half = pixel.half_box();
            let part = |at: usize, middle: f64, half: f64| overlap(at as f64, middle - half, middle + half);
            part(i, pixel.middle.x, half.x) * part(j, pixel.middle.y, half.y)
        },
        Classic::RepeatedIntegration(order) => match order.get() {
            1 => |pixel, i, j| splines(pixel, 1, i, j),
            2 => |pixel, i, j| splines(pixel, 2, i, j),
            _ => |pixel, i, j| splines(pixel, 3, i, j),
        },
        Classic::Catmull => area,
        Classic::BlinnNewell => |pixel, i, j| {
            let at = pixel.on_screen(i, j);
            (1.0 - at.x.abs()).max(0.0) * (1.0 - at.y.abs()).max(0.0)
        },
        Classic::FeibushLevoyCook | Classic::EwaPaper | Classic::EwaInteger => round,
        Classic::Gangnet => samples,
        Classic::TwoPass => two_passes,
    }
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
    let light = grey(&world, value);
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

#[test]
fn integrals_have_orders_from_one_to_four() {
    for order in [0, 1, 4, 5, u32::MAX] {
        let expected = (1..=4).contains(&order).then_some(order);
        assert_eq!(IntegrationOrder::new(order).map(IntegrationOrder::get), expected);
    }
}
