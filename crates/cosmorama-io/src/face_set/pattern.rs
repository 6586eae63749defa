use std::path::Path;

use cosmorama::sphere::CubeFace;

use super::Naming;

/// A file name with a placeholder for the face's name: `{face}`, or `%c` as in Bourke's tools.
///
/// Every placeholder is replaced, so that a folder may be named by the face, too. Frame markers (`####`, `%04d`,
/// `@@@@`) are kept.
///
/// ```
/// use cosmorama_io::{FacePattern, Naming};
/// use cosmorama::sphere::CubeFace;
/// let pattern = FacePattern::parse("%c/frame_%c_%04d.tga").unwrap();
/// let naming = Naming::named("bourke").unwrap();
/// assert_eq!(pattern.name(naming, LetterCase::Lower, CubeFace::Up), "t/frame_t_%04d.tga");
/// # use cosmorama_io::LetterCase;
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FacePattern(String);

const MARKERS: [&str; 2] = ["{face}", "%c"];

impl FacePattern {
    /// Parses a file name; `None` if it has no placeholder for a face.
    pub fn parse(text: &str) -> Option<Self> {
        MARKERS.iter().any(|marker| text.contains(marker)).then(|| Self(text.to_owned()))
    }

    /// Returns the pattern as it was typed.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Builds the file name (or frame pattern) of a face.
    pub fn name(&self, naming: &Naming, case: LetterCase, face: CubeFace) -> String {
        let name = case.apply(naming.face_name(face));
        MARKERS.iter().fold(self.0.clone(), |text, marker| text.replace(marker, &name))
    }

    /// Returns the folder above the first part that varies with the face.
    pub(crate) fn folder(&self) -> &Path {
        let varying = |path: &Path| MARKERS.iter().any(|marker| path.to_string_lossy().contains(marker));
        let folder = Path::new(&self.0).ancestors().find(|path| !varying(path)).unwrap_or(Path::new(""));
        if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
    }
}

/// Case of a face's name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LetterCase {
    /// As in the preset: `front`.
    #[default]
    Lower,
    /// Capitalised: `Front`.
    Capitalised,
    /// In capitals: `FRONT`.
    Upper,
}

impl LetterCase {
    /// All three cases.
    pub const ALL: [Self; 3] = [Self::Lower, Self::Capitalised, Self::Upper];

    /// Spells a name in this case.
    pub fn apply(self, name: &str) -> String {
        match self {
            Self::Lower => name.to_owned(),
            Self::Upper => name.to_uppercase(),
            Self::Capitalised => {
                let mut letters = name.chars();
                letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
            }
        }
    }
}
