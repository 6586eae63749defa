use std::ops::{Add, AddAssign, Mul};

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// A pixel of linear light, premultiplied by alpha: red, green, blue, alpha.
///
/// Primaries are those of Rec. 709 unless a file says otherwise. 1 is the white of an integer image; HDR goes beyond
/// it. A missing pixel is transparent: all four values are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Rgba(pub [f32; 4]);

/// Largest finite half float, which replaces infinite samples.
const LARGEST: f32 = 65504.0;

impl Rgba {
    /// A transparent pixel: no light, no coverage.
    pub const TRANSPARENT: Self = Self([0.0; 4]);
    /// Opaque black.
    pub const BLACK: Self = Self([0.0, 0.0, 0.0, 1.0]);

    /// Returns an opaque pixel.
    pub const fn opaque(red: f32, green: f32, blue: f32) -> Self {
        Self([red, green, blue, 1.0])
    }

    /// Returns alpha, the covered fraction of the pixel, 0 to 1.
    pub const fn alpha(self) -> f32 {
        self.0[3]
    }

    /// Removes non-finite samples, by one rule for all: a pixel with a NaN is missing (transparent), and ±∞ becomes
    /// ±65504, the largest half float.
    #[must_use]
    pub fn finite(self) -> Self {
        if self.0.iter().any(|c| c.is_nan()) {
            return Self::TRANSPARENT;
        }
        Self(self.0.map(|c| if c.is_infinite() { LARGEST.copysign(c) } else { c }))
    }

    /// Returns the colour with alpha divided out; black for a transparent pixel.
    pub fn unpremultiplied(self) -> [f32; 3] {
        let [red, green, blue, alpha] = self.0;
        if alpha <= 0.0 { [0.0; 3] } else { [red / alpha, green / alpha, blue / alpha] }
    }

    /// Returns this pixel composited over another (Porter & Duff's *over*).
    #[must_use]
    pub fn over(self, behind: Self) -> Self {
        self + behind * (1.0 - self.alpha())
    }
}

impl Add for Rgba {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        // All four at once.
        Self((Vec4::from_array(self.0) + Vec4::from_array(other.0)).to_array())
    }
}

impl AddAssign for Rgba {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul<f32> for Rgba {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self((Vec4::from_array(self.0) * factor).to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_missing_and_infinity_is_the_largest_half() {
        assert_eq!(Rgba([1.0, f32::NAN, 0.0, 1.0]).finite(), Rgba::TRANSPARENT);
        let clamped = Rgba([f32::INFINITY, f32::NEG_INFINITY, 3.0, 1.0]).finite();
        assert_eq!(clamped, Rgba([65504.0, -65504.0, 3.0, 1.0]));
    }
}
