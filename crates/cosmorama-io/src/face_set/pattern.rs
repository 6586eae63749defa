use std::path::Path;

use cosmorama::sphere::CubeFace;

use super::Naming;

/// A file name in which the name of a face stands: `{face}`, or `%c` as Bourke's tools write it.
///
/// Every one of them is replaced, so that the face may also name a folder; frame markers (`####`, `%04d`, `@@@@`)
/// stay as they are.
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
    /// Parses a file name; `None` where no face stands in it.
    pub fn parse(text: &str) -> Option<Self> {
        MARKERS.iter().any(|marker| text.contains(marker)).then(|| Self(text.to_owned()))
    }

    /// Returns the pattern as it was written.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Builds the file name (or frame pattern) of a face.
    pub fn name(&self, naming: &Naming, case: LetterCase, face: CubeFace) -> String {
        let name = case.apply(naming.face_name(face));
        MARKERS.iter().fold(self.0.clone(), |text, marker| text.replace(marker, &name))
    }

    /// The folder above the first part that varies with the face.
    pub(crate) fn folder(&self) -> &Path {
        let varying = |path: &Path| MARKERS.iter().any(|marker| path.to_string_lossy().contains(marker));
        let folder = Path::new(&self.0).ancestors().find(|path| !varying(path)).unwrap_or(Path::new(""));
        if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
    }
}

/// Spelling of a face's name in capital or small letters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LetterCase {
    /// As the preset has them: `front`.
    #[default]
    Lower,
    /// `Front`.
    Capitalised,
    /// `FRONT`.
    Upper,
}

impl LetterCase {
    /// Every spelling.
    pub const ALL: [Self; 3] = [Self::Lower, Self::Capitalised, Self::Upper];

    /// Spells a name.
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
