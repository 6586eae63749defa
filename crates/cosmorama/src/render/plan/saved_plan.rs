use super::weights::Weights;
use super::{Compiled, FixedPlan, Plan};
use crate::render::apply::fixed::weights::FixedWeights;
use crate::render::apply::float::weights::FloatWeights;
use crate::render::{PlanError, PlanKey, Resampler};

/// A plan that can be kept as bytes, so that it serves another run: [`Plan`] and [`FixedPlan`] are such.
pub trait SavedPlan: Sized {
    /// What tells the plan of a conversion from any other.
    fn key(resampler: &Resampler) -> PlanKey;

    /// The plan of the conversion that has this key, to be kept.
    fn to_bytes(&self, key: PlanKey) -> Vec<u8>;

    /// A plan that was kept. Bytes from anywhere are safe to give: all that the plan says is checked.
    ///
    /// # Errors
    /// When they are not the plan of this conversion and of this version, whole and sound.
    fn from_bytes(bytes: &[u8], key: PlanKey, resampler: &Resampler) -> Result<Self, PlanError>;

    /// Bytes of memory that the plan holds.
    fn bytes(&self) -> usize;
}

/// What plans differ in: for which light they are, and so how they hold weights.
pub(crate) trait ForLight: Sized {
    type Weights: Weights;

    /// The light, as keys name it.
    const LIGHT: &'static str;

    fn of(compiled: Compiled<Self::Weights>) -> Self;

    fn compiled(&self) -> &Compiled<Self::Weights>;
}

impl ForLight for Plan {
    type Weights = FloatWeights;

    const LIGHT: &'static str = "light of any range";

    fn of(compiled: Compiled<FloatWeights>) -> Self {
        Self(compiled)
    }

    fn compiled(&self) -> &Compiled<FloatWeights> {
        &self.0
    }
}

impl ForLight for FixedPlan {
    type Weights = FixedWeights;

    const LIGHT: &'static str = "light of 15 bits";

    fn of(compiled: Compiled<FixedWeights>) -> Self {
        Self(compiled)
    }

    fn compiled(&self) -> &Compiled<FixedWeights> {
        &self.0
    }
}

impl<P: ForLight> SavedPlan for P {
    fn key(resampler: &Resampler) -> PlanKey {
        PlanKey::new(resampler, P::LIGHT)
    }

    fn to_bytes(&self, key: PlanKey) -> Vec<u8> {
        self.compiled().to_bytes(key)
    }

    fn from_bytes(bytes: &[u8], key: PlanKey, resampler: &Resampler) -> Result<Self, PlanError> {
        Compiled::from_bytes(bytes, key, resampler).map(P::of)
    }

    fn bytes(&self) -> usize {
        self.compiled().bytes()
    }
}
