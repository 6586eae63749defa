use crate::camera::SamplePositions;
use crate::sphere::CubeFace::{self, Back, Down, Front, Left, Right, Up};

/// Order of the faces in one picture, and the rotation of each, as a tool arranges them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceOrder {
    /// Name in `order=`.
    pub name: &'static str,
    /// Names of other tools that use this order.
    pub aliases: &'static [&'static str],
    /// The face in each place, in reading order.
    pub faces: [CubeFace; 6],
    /// Clockwise quarter turns of each picture; `None` where the layout's own turns apply.
    pub turns: Option<[u8; 6]>,
    /// Position of the outermost samples.
    pub samples: SamplePositions,
}

/// Every preset.
static PRESETS: [FaceOrder; 5] = [
    plain("ffmpeg", &["v360", "opengl", "threejs", "ktx", "dds"], [Right, Left, Up, Down, Front, Back]),
    plain("kartavr", &["fusion"], [Left, Right, Up, Down, Back, Front]),
    plain("navegar", &[], [Left, Right, Front, Back, Up, Down]),
    OPENEXR,
    FaceOrder { name: "envutil", aliases: &["lux"], samples: SamplePositions::Centres, ..OPENEXR },
];

/// +X −X +Y −Y +Z −Z in a right-handed frame. The middle of OpenEXR's panoramas is +Z: so +Z is the front, +X the left,
/// and the upper and lower faces are drawn as seen from −Z.
const OPENEXR: FaceOrder = FaceOrder {
    name: "openexr",
    aliases: &["exrenvmap"],
    faces: [Left, Right, Up, Down, Front, Back],
    turns: Some([0, 0, 2, 2, 0, 0]),
    samples: SamplePositions::Edges,
};

const fn plain(name: &'static str, aliases: &'static [&'static str], faces: [CubeFace; 6]) -> FaceOrder {
    FaceOrder { name, aliases, faces, turns: None, samples: SamplePositions::Centres }
}

impl FaceOrder {
    /// Returns all presets.
    pub fn presets() -> &'static [Self] {
        &PRESETS
    }

    /// OpenEXR's order.
    pub const OPENEXR: Self = OPENEXR;

    /// Returns the preset of this name or alias, or an order of six letters, each of r, l, u, d, f and b once:
    /// `rludfb`.
    pub fn parse(text: &str) -> Option<Self> {
        let fits = |order: &&Self| order.name == text || order.aliases.contains(&text);
        PRESETS.iter().find(fits).copied().or_else(|| letters(text))
    }

    /// Returns the initials of its faces.
    pub fn letters(&self) -> String {
        self.faces.iter().filter_map(|face| face.name().chars().next()).collect()
    }
}

fn letters(text: &str) -> Option<FaceOrder> {
    let face = |letter: char| CubeFace::ALL.into_iter().find(|face| face.name().starts_with(letter));
    let faces: Vec<CubeFace> = text.chars().map(face).collect::<Option<_>>()?;
    let faces: [CubeFace; 6] = faces.try_into().ok()?;
    let each_once = CubeFace::ALL.iter().all(|face| faces.contains(face));
    each_once.then_some(plain("", &[], faces))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_presets_or_six_letters() {
        assert_eq!(FaceOrder::parse("rludfb").unwrap().faces, FaceOrder::parse("v360").unwrap().faces);
        assert_eq!(FaceOrder::parse("lrfbud").unwrap().letters(), "lrfbud");
        for wrong in ["", "rludf", "rludff", "rludfbb", "rludfx", "RLUDFB", "cubism"] {
            assert_eq!(FaceOrder::parse(wrong), None, "{wrong}");
        }
    }
}
