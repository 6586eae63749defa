use glam::{DMat3, DVec3};

use super::Primaries;
use crate::raster::Rgba;

/// Conversion of light from one set of primaries to another: a matrix of three rows.
///
/// ```
/// use cosmorama::raster::{ColourMatrix, Primaries};
///
/// let to_acescg = ColourMatrix::between(&Primaries::REC709, &Primaries::AP1);
/// // White stays white.
/// assert!(to_acescg.apply([1.0; 3]).iter().all(|light| (light - 1.0).abs() < 1e-12));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourMatrix(DMat3);

/// Cone responses of Bradford's adaptation (Lam 1985), by column, as in Lindbloom, "Chromatic Adaptation".
const BRADFORD: DMat3 = DMat3::from_cols_array(&[
    0.8951, -0.7502, 0.0389, // X
    0.2664, 1.7135, -0.0685, // Y
    -0.1614, 0.0367, 1.0296, // Z
]);

/// Light below which a pixel lies outside of the primaries' triangle, as a part of its brightest sample.
const OUTSIDE: f32 = -1e-4;
/// Least value of the brightest sample for a pixel to count; darker pixels are black to the eye.
const LEAST: f32 = 1e-3;

impl ColourMatrix {
    /// Changes nothing.
    pub const IDENTITY: Self = Self(DMat3::IDENTITY);

    /// Creates a matrix of three rows.
    pub fn from_rows(rows: [[f64; 3]; 3]) -> Self {
        Self(DMat3::from_cols_array_2d(&rows).transpose())
    }

    /// Returns the conversion to CIE XYZ, in which white has Y = 1 (SMPTE RP 177, section 3.3).
    pub fn to_xyz(primaries: &Primaries) -> Self {
        let Primaries { red, green, blue, white } = primaries;
        // Vectors to the primaries on the plane x + y + z = 1, which exist for y = 0, too.
        let columns = DMat3::from_cols(direction(*red), direction(*green), direction(*blue));
        let parts = columns.inverse() * xyz(*white);
        Self(columns * DMat3::from_diagonal(parts))
    }

    /// Returns Bradford's adaptation of XYZ from one white point to another.
    pub fn adaptation(from: [f64; 2], to: [f64; 2]) -> Self {
        if from == to {
            return Self::IDENTITY;
        }
        let gains = (BRADFORD * xyz(to)) / (BRADFORD * xyz(from));
        Self(BRADFORD.inverse() * DMat3::from_diagonal(gains) * BRADFORD)
    }

    /// Returns the conversion from one set of primaries to another, adapted to the other white.
    pub fn between(from: &Primaries, to: &Primaries) -> Self {
        if from.is_same(to) {
            return Self::IDENTITY;
        }
        Self::to_xyz(from).then(&Self::adaptation(from.white, to.white)).then(&Self::to_xyz(to).inverse())
    }

    /// Returns this conversion followed by another.
    #[must_use]
    pub fn then(&self, other: &Self) -> Self {
        Self(other.0 * self.0)
    }

    /// Returns this conversion with all light multiplied by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self(self.0 * factor)
    }

    /// Returns the conversion back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }

    /// Returns the three rows.
    pub fn rows(&self) -> [[f64; 3]; 3] {
        self.0.transpose().to_cols_array_2d()
    }

    /// Returns whether nothing is changed.
    pub fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    /// Converts one colour.
    pub fn apply(&self, colour: [f64; 3]) -> [f64; 3] {
        (self.0 * DVec3::from_array(colour)).to_array()
    }

    /// Converts light in place. Returns the number of pixels that lie outside of the primaries' triangle, where some
    /// light is negative.
    pub fn convert(&self, light: &mut [Rgba]) -> usize {
        let column = |index: usize| self.0.col(index).as_vec3().extend(0.0);
        let (red, green, blue) = (column(0), column(1), column(2));
        let mut outside = 0;
        for pixel in light {
            let [r, g, b, alpha] = pixel.0;
            let colour = red * r + green * g + blue * b;
            outside += usize::from(colour.min_element() < OUTSIDE * colour.max_element().max(LEAST));
            *pixel = Rgba([colour.x, colour.y, colour.z, alpha]);
        }
        outside
    }
}

/// Returns the point of a chromaticity on the plane X + Y + Z = 1.
fn direction([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x, y, 1.0 - x - y)
}

/// Returns XYZ of a white with Y = 1.
fn xyz(white: [f64; 2]) -> DVec3 {
    direction(white) / white[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_rows(matrix: ColourMatrix, expected: [[f64; 3]; 3]) {
        for (row, expected) in matrix.rows().into_iter().zip(expected) {
            for (found, expected) in row.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
            }
        }
    }

    /// Matrices of colour-science 0.4.7 (PyPI): `normalised_primary_matrix`.
    #[test]
    fn matrices_to_xyz_are_those_of_colour_science() {
        for (primaries, expected) in [
            (
                Primaries::REC709,
                [
                    [0.41239079926595934, 0.35758433938387796, 0.1804807884018343],
                    [0.2126390058715103, 0.7151686787677559, 0.07219231536073371],
                    [0.019330818715591825, 0.11919477979462595, 0.9505321522496606],
                ],
            ),
            (
                Primaries::P3_D65,
                [
                    [0.486570948648216, 0.2656676931690931, 0.1982172852343625],
                    [0.2289745640697487, 0.6917385218365064, 0.079286914093745],
                    [-3.9720755169334855e-17, 0.04511338185890264, 1.0439443689009757],
                ],
            ),
            (
                Primaries::P3_DCI,
                [
                    [0.4451698155645524, 0.27713440920677773, 0.17228266981556453],
                    [0.20949167791273052, 0.7215952541610438, 0.06891306792622581],
                    [-3.634101316969856e-17, 0.04706056005398116, 0.9073553943619733],
                ],
            ),
            (
                Primaries::REC2020,
                [
                    [0.6369580483012912, 0.1446169035862084, 0.16888097516417208],
                    [0.262700212011267, 0.6779980715188711, 0.05930171646986195],
                    [4.994106574466074e-17, 0.028072693049087445, 1.0609850577107909],
                ],
            ),
            (
                Primaries::AP0,
                [
                    [0.9525523959381859, 0.0, 9.367863166046853e-05],
                    [0.3439664497650751, 0.7281660966134857, -0.07213254637856076],
                    [0.0, 0.0, 1.0088251843515854],
                ],
            ),
            (
                Primaries::AP1,
                [
                    [0.6624541811085055, 0.13400420645643313, 0.15618768700490773],
                    [0.2722287167809146, 0.6740817658111483, 0.05368951740793703],
                    [-0.005574649490394109, 0.004060733528982825, 1.010339100312997],
                ],
            ),
            (
                Primaries::ADOBE_RGB,
                [
                    [0.5766690429101304, 0.1855582379065463, 0.1882286462349947],
                    [0.29734497525053605, 0.6273635662554661, 0.07529145849399788],
                    [0.02703136138641234, 0.07068885253582723, 0.9913375368376387],
                ],
            ),
        ] {
            assert_rows(ColourMatrix::to_xyz(&primaries), expected);
        }
    }

    /// Matrices of colour-science 0.4.7 (PyPI): normalised primary matrices with `matrix_chromatic_adaptation_VonKries`
    /// and its Bradford transform between them.
    #[test]
    fn matrices_between_primaries_are_those_of_colour_science() {
        for (from, to, expected) in [
            (
                Primaries::REC709,
                Primaries::AP1,
                [
                    [0.6130974024011875, 0.339523146184106, 0.047379451414706675],
                    [0.07019372246958168, 0.9163538790573437, 0.013452398473074108],
                    [0.020615592882226922, 0.10956977293813543, 0.8698146341796374],
                ],
            ),
            (
                Primaries::REC2020,
                Primaries::P3_D65,
                [
                    [1.343578252584333, -0.28217967052613585, -0.061398582058196316],
                    [-0.0652974527891196, 1.0757879158485741, -0.01049046305945494],
                    [0.002821787261701058, -0.019598494524494185, 1.0167767072627931],
                ],
            ),
            (
                Primaries::P3_DCI,
                Primaries::REC709,
                [
                    [1.1575164061997585, -0.15496237807385796, -0.0025540281259012337],
                    [-0.041500071530685904, 1.0455679230796995, -0.004067851549013207],
                    [-0.018050038956253976, -0.07857827265302898, 1.096628311609283],
                ],
            ),
            (
                Primaries::AP0,
                Primaries::ADOBE_RGB,
                [
                    [1.7245603168118084, -0.41999359416150367, -0.30456672265030377],
                    [-0.2764799142299223, 1.3727190876682556, -0.09623917343833388],
                    [-0.026125525825664898, -0.09017478065519095, 1.1163003064808559],
                ],
            ),
        ] {
            assert_rows(ColourMatrix::between(&from, &to), expected);
        }
        let to_d50 = ColourMatrix::adaptation(Primaries::REC709.white, [0.3457, 0.3585]);
        assert_rows(
            to_d50,
            [
                [1.0479297925449969, 0.022946870601609666, -0.050192266289205194],
                [0.029627808770055802, 0.9904344267538798, -0.017073799063418788],
                [-0.009243040646204511, 0.015055191490298143, 0.7518742814281372],
            ],
        );
    }

    #[test]
    fn colours_come_back() {
        for (from, to) in [(Primaries::REC709, Primaries::AP1), (Primaries::REC2020, Primaries::P3_D65)] {
            let (there, back) = (ColourMatrix::between(&from, &to), ColourMatrix::between(&to, &from));
            assert_rows(there.inverse(), back.rows());
            let colours = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.2, 0.7, 0.05]];
            let mut light = colours.map(|[r, g, b]| Rgba([r, g, b, 0.5]));
            there.convert(&mut light);
            back.convert(&mut light);
            for (light, colour) in light.into_iter().zip(colours) {
                assert!(light.0[3] == 0.5 && (0..3).all(|c| (light.0[c] - colour[c]).abs() < 1e-6), "{light:?}");
            }
        }
        assert!(ColourMatrix::between(&Primaries::AP0, &Primaries::AP0).is_identity());
    }

    #[test]
    fn colours_outside_are_counted_and_kept() {
        let narrower = ColourMatrix::between(&Primaries::REC2020, &Primaries::REC709);
        let mut light = [Rgba::opaque(0.0, 1.0, 0.0), Rgba::opaque(1.0, 1.0, 1.0), Rgba::TRANSPARENT, Rgba::BLACK];
        assert_eq!(narrower.convert(&mut light), 1);
        assert!(light[0].0[0] < -0.5 && light[0].0[1] > 1.1);
        assert_eq!(narrower.inverse().convert(&mut light), 0);
    }
}
