use std::path::{Path, PathBuf};

use cosmorama::sphere::Orientation;
use cosmorama::world::{Canvas, Mirror};

use super::fields::{Fields, wrong};
use super::{Shape, Single, Spec, SpecError};

/// A picture that an st map relates to another one, before the map has been read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StMapSpec {
    /// The map.
    pub(crate) file: PathBuf,
    /// Whether it is used the other way round.
    pub(crate) invert: bool,
    /// What the picture at its other end is, if given.
    pub(crate) base: Option<Single>,
    /// How this picture is turned.
    pub(crate) orientation: Orientation,
    /// How it is mirrored.
    pub(crate) mirror: Mirror,
    /// The canvas that it is a window of.
    pub(crate) canvas: Option<Canvas>,
    /// The files that `base=` names.
    pub(super) base_files: Vec<PathBuf>,
}

impl StMapSpec {
    pub(super) fn build(fields: &Fields) -> Result<Self, SpecError> {
        let file = fields.file("file").filter(|_| fields.get("file") != Some("")).ok_or(SpecError::Missing {
            name: "st-map",
            key: "file",
            example: "st-map:file=undistort.exr",
        })?;
        let base = fields.get("base").map(|text| base(text, fields.folder())).transpose()?;
        let (base, base_files) = base.map_or((None, Vec::new()), |(single, files)| (Some(single), files));
        Ok(Self {
            file,
            invert: fields.choice("invert", &[("yes", true), ("no", false)])?.unwrap_or_default(),
            base,
            base_files,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        })
    }
}

/// A SPEC within a SPEC, whose commas are colons, and the files that it names.
fn base(text: &str, folder: &Path) -> Result<(Single, Vec<PathBuf>), SpecError> {
    let expected = |what: &str| wrong("base", text, what);
    let (name, keys) = text.split_once(':').unwrap_or((text, ""));
    let mut pairs: Vec<String> = Vec::new();
    for part in keys.split(':').filter(|_| !keys.is_empty()) {
        match pairs.last_mut() {
            // A part without `=` goes on with the value before it: `center=983:921`.
            Some(last) if !part.contains('=') => *last = format!("{last}:{part}"),
            _ => pairs.push(part.to_owned()),
        }
    }
    let spec = Spec::parse_in(folder, &format!("{name}:{}", pairs.join(","))).map_err(|error| match error {
        of_file if of_file.is_of_file() => of_file,
        error => wrong("base", text, format!("a SPEC with colons for commas, as in base=perspective:fov=60 ({error})")),
    })?;
    if spec.stereo.is_some() {
        return Err(expected("the picture of one eye, without stereo="));
    }
    match spec.shape {
        Shape::Single(single) if single.placement.canvas.is_none() => Ok((single, spec.files)),
        Shape::Single(_) => Err(expected("a whole picture, without canvas=")),
        Shape::Cube(_) | Shape::Dual(_) | Shape::StMap(_) => {
            Err(expected("the SPEC of one picture that is given by a formula"))
        }
    }
}
