use super::byte_codes::{ByteTable, RgbTables};
use crate::raster::{ColourChannel, Transfer};

/// Table from light to integer codes, exactly as rounding the transfer function would give them. It holds the least
/// light of each code, and is indexed by the bits of the float.
#[derive(Debug)]
pub(crate) struct Quantizer {
    channels: Vec<Thresholds>,
}

impl Quantizer {
    /// Creates the table for codes from 0 to `last`.
    pub(crate) fn new(transfer: &Transfer, last: u16) -> Self {
        let thresholds = |channel: &ColourChannel| Thresholds::new(transfer, last, *channel);
        Self { channels: transfer.channels().iter().map(thresholds).collect() }
    }

    /// Returns the code of a light value: 0 for NaN and negative light, `last` for white and above.
    #[inline]
    pub(crate) fn code(&self, light: f32, channel: ColourChannel) -> u16 {
        self.of(channel).code(light)
    }

    fn of(&self, channel: ColourChannel) -> &Thresholds {
        &self.channels[channel.index().min(self.channels.len() - 1)]
    }

    /// Returns the small tables of red, green and blue, if codes have 8 bits and lie apart.
    pub(super) fn byte_tables(&self) -> Option<RgbTables<'_>> {
        let [red, green, blue] = ColourChannel::ALL.map(|channel| self.of(channel).bytes.as_deref());
        Some(RgbTables([red?, green?, blue?]))
    }
}

/// Number of low bits of a float that are dropped to find its bucket: 512 buckets per doubling of the light.
const SHIFT: u32 = 14;

#[derive(Debug)]
pub(super) struct Thresholds {
    /// Least light of codes 1, 2, 3 …
    least: Vec<f32>,
    /// Number of codes that begin before each bucket; one more entry at the end.
    before: Vec<u16>,
    /// Smaller table of the same, of most curves with codes of 8 bits.
    bytes: Option<Box<ByteTable>>,
}

impl Thresholds {
    pub(super) fn new(transfer: &Transfer, last: u16, channel: ColourChannel) -> Self {
        let boundary = |code: u16| transfer.decode((f64::from(code) - 0.5) / f64::from(last), channel) as f32;
        let least: Vec<f32> = (1..=last).map(boundary).collect();
        let of = |light: Option<&f32>| light.filter(|light| **light > 0.0).map_or(0, |light| bucket(*light));
        let (first, greatest) = (of(least.first()), of(least.last()));
        // No code begins before the bucket of the least, which is near the end: floats have many buckets close to zero.
        let mut before = vec![0; first];
        let mut code = 0;
        before.extend((first..=greatest + 1).map(|bucket| {
            let start = f32::from_bits((bucket << SHIFT) as u32);
            while code < least.len() && least[code] < start {
                code += 1;
            }
            code as u16
        }));
        let bytes = ByteTable::new(&least).map(Box::new);
        Self { least, before, bytes }
    }

    /// Returns the least light of codes 1, 2, 3 and so on.
    #[cfg(test)]
    pub(super) fn least(&self) -> &[f32] {
        &self.least
    }

    #[inline(always)]
    fn code(&self, light: f32) -> u16 {
        match &self.bytes {
            Some(table) => table.code(light) as u16,
            None => self.search(light),
        }
    }

    #[inline(always)]
    pub(super) fn search(&self, light: f32) -> u16 {
        if light.is_nan() || light <= 0.0 {
            return 0;
        }
        // The greatest code begins in the last bucket.
        let bucket = bucket(light).min(self.before.len() - 2);
        let (from, to) = (usize::from(self.before[bucket]), usize::from(self.before[bucket + 1]));
        (from + self.least[from..to].partition_point(|&least| least <= light)) as u16
    }
}

fn bucket(light: f32) -> usize {
    (light.to_bits() >> SHIFT) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::codec::quantizer::ColourChannel::Red;

    #[test]
    fn codes_are_the_rounded_transfer_function() {
        for transfer in [Transfer::Srgb, Transfer::Linear, Transfer::Gamma(2.2), Transfer::Pq] {
            for last in [255, 1023, 65535] {
                let quantizer = Quantizer::new(&transfer, last);
                for i in 0..20_000 {
                    let light = i as f32 / 15_000.0;
                    let exact = transfer.encode(f64::from(light), Red).min(1.0) * f64::from(last);
                    let error = (f64::from(quantizer.code(light, Red)) - exact).abs();
                    assert!(error < 0.504, "{transfer:?} {last} {light}: off by {error} codes");
                }
            }
        }
    }

    #[test]
    fn the_ends_are_clamped() {
        let quantizer = Quantizer::new(&Transfer::Srgb, 255);
        assert_eq!([f32::NAN, -1.0, 0.0, -0.0, f32::NEG_INFINITY].map(|light| quantizer.code(light, Red)), [0; 5]);
        assert_eq!([1.0, 2.0, f32::MAX, f32::INFINITY].map(|light| quantizer.code(light, Red)), [255; 4]);
    }
}
