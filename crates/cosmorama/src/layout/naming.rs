use super::FacePlacement;
use crate::camera::SamplePositions;
use crate::sphere::CubeFace;

/// How a tool names the six faces in file names.
///
/// Axis names follow the tool's own axes: in OpenGL's cube maps, which are left-handed, +Z is the front and +X
/// the right; in OpenEXR's, which are right-handed, +Z, the middle of its panoramas, is the front and +X the left.
#[derive(Debug, PartialEq, Eq)]
pub struct Naming {
    /// What `naming=` calls it.
    pub name: &'static str,
    /// Other tools whose names are the same.
    pub aliases: &'static [&'static str],
    /// The names, in the order of [`CubeFace::ALL`]: front, right, back, left, up, down.
    pub names: [&'static str; 6],
    /// How the pictures lie, in the same order.
    pub placements: [FacePlacement; 6],
    /// Where the outermost samples of a face lie.
    pub samples: SamplePositions,
    /// Whether files are tried against it unasked. Not where another preset has the same names and another
    /// meaning: file names cannot tell.
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

/// OpenEXR's upper and lower faces lie as seen from −Z.
const SEEN_FROM_BEHIND: [FacePlacement; 6] = [
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::UPRIGHT,
    FacePlacement::HALF_TURN,
    FacePlacement::HALF_TURN,
];

/// What exrenvmap writes and reads where a name has a `%`: the six parts of OpenEXR's cube.
const EXRENVMAP: Naming = Naming {
    name: "exrenvmap",
    aliases: &["openexr"],
    names: ["+Z", "-X", "-Z", "+X", "+Y", "-Y"],
    placements: SEEN_FROM_BEHIND,
    samples: SamplePositions::Edges,
    automatic: true,
};

/// envutil's names are those of `words`, but its front is OpenEXR's +Z, and its upper and lower faces lie as those do: "top
/// and bottom align with the back image", says its manual.
const ENVUTIL: Naming = Naming {
    name: "envutil",
    aliases: &["lux"],
    names: ["front", "right", "back", "left", "top", "bottom"],
    placements: SEEN_FROM_BEHIND,
    samples: SamplePositions::Centres,
    automatic: false,
};

impl Naming {
    /// Every preset.
    pub fn presets() -> &'static [Self] {
        &PRESETS
    }

    /// The preset of this name or alias.
    pub fn named(name: &str) -> Option<&'static Self> {
        let wanted = name.to_ascii_lowercase();
        PRESETS.iter().find(|naming| naming.name == wanted || naming.aliases.contains(&&*wanted))
    }

    /// What this preset calls a face.
    pub fn face_name(&self, face: CubeFace) -> &'static str {
        self.names[face as usize]
    }

    /// How the picture of a face lies.
    pub fn placement(&self, face: CubeFace) -> FacePlacement {
        self.placements[face as usize]
    }
}
