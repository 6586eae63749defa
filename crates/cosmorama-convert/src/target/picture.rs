use cosmorama::camera::{CameraError, CameraModel, Mirror, Placement, SamplePositions, View};
use cosmorama::layout::{CubeLayout, Eye, FaceOrder, FacePart, LayoutKind};
use cosmorama::sphere::CubeFace;
use cosmorama_io::{EnvMap, Format, Naming, Window};
use cosmorama_spec::{Cube, Dual, Packing, Shape, Single, Size, SphereSamples, StereoSpec};

use crate::diagnostic::{Code, ConvertError, Result, SIZE, TO, usage, usage_as};
use crate::packing::canvas::lies_on_canvas;
use crate::packing::eye::{eye_size, squeezed};
use crate::packing::face_view::face_placement;
use crate::packing::size::{lens_image_size, size};
use crate::packing::{EyePart, Piece, Place};
use crate::settings::GeometrySettings;
use crate::source::unread;
use crate::target::gpano;

/// An image to make, with its geometry and its role.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Face of the cube, if it is one.
    pub face: Option<CubeFace>,
    /// Name of its part in an image that it shares with others, or in a cube.
    pub part: Option<&'static str>,
    /// Eye, if there are two.
    pub eye: Option<Eye>,
    /// Geometry of the image.
    pub view: View,
    /// Place in an image that it shares with others.
    pub place: Option<Place>,
    /// Environment map that the file declares.
    pub envmap: Option<EnvMap>,
    /// Whole panorama of which it is a part, or all.
    pub panorama: Option<Window>,
}

/// Width of a picture whose size is not known.
const PLANNED: usize = 1024;

impl Picture {
    /// Returns the images for `--to`, `--size` and the orientation, in one file of a format or in files of their own.
    /// Without a size, the centre gets so many pixels per radian.
    pub(crate) fn all(
        geometry: &GeometrySettings,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let pictures = match geometry.to.as_ref().and_then(|spec| spec.stereo) {
            Some(stereo) => Self::stereo(stereo, geometry, pixels_per_radian)?,
            None => Self::mono(geometry, format, pixels_per_radian)?,
        };
        match format {
            Some(format) if format.is_cube_map() && pictures[0].envmap != Some(EnvMap::GlCube) => Err(usage(format!(
                "{format} files hold the six whole faces of a cube in their own order; expected {TO} cube",
            ))),
            _ => Ok(pictures),
        }
    }

    /// Lays out the pictures of both eyes, squeezed if the packing requires it.
    fn stereo(stereo: StereoSpec, geometry: &GeometrySettings, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        if let Some(eye) = stereo.eye {
            return Err(usage(format!("{TO}: eye={} is for inputs; an output with stereo= has both eyes", eye.name())));
        }
        let size = geometry.size.map(|size| eye_size(stereo.packing, size)).transpose()?;
        // A format's own layout is for a single picture.
        let one = Self::mono(&GeometrySettings { size, ..geometry.clone() }, None, pixels_per_radian)?;
        let both = Eye::ALL.into_iter().flat_map(|eye| one.iter().map(move |picture| (eye, picture)));
        both.map(|(eye, picture)| eye_picture(EyePart { stereo: stereo.packing, eye }, picture)).collect()
    }

    /// Returns its name in messages; `None` if it is the only one.
    pub fn label(&self) -> Option<String> {
        let eye = self.eye.map(|eye| format!("{}-eye", eye.name()));
        let parts: Vec<String> = eye.into_iter().chain(self.part.map(str::to_owned)).collect();
        (!parts.is_empty()).then(|| parts.join("-"))
    }

    /// Returns the pictures of an output that may have no size yet: then they are 1024 pixels wide.
    ///
    /// # Errors
    /// When there is no projection, or it makes no picture.
    pub fn planned(geometry: &GeometrySettings) -> Result<Vec<Self>> {
        if geometry.to.is_none() {
            return Err(usage_as(
                Code::MissingSetting,
                format!("{TO} is missing: say whose pictures they are, as in {TO} cube:half=up"),
            ));
        }
        let size = geometry.size.or(Some(Size { width: PLANNED, height: None }));
        Self::all(&GeometrySettings { size, ..geometry.clone() }, None, None)
    }

    /// Returns the index of the world that it shows, among so many.
    pub fn world(&self, count: usize) -> usize {
        world_of(self.eye, count)
    }

    fn mono(geometry: &GeometrySettings, format: Option<Format>, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Single(single)) if single.pose => Err(usage(format!(
                "{TO}: pose=yes is for inputs, whose files say how the camera was held; leave it out"
            ))),
            Some(Shape::Single(single)) => Self::single(single, geometry, format, pixels_per_radian),
            Some(Shape::Cube(cube)) => {
                let cube = completed(cube, format);
                match cube.one_image() {
                    Some(layout) => Self::sheet(&cube, &layout, geometry, format, pixels_per_radian),
                    None => Self::faces(&cube, geometry, pixels_per_radian),
                }
            }
            Some(Shape::Dual(dual)) => Self::lenses(dual, geometry, pixels_per_radian),
            Some(Shape::StMap(map)) => Err(unread::st_map(map)),
            Some(Shape::Calibrated(camera)) => Err(unread::calibration(camera)),
            None => Self::faces(&Cube::default(), geometry, pixels_per_radian),
        }
    }

    fn single(
        single: &Single,
        geometry: &GeometrySettings,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let view = single_view(single, geometry, pixels_per_radian)?;
        let envmap = panorama_envmap(single, format).filter(|_| view.covers_sphere());
        let panorama = gpano::window(single, (view.width(), view.height()));
        Ok(vec![Self { envmap, panorama, ..Self::new(view) }])
    }

    fn faces(cube: &Cube, geometry: &GeometrySettings, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        let (width, height) = size(cube.frame(), geometry.size, pixels_per_radian, TO)?;
        let mut pictures = Vec::new();
        for &face in &cube.faces {
            let lies = cube.file_placement(face, naming(cube).placement(face));
            let Some(part) = FacePart::of(face, lies, cube.half) else { continue };
            let (width, height) = part.size(width, height);
            let canvas = cube.canvas_of(face).or_else(|| cube.half.map(|_| part.canvas(width, height)));
            let placement = face_placement(cube, face, lies, canvas, geometry.orientation);
            let view = placement.view(width, height).map_err(wrong)?;
            pictures.push(Self { face: Some(face), part: Some(face.name()), ..Self::new(view) });
        }
        check_any(pictures)
    }

    /// Lays out the faces of a cube in one image.
    fn sheet(
        cube: &Cube,
        layout: &CubeLayout,
        geometry: &GeometrySettings,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let edge = match geometry.size {
            Some(Size { width, height: Some(height) }) => {
                layout.edge(width, height).map_err(|error| usage(format!("{SIZE}: {error}")))?
            }
            edge => size(cube.frame(), edge, pixels_per_radian, TO)?.0,
        };
        let of = layout.size(edge).map_err(|error| usage(format!("{TO}: {error}")))?;
        let envmap = cube_envmap(cube, format);
        let pieces = Piece::faces(cube, layout, edge);
        let pictures = pieces.iter().map(|piece| Ok(Self { envmap, ..Self::of(piece, of, geometry)? }));
        check_any(pictures.collect::<Result<_>>()?)
    }

    /// Lays out two fisheyes in one image.
    fn lenses(dual: &Dual, geometry: &GeometrySettings, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        let of = lens_image_size(dual, geometry.size, pixels_per_radian, TO)?;
        let pieces = Piece::lenses(dual, of).map_err(|error| usage(format!("{TO}: {error}")))?;
        pieces.iter().map(|piece| Self::of(piece, of, geometry)).collect()
    }

    fn of(piece: &Piece, of: (usize, usize), geometry: &GeometrySettings) -> Result<Self> {
        let view = piece.view(geometry.orientation).map_err(wrong)?;
        let place = Some(Place { corner: (piece.rect.left, piece.rect.top), of });
        Ok(Self { face: piece.face, part: Some(piece.name), place, ..Self::new(view) })
    }

    fn new(view: View) -> Self {
        Self { face: None, part: None, eye: None, view, place: None, envmap: None, panorama: None }
    }
}

/// Returns the index of the world that an eye sees, among so many.
pub(crate) fn world_of(eye: Option<Eye>, count: usize) -> usize {
    if eye == Some(Eye::Right) { count.saturating_sub(1) } else { 0 }
}

fn wrong(error: CameraError) -> ConvertError {
    usage(format!("{TO}: {error}"))
}

fn check_any(pictures: Vec<Picture>) -> Result<Vec<Picture>> {
    if pictures.is_empty() {
        return Err(usage(format!("{TO}: half= leaves nothing of the faces= that are asked for")));
    }
    Ok(pictures)
}

/// Returns the naming of faces: in words, unless given.
pub(crate) fn naming(cube: &Cube) -> &'static Naming {
    cube.naming.unwrap_or(&Naming::presets()[0])
}

/// Returns the layout of the cubes that files of a format hold where no layout is given.
pub(crate) fn own_layout(format: Format) -> Option<LayoutKind> {
    (format == Format::Exr || format.is_cube_map()).then_some(LayoutKind::StripV)
}

/// Completes a cube by the format's own layout, unless another is given. In OpenEXR, faces with samples on the edges are
/// those of its environment map.
fn completed(cube: &Cube, format: Option<Format>) -> Cube {
    let Some((format, kind)) = format.and_then(|format| Some((format, own_layout(format)?))) else {
        return cube.clone();
    };
    if cube.layout.is_some() {
        return cube.clone();
    }
    let is_environment = format == Format::Exr && cube.samples == Some(SamplePositions::Edges);
    let order = cube.order.or(is_environment.then_some(FaceOrder::OPENEXR));
    Cube { layout: Some(Packing::OneImage(kind)), order, ..cube.clone() }
}

fn single_view(single: &Single, geometry: &GeometrySettings, pixels_per_radian: Option<f64>) -> Result<View> {
    let Placement { frame, orientation, mirror, canvas } = single.placement.clone();
    if canvas.is_some() && geometry.size.is_none() {
        return Err(usage(format!("{TO} has canvas=, so the size of the window on it must be given with {SIZE} WxH")));
    }
    let (width, height) = size(frame.clone(), geometry.size, pixels_per_radian, TO)?;
    if let Some(canvas) = canvas {
        lies_on_canvas(TO, (width, height), canvas)?;
    }
    let placement = Placement { frame, orientation: orientation.within(geometry.orientation), mirror, canvas };
    placement.view(width, height).map_err(|error| usage(format!("{TO}: {error}")))
}

/// Returns OpenEXR's environment map for a whole panorama whose SPEC puts the samples on the edges, as that attribute means.
fn panorama_envmap(single: &Single, format: Option<Format>) -> Option<EnvMap> {
    let CameraModel::Equirect(frame) = single.placement.frame else { return None };
    let whole = frame.horizontal.degrees() > 359.999 && frame.vertical.degrees() > 179.999;
    let on_edges = single.samples == SphereSamples::Given(SamplePositions::Edges);
    let upright = single.placement.canvas.is_none() && single.placement.mirror == Mirror::default();
    (format == Some(Format::Exr) && whole && on_edges && upright).then_some(EnvMap::LatLong)
}

/// Returns the format's own environment map, if six whole faces lie as it requires.
fn cube_envmap(cube: &Cube, format: Option<Format>) -> Option<EnvMap> {
    let format = format?;
    let (order, envmap) = match format {
        Format::Exr => (Some(FaceOrder::OPENEXR), EnvMap::Cube),
        _ => (None, EnvMap::GlCube),
    };
    let own = Cube { layout: Some(Packing::OneImage(own_layout(format)?)), order, ..Cube::default() };
    let lies_as =
        |own: &Cube| cube.one_image() == own.one_image() && cube.frame() == own.frame() && cube.mirror == own.mirror;
    let mirrored = Cube { order: FaceOrder::parse("lrudfb"), mirror: Mirror { x: true, y: false }, ..own.clone() };
    // Programs that look textures up by directions of a right-handed frame want them mirrored.
    let same = lies_as(&own) || (envmap == EnvMap::GlCube && lies_as(&mirrored));
    let is_whole = CubeFace::ALL.iter().all(|face| cube.faces.contains(face));
    (same && is_whole).then_some(envmap)
}

/// Places the picture of an eye in an image for both.
fn eye_picture(part: EyePart, picture: &Picture) -> Result<Picture> {
    let size = (picture.view.width(), picture.view.height());
    let Place { corner, of } = picture.place.unwrap_or(Place::whole(size));
    let (rect, of) = part.rect(corner, size, of)?;
    Ok(Picture {
        eye: Some(part.eye),
        view: squeezed(picture.view.clone(), part.stereo.squeeze())?,
        place: Some(Place { corner: (rect.left, rect.top), of }),
        envmap: None,
        panorama: None,
        ..picture.clone()
    })
}
