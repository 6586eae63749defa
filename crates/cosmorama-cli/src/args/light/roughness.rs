use clap::ValueEnum;
use cosmorama::lighting::RoughnessMap;

/// Name of a rule by which the levels of a chain get rougher.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RoughnessMapName {
    /// α = level/(N−1)
    Linear,
    /// α = roughness², roughness = level/(N−1)
    Squared,
    /// As cmgen: roughness = 1 − √(1 − level/(N−1)), α = roughness²
    Filament,
    /// As Khronos' glTF sampler: squared
    Gltf,
    /// As reflection captures: roughness = 2^((level + 2 − log₂ edge)/1.2), at most 1, α = roughness²
    Unreal,
    /// As three.js' PMREM: roughness by the size of the level's faces, α = roughness²
    Three,
}

impl From<RoughnessMapName> for RoughnessMap {
    fn from(name: RoughnessMapName) -> Self {
        match name {
            RoughnessMapName::Linear => Self::Linear,
            RoughnessMapName::Squared => Self::Squared,
            RoughnessMapName::Filament => Self::Filament,
            RoughnessMapName::Gltf => Self::Gltf,
            RoughnessMapName::Unreal => Self::Unreal,
            RoughnessMapName::Three => Self::Three,
        }
    }
}
