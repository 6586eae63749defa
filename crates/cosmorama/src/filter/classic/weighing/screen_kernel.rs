use crate::filter::{CrossSection, Kernel, WeightTable};

/// A round Gaussian on the screen, tabulated over the squared distance: the paper's WTAB, exp(−2 r²) out to r = 1, unless
/// another is asked for (Greene & Heckbert 1986).
#[derive(Clone, Debug)]
pub(in crate::filter::classic) struct ScreenKernel {
    kernel: Kernel,
    table: WeightTable,
}

impl ScreenKernel {
    /// The paper's kernel.
    const PAPER: Kernel =
        Kernel { entries: 4096, ..Kernel::uniform(CrossSection::Gaussian { alpha: 2.0, cutoff: 1.0 }) };

    /// Tabulates a Gaussian; of any other kernel, the paper's stands instead.
    pub(in crate::filter::classic) fn of(kernel: &Kernel) -> Self {
        let is_gaussian = matches!(kernel.fine, CrossSection::Gaussian { .. });
        let kernel = if is_gaussian { *kernel } else { Self::PAPER };
        Self { kernel, table: WeightTable::new(kernel.fine, kernel.entries.max(1)) }
    }

    /// Returns the kernel that is tabulated.
    pub(in crate::filter::classic) fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Returns the radius, in pixels.
    pub(in crate::filter::classic) fn radius(&self) -> f64 {
        self.kernel.radius() * self.kernel.scale
    }

    /// Returns the number of entries of the table: Q where weights end.
    pub(in crate::filter::classic) fn length(&self) -> usize {
        self.table.length()
    }

    /// Returns the entries for a squared distance of one pixel.
    pub(in crate::filter::classic) fn entries_per_unit(&self) -> f64 {
        self.length() as f64 / self.radius().powi(2)
    }

    /// Returns the weight at a squared distance, in pixels; zero from the radius on.
    pub(in crate::filter::classic) fn weight(&self, square: f64) -> f64 {
        self.table.entry((square * self.entries_per_unit()) as usize)
    }

    /// Returns the entry for Q; zero from the table's length on.
    pub(in crate::filter::classic) fn entry(&self, q: usize) -> f64 {
        self.table.entry(q)
    }

    /// Returns the integral along a line through the middle, in pixels.
    pub(in crate::filter::classic) fn integral(&self) -> f64 {
        /// Points of the line.
        const POINTS: usize = 512;
        let step = 2.0 * self.radius() / POINTS as f64;
        (0..POINTS).map(|k| step * self.weight(((k as f64 + 0.5) * step - self.radius()).powi(2))).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_is_tabulated_as_it_is_asked_for() {
        let paper = ScreenKernel::of(&Kernel::ADAPTIVE);
        assert_eq!((paper.length(), paper.radius()), (4096, 1.0));
        // ∫ exp(−2 x²) from −1 to 1.
        assert!((paper.integral() - 1.196_288).abs() < 1e-4, "{}", paper.integral());
        let wide = CrossSection::Gaussian { alpha: 3.0, cutoff: 1.5 };
        let wide = ScreenKernel::of(&Kernel { entries: 1 << 16, scale: 0.5, ..Kernel::uniform(wide) });
        for r in [0.0f64, 0.3, 0.74] {
            assert!((wide.weight(r * r) - (-3.0 * (2.0 * r).powi(2)).exp()).abs() < 1e-3, "{r}");
        }
        assert_eq!(wide.weight(0.76 * 0.76), 0.0);
    }
}
