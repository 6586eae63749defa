/// Rule by which the levels of a chain get rougher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoughnessMap {
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

/// Place of a level in a chain.
#[derive(Clone, Copy, Debug)]
pub struct ChainLevel {
    /// Its number, from 0.
    pub level: usize,
    /// Number of levels.
    pub levels: usize,
    /// Columns of a face at level 0.
    pub edge: usize,
}

impl RoughnessMap {
    /// Returns whether roughness goes by the size of faces, not by the number of levels.
    pub fn goes_by_faces(self) -> bool {
        matches!(self, Self::Unreal | Self::Three)
    }

    /// Returns the roughness α of a level: 0, a mirror, at the first.
    pub fn alpha(self, ChainLevel { level, levels, edge }: ChainLevel) -> f64 {
        if level == 0 {
            return 0.0;
        }
        let part = level as f64 / (levels - 1).max(1) as f64;
        // Binary logarithm of the level's edge.
        let mip = (edge as f64).log2() - level as f64;
        let roughness = match self {
            Self::Linear => return part,
            Self::Squared | Self::Gltf => part,
            Self::Filament => 1.0 - (1.0 - part).sqrt(),
            Self::Unreal => ((2.0 - mip) / 1.2).exp2().min(1.0),
            Self::Three => three(mip),
        };
        roughness * roughness
    }
}

/// Roughness at some sizes of faces, between which three.js interpolates (`cube_uv_reflection_fragment`, `roughnessToMip`): binary
/// logarithms of the size, and roughness.
const THREE: [(f64, f64); 5] = [(-2.0, 1.0), (-1.0, 0.8), (2.0, 0.4), (3.0, 0.305), (4.0, 0.21)];

fn three(mip: f64) -> f64 {
    let part = THREE.windows(2).find(|ends| mip <= ends[1].0);
    match part {
        Some([(first, rough), (last, smooth)]) => rough + (mip - first).max(0.0) / (last - first) * (smooth - rough),
        _ => (-mip / 2.0).exp2() / 1.16,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_those_of_their_engines() {
        let alphas = |map: RoughnessMap, levels: usize, edge: usize| -> Vec<f64> {
            (0..levels).map(|level| map.alpha(ChainLevel { level, levels, edge })).collect()
        };
        assert_eq!(alphas(RoughnessMap::Linear, 5, 256), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(alphas(RoughnessMap::Squared, 3, 256), [0.0, 0.25, 1.0]);
        assert_eq!(alphas(RoughnessMap::Linear, 1, 256), [0.0]);
        // lod = 2 r − r².
        for (level, alpha) in alphas(RoughnessMap::Filament, 5, 256).into_iter().enumerate() {
            let roughness = alpha.sqrt();
            assert!((2.0 * roughness - alpha - level as f64 / 4.0).abs() < 1e-12);
        }
        // The level of 8 pixels, three from that of one: mip = max − 1 − (1 − 1.2 log₂ r).
        let rough = alphas(RoughnessMap::Unreal, 9, 256)[5].sqrt();
        assert!((8.0 - 1.0 - (1.0 - 1.2 * rough.log2()) - 5.0).abs() < 1e-12, "{rough}");
        // Faces of 16, 4 and 1024 pixels.
        let three = alphas(RoughnessMap::Three, 12, 2048);
        assert!((three[7].sqrt() - 0.21).abs() < 1e-12 && (three[9].sqrt() - 0.4).abs() < 1e-12);
        assert!((-2.0 * (1.16 * three[1].sqrt()).log2() - 10.0).abs() < 1e-9);
        let all = [RoughnessMap::Unreal, RoughnessMap::Three, RoughnessMap::Filament];
        for alphas in all.map(|map| alphas(map, 9, 256)) {
            assert!(alphas.windows(2).all(|pair| pair[0] <= pair[1] && pair[1] <= 1.0), "{alphas:?}");
        }
    }
}
