//! Detection of images with two pictures: two circles, or one picture for each eye.

use cosmorama::camera::{FisheyeCamera, LensCircle, Mirror, PixelRect};
use cosmorama::circle;
use cosmorama::circle::{Circle, Found};
use cosmorama::compare::likeness;
use cosmorama::layout::{Arrangement, DualFisheye, DualLens, LensSide};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::Orientation;
use cosmorama_spec::{Dual, Shape, Spec};

use crate::detect::disc::lens_circle;
use crate::detect::pixels::{fills, is_round};

/// Similarity above which two pictures show the same.
const ALIKE: f64 = 0.85;

/// A circle in each half of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circles {
    /// Arrangement of the halves.
    pub(crate) arrangement: Arrangement,
    /// Circles in pixels of the whole image, the first half's first; `None` if they fill their halves.
    pub(crate) circles: Option<[Circle; 2]>,
    /// Whether both show the same: two eyes, not two sides.
    pub(crate) are_alike: bool,
}

/// Halves that show the same.
pub(crate) struct Twins;

impl Circles {
    /// Looks for a circle in each of two squares.
    pub(crate) fn find(codes: &Image<Rgba>) -> Option<Self> {
        let (width, height) = (codes.width(), codes.height());
        let arrangement = match (width == 2 * height, height == 2 * width) {
            (true, _) => Arrangement::SideBySide,
            (_, true) => Arrangement::TopBottom,
            _ => return None,
        };
        let (rects, halves) = halves(codes, arrangement)?;
        let found = [circle(&halves[0])?, circle(&halves[1])?];
        let circles = match found {
            [InSquare::Filling, InSquare::Filling] => None,
            [InSquare::At(a), InSquare::At(b)] => Some([placed(a, rects[0]), placed(b, rects[1])]),
            _ => return None,
        };
        let side = halves[0].width();
        let inside = |i: usize, j: usize| {
            let (x, y) = (2 * i as i64 + 1 - side as i64, 2 * j as i64 + 1 - side as i64);
            10 * (x * x + y * y) < 6 * (side * side) as i64
        };
        let are_alike = likeness(&halves[0], &halves[1], inside).is_some_and(|likeness| likeness > ALIKE);
        Some(Self { arrangement, circles, are_alike })
    }

    /// Returns the SPEC of two cameras back to back, with a guessed field of view.
    pub(crate) fn dual_spec(&self) -> Spec {
        let [front, back] = match self.circles {
            Some(circles) => circles.map(|circle| lens_circle(&Found::Measured(circle))),
            None => [LensCircle::FITTED; 2],
        };
        let whole = FisheyeCamera { field_of_view: DualFisheye::FIELD_OF_VIEW, ..FisheyeCamera::default() };
        let lens = |circle| DualLens { frame: FisheyeCamera { circle, ..whole }, turned: Orientation::IDENTITY };
        let (front, back, first) = (lens(front), lens(back), LensSide::Front);
        let picture = DualFisheye { arrangement: self.arrangement, first, front, back, feather: None };
        let dual = Dual { picture, orientation: Orientation::IDENTITY, mirror: Mirror::default() };
        Shape::Dual(Box::new(dual)).into()
    }
}

impl Twins {
    /// Finds halves that show the same: side by side in a wide image, else one above the other.
    pub(crate) fn find(codes: &Image<Rgba>) -> Option<Arrangement> {
        let both = [Arrangement::SideBySide, Arrangement::TopBottom];
        both.into_iter().find(|arrangement| {
            let same = |(_, [a, b]): ([PixelRect; 2], [Image<Rgba>; 2])| likeness(&a, &b, |_, _| true);
            // Halves of horizontal bands, as in a flag, are alike, too, but have no content along rows that could be
            // compared.
            halves(codes, *arrangement).and_then(same).is_some_and(|likeness| likeness > ALIKE)
        })
    }
}

/// Place of a circle in a square.
enum InSquare {
    Filling,
    At(Circle),
}

fn circle(codes: &Image<Rgba>) -> Option<InSquare> {
    match circle::find(codes) {
        Some(Found::Measured(found)) if !fills(&found, codes) => Some(InSquare::At(found)),
        _ => is_round(codes).then_some(InSquare::Filling),
    }
}

fn placed(circle: Circle, rect: PixelRect) -> Circle {
    let (x, y) = circle.centre;
    Circle { centre: (x + rect.left as f64, y + rect.top as f64), ..circle }
}

fn halves(codes: &Image<Rgba>, arrangement: Arrangement) -> Option<([PixelRect; 2], [Image<Rgba>; 2])> {
    let rects = arrangement.halves(codes.width(), codes.height()).ok()?;
    let half =
        |rect: PixelRect| Image::from_fn(rect.width(), rect.height(), |i, j| *codes.get(rect.left + i, rect.top + j));
    Some((rects, rects.map(half)))
}
