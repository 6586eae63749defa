//! St maps as projections: reads the map, and finds the picture that it relates to.

use std::path::Path;

use cosmorama::camera::{CameraModel, FieldOfView, Mirror, PerspectiveCamera, Placement, StMapCamera};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_io::{Header, StPairs};
use cosmorama_spec::{Shape, Single, Size, Spec, SphereSamples, StMapBase, StMapSpec};

use crate::diagnostic::{Code, ConvertError, Diagnostic, FROM, Mark, Result, TO, failure, usage, usage_as};
use crate::input::lists::hugin;
use crate::input::spec_files::calibration::read_calibrations;
use crate::settings::GeometrySettings;
use crate::source::{Access, Name, ViewFiles, wanted_frames};

/// Side of a conversion for which a map is given.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Input,
    Output,
}

/// Picture at the other end of a map, with its size where known.
struct Base {
    placement: Placement,
    size: Option<(usize, usize)>,
}

/// Completes the settings from a Hugin project, if no projection is given, and reads the maps of `--from` and `--to`.
///
/// Without `base=` a map relates the two sides of the conversion to each other. A side that is not given is then a
/// plain picture, and the output has the size of the map unless `--size` gives another.
pub(crate) fn settled(
    geometry: &GeometrySettings,
    input: Option<&Name>,
    access: Access,
    warnings: &mut Vec<Diagnostic>,
) -> Result<GeometrySettings> {
    let geometry = &GeometrySettings {
        from: calibrated(&geometry.from, Side::Input, access)?,
        to: calibrated(&geometry.to, Side::Output, access)?,
        ..geometry.clone()
    };
    let mut settled = match input {
        Some(input) => hugin::complete(input, geometry, access)?,
        None => geometry.clone(),
    };
    if let (Some(Shape::StMap(StMapSpec { invert: false, file, .. })), None) = (shape(&geometry.to), geometry.size) {
        // The output has the map's pixels.
        let (width, height) = canvas_size(&access.probe_pairs(file)?);
        settled.size = Some(Size { width, height: Some(height) });
    }
    match (shape(&geometry.from), shape(&geometry.to)) {
        (Some(Shape::StMap(from)), Some(Shape::StMap(to))) => {
            settled.from = Some(with_given_base(from, Side::Input, access)?);
            settled.to = Some(with_given_base(to, Side::Output, access)?);
        }
        (Some(Shape::StMap(from)), _) if from.base.is_some() => {
            settled.from = Some(with_given_base(from, Side::Input, access)?);
        }
        (_, Some(Shape::StMap(to))) if to.base.is_some() => {
            settled.to = Some(with_given_base(to, Side::Output, access)?);
        }
        (Some(Shape::StMap(from)), None) if is_plain(from) => apply_plainly(&mut settled, from, input, access)?,
        (Some(Shape::StMap(from)), to) => {
            if to.is_some() {
                let message = format!(
                    "{FROM} st-map has no base=: {} is taken to relate the input to the picture of {TO}",
                    from.file.display()
                );
                warnings.push(Diagnostic::warning(Code::MapBase, message).about(from.file.display()));
            }
            settle_from(&mut settled, from, to, access)?;
        }
        (from, Some(Shape::StMap(to))) => settle_to(&mut settled, to, from, input, access)?,
        _ => {}
    }
    Ok(settled)
}

/// Applies a map alone: the output has the map's pixels, and is empty where the map has no place.
fn apply_plainly(settled: &mut GeometrySettings, from: &StMapSpec, input: Option<&Name>, access: Access) -> Result<()> {
    let Some(input) = input else { return Err(without_base(Side::Input)) };
    let pairs = read(&from.file, access)?;
    settled.size.get_or_insert_with(|| size_of(&pairs));
    let Shape::Single(single) = plain().shape else { return Err(without_base(Side::Input)) };
    let base = Base { placement: single.placement, size: Some(input_size(input, access)?) };
    settled.to = Some(spec(from, &pairs, base, Side::Output, access)?);
    settled.from = Some(plain());
    Ok(())
}

/// Completes a map of `--from`, which relates the input to the picture of `--to`.
fn settle_from(settled: &mut GeometrySettings, from: &StMapSpec, to: Option<&Shape>, access: Access) -> Result<()> {
    let pairs = read(&from.file, access)?;
    let size = settled.size.get_or_insert_with(|| size_of(&pairs));
    let other = other_side(to, Side::Input)?;
    let height = size.height.unwrap_or_else(|| other.frame.natural_height(size.width));
    let base = Base { placement: other, size: Some((size.width, height)) };
    settled.from = Some(spec(from, &pairs, base, Side::Input, access)?);
    settled.to.get_or_insert_with(plain);
    Ok(())
}

/// Completes a map of `--to`, which relates the output to the picture of `--from`.
fn settle_to(
    settled: &mut GeometrySettings,
    to: &StMapSpec,
    from: Option<&Shape>,
    input: Option<&Name>,
    access: Access,
) -> Result<()> {
    let pairs = read(&to.file, access)?;
    settled.size.get_or_insert_with(|| size_of(&pairs));
    let Some(input) = input else { return Err(without_base(Side::Output)) };
    let base = Base { placement: other_side(from, Side::Output)?, size: Some(input_size(input, access)?) };
    settled.to = Some(spec(to, &pairs, base, Side::Output, access)?);
    settled.from.get_or_insert_with(plain);
    Ok(())
}

/// Reads the st map of a view in a world file.
pub(crate) fn read_map(spec: Spec, access: Access) -> Result<Spec> {
    let Shape::StMap(map) = &spec.shape else { return Ok(spec) };
    with_given_base(map, Side::Input, access)
}

/// Reads the calibration of a SPEC.
fn calibrated(spec: &Option<Spec>, side: Side, access: Access) -> Result<Option<Spec>> {
    let read =
        |spec| read_calibrations(spec, access).map_err(|error| error.after(&format!("{} <SPEC>: ", option(side))));
    spec.clone().map(read).transpose()
}

/// Returns whether a map is applied alone, without a declaration of the input.
fn is_plain(map: &StMapSpec) -> bool {
    !map.invert && map.orientation == Orientation::IDENTITY && map.mirror == Mirror::default() && map.canvas.is_none()
}

fn shape(spec: &Option<Spec>) -> Option<&Shape> {
    spec.as_ref().map(|spec| &spec.shape)
}

fn option(side: Side) -> Mark {
    match side {
        Side::Input => FROM,
        Side::Output => TO,
    }
}

fn without_base(side: Side) -> ConvertError {
    usage_as(
        Code::MissingSetting,
        format!(
            "{} st-map needs base=, the projection of the picture at the map's other end, as in base=perspective:fov=60",
            option(side)
        ),
    )
}

/// Returns a plain picture: a pinhole camera so narrow that directions form a plane.
fn plain() -> Spec {
    let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(1.0)));
    let placement = Placement::new(CameraModel::Perspective(camera));
    let single = Single { placement, samples: SphereSamples::NotAPanorama, any_shape: false, pose: false };
    Spec { name: "perspective", shape: Shape::Single(single), stereo: None, files: Vec::new() }
}

/// Returns the picture on the other side of the conversion.
fn other_side(shape: Option<&Shape>, side: Side) -> Result<Placement> {
    let plain = plain().shape;
    match shape.unwrap_or(&plain) {
        Shape::Single(single) if single.placement.canvas.is_none() => Ok(single.placement.clone()),
        _ => Err(without_base(side)),
    }
}

/// Returns the size of the input's first picture.
fn input_size(input: &Name, access: Access) -> Result<(usize, usize)> {
    let files = ViewFiles::new(Path::new(input));
    let first = wanted_frames::find(&files, access.files, None)?[0];
    Ok(canvas_size(&access.probe(&files.path(first))?))
}

/// Returns the size of a picture, or of its canvas if it has one.
fn canvas_size(header: &Header) -> (usize, usize) {
    header.window.map_or((header.width, header.height), |window| (window.canvas_width, window.canvas_height))
}

fn size_of(pairs: &StPairs) -> Size {
    Size { width: pairs.width, height: Some(pairs.height) }
}

fn read(file: &Path, access: Access) -> Result<StPairs> {
    Ok(access.read_pairs(file)?)
}

fn with_given_base(map: &StMapSpec, side: Side, access: Access) -> Result<Spec> {
    let Some(StMapBase::Single(base)) = &map.base else { return Err(without_base(side)) };
    let base = Base { placement: base.placement.clone(), size: None };
    spec(map, &read(&map.file, access)?, base, side, access)
}

/// Converts a map that has been read to a picture whose mapping is a table.
fn spec(map: &StMapSpec, pairs: &StPairs, base: Base, side: Side, access: Access) -> Result<Spec> {
    let has_pixels_of_map = (side == Side::Output) != map.invert;
    let size = base.size.filter(|_| has_pixels_of_map).unwrap_or((pairs.width, pairs.height));
    let view = base.placement.view(size.0, size.1).map_err(|error| usage(format!("{} base: {error}", option(side))))?;
    let map_size = (pairs.width, pairs.height);
    access.memory.check_table(&map.file, map_size, !has_pixels_of_map)?;
    let pair = |i, j| pairs.get(i, j);
    let frame = if has_pixels_of_map {
        StMapCamera::looking(map_size, pair, &view)
    } else {
        StMapCamera::looked_at(map_size, pair, &view)
    };
    let frame = frame.map_err(|error| failure!(Malformed: "{}: {error}", map.file.display()))?;
    let placement = Placement {
        frame: CameraModel::StMap(frame),
        orientation: map.orientation,
        mirror: map.mirror,
        canvas: map.canvas,
    };
    let single = Single { placement, samples: SphereSamples::NotAPanorama, any_shape: false, pose: false };
    Ok(Spec { name: "st-map", shape: Shape::Single(single), stereo: None, files: vec![map.file.clone()] })
}
