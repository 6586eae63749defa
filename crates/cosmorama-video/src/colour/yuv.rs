use crate::SignalRange;

/// Relation between the codes of YUV and RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coding {
    /// Weights of red and blue in luma; green has the rest.
    red: f32,
    blue: f32,
    /// Codes of black, and between black and white.
    black: f32,
    luma: f32,
    /// Codes of no colour, and between the two ends of a chroma axis.
    neutral: f32,
    chroma: f32,
    most: f32,
}

impl Coding {
    /// Creates the relation of a matrix (H.273, table 4); `None` unless it is one of three weights.
    pub(crate) fn new(matrix: u8, range: SignalRange, bits: u32) -> Option<Self> {
        let (red, blue) = match matrix {
            1 => (0.2126, 0.0722),
            4 => (0.30, 0.11),
            5 | 6 => (0.299, 0.114),
            7 => (0.212, 0.087),
            9 => (0.2627, 0.0593),
            _ => return None,
        };
        // Exact: a power of two.
        let step = f32::from(1_u16 << (bits - 8));
        let most = 256.0 * step - 1.0;
        let neutral = 128.0 * step;
        Some(match range {
            SignalRange::Narrow => {
                Self { red, blue, black: 16.0 * step, luma: 219.0 * step, neutral, chroma: 224.0 * step, most }
            }
            SignalRange::Full => Self { red, blue, black: 0.0, luma: most, neutral, chroma: most, most },
        })
    }

    /// Returns red, green and blue, black at 0 and white at 1, of codes.
    pub(crate) fn rgb(&self, [y, u, v]: [f32; 3]) -> [f32; 3] {
        let y = (y - self.black) / self.luma;
        let (u, v) = ((u - self.neutral) / self.chroma, (v - self.neutral) / self.chroma);
        let (red, blue) = (y + 2.0 * (1.0 - self.red) * v, y + 2.0 * (1.0 - self.blue) * u);
        let green = (y - self.red * red - self.blue * blue) / (1.0 - self.red - self.blue);
        [red, green, blue]
    }

    /// Returns the light of a luma code without chroma.
    pub(crate) fn grey(&self, y: f32) -> f32 {
        (y - self.black) / self.luma
    }

    /// Returns the codes of red, green and blue, without rounding.
    pub(crate) fn yuv(&self, [red, green, blue]: [f32; 3]) -> [f32; 3] {
        let y = self.red * red + (1.0 - self.red - self.blue) * green + self.blue * blue;
        let (u, v) = ((blue - y) / (2.0 * (1.0 - self.blue)), (red - y) / (2.0 * (1.0 - self.red)));
        [self.black + y * self.luma, self.neutral + u * self.chroma, self.neutral + v * self.chroma]
    }

    /// Returns the greatest code.
    pub(crate) fn most(&self) -> f32 {
        self.most
    }

    /// Returns the nearest code.
    pub(crate) fn code(&self, value: f32) -> u16 {
        value.round().clamp(0.0, self.most) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(coding: &Coding, rgb: [f32; 3]) -> [u16; 3] {
        coding.yuv(rgb).map(|value| coding.code(value))
    }

    #[test]
    fn colours_have_the_codes_of_the_standards() {
        let hd = Coding::new(1, SignalRange::Narrow, 8).unwrap();
        // BT.709 bars: SMPTE RP 219.
        assert_eq!(codes(&hd, [1.0, 1.0, 1.0]), [235, 128, 128]);
        assert_eq!(codes(&hd, [0.0, 0.0, 0.0]), [16, 128, 128]);
        assert_eq!(codes(&hd, [0.75, 0.0, 0.0]), [51, 109, 212]);
        assert_eq!(codes(&hd, [0.0, 0.75, 0.0]), [133, 63, 52]);
        assert_eq!(codes(&hd, [0.0, 0.0, 0.75]), [28, 212, 120]);
        let sd = Coding::new(6, SignalRange::Full, 8).unwrap();
        // JFIF.
        assert_eq!(codes(&sd, [1.0, 0.0, 0.0]), [76, 85, 255]);
        let deep = Coding::new(9, SignalRange::Narrow, 10).unwrap();
        assert_eq!(codes(&deep, [1.0, 1.0, 1.0]), [940, 512, 512]);
        assert_eq!(Coding::new(10, SignalRange::Narrow, 8), None);
    }

    #[test]
    fn colours_come_back_to_within_the_rounding_of_codes() {
        for matrix in [1, 4, 6, 7, 9] {
            for (range, bits) in
                [(SignalRange::Narrow, 8), (SignalRange::Full, 8), (SignalRange::Narrow, 12), (SignalRange::Full, 16)]
            {
                let coding = Coding::new(matrix, range, bits).unwrap();
                for rgb in (0..729).map(|i| [i % 9, i / 9 % 9, i / 81].map(|level| level as f32 / 8.0)) {
                    let back = coding.rgb(codes(&coding, rgb).map(f32::from));
                    // Half a code of each axis, by its weight, of which blue has the greatest: 2.9 in all.
                    let allowed = 0.5 * 2.9 / (219.0 * f32::from(1_u16 << (bits - 8))) + 1e-6;
                    let error = (0..3).map(|c| (back[c] - rgb[c]).abs()).fold(0.0, f32::max);
                    assert!(error <= allowed, "{matrix} {range:?} {bits} {rgb:?}: {back:?}");
                }
            }
        }
    }
}
