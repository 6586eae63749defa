use std::fmt;

use cosmorama::camera::{CameraModel, Canvas, CubeFaceCamera, FaceMapping, LayoutFaceCamera, Mirror, SamplePositions};
use cosmorama::layout::{CubeLayout, FaceOrder, FacePlacement, LayoutKind, Naming};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::Blend;

use super::Shape;
use super::fields::{Fields, samples_name, wrong};
use super::keys::Keys;
use crate::angle::Degrees;
use crate::window::Window;
use crate::{SpecError, did_you_mean};

/// Faces of a cube, in a file each or in one image.
#[derive(Clone, Debug, PartialEq)]
pub struct Cube {
    /// Packing of the faces; `None` if the file's name, metadata or shape decides.
    pub layout: Option<Packing>,
    /// Naming of the files.
    pub naming: Option<&'static Naming>,
    /// Order of the faces in one image.
    pub order: Option<FaceOrder>,
    /// Clockwise quarter turns of each picture, in reading order; for files, in the order `rludfb`.
    pub rotate: Option<[u8; 6]>,
    /// Field of view of a face, from edge to edge.
    pub field_of_view: Angle,
    /// Columns that both halves of an outer face show, where these are stored as halves; 0 where they are whole.
    pub overlap: usize,
    /// Width of the band at its border over which a face fades out, if given.
    pub feather: Option<Angle>,
    /// Face at the middle of half a cube; `None` for a whole cube.
    pub half: Option<CubeFace>,
    /// Position of the outermost samples of a face, if given.
    pub samples: Option<SamplePositions>,
    /// Faces that are used.
    pub faces: Vec<CubeFace>,
    /// Orientation of the cube.
    pub orientation: Orientation,
    /// Mirroring of every picture.
    pub mirror: Mirror,
    /// Canvas of every face.
    pub canvas: Option<Canvas>,
    /// Canvas of single faces.
    pub face_canvas: Vec<(CubeFace, Canvas)>,
}

/// Packing of the faces of a cube in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// One file per face.
    Files,
    /// All faces in one image.
    OneImage(LayoutKind),
}

/// Prints the value of `layout=`.
impl fmt::Display for Packing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Files => "faces",
            Self::OneImage(kind) => kind.name(),
        })
    }
}

impl Default for Cube {
    fn default() -> Self {
        Self {
            layout: None,
            naming: None,
            order: None,
            rotate: None,
            field_of_view: LayoutFaceCamera::RIGHT_ANGLE,
            overlap: 0,
            feather: None,
            half: None,
            samples: None,
            faces: CubeFace::ALL.to_vec(),
            orientation: Orientation::IDENTITY,
            mirror: Mirror::default(),
            canvas: None,
            face_canvas: Vec::new(),
        }
    }
}

/// Makes a cube whose faces lie in one image.
impl From<LayoutKind> for Cube {
    fn from(kind: LayoutKind) -> Self {
        Self { layout: Some(Packing::OneImage(kind)), ..Self::default() }
    }
}

impl Cube {
    /// Returns the canvas of a face.
    pub fn canvas_of(&self, face: CubeFace) -> Option<Canvas> {
        let own = self.face_canvas.iter().find(|(other, _)| *other == face).map(|(_, canvas)| *canvas);
        own.or(self.canvas)
    }

    /// Returns the layout of the faces in one image; `None` for faces in files.
    pub fn one_image(&self) -> Option<CubeLayout> {
        let Some(Packing::OneImage(kind)) = self.layout else { return None };
        let mut layout = CubeLayout::new(kind);
        if let Some(order) = &self.order {
            layout = layout.with_order(order);
        }
        if let Some(turns) = self.rotate {
            layout = layout.with_turns(turns);
        }
        if let Some(half) = self.half {
            layout = layout.with_half(half);
        }
        Some(layout.with_overlap(self.overlap).mirrored(self.mirror))
    }

    /// Returns the placement of the picture in a face's own file, from its naming and `rotate=`.
    pub fn file_placement(&self, face: CubeFace, named: FacePlacement) -> FacePlacement {
        let place = FaceOrder::parse("rludfb").and_then(|order| order.faces.iter().position(|other| *other == face));
        match (self.rotate, place) {
            (Some(turns), Some(place)) => {
                let turned = FacePlacement::turned(turns[place]);
                FacePlacement { quarter_turns: (named.quarter_turns + turned.quarter_turns) % 4, ..named }
            }
            _ => named,
        }
    }

    /// Returns the position of the outermost samples of a face.
    pub fn samples(&self) -> SamplePositions {
        let by_order = self.order.as_ref().map(|order| order.samples);
        let by_naming = self.naming.map(|naming| naming.samples);
        self.samples.or(by_order).or(by_naming).unwrap_or_default()
    }

    /// Returns the camera model of a face.
    pub fn frame(&self) -> CameraModel {
        let mapping = match self.layout {
            Some(Packing::OneImage(kind)) => kind.mapping(),
            Some(Packing::Files) | None => FaceMapping::Perspective,
        };
        let frame = LayoutFaceCamera { mapping, samples: self.samples(), field_of_view: self.field_of_view };
        if frame == LayoutFaceCamera::default() {
            CameraModel::CubeFace(CubeFaceCamera)
        } else {
            CameraModel::LayoutFace(frame)
        }
    }

    /// Returns the blending of overlapping faces: each fades to zero at its own border.
    pub fn blend(&self) -> Blend {
        let shared = self.field_of_view - LayoutFaceCamera::RIGHT_ANGLE;
        let feather = if shared > Angle::ZERO { self.feather.unwrap_or(shared) } else { Angle::ZERO };
        Blend { priority: 0, feather }
    }

    /// Reads the keys of a cube.
    pub(super) fn build(fields: &Fields) -> Result<Self, SpecError> {
        let faces =
            fields.get("faces").map(|list| list.split([',', '+', ' ']).map(|name| face("faces", list, name)).collect());
        let half = fields.get("half").map(|name| face("half", name, name)).transpose()?;
        let cube = Self {
            layout: layout(fields)?,
            naming: naming(fields)?,
            order: order(fields)?,
            rotate: fields.read("rotate", "six quarter turns from 0 to 3, as in rotate=000102", turns)?,
            field_of_view: fields.angle("fov")?.unwrap_or(LayoutFaceCamera::RIGHT_ANGLE),
            overlap: fields.read("overlap", OVERLAP, overlap)?.unwrap_or(0),
            feather: fields.feather()?,
            half,
            samples: fields.samples()?,
            faces: faces.transpose()?.unwrap_or_else(|| CubeFace::ALL.to_vec()),
            orientation: fields.orientation()?,
            mirror: fields.mirror()?,
            canvas: fields.canvas("canvas")?,
            face_canvas: face_canvas(fields)?,
        };
        cube.check(fields)?;
        Ok(cube)
    }

    /// Writes the keys, if the shape is a cube.
    pub(super) fn write(shape: &Shape) -> Option<Keys> {
        let Shape::Cube(cube) = shape else { return None };
        let order = cube.order.map(|order| match order.name {
            "" => order.letters(),
            name => name.to_owned(),
        });
        let rotate = cube.rotate.map(|turns| turns.map(|turn| turn.to_string()).concat());
        let faces: Vec<&str> = cube.faces.iter().map(|face| face.name()).collect();
        let keys = Keys::default()
            .maybe("layout", cube.layout)
            .maybe("naming", cube.naming.map(|naming| naming.name))
            .maybe("order", order)
            .maybe("rotate", rotate)
            .angle("fov", cube.field_of_view, LayoutFaceCamera::RIGHT_ANGLE)
            .maybe("overlap", Some(cube.overlap).filter(|overlap| *overlap > 0))
            .maybe("feather", cube.feather.map(Degrees))
            .maybe("half", cube.half.map(CubeFace::name))
            .maybe("samples", cube.samples.map(samples_name))
            .maybe("faces", Some(faces.join(",")).filter(|_| cube.faces != CubeFace::ALL));
        let keys = cube
            .face_canvas
            .iter()
            .fold(keys, |keys, (face, canvas)| keys.with(format!("canvas.{}", face.name()), Window(*canvas)));
        Some(keys.placed(cube.orientation, cube.mirror, cube.canvas))
    }

    /// Checks that keys are compatible: some apply only to files, others only to a layout in one image.
    fn check(&self, fields: &Fields) -> Result<(), SpecError> {
        let one_image = matches!(self.layout, Some(Packing::OneImage(_))) || self.order.is_some();
        if let (true, Some(naming)) = (one_image, self.naming) {
            return Err(wrong("naming", naming.name, "layout=faces; faces in one image have no names, but an order="));
        }
        if let (Some(Packing::Files), Some(order)) = (self.layout, fields.get("order")) {
            return Err(wrong("order", order, "a layout in one image, such as layout=3x2; files are found by naming="));
        }
        if one_image && (self.canvas.is_some() || !self.face_canvas.is_empty()) {
            return Err(SpecError::Both { first: "canvas", second: "layout" });
        }
        let is_alone = self.field_of_view <= LayoutFaceCamera::RIGHT_ANGLE && self.overlap == 0;
        if let (Some(feather), true) = (fields.get("feather"), is_alone) {
            return Err(wrong("feather", feather, "faces that overlap, as with fov=100; these have nothing to blend"));
        }
        if let Some(overlap) = fields.get("overlap") {
            self.check_overlap(fields, overlap)?;
        }
        if self.half.is_some() && self.samples() == SamplePositions::Edges {
            return Err(SpecError::Both { first: "half", second: "samples=edges" });
        }
        Ok(())
    }
}

/// Value of `overlap=`, in words.
const OVERLAP: &str = "an even number of columns from 2 to 4096, as in overlap=32";

fn overlap(text: &str) -> Option<usize> {
    text.parse().ok().filter(|columns: &usize| (2..=4096).contains(columns) && columns.is_multiple_of(2))
}

impl Cube {
    /// Checks that halves of faces are those of whole faces in a layout with outer columns.
    fn check_overlap(&self, fields: &Fields, overlap: &str) -> Result<(), SpecError> {
        if self.layout != Some(Packing::OneImage(LayoutKind::Eac)) {
            return Err(wrong("overlap", overlap, "layout=eac beside it; in other layouts, faces are whole"));
        }
        match ["half", "fov"].into_iter().find(|key| fields.get(key).is_some()) {
            Some(first) => Err(SpecError::Both { first, second: "overlap" }),
            None => Ok(()),
        }
    }
}

fn layout(fields: &Fields) -> Result<Option<Packing>, SpecError> {
    let own = LayoutKind::ALL.map(|kind| (kind.name(), Packing::OneImage(kind)));
    let choices: Vec<_> = [("faces", Packing::Files)].into_iter().chain(own).collect();
    fields.choice("layout", &choices)
}

fn order(fields: &Fields) -> Result<Option<FaceOrder>, SpecError> {
    let names: Vec<_> = FaceOrder::presets().iter().map(|order| order.name).collect();
    let expected = format!("six letters, each of r, l, u, d, f and b once, as in rludfb, or {}", names.join(", "));
    fields.read("order", &expected, |text| FaceOrder::parse(text).or_else(|| FaceOrder::parse(&letters(text)?)))
}

/// Returns the letters of an order that is given in words, or with `t` for the upper face.
fn letters(text: &str) -> Option<String> {
    match text.split_once([',', '+', ' ']) {
        Some(_) => text.split([',', '+', ' ']).map(|word| named_face(word)?.name().chars().next()).collect(),
        None => Some(text.replace('t', "u")),
    }
}

fn turns(text: &str) -> Option<[u8; 6]> {
    let digits: Vec<u8> = text.chars().map(|c| c.to_digit(4).map(|digit| digit as u8)).collect::<Option<_>>()?;
    digits.try_into().ok()
}

fn naming(fields: &Fields) -> Result<Option<&'static Naming>, SpecError> {
    let known: Vec<&str> = Naming::presets().iter().map(|naming| naming.name).collect();
    let all: Vec<&str> =
        Naming::presets().iter().flat_map(|naming| [&[naming.name], naming.aliases].concat()).collect();
    let expected = |name: &str| format!("one of {}{}", known.join(", "), did_you_mean(name, &all));
    let find = |name: &str| Naming::named(name).ok_or_else(|| wrong("naming", name, expected(name)));
    fields.get("naming").map(find).transpose()
}

fn face_canvas(fields: &Fields) -> Result<Vec<(CubeFace, Canvas)>, SpecError> {
    let mut canvases = Vec::new();
    for (name, value) in fields.with_prefix("canvas.") {
        let key = format!("canvas.{name}");
        if let Some(canvas) = fields.canvas(&key)? {
            canvases.push((face(&key, value, name)?, canvas));
        }
    }
    Ok(canvases)
}

fn face(key: &str, value: &str, name: &str) -> Result<CubeFace, SpecError> {
    named_face(name).ok_or_else(|| {
        wrong(key, value, format!("faces of a cube (front, right, back, left, up, down); '{name}' is none"))
    })
}

/// Finds a face by its name; `top` and `bottom` are accepted for up and down.
fn named_face(name: &str) -> Option<CubeFace> {
    let own = match name.trim() {
        "top" => "up",
        "bottom" => "down",
        name => name,
    };
    CubeFace::ALL.into_iter().find(|face| face.name() == own)
}
