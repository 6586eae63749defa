//! Primaries: the colours that red, green and blue light stand for, and the white that all three make.

pub(crate) mod colour_matrix;

/// Chromaticities of red, green, blue and white: x and y of CIE 1931.
///
/// ```
/// use cosmorama::raster::Primaries;
///
/// assert_eq!(Primaries::of_number(9), Some(Primaries::REC2020));
/// assert_eq!(Primaries::REC2020.name(), Some("Rec. 2020"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// Chromaticity of red.
    pub red: [f64; 2],
    /// Chromaticity of green.
    pub green: [f64; 2],
    /// Chromaticity of blue.
    pub blue: [f64; 2],
    /// Chromaticity of white, which is red, green and blue of 1 each.
    pub white: [f64; 2],
}

/// CIE standard illuminant D65, as in ITU-R BT.709.
const D65: [f64; 2] = [0.3127, 0.3290];
/// White of the Academy Color Encoding System (SMPTE ST 2065-1).
const ACES_WHITE: [f64; 2] = [0.32168, 0.33767];
/// CIE standard illuminant C, as in ITU-R BT.470.
const ILLUMINANT_C: [f64; 2] = [0.310, 0.316];
/// Red and blue of ITU-R BT.709, shared by others.
const REC709_RED: [f64; 2] = [0.64, 0.33];
const REC709_BLUE: [f64; 2] = [0.15, 0.06];

/// Largest difference of chromaticities that count as the same: files round them to five digits at best, and profiles
/// to fewer.
const SAME: f64 = 1e-4;

/// Least area of the triangle of red, green and blue: that of Rec. 709 is 0.11.
const LEAST_AREA: f64 = 1e-4;

impl Primaries {
    /// ITU-R BT.709, also those of sRGB.
    pub const REC709: Self = Self { red: REC709_RED, green: [0.30, 0.60], blue: REC709_BLUE, white: D65 };
    /// SMPTE EG 432-1, also those of Display P3.
    pub const P3_D65: Self = Self { red: [0.68, 0.32], green: [0.265, 0.69], blue: REC709_BLUE, white: D65 };
    /// SMPTE RP 431-2, cinema projection.
    pub const P3_DCI: Self = Self { white: [0.314, 0.351], ..Self::P3_D65 };
    /// ITU-R BT.2020, also those of BT.2100.
    pub const REC2020: Self = Self { red: [0.708, 0.292], green: [0.170, 0.797], blue: [0.131, 0.046], white: D65 };
    /// SMPTE ST 2065-1, ACES2065-1.
    pub const AP0: Self = Self { red: [0.7347, 0.2653], green: [0.0, 1.0], blue: [0.0001, -0.0770], white: ACES_WHITE };
    /// ACES primaries 1, those of ACEScg (Academy S-2014-004).
    pub const AP1: Self = Self { red: [0.713, 0.293], green: [0.165, 0.830], blue: [0.128, 0.044], white: ACES_WHITE };
    /// Adobe RGB (1998).
    pub const ADOBE_RGB: Self = Self { red: REC709_RED, green: [0.21, 0.71], blue: REC709_BLUE, white: D65 };
    /// ITU-R BT.470 system M, NTSC of 1953.
    pub const NTSC1953: Self = Self { red: [0.67, 0.33], green: [0.21, 0.71], blue: [0.14, 0.08], white: ILLUMINANT_C };
    /// ITU-R BT.601 of 625 lines (EBU Tech 3213-E).
    pub const REC601_625: Self = Self { red: REC709_RED, green: [0.29, 0.60], blue: REC709_BLUE, white: D65 };
    /// ITU-R BT.601 of 525 lines (SMPTE ST 170), also those of SMPTE ST 240.
    pub const REC601_525: Self = Self { red: [0.630, 0.340], green: [0.310, 0.595], blue: [0.155, 0.070], white: D65 };
    /// Generic film with illuminant C, number 8 of ITU-T H.273.
    pub const FILM: Self =
        Self { red: [0.681, 0.319], green: [0.243, 0.692], blue: [0.145, 0.049], white: ILLUMINANT_C };
    /// CIE 1931 XYZ itself with an equal-energy white (SMPTE ST 428-1).
    pub const XYZ: Self = Self { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: [1.0 / 3.0, 1.0 / 3.0] };
    /// Number 22 of ITU-T H.273.
    pub const EBU3213: Self = Self { red: [0.630, 0.340], green: [0.295, 0.605], blue: [0.155, 0.077], white: D65 };

    /// Every set of primaries with a name, as people say it.
    pub const NAMED: [(&str, Self); 13] = [
        ("Rec. 709", Self::REC709),
        ("P3-D65", Self::P3_D65),
        ("P3-DCI", Self::P3_DCI),
        ("Rec. 2020", Self::REC2020),
        ("ACES AP0", Self::AP0),
        ("ACES AP1", Self::AP1),
        ("Adobe RGB", Self::ADOBE_RGB),
        ("NTSC 1953", Self::NTSC1953),
        ("Rec. 601 (625 lines)", Self::REC601_625),
        ("Rec. 601 (525 lines)", Self::REC601_525),
        ("generic film", Self::FILM),
        ("CIE XYZ", Self::XYZ),
        ("EBU 3213", Self::EBU3213),
    ];

    /// Numbers of ITU-T H.273 (table 2). If a set has several numbers, the first is written.
    const NUMBERS: [(u8, Self); 11] = [
        (1, Self::REC709),
        (4, Self::NTSC1953),
        (5, Self::REC601_625),
        (6, Self::REC601_525),
        (7, Self::REC601_525),
        (8, Self::FILM),
        (9, Self::REC2020),
        (10, Self::XYZ),
        (11, Self::P3_DCI),
        (12, Self::P3_D65),
        (22, Self::EBU3213),
    ];

    /// Returns the primaries with these chromaticities, as a file gives them; named primaries if all four pairs agree
    /// with theirs. `None` if the pairs are not numbers, or span no triangle.
    pub fn of_pairs(red: [f64; 2], green: [f64; 2], blue: [f64; 2], white: [f64; 2]) -> Option<Self> {
        let given = Self { red, green, blue, white };
        let is_finite = given.pairs().iter().flatten().all(|number| number.is_finite() && number.abs() < 10.0);
        if !is_finite || white[1] <= 0.0 || given.area().abs() < LEAST_AREA || !given.makes_white() {
            return None;
        }
        let named = Self::NAMED.into_iter().map(|(_, named)| named);
        Some(named.into_iter().find(|named| named.is_same(&given)).unwrap_or(given))
    }

    /// Returns the primaries with this number in ITU-T H.273; `None` for 2, unspecified, and for reserved numbers.
    pub fn of_number(number: u8) -> Option<Self> {
        Self::NUMBERS.into_iter().find(|(known, _)| *known == number).map(|(_, primaries)| primaries)
    }

    /// Returns the number in ITU-T H.273, if there is one.
    pub fn number(&self) -> Option<u8> {
        Self::NUMBERS.into_iter().find(|(_, known)| known.is_same(self)).map(|(number, _)| number)
    }

    /// Returns the name, if there is one.
    pub fn name(&self) -> Option<&'static str> {
        Self::NAMED.into_iter().find(|(_, named)| named.is_same(self)).map(|(name, _)| name)
    }

    /// Returns whether two sets of primaries are equal, within the precision of files.
    pub fn is_same(&self, other: &Self) -> bool {
        let pairs = self.pairs().into_iter().flatten().zip(other.pairs().into_iter().flatten());
        pairs.into_iter().all(|(a, b)| (a - b).abs() <= SAME)
    }

    /// Returns red, green, blue and white.
    pub const fn pairs(&self) -> [[f64; 2]; 4] {
        [self.red, self.green, self.blue, self.white]
    }

    /// Returns twice the area of the triangle of red, green and blue.
    fn area(&self) -> f64 {
        let [red, green, blue, _] = self.pairs();
        (green[0] - red[0]) * (blue[1] - red[1]) - (blue[0] - red[0]) * (green[1] - red[1])
    }

    /// Returns whether white is a mixture of positive amounts of all three primaries.
    fn makes_white(&self) -> bool {
        let [red, green, blue, white] = self.pairs();
        let part = |a: [f64; 2], b: [f64; 2]| Self { red: white, green: a, blue: b, white }.area() / self.area() > 0.0;
        part(green, blue) && part(blue, red) && part(red, green)
    }
}

/// Writes the name, or the four pairs where there is none.
impl std::fmt::Display for Primaries {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if let Some(name) = self.name() {
            return f.write_str(name);
        }
        let [r, g, b, w] = self.pairs().map(|[x, y]| format!("{x:.4} {y:.4}"));
        write!(f, "red {r}, green {g}, blue {b}, white {w}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_and_name_comes_back() {
        for number in 0..=255 {
            let Some(primaries) = Primaries::of_number(number) else { continue };
            // SMPTE ST 240 has the primaries of 525 lines.
            assert_eq!(primaries.number(), Some(if number == 7 { 6 } else { number }));
        }
        for (name, primaries) in Primaries::NAMED {
            assert_eq!((primaries.name(), primaries.to_string()), (Some(name), name.to_owned()));
        }
        assert_eq!(Primaries::of_number(2), None);
        assert_eq!(Primaries::AP1.number(), None);
    }

    #[test]
    fn rounded_pairs_are_those_with_a_name() {
        let rounded = |pair: [f64; 2]| pair.map(|number| (f64::from(number as f32) * 1e5).round() / 1e5);
        for (name, Primaries { red, green, blue, white }) in Primaries::NAMED {
            let found = Primaries::of_pairs(rounded(red), rounded(green), rounded(blue), rounded(white));
            assert_eq!(found.and_then(|found| found.name()), Some(name));
        }
        let own = Primaries::of_pairs([0.6, 0.3], [0.3, 0.6], [0.1, 0.1], D65).unwrap();
        assert_eq!(own.to_string(), "red 0.6000 0.3000, green 0.3000 0.6000, blue 0.1000 0.1000, white 0.3127 0.3290");
    }

    #[test]
    fn what_spans_no_triangle_around_white_is_no_primaries() {
        let Primaries { red, green, blue, white } = Primaries::REC709;
        assert!(Primaries::of_pairs(red, green, red, white).is_none());
        assert!(Primaries::of_pairs([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]).is_none());
        assert!(Primaries::of_pairs(red, [f64::NAN, 0.6], blue, white).is_none());
        assert!(Primaries::of_pairs(red, green, blue, [0.7, 0.3]).is_none());
        assert!(Primaries::of_pairs(red, green, blue, [0.3, 0.0]).is_none());
    }
}
