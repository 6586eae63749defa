//! Maps in another shape than their natural one.

use cosmorama::camera::{CameraModel, View};
use cosmorama_spec::{Shape, Size, Spec};

use crate::diagnostic::{Code, Diagnostic, Remedy, SIZE, Setting, TO};
use crate::packing::canvas::is_near;
use crate::settings::GeometrySettings;

/// Returns a warning if pixels are not square although nobody asked for that: such a map is refused as an input.
pub(crate) fn warning(geometry: &GeometrySettings, view: &View) -> Option<Diagnostic> {
    let Some(Spec { name, shape: Shape::Single(single), stereo: None, .. }) = &geometry.to else { return None };
    let Some(Size { height: Some(_), .. }) = geometry.size else { return None };
    let frame = &single.placement.frame;
    let (fills_any_shape, whole) = match frame {
        CameraModel::Equirect(_) => (true, ", or, if it is meant, give hfov= and vfov="),
        CameraModel::WorldMap(_) | CameraModel::Octahedral(_) => (true, ""),
        CameraModel::Cylinder(frame) => (frame.top.is_some(), ""),
        _ => (false, ""),
    };
    if !fills_any_shape || single.any_shape || single.placement.canvas.is_some() {
        return None;
    }
    let (width, height) = (view.width(), view.height());
    let natural = frame.natural_height(width);
    (!is_near(natural, height)).then(|| {
        let message = format!(
            "{TO} {name}: pixels are not square: {width}x{height}; the natural height is {natural}: give {SIZE} {width}{whole}"
        );
        Diagnostic::warning(Code::Aspect, message).with_remedy(Remedy::Set(Setting::Size, width.to_string()))
    })
}
