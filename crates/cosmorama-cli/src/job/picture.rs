use anyhow::Result;
use cosmorama::sphere::CubeFace;
use cosmorama::world::{
    Canvas, CubeLayout, EquirectFrame, FaceOrder, FacePart, Frame, FrameError, LayoutKind, Mirror, PlacedFace,
    Placement, SamplePositions, View,
};
use cosmorama_io::{EnvMap, Format, Naming, Window};

use super::face_view::face_placement;
use crate::args::SizeArg;
use crate::args::convert::GeometryArgs;
use crate::failure::usage;
use crate::spec::{Cube, Packing, Shape, Single, SphereSamples};

/// The geometry of an image to make.
pub(crate) struct Picture {
    /// The face of a cube that it is.
    pub(crate) face: Option<CubeFace>,
    /// The geometry.
    pub(crate) view: View,
    /// Where it lies in an image that it shares with others.
    pub(crate) place: Option<Place>,
    /// What the file says that it is a picture of.
    pub(crate) envmap: Option<EnvMap>,
    /// The panorama of which it is a part or all.
    pub(crate) panorama: Option<Window>,
}

/// A place in an image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// The first column and row.
    pub(crate) corner: (usize, usize),
    /// Columns and rows of the image.
    pub(crate) of: (usize, usize),
}

impl Place {
    /// All of an image.
    pub(crate) fn whole(size: (usize, usize)) -> Self {
        Self { corner: (0, 0), of: size }
    }
}

impl Picture {
    /// The images that `--to`, `--size` and the orientation stand for, in one file of a format, or in files of their own.
    /// Without a size, the centre gets so many pixels a radian.
    pub(crate) fn all(
        geometry: &GeometryArgs,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let pictures = match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Single(single)) => Self::single(single, geometry, format, pixels_per_radian)?,
            Some(Shape::Cube(cube)) => {
                let cube = completed(cube, format);
                match cube.one_image() {
                    Some(layout) => Self::sheet(&cube, &layout, geometry, format, pixels_per_radian)?,
                    None => Self::faces(&cube, geometry, pixels_per_radian)?,
                }
            }
            Some(Shape::StMap(map)) => return Err(super::st_map::unread(map)),
            None => Self::faces(&Cube::default(), geometry, pixels_per_radian)?,
        };
        match format {
            Some(format) if format.is_cube_map() && pictures[0].envmap != Some(EnvMap::GlCube) => Err(usage(format!(
                "{format} files hold the six whole faces of a cube in their own order; expected --to cube",
            ))),
            _ => Ok(pictures),
        }
    }

    fn single(
        single: &Single,
        geometry: &GeometryArgs,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let picture = |view, envmap, panorama| vec![Self { face: None, view, place: None, envmap, panorama }];
        if format == Some(Format::Exr) {
            // OpenEXR's attribute, and its samples on the edges, are for the whole sphere alone.
            let edges = single.with_samples(SamplePositions::Edges);
            let view = single_view(edges, geometry, pixels_per_radian)?;
            if let Some(envmap) = panorama_envmap(&edges).filter(|_| view.covers_sphere()) {
                return Ok(picture(view, Some(envmap), None));
            }
        }
        let view = single_view(*single, geometry, pixels_per_radian)?;
        Ok(picture(view, None, gpano(single, &view)))
    }

    fn faces(cube: &Cube, geometry: &GeometryArgs, pixels_per_radian: Option<f64>) -> Result<Vec<Self>> {
        let (width, height) = size(cube.frame(), geometry.size, pixels_per_radian)?;
        let mut pictures = Vec::new();
        for &face in &cube.faces {
            let lies = cube.file_placement(face, naming(cube).placement(face));
            let Some(part) = FacePart::of(face, lies, cube.half) else { continue };
            let (width, height) = part.size(width, height);
            let canvas = cube.canvas_of(face).or_else(|| cube.half.map(|_| part.canvas(width, height)));
            let placement = face_placement(cube, face, lies, canvas, geometry.orientation());
            let view = placement.view(width, height).map_err(wrong)?;
            pictures.push(Self { face: Some(face), view, place: None, envmap: None, panorama: None });
        }
        check_any(pictures)
    }

    /// The faces of a cube in one image.
    fn sheet(
        cube: &Cube,
        layout: &CubeLayout,
        geometry: &GeometryArgs,
        format: Option<Format>,
        pixels_per_radian: Option<f64>,
    ) -> Result<Vec<Self>> {
        let edge = match geometry.size {
            Some(SizeArg { width, height: Some(height) }) => {
                layout.edge(width, height).map_err(|error| usage(format!("--size: {error}")))?
            }
            edge => size(cube.frame(), edge, pixels_per_radian)?.0,
        };
        let of = layout.size(edge).map_err(|error| usage(format!("--to: {error}")))?;
        let envmap = cube_envmap(cube, format);
        let picture = |placed: PlacedFace| {
            let canvas = Some(placed.canvas);
            let placement = face_placement(cube, placed.face, placed.lies, canvas, geometry.orientation());
            let view = placement.view(placed.rect.width(), placed.rect.height()).map_err(wrong)?;
            let place = Some(Place { corner: (placed.rect.left, placed.rect.top), of });
            Ok(Self { face: Some(placed.face), view, place, envmap, panorama: None })
        };
        let wanted = layout.faces(edge).into_iter().filter(|placed| cube.faces.contains(&placed.face));
        check_any(wanted.map(picture).collect::<Result<_>>()?)
    }
}

fn wrong(error: FrameError) -> anyhow::Error {
    usage(format!("--to: {error}"))
}

fn check_any(pictures: Vec<Picture>) -> Result<Vec<Picture>> {
    if pictures.is_empty() {
        return Err(usage("--to: half= leaves nothing of the faces= that are asked for"));
    }
    Ok(pictures)
}

/// How faces are named and lie, unless told: in words.
pub(super) fn naming(cube: &Cube) -> &'static Naming {
    cube.naming.unwrap_or(&Naming::presets()[0])
}

/// The layout and order that a format has of its own for a cube in one file.
pub(super) fn own_layout(format: Format) -> Option<(LayoutKind, Option<FaceOrder>)> {
    match format {
        Format::Exr => Some((LayoutKind::StripV, Some(FaceOrder::OPENEXR))),
        format if format.is_cube_map() => Some((LayoutKind::StripV, None)),
        _ => None,
    }
}

/// What a format has of its own, where nothing else is asked for.
fn completed(cube: &Cube, format: Option<Format>) -> Cube {
    match (cube.layout, format.and_then(own_layout)) {
        (None, Some((kind, order))) => {
            Cube { layout: Some(Packing::OneImage(kind)), order: cube.order.or(order), ..cube.clone() }
        }
        _ => cube.clone(),
    }
}

fn single_view(single: Single, geometry: &GeometryArgs, pixels_per_radian: Option<f64>) -> Result<View> {
    let Placement { frame, orientation, mirror, canvas } = single.placement;
    if canvas.is_some() && geometry.size.is_none() {
        return Err(usage("--to has canvas=, so the size of the window on it must be given with --size WxH"));
    }
    let (width, height) = size(frame, geometry.size, pixels_per_radian)?;
    let placement = Placement { frame, orientation: orientation.within(geometry.orientation()), mirror, canvas };
    placement.view(width, height).map_err(|error| usage(format!("--to: {error}")))
}

fn size(frame: Frame, given: Option<SizeArg>, pixels_per_radian: Option<f64>) -> Result<(usize, usize)> {
    match (given, pixels_per_radian) {
        (Some(SizeArg { width, height }), _) => Ok((width, height.unwrap_or_else(|| frame.natural_height(width)))),
        (None, Some(pixels)) => frame.size_at(pixels).map_err(|error| match error {
            FrameError::SizeNeeded | FrameError::SizeUnbounded { .. } => {
                usage(format!("--to: {error}, with --size WxH"))
            }
            error => usage(format!("--to: {error}")),
        }),
        (None, None) => Err(usage("--size is missing: without an input, nothing tells how large the output is to be")),
    }
}

/// OpenEXR's environment maps have their samples on the edges and show the whole sphere.
fn panorama_envmap(single: &Single) -> Option<EnvMap> {
    let Frame::Equirect(frame) = single.placement.frame else { return None };
    let whole = frame.horizontal.degrees() > 359.999 && frame.vertical.degrees() > 179.999;
    let by_format = single.samples != SphereSamples::Given(SamplePositions::Centres);
    let upright = single.placement.canvas.is_none() && single.placement.mirror == Mirror::default();
    (whole && by_format && upright).then_some(EnvMap::LatLong)
}

/// Whether six whole faces lie as the format's own cubes have them.
fn cube_envmap(cube: &Cube, format: Option<Format>) -> Option<EnvMap> {
    let (kind, order) = own_layout(format?)?;
    let own = Cube { layout: Some(Packing::OneImage(kind)), order, ..Cube::default() };
    let same = cube.one_image() == own.one_image()
        && cube.samples() == own.samples()
        && cube.mirror == Mirror::default()
        && CubeFace::ALL.iter().all(|face| cube.faces.contains(face));
    let envmap = if format == Some(Format::Exr) { EnvMap::Cube } else { EnvMap::GlCube };
    same.then_some(envmap)
}

/// What GPano metadata say of a panorama of 360°×180°, or of a window of one.
fn gpano(single: &Single, view: &View) -> Option<Window> {
    let Placement { frame, mirror, canvas, .. } = single.placement;
    if frame != Frame::Equirect(EquirectFrame::default()) || mirror != Mirror::default() {
        return None;
    }
    let (width, height) = (view.width(), view.height());
    let canvas = canvas.unwrap_or(Canvas { width, height, left: 0, top: 0 });
    let (x, y) = (usize::try_from(canvas.left).ok()?, usize::try_from(canvas.top).ok()?);
    let inside = x.checked_add(width)? <= canvas.width && y.checked_add(height)? <= canvas.height;
    // Viewers take pixels for square.
    (inside && canvas.width == 2 * canvas.height).then_some(Window {
        canvas_width: canvas.width,
        canvas_height: canvas.height,
        x,
        y,
    })
}
