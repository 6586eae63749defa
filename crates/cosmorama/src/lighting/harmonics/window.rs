use std::f64::consts::PI;

/// Factors by band that weaken ringing about bright sources, at the price of sharpness.
///
/// Both end at a width w: bands from w onwards vanish (P.-P. Sloan, *Stupid Spherical Harmonics Tricks*, GDC 2008, "Windowing").
/// With a width of the order plus one, all bands keep something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HarmonicWindow {
    /// (1 + cos(πl/w)) / 2.
    Hanning {
        /// Width w, in bands.
        width: f64,
    },
    /// sin(πl/w) / (πl/w).
    Lanczos {
        /// Width w, in bands.
        width: f64,
    },
}

impl HarmonicWindow {
    /// Returns the factor of a band.
    pub(super) fn factor(self, band: usize) -> f64 {
        let (Self::Hanning { width } | Self::Lanczos { width }) = self;
        let x = PI * band as f64 / width;
        match self {
            _ if band == 0 => 1.0,
            _ if band as f64 >= width => 0.0,
            Self::Hanning { .. } => 0.5 + 0.5 * x.cos(),
            Self::Lanczos { .. } => x.sin() / x,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_fall_from_one_to_nothing() {
        for window in [HarmonicWindow::Hanning { width: 4.0 }, HarmonicWindow::Lanczos { width: 4.0 }] {
            let factors: Vec<f64> = (0..6).map(|band| window.factor(band)).collect();
            assert!(factors[0] == 1.0 && factors[3] > 0.1 && factors[4..] == [0.0, 0.0], "{factors:?}");
            assert!(factors[..5].windows(2).all(|pair| pair[0] > pair[1]), "{factors:?}");
        }
        assert!((HarmonicWindow::Hanning { width: 4.0 }.factor(2) - 0.5).abs() < 1e-15);
        assert!((HarmonicWindow::Lanczos { width: 4.0 }.factor(2) - 2.0 / PI).abs() < 1e-15);
    }
}
