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
        self.channels[channel.index().min(self.channels.len() - 1)].code(light)
    }
}

/// Number of low bits of a float that are dropped to find its bucket: 512 buckets per doubling of the light.
const SHIFT: u32 = 14;

#[derive(Debug)]
struct Thresholds {
    /// Least light of codes 1, 2, 3 …
    least: Vec<f32>,
    /// Number of codes that begin before each bucket; one more entry at the end.
    before: Vec<u16>,
    /// Whether at most one code begins in each bucket, as with 8 bits.
    is_sparse: bool,
}

impl Thresholds {
    fn new(transfer: &Transfer, last: u16, channel: ColourChannel) -> Self {
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
        let is_sparse = before[first..].windows(2).all(|pair| pair[1] - pair[0] <= 1);
        Self { least, before, is_sparse }
    }

    #[inline(always)]
    fn code(&self, light: f32) -> u16 {
        if light.is_nan() || light <= 0.0 {
            return 0;
        }
        // The greatest code begins in the last bucket.
        let bucket = bucket(light).min(self.before.len() - 2);
        let from = usize::from(self.before[bucket]);
        if self.is_sparse {
            // Without a branch, since nobody can guess it.
            return self.before[bucket] + u16::from(self.least[from] <= light);
        }
        let to = usize::from(self.before[bucket + 1]);
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
