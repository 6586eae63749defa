pub(crate) mod colour_channel;
pub(crate) mod tone_curve;

use std::sync::Arc;

use super::{ColourChannel, ToneCurve};

/// Relation between code values, scaled to 0–1, and linear light.
///
/// Powers are continued below zero as odd functions, so that float files with negative values survive a round trip.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Transfer {
    /// IEC 61966-2-1.
    #[default]
    Srgb,
    /// Code values are linear light.
    Linear,
    /// A pure power, light = code^γ.
    Gamma(f64),
    /// ITU-R BT.1886 with a black of zero: γ = 2.4.
    Bt1886,
    /// SMPTE ST 2084; light 1 is the reference white of ITU-R BT.2408, 203 cd/m².
    Pq,
    /// ARIB STD-B67 scene light; light 1 is the reference white of ITU-R BT.2408, 75 % signal.
    Hlg,
    /// The tone curves of an ICC profile.
    Curve(Arc<ToneCurve>),
}

impl Transfer {
    /// Returns the linear light of a code value. Channels differ only in the curves of an ICC profile.
    pub fn decode(&self, code: f64, channel: ColourChannel) -> f64 {
        match self {
            Self::Srgb => odd(code, srgb_decode),
            Self::Linear => code,
            Self::Gamma(gamma) => odd(code, |c| c.powf(*gamma)),
            Self::Bt1886 => odd(code, |c| c.powf(2.4)),
            Self::Pq => pq_decode(code),
            Self::Hlg => hlg_decode(code),
            Self::Curve(curve) => curve.decode(code, channel),
        }
    }

    /// Returns the code value of linear light: the inverse of [`Transfer::decode`].
    pub fn encode(&self, light: f64, channel: ColourChannel) -> f64 {
        match self {
            Self::Srgb => odd(light, srgb_encode),
            Self::Linear => light,
            Self::Gamma(gamma) => odd(light, |l| l.powf(gamma.recip())),
            Self::Bt1886 => odd(light, |l| l.powf(2.4_f64.recip())),
            Self::Pq => pq_encode(light),
            Self::Hlg => hlg_encode(light),
            Self::Curve(curve) => curve.encode(light, channel),
        }
    }

    /// Returns the channels with different curves: one channel if all share a curve.
    pub(crate) fn channels(&self) -> &'static [ColourChannel] {
        if self.is_common() { &ColourChannel::ALL[..1] } else { &ColourChannel::ALL }
    }

    /// Returns whether the three channels share one curve.
    pub(crate) fn is_common(&self) -> bool {
        match self {
            Self::Curve(curve) => curve.is_common(),
            _ => true,
        }
    }
}

fn odd(x: f64, positive: impl Fn(f64) -> f64) -> f64 {
    positive(x.abs()).copysign(x)
}

fn srgb_decode(code: f64) -> f64 {
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

fn srgb_encode(light: f64) -> f64 {
    if light <= 0.04045 / 12.92 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// ST 2084's peak of 10 000 cd/m² in units of the reference white.
const PQ_PEAK: f64 = 10_000.0 / 203.0;
// m₁, m₂, c₁, c₂ and c₃ of SMPTE ST 2084:2014 and of ITU-R BT.2100-2, table 4.
const PQ_M1: f64 = 2610.0 / 16384.0;
const PQ_M2: f64 = 2523.0 / 4096.0 * 128.0;
const PQ_C1: f64 = 3424.0 / 4096.0;
const PQ_C2: f64 = 2413.0 / 4096.0 * 32.0;
const PQ_C3: f64 = 2392.0 / 4096.0 * 32.0;

fn pq_decode(code: f64) -> f64 {
    let power = code.clamp(0.0, 1.0).powf(PQ_M2.recip());
    let ratio = (power - PQ_C1).max(0.0) / (PQ_C2 - PQ_C3 * power);
    PQ_PEAK * ratio.powf(PQ_M1.recip())
}

fn pq_encode(light: f64) -> f64 {
    let power = (light / PQ_PEAK).clamp(0.0, 1.0).powf(PQ_M1);
    ((PQ_C1 + PQ_C2 * power) / (1.0 + PQ_C3 * power)).powf(PQ_M2)
}

// a and b of ARIB STD-B67 and of ITU-R BT.2100-2, table 5.
const HLG_A: f64 = 0.178_832_77;
const HLG_B: f64 = 1.0 - 4.0 * HLG_A;

/// Returns the third constant of STD-B67, which makes both pieces meet at half signal.
fn hlg_c() -> f64 {
    0.5 - HLG_A * (4.0 * HLG_A).ln()
}

/// Returns the scene light, 0–1, of a signal.
fn hlg_scene(code: f64) -> f64 {
    if code <= 0.5 { code * code / 3.0 } else { (((code - hlg_c()) / HLG_A).exp() + HLG_B) / 12.0 }
}

fn hlg_decode(code: f64) -> f64 {
    hlg_scene(code.clamp(0.0, 1.0)) / hlg_scene(0.75)
}

fn hlg_encode(light: f64) -> f64 {
    let scene = (light * hlg_scene(0.75)).clamp(0.0, 1.0);
    if scene <= 1.0 / 12.0 { (3.0 * scene).sqrt() } else { HLG_A * (12.0 * scene - HLG_B).ln() + hlg_c() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::transfer::ColourChannel::Red;

    fn assert_close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-6 * b.abs().max(1.0), "{a} is not {b}");
    }

    #[test]
    fn pq_meets_the_published_values() {
        // ST 2084 and BT.2408: 100 cd/m² at 50.81 %, 203 cd/m² at 58.07 %, 1000 cd/m² at 75.18 %.
        for (nits, signal) in [(0.0, 0.0), (100.0, 0.508_078), (203.0, 0.580_689), (1000.0, 0.751_827), (10_000.0, 1.0)]
        {
            assert!((Transfer::Pq.encode(nits / 203.0, Red) - signal).abs() < 2e-6, "{nits}");
            assert_close(Transfer::Pq.decode(Transfer::Pq.encode(nits / 203.0, Red), Red), nits / 203.0);
        }
    }

    #[test]
    fn hlg_meets_the_published_values() {
        assert_close(Transfer::Hlg.decode(0.75, Red), 1.0);
        assert_close(hlg_scene(0.5), 1.0 / 12.0);
        assert_close(hlg_scene(1.0), 1.0);
        assert_close(hlg_scene(0.75), 0.264_962_56);
        assert_close(hlg_c(), 0.559_910_73);
    }

    #[test]
    fn srgb_meets_the_published_values() {
        assert_close(Transfer::Srgb.decode(0.5, Red), 0.214_041_14);
        assert_close(Transfer::Srgb.encode(0.18, Red), 0.461_356_13);
        assert_close(Transfer::Srgb.decode(-0.5, Red), -0.214_041_14);
    }
}
