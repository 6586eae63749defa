use std::path::{Path, PathBuf};

use cosmorama::camera::{Canvas, Mirror};
use cosmorama::sphere::Orientation;

use crate::SpecError;
use crate::spec::fields::{Fields, wrong};
use crate::spec::keys::Keys;
use crate::spec::{CalibrationSpec, Shape, Single, Spec};

/// A picture that an st map relates to another one, before the map has been read.
#[derive(Clone, Debug, PartialEq)]
pub struct StMapSpec {
    /// File of the map.
    pub file: PathBuf,
    /// Whether the map is used in the opposite direction.
    pub invert: bool,
    /// Picture at the map's other end, if given.
    pub base: Option<StMapBase>,
    /// Orientation of this picture.
    pub orientation: Orientation,
    /// Mirroring of this picture.
    pub mirror: Mirror,
    /// Canvas of which this picture is a window.
    pub canvas: Option<Canvas>,
}

/// Picture at the other end of an st map.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a conversion holds two of them at most")]
pub enum StMapBase {
    /// A picture whose projection is a formula.
    Single(Single),
    /// A calibrated camera, whose file is still to be read.
    Calibrated(CalibrationSpec),
}

impl StMapSpec {
    pub(in crate::spec) fn build(fields: &Fields) -> Result<Self, SpecError> {
        let file = fields.file("file").filter(|_| fields.get("file") != Some("")).ok_or(SpecError::Missing {
            name: "st-map",
            key: "file",
            example: "st-map:file=undistort.exr",
        })?;
        let base = fields.get("base").map(|text| base(text, fields.folder())).transpose()?;
        Ok(Self {
            file,
            invert: fields.choice("invert", &[("yes", true), ("no", false)])?.unwrap_or_default(),
            base,
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
        })
    }
}

impl StMapSpec {
    /// Writes the keys, if the shape is an st map.
    pub(in crate::spec) fn write(shape: &Shape) -> Option<Keys> {
        let Shape::StMap(map) = shape else { return None };
        let base = map.base.clone().map(|base| base.spec().to_string().replace(',', ":"));
        let keys = Keys::default().with("file", map.file.display()).switch("invert", map.invert).maybe("base", base);
        Some(keys.placed(map.orientation, map.mirror, map.canvas))
    }

    /// Returns the file that `base=` names, if any.
    pub(in crate::spec) fn base_file(&self) -> Option<&PathBuf> {
        match &self.base {
            Some(StMapBase::Calibrated(camera)) => Some(&camera.file),
            Some(StMapBase::Single(_)) | None => None,
        }
    }
}

impl StMapBase {
    /// Returns the SPEC of the picture at the map's other end.
    fn spec(self) -> Spec {
        match self {
            Self::Single(single) => Shape::Single(single).into(),
            Self::Calibrated(camera) => Shape::Calibrated(camera).into(),
        }
    }
}

/// Parses a SPEC within a SPEC, whose commas are colons.
fn base(text: &str, folder: &Path) -> Result<StMapBase, SpecError> {
    let expected = |what: &str| wrong("base", text, what);
    let (name, keys) = text.split_once(':').unwrap_or((text, ""));
    let mut pairs: Vec<String> = Vec::new();
    for part in keys.split(':').filter(|_| !keys.is_empty()) {
        match pairs.last_mut() {
            // A part without `=` continues the value before it: `center=983:921`.
            Some(last) if !part.contains('=') => *last = format!("{last}:{part}"),
            _ => pairs.push(part.to_owned()),
        }
    }
    let spec = Spec::parse_in(folder, &format!("{name}:{}", pairs.join(","))).map_err(|error| {
        wrong("base", text, format!("a SPEC with colons for commas, as in base=perspective:fov=60 ({error})"))
    })?;
    if spec.stereo.is_some() {
        return Err(expected("the picture of one eye, without stereo="));
    }
    let (base, canvas) = match spec.shape {
        Shape::Single(single) => {
            let canvas = single.placement.canvas;
            (StMapBase::Single(single), canvas)
        }
        Shape::Calibrated(camera) => {
            let canvas = camera.canvas;
            (StMapBase::Calibrated(camera), canvas)
        }
        Shape::Cube(_) | Shape::Dual(_) | Shape::StMap(_) => {
            return Err(expected("the SPEC of one picture that is given by a formula"));
        }
    };
    match canvas {
        None => Ok(base),
        Some(_) => Err(expected("a whole picture, without canvas=")),
    }
}
