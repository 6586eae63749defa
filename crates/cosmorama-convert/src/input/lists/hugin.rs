//! Hugin projects: each picture is a view, and the p-line is the default output.

use std::path::Path;

use cosmorama::camera::{
    CameraModel, Canvas, HuginCamera, HuginProjection, Mirror, PixelPoint, Placement, WorldMapCamera,
};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama::world::{Blend, MaskShape};
use cosmorama_io::{PtoImage, PtoPanorama};
use cosmorama_spec::{Shape, Single, Size, Spec, SphereSamples};

use crate::diagnostic::{Code, Diagnostic, InPlace, Result, SIZE, TO, failure, usage};
use crate::input::{Input, InputView, Listed};
use crate::packing::Place;
use crate::settings::GeometrySettings;
use crate::source::{Access, Name, ViewFiles};

/// Degrees over which pictures of a project blend.
const FEATHER: f64 = 3.0;

/// Returns whether an input names a Hugin project.
pub(crate) fn is_project(pattern: &Name) -> bool {
    Path::new(pattern).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pto"))
}

/// Finds and probes the pictures of a project.
pub(crate) fn find(name: &Name, access: Access, warnings: &mut Vec<Diagnostic>) -> Result<Input> {
    let project = access.read_project(Path::new(name))?;
    let told = |warning| Diagnostic::warning(Code::Project, format!("{name}: {warning}")).about(name);
    warnings.extend(project.warnings.iter().map(told));
    let folder = Path::new(name).parent().unwrap_or(Path::new(""));
    let view = |image: &PtoImage| view(folder, image, access).at(|| format!("{name}, line {}", image.line));
    let views = project.images.iter().map(view).collect::<Result<_>>()?;
    Ok(Input { worlds: vec![views], frames: vec![None], faces: None, beside: vec![name.into()] })
}

/// Returns each picture of a project by itself.
pub(crate) fn listed(name: &Name, access: Access, warnings: &mut Vec<Diagnostic>) -> Result<Vec<Listed>> {
    let images = access.read_project(Path::new(name))?.images;
    let views = find(name, access, warnings)?.worlds.into_iter().flatten();
    let list = |(image, view): (PtoImage, InputView)| Listed {
        image: image.file.display().to_string(),
        place: format!("{name}, line {}", image.line),
        spec: Some(format!("f{} v{}", image.lens, image.field_of_view)),
        input: Input { worlds: vec![vec![view]], frames: vec![None], faces: None, beside: Vec::new() },
    };
    Ok(images.into_iter().zip(views).map(list).collect())
}

/// Completes projection and size from a project's p-line, where they are not given.
pub(crate) fn complete(input: &Name, geometry: &GeometrySettings, access: Access) -> Result<GeometrySettings> {
    let mut geometry = geometry.clone();
    if !is_project(input) || geometry.to.is_some() {
        return Ok(geometry);
    }
    let Some(panorama) = access.read_project(Path::new(input))?.panorama else { return Ok(geometry) };
    let told = |reason: String| failure!(Unsupported: "{input}, line {}: {reason}", panorama.line);
    let frame = output_frame(&panorama).map_err(told)?;
    let (width, height) = panorama.size;
    let (size, canvas) = match panorama.crop {
        None => (panorama.size, None),
        Some([left, right, top, bottom]) => {
            let side = |from: i64, to: i64| (to - from).unsigned_abs() as usize;
            ((side(left, right), side(top, bottom)), Some(Canvas { width, height, left, top }))
        }
    };
    geometry.size = Some(match geometry.size {
        None => Size { width: size.0, height: Some(size.1) },
        Some(_) if canvas.is_some() => {
            return Err(usage(format!(
                "{input} makes a part of a panorama (S in its p-line); leave out {SIZE}, or give {TO}"
            )));
        }
        // A panorama of another size is this one scaled.
        Some(Size { width: wide, height: None }) => {
            Size { width: wide, height: Some((wide * height).div_ceil(width).max(1)) }
        }
        Some(whole) => whole,
    });
    let placement = Placement { canvas, ..Placement::new(frame) };
    let shape = Shape::Single(Single { placement, samples: SphereSamples::NotAPanorama, any_shape: true, pose: false });
    geometry.to = Some(Spec { name: "the p-line", shape, stereo: None, files: Vec::new() });
    Ok(geometry)
}

fn view(folder: &Path, image: &PtoImage, access: Access) -> Result<InputView> {
    let path = folder.join(&image.file);
    let whole = access.probe(&path)?;
    let (width, height) = image.size;
    if (whole.width, whole.height) != image.size {
        let found = format!("{}x{}", whole.width, whole.height);
        return Err(
            failure!(WrongSize: "{} has {found} pixels, but the project says w{width} h{height}", path.display()),
        );
    }
    let frame = HuginCamera {
        projection: lens(image.lens)?,
        field_of_view: Angle::from_degrees(image.field_of_view),
        correction: image.correction,
        shift: image.shift,
    };
    let [yaw, pitch, roll] = image.yaw_pitch_roll.map(Angle::from_degrees);
    let orientation = Orientation::from_yaw_pitch_roll(yaw, pitch, roll);
    let placement =
        |canvas| Placement { frame: CameraModel::Hugin(frame), orientation, mirror: Mirror::default(), canvas };
    let Part { corner, size } = Part::of(image)?;
    let shapes = shapes(image);
    let mask = if shapes.is_empty() {
        None
    } else {
        Some(crate::input::lists::mask::of_shapes(&shapes, corner, size, access)?)
    };
    let canvas = Canvas { width, height, left: corner.0 as i64, top: corner.1 as i64 };
    let held = placement(Some(canvas)).view(size.0, size.1)?;
    Ok(InputView {
        name: image.file.display().to_string(),
        files: ViewFiles::One(path),
        part: (size != image.size).then_some(Place { corner, of: image.size }),
        header: Some(cosmorama_io::Header { width: size.0, height: size.1, ..whole }),
        // What was cropped away is not there, as if it had never been photographed.
        nominal: held.clone(),
        window: Some((held, Canvas { width: size.0, height: size.1, left: 0, top: 0 })),
        blend: Blend { priority: 0, feather: Angle::from_degrees(FEATHER) },
        mask,
        wanted: true,
    })
}

/// Visible part of a picture.
struct Part {
    corner: (usize, usize),
    size: (usize, usize),
}

impl Part {
    fn of(image: &PtoImage) -> Result<Self> {
        let (width, height) = image.size;
        let Some([left, right, top, bottom]) = image.crop else {
            return Ok(Self { corner: (0, 0), size: image.size });
        };
        let inside = |at: i64, size: usize| at.clamp(0, size as i64) as usize;
        let (left, right) = (inside(left, width), inside(right, width));
        let (top, bottom) = (inside(top, height), inside(bottom, height));
        if left >= right || top >= bottom {
            return Err(failure!(Malformed: "S leaves nothing of the picture's {width}x{height} pixels"));
        }
        Ok(Self { corner: (left, top), size: (right - left, bottom - top) })
    }
}

/// Returns the shapes of a picture's masks and of a round crop.
fn shapes(image: &PtoImage) -> Vec<MaskShape> {
    let hole =
        |corners: &Vec<[f64; 2]>| MaskShape::Hole(corners.iter().map(|[x, y]| PixelPoint::new(*x, *y)).collect());
    let circle = image.crop.filter(|_| image.lens == CIRCULAR).map(|[left, right, top, bottom]| MaskShape::Circle {
        centre: PixelPoint::new((left + right) as f64 / 2.0, (top + bottom) as f64 / 2.0),
        radius: (right - left).min(bottom - top) as f64 / 2.0,
    });
    image.holes.iter().map(hole).chain(circle).collect()
}

/// Lens number of a fisheye with a round crop.
const CIRCULAR: u32 = 2;

/// Returns the lens of an i-line's f.
fn lens(f: u32) -> Result<HuginProjection> {
    HuginProjection::of_lens(f).ok_or_else(|| {
        let name = match f {
            7 => " (mirror)",
            9 => " (Lambert azimuthal)",
            20 => " (Thoby)",
            _ => "",
        };
        failure!(Unsupported: "the lens f{f}{name} is not supported; there are f0, f1, f2, f3, f4, f8, f10 and f21")
    })
}

/// Returns the camera model of the p-line's f.
fn output_frame(panorama: &PtoPanorama) -> Result<CameraModel, String> {
    let field_of_view = Angle::from_degrees(panorama.field_of_view);
    let f = panorama.projection;
    let Some(projection) = HuginProjection::of_panorama(f) else {
        return match (f, is_whole_world(panorama)) {
            (7, true) => Ok(CameraModel::WorldMap(WorldMapCamera::Sinusoidal)),
            (21, true) => Ok(CameraModel::WorldMap(WorldMapCamera::Hammer)),
            _ => Err(format!("the panorama's projection f{f} is not supported as it is; give {TO} SPEC and {SIZE}")),
        };
    };
    Ok(CameraModel::Hugin(HuginCamera { projection, field_of_view, correction: [0.0; 3], shift: [0.0; 2] }))
}

/// Returns whether the panorama is the whole world, as maps of the world must be.
fn is_whole_world(panorama: &PtoPanorama) -> bool {
    let (width, height) = panorama.size;
    panorama.field_of_view >= 360.0 && width == 2 * height
}
