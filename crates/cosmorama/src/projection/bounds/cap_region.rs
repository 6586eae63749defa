use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;

use crate::projection::{PlanePoint, PlaneRect};

/// A part of the plane that holds the image of a spherical cap, and little else. Around a rim or across a seam, a
/// single rectangle might be most of the picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// Rectangles, which may overlap: a cap across a seam lies in several places.
    Rects(Vec<PlaneRect>),
    /// A ring around the origin.
    Ring(Ring),
}

impl Outline {
    /// Appends the intervals of x, in any order, in which the line at height `y` lies inside.
    pub fn cut(&self, y: f64, spans: &mut Vec<[f64; 2]>) {
        match self {
            Self::Rects(rects) => {
                let at = rects.iter().filter(|rect| (rect.min.y..=rect.max.y).contains(&y));
                spans.extend(at.map(|rect| [rect.min.x, rect.max.x]));
            }
            Self::Ring(ring) => ring.cut(y, spans),
        }
    }

    /// Returns the area. Rectangles are limited to `rect`, and their overlap is counted more than once.
    pub fn area_within(&self, rect: PlaneRect) -> f64 {
        match self {
            Self::Rects(rects) => {
                let side = |min: f64, max: f64| (max - min).max(0.0);
                let shared = |other: &PlaneRect| {
                    side(rect.min.x.max(other.min.x), rect.max.x.min(other.max.x))
                        * side(rect.min.y.max(other.min.y), rect.max.y.min(other.max.y))
                };
                rects.iter().map(shared).sum()
            }
            Self::Ring(Ring { inner, outer, sector }) => {
                let half_width = sector.map_or(PI, |sector| sector.half_width);
                half_width * (outer * outer - inner.max(0.0).powi(2))
            }
        }
    }

    /// Returns the smallest rectangle that holds the region.
    pub fn bounds(&self) -> PlaneRect {
        match self {
            Self::Rects(rects) => {
                let corners = rects.iter().flat_map(|rect| [rect.min, rect.max]);
                corners.fold(PlaneRect::NOTHING, PlaneRect::with)
            }
            Self::Ring(ring) => ring.bounds(),
        }
    }
}

/// The region between two circles around the origin: a full ring or a sector of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radius of the smaller circle.
    pub inner: f64,
    /// Radius of the larger circle, finite.
    pub outer: f64,
    /// Azimuths of the sector; `None` for a full ring.
    pub sector: Option<Sector>,
}

/// A range of azimuths around a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sector {
    azimuth: f64,
    half_width: f64,
    /// Normals of its two sides, pointing inwards.
    inward: [DVec2; 2],
}

impl Ring {
    fn cut(&self, y: f64, spans: &mut Vec<[f64; 2]>) {
        let half = |radius: f64| radius * radius - y * y;
        let (outer, inner) = (half(self.outer), half(self.inner));
        let [low, high] = self.sector.map_or([f64::NEG_INFINITY, f64::INFINITY], |sector| sector.cut(y));
        if outer < 0.0 {
            return;
        }
        let outer = outer.sqrt();
        let whole = [[-outer, outer]; 1];
        let halves = |inner: f64| [[-outer, -inner], [inner, outer]];
        let mut add = |parts: &[[f64; 2]]| {
            let within = parts.iter().map(|[left, right]| [left.max(low), right.min(high)]);
            spans.extend(within.filter(|[left, right]| left <= right));
        };
        if inner <= 0.0 { add(&whole) } else { add(&halves(inner.sqrt())) }
    }

    fn bounds(&self) -> PlaneRect {
        let Self { inner, outer, sector } = *self;
        let Some(Sector { azimuth, half_width, .. }) = sector else {
            return PlaneRect { min: PlanePoint::new(-outer, -outer), max: PlanePoint::new(outer, outer) };
        };
        let (min_cos, max_cos) = cosine_range(azimuth, half_width);
        let (min_sin, max_sin) = cosine_range(azimuth - FRAC_PI_2, half_width);
        let low = |c: f64| if c < 0.0 { c * outer } else { c * inner };
        let high = |c: f64| if c > 0.0 { c * outer } else { c * inner };
        PlaneRect {
            min: PlanePoint::new(low(min_cos), low(min_sin)),
            max: PlanePoint::new(high(max_cos), high(max_sin)),
        }
    }
}

impl Sector {
    /// Returns the azimuths within `half_width` ≤ π/2 of `azimuth`, in radians.
    pub fn new(azimuth: f64, half_width: f64) -> Self {
        let (right, left) = (DVec2::from_angle(azimuth - half_width), DVec2::from_angle(azimuth + half_width));
        Self { azimuth, half_width, inward: [right.perp(), -left.perp()] }
    }

    /// Returns the least and greatest x at height `y`, limited by the sector's two sides.
    fn cut(&self, y: f64) -> [f64; 2] {
        let mut span = [f64::NEG_INFINITY, f64::INFINITY];
        for inward in self.inward {
            // inward·(x, y) ≥ 0.
            let x = -inward.y * y / inward.x;
            if inward.x > 0.0 {
                span[0] = span[0].max(x);
            } else if inward.x < 0.0 {
                span[1] = span[1].min(x);
            } else if inward.y * y < 0.0 {
                return [f64::INFINITY, f64::NEG_INFINITY];
            }
        }
        span
    }
}

/// Returns the least and greatest cosine of the angles within `half_width` ≤ π/2 of `centre`.
fn cosine_range(centre: f64, half_width: f64) -> (f64, f64) {
    use std::f64::consts::{PI, TAU};
    let (a, b) = ((centre - half_width).cos(), (centre + half_width).cos());
    let reaches = |angle: f64| (centre - angle + PI).rem_euclid(TAU) - PI;
    let min = if reaches(PI).abs() <= half_width { -1.0 } else { a.min(b) };
    let max = if reaches(0.0).abs() <= half_width { 1.0 } else { a.max(b) };
    (min, max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_cut(outline: &Outline, x: f64, y: f64) -> bool {
        let mut spans = Vec::new();
        outline.cut(y, &mut spans);
        spans.iter().any(|[left, right]| (left..=right).contains(&&x))
    }

    #[test]
    fn rings_are_cut_where_they_are() {
        let sectors = (0..40).map(|k| Sector::new(0.17 * f64::from(k), 0.04 * f64::from(k % 39)));
        for sector in sectors.map(Some).chain([None]) {
            let outline = Outline::Ring(Ring { inner: 0.4, outer: 0.9, sector });
            let bounds = outline.bounds();
            for (i, j) in (0..50).flat_map(|j| (0..50).map(move |i| (i, j))) {
                let point = DVec2::new(f64::from(i) / 25.0 - 0.99, f64::from(j) / 25.0 - 0.99);
                let is_in_sector = sector
                    .is_none_or(|sector| point.angle_to(DVec2::from_angle(sector.azimuth)).abs() <= sector.half_width);
                let is_inside = (0.4..=0.9).contains(&point.length()) && is_in_sector;
                assert_eq!(is_cut(&outline, point.x, point.y), is_inside, "{point} in {outline:?}");
                let is_in_bounds = (bounds.min.x..=bounds.max.x).contains(&point.x)
                    && (bounds.min.y..=bounds.max.y).contains(&point.y);
                assert!(is_in_bounds || !is_inside, "{point} in {bounds:?}");
            }
        }
    }
}
