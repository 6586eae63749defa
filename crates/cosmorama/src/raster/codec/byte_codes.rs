/// Table from light to codes of 8 bits, small enough for a processor's nearest cache. It gives the codes that a search of
/// their least light gives, with two reads and no branch.
#[derive(Debug)]
pub(crate) struct ByteTable {
    /// Number of the first bucket. What is darker belongs to it, too.
    first: u32,
    /// Number of codes that begin before each bucket.
    before: [u8; BUCKETS],
    /// Least light of codes 1, 2, 3 …; NaN behind the last, since no light reaches a code beyond it, not even an infinite one.
    least: [f32; CODES],
}

/// Number of buckets.
const BUCKETS: usize = 1 << 12;

/// Number of codes.
const CODES: usize = 1 << 8;

/// Number of low bits of a float that are dropped to find its bucket: 128 buckets per doubling of the light, of which the
/// table has 32.
const SHIFT: u32 = 16;

impl ByteTable {
    /// Creates the table from the least light of codes 1, 2, 3 and so on; `None` if codes are not 256, or if several of them
    /// begin in one bucket.
    pub(super) fn new(least: &[f32]) -> Option<Self> {
        let (darkest, greatest) = (*least.first()?, *least.last()?);
        if least.len() != CODES - 1 || darkest.is_nan() || darkest <= 0.0 {
            return None;
        }
        let mut table = Self {
            first: (greatest.to_bits() >> SHIFT).saturating_sub(BUCKETS as u32 - 1),
            before: [0; BUCKETS],
            least: [f32::NAN; CODES],
        };
        table.least[..CODES - 1].copy_from_slice(least);
        let (mut code, mut most) = (0, 0);
        for bucket in 0..BUCKETS {
            table.before[bucket] = u8::try_from(code).ok()?;
            let begun = least[code..].iter().take_while(|least| table.bucket(**least) == bucket).count();
            (code, most) = (code + begun, most.max(begun));
        }
        (most <= 1 && code == least.len()).then_some(table)
    }

    #[inline(always)]
    fn bucket(&self, light: f32) -> usize {
        bucket(light, self.first) as usize
    }

    /// Returns the code of a light value in a bucket.
    #[inline(always)]
    fn code_in(&self, bucket: u32, light: f32) -> u32 {
        let before = self.before[bucket as usize % BUCKETS];
        u32::from(before) + u32::from(self.least[usize::from(before)] <= light)
    }

    /// Returns the code of a light value: 0 for NaN and negative light, 255 for white and above.
    #[inline(always)]
    pub(super) fn code(&self, light: f32) -> u32 {
        self.code_in(bucket(light, self.first), light)
    }
}

/// Returns the bucket of a light value, by the number of a table's first one.
#[inline(always)]
fn bucket(light: f32, first: u32) -> u32 {
    // Not `max`, which may leave the sign of a negative zero.
    let light = if light > 0.0 { light } else { 0.0 };
    (light.to_bits() >> SHIFT).saturating_sub(first).min(BUCKETS as u32 - 1)
}

/// Small tables of red, green and blue.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RgbTables<'a>(pub(super) [&'a ByteTable; 3]);

impl RgbTables<'_> {
    /// Returns the codes of light, from the low byte on.
    #[inline(always)]
    pub(super) fn packed(self, [red, green, blue, _]: [f32; 4]) -> u32 {
        let [reds, greens, blues] = self.0;
        reds.code(red) | greens.code(green) << 8 | blues.code(blue) << 16
    }

    /// Returns the codes of eight lights, each from the low byte on.
    #[inline(always)]
    pub(super) fn packed_eight(self, light: &[[f32; 4]; 8]) -> [u32; 8] {
        let [reds, greens, blues] = self.0;
        let first = [reds.first, greens.first, blues.first, 0];
        // All buckets first, so that the compiler finds many at once.
        let mut buckets = [[0; 4]; 8];
        for (buckets, light) in buckets.iter_mut().zip(light) {
            for (bucket, (light, first)) in buckets.iter_mut().zip(light.iter().zip(first)) {
                *bucket = self::bucket(*light, first);
            }
        }
        let mut codes = [0; 8];
        for (code, (buckets, light)) in codes.iter_mut().zip(buckets.iter().zip(light)) {
            let [red, green, blue] = [(reds, 0), (greens, 1), (blues, 2)]
                .map(|(table, channel)| table.code_in(buckets[channel], light[channel]));
            *code = red | green << 8 | blue << 16;
        }
        codes
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::raster::codec::quantizer::Thresholds;
    use crate::raster::{ColourChannel, ToneCurve, Transfer};

    /// Returns the transfer of a curve of 4096 steps.
    fn curve(of: impl Fn(f32) -> f32) -> Transfer {
        let table: Vec<f32> = (0..4096).map(|at| of(at as f32 / 4095.0)).collect();
        Transfer::Curve(Arc::new(ToneCurve::new([table.clone(), table.clone(), table]).expect("a curve")))
    }

    fn thresholds(transfer: &Transfer, last: u16) -> Thresholds {
        Thresholds::new(transfer, last, ColourChannel::Green)
    }

    fn table(thresholds: &Thresholds) -> Option<ByteTable> {
        ByteTable::new(thresholds.least())
    }

    #[test]
    fn codes_are_those_that_are_searched() {
        let gammas = [1.0, 1.8, 2.2, 2.6].map(Transfer::Gamma);
        let others = [Transfer::Srgb, Transfer::Linear, Transfer::Bt1886, Transfer::Pq, Transfer::Hlg];
        // White may be next to nothing.
        let dark = curve(|code| ((code + 1.0) / 65536.0).powi(7));
        for transfer in gammas.into_iter().chain(others).chain([dark]) {
            let thresholds = thresholds(&transfer, 255);
            let table = table(&thresholds).unwrap_or_else(|| panic!("no table of {transfer:?}"));
            let near = |light: f32| [light.next_down(), light, light.next_up()];
            let edges = thresholds.least().iter().copied().flat_map(near);
            // Floats of all sizes and both signs, infinities and NaN among them.
            let all = (0..=u16::MAX).flat_map(|high| near(f32::from_bits(u32::from(high) << 16)));
            for light in edges.chain(all) {
                let code = u32::from(thresholds.search(light));
                assert_eq!(table.code(light), code, "{light:e} by {transfer:?}");
                let [packed, ..] = RgbTables([&table; 3]).packed_eight(&[[light; 4]; 8]);
                assert_eq!(packed, 0x01_01_01 * code, "{light:e} by {transfer:?}");
            }
        }
    }

    #[test]
    fn each_channel_has_its_own_table() {
        let tables = [1.8, 2.2, 2.6].map(|gamma| table(&thresholds(&Transfer::Gamma(gamma), 255)).expect("a table"));
        let [reds, greens, blues] = &tables;
        let tables = RgbTables([reds, greens, blues]);
        let light: [[f32; 4]; 8] =
            std::array::from_fn(|at| [0.1, 0.2, 0.4, 1.0].map(|channel| channel * (at + 1) as f32 / 8.0));
        let codes =
            light.map(|[red, green, blue, _]| reds.code(red) | greens.code(green) << 8 | blues.code(blue) << 16);
        assert_eq!(tables.packed_eight(&light), codes);
        assert_eq!(light.map(|light| tables.packed(light)), codes);
        let [red, green, blue, _] = codes[7].to_le_bytes();
        let gamma = |light: f64, gamma: f64| (255.0 * light.powf(1.0 / gamma)).round() as u8;
        assert_eq!([red, green, blue], [gamma(0.1, 1.8), gamma(0.2, 2.2), gamma(0.4, 2.6)]);
    }

    #[test]
    fn what_does_not_fit_has_no_table() {
        assert!(table(&thresholds(&Transfer::Srgb, 1023)).is_none(), "more codes");
        let narrow = curve(|code| 0.5 + code / 2000.0);
        assert!(table(&thresholds(&narrow, 255)).is_none(), "all codes in half a thousandth of light");
    }
}
