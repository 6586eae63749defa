use std::sync::Arc;

/// How code values, scaled to 0–1, relate to linear light.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Transfer {
    /// IEC 61966-2-1.
    #[default]
    Srgb,
    /// Code values are light.
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

/// Tabulated tone curves of red, green and blue: linear light at equal steps of the code value from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneCurve {
    channels: [Vec<f32>; 3],
}
