use super::FacePlacement;
use crate::camera::SamplePositions;
use crate::sphere::CubeFace;

/// Names of the six faces in file names, as a tool writes them.
///
/// Axis names follow the tool's own axes. In OpenGL's cube maps, which are left-handed, +Z is the front and +X the
/// right. In OpenEXR's, which are right-handed, +Z is the front and +X the left.
#[derive(Debug, PartialEq, Eq)]
pub struct Naming {
    /// Name in `naming=`.
    pub name: &'static str,
    /// Names of other tools that use these face names.
    pub aliases: &'static [&'static str],
    /// The names, in the order of [`CubeFace::ALL`]: front, right, back, left, up, down.
    pub names: [&'static str; 6],
    /// Placement of each picture, in the same order.
    pub placements: [FacePlacement; 6],
    /// Position of the outermost samples of a face.
    pub samples: SamplePositions,
    /// Whether the preset is tried unless it is named. False where another preset has the same face names with another
    /// meaning, since file names cannot tell them apart.
    pub automatic: bool,
}

const fn upright(name: &'static str, aliases: &'static [&'static str], names: [&'static str; 6]) -> Naming {
    Naming {
        name,
        aliases,
        names,
        placements: [FacePlacement::UPRIGHT; 6],
        samples: SamplePositions::Centres,
        automatic: true,
    }
}

/// Every preset.
static PRESETS: [Naming; 8] = [
    upright("words", &["navegar"], ["front", "right", "back", "left", "top", "bottom"]),
    upright("cosmorama", &["kartavr"], ["front", "right", "back", "left", "up", "down"]),
    upright("bourke", &["cube2dome"], ["f", "r", "b", "l", "t", "d"]),
    upright("pannellum", &["ffmpeg", "v360"], ["f", "r", "b", "l", "u", "d"]),
    upright("opengl", &["posx"], ["posz", "posx", "negz", "negx", "posy", "negy"]),
    upright("px", &["threejs", "vtk"], ["pz", "px", "nz", "nx", "py", "ny"]),
    EXRENVMAP,
    ENVUTIL,
];

/// Placements of OpenEXR's faces: the upper and lower one are drawn as seen from −Z.
const SEEN_FROM_BEHIND: [FacePlacement; 6] = [
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::HALF_TURN,
    FacePlacement::HALF_TURN,
];

/// Names that exrenvmap puts in the place of `%`: the six parts of OpenEXR's cube.
const EXRENVMAP: Naming = Naming {
    name: "exrenvmap",
    aliases: &["openexr"],
    names: ["+Z", "-X", "-Z", "+X", "+Y", "-Y"],
    placements: SEEN_FROM_BEHIND,
    samples: SamplePositions::Edges,
    automatic: true,
};

/// envutil has the face names of `words` and the placements of OpenEXR: its manual says that "top and bottom align with
/// the back image".
const ENVUTIL: Naming = Naming {
    name: "envutil",
    aliases: &["lux"],
    names: ["front", "right", "back", "left", "top", "bottom"],
    placements: SEEN_FROM_BEHIND,
    samples: SamplePositions::Centres,
    automatic: false,
};

impl Naming {
    /// Returns all presets.
    pub fn presets() -> &'static [Self] {
        &PRESETS
    }

    /// Returns the preset of this name or alias.
    pub fn named(name: &str) -> Option<&'static Self> {
        let wanted = name.to_ascii_lowercase();
        PRESETS.iter().find(|naming| naming.name == wanted || naming.aliases.contains(&&*wanted))
    }

    /// Returns the name of a face.
    pub fn face_name(&self, face: CubeFace) -> &'static str {
        self.names[face as usize]
    }

    /// Returns the placement of a face's picture.
    pub fn placement(&self, face: CubeFace) -> FacePlacement {
        self.placements[face as usize]
    }
}
