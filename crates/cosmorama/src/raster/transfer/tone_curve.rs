use crate::raster::ColourChannel;

/// Tabulated tone curves of red, green and blue: linear light at equal steps of the code value from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneCurve {
    channels: [Vec<f32>; 3],
}

impl ToneCurve {
    /// Creates curves from three tables. Each is made finite and non-decreasing, so that it can be inverted. `None`
    /// when a table has fewer than two entries.
    pub fn new(channels: [Vec<f32>; 3]) -> Option<Self> {
        if channels.iter().any(|table| table.len() < 2) {
            return None;
        }
        Some(Self { channels: channels.map(monotone) })
    }

    /// Returns the linear light of a code value; codes outside 0–1 are clamped.
    pub fn decode(&self, code: f64, channel: ColourChannel) -> f64 {
        let table = &self.channels[channel.index()];
        let last = table.len() - 1;
        let position = code.clamp(0.0, 1.0) * last as f64;
        let below = (position as usize).min(last - 1);
        let (low, high) = (f64::from(table[below]), f64::from(table[below + 1]));
        low + (high - low) * (position - below as f64)
    }

    /// Finds the least code value with this light; light beyond the curve's ends is clamped.
    pub fn encode(&self, light: f64, channel: ColourChannel) -> f64 {
        let table = &self.channels[channel.index()];
        let last = table.len() - 1;
        let above = table.partition_point(|&entry| f64::from(entry) < light);
        if above == 0 {
            return 0.0;
        }
        if above > last {
            // The end of the curve may be flat. There, too, the least code with the greatest light is wanted.
            let top = table.partition_point(|&entry| entry < table[last]);
            return top as f64 / last as f64;
        }
        let (low, high) = (f64::from(table[above - 1]), f64::from(table[above]));
        ((above - 1) as f64 + (light - low) / (high - low)) / last as f64
    }

    /// Returns whether the three channels share one curve.
    pub fn is_common(&self) -> bool {
        self.channels[0] == self.channels[1] && self.channels[1] == self.channels[2]
    }
}

fn monotone(mut table: Vec<f32>) -> Vec<f32> {
    let mut greatest = 0.0_f32;
    for entry in &mut table {
        // `max` ignores NaN.
        greatest = greatest.max(if entry.is_finite() { *entry } else { greatest });
        *entry = greatest;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::transfer::tone_curve::ColourChannel::{Green, Red};

    fn common(table: &[f32]) -> ToneCurve {
        ToneCurve::new([table.to_vec(), table.to_vec(), table.to_vec()]).unwrap()
    }

    #[test]
    fn encode_inverts_decode() {
        let table: Vec<f32> = (0..1024).map(|i| (i as f32 / 1023.0).powf(1.8)).collect();
        let curve = common(&table);
        for code in (0..=1000).map(|i| f64::from(i) / 1000.0) {
            assert!((curve.encode(curve.decode(code, Green), Green) - code).abs() < 1e-6);
        }
    }

    #[test]
    fn a_broken_table_is_made_monotone() {
        let curve = common(&[0.0, 0.5, f32::NAN, 0.25, f32::INFINITY, 1.0]);
        let mut before = -1.0;
        for code in (0..=50).map(|i| f64::from(i) / 50.0) {
            let light = curve.decode(code, Red);
            assert!(light >= before && light.is_finite());
            before = light;
        }
        assert_eq!(curve.encode(2.0, Red), 1.0);
        assert_eq!(curve.encode(-1.0, Red), 0.0);
    }

    #[test]
    fn a_table_of_one_entry_is_no_curve() {
        assert_eq!(ToneCurve::new([vec![1.0], vec![0.0, 1.0], vec![0.0, 1.0]]), None);
    }
}
