use anyhow::Result;
use cosmorama::camera::View;
use cosmorama_convert::{
    ConvertError, ExplanationSettings, GeometrySettings, MemoryBudget, Place as SheetPlace, Setting,
};
use cosmorama_scene::{Camera, Orthographic, Place, Scene};
use cosmorama_spec::{Size, Spec};

use crate::args::{CameraName, ShadeArgs};
use crate::failure::usage;

/// A picture that a camera makes, and its place in an image that it shares with others.
pub(super) struct Shot {
    pub(super) camera: Camera,
    pub(super) place: Option<SheetPlace>,
}

/// Columns of a picture, unless given.
const WIDTH: usize = 640;

/// Projection of worlds of which nothing is known yet.
const ANY_WORLD: &str = "equirect";

/// Returns the pictures that the camera makes: one, or the parts of an image.
pub(super) fn shots(args: &ShadeArgs, scene: &Scene) -> Result<Vec<Shot>> {
    let size = args.size.unwrap_or(Size { width: WIDTH, height: None });
    match &args.camera {
        CameraName::Orthographic(height) => {
            let pixels = [size.width, size.height.unwrap_or_else(|| (size.width * 3).div_ceil(4))];
            MemoryBudget::new(args.limits.memory).check_picture(pixels.into())?;
            let (place, usual) = scene.place_before_parallel(pixels);
            let camera = Orthographic::new(placed(args, place), height.unwrap_or(usual), pixels).map_err(wrong)?;
            Ok(vec![Shot { camera: Camera::Orthographic(camera), place: None }])
        }
        CameraName::Lens(spec) => lens(args, (**spec).clone(), size, scene),
    }
}

fn lens(args: &ShadeArgs, spec: Spec, size: Size, scene: &Scene) -> Result<Vec<Shot>> {
    let geometry = GeometrySettings {
        from: Some(ANY_WORLD.parse()?),
        to: Some(spec),
        size: Some(size),
        ..GeometrySettings::default()
    };
    let settings =
        ExplanationSettings { geometry, limits: args.limits.clone().into(), ..ExplanationSettings::default() };
    let explanation = settings.check().result.map_err(of_camera)?;
    // Checks the size, too.
    explanation.worlds().map_err(of_camera)?;
    let pictures = explanation.pictures();
    if pictures.len() > 1 && pictures.iter().any(|picture| picture.place.is_none()) {
        return Err(usage(
            "--camera: one picture is made, but a cube has six; put them into one image, as in --camera cube:layout=3x2",
        ));
    }
    let view = |index: usize| -> &View { &pictures[index].view };
    let place = placed(args, scene.place_before(view(0)));
    let shot = |index: usize| {
        let camera = Camera::lens(place, view(index).clone()).map_err(wrong)?;
        Ok(Shot { camera, place: pictures[index].place })
    };
    (0..pictures.len()).map(shot).collect()
}

/// Returns the camera's place, as far as it is given.
fn placed(args: &ShadeArgs, usual: Place) -> Place {
    Place {
        eye: args.eye.map_or(usual.eye, |point| point.0.into()),
        target: args.target.map_or(usual.target, |point| point.0.into()),
    }
}

/// Returns an error about a target as one about the camera.
fn of_camera(error: ConvertError) -> anyhow::Error {
    if !error.is_of_settings() {
        return error.into();
    }
    usage(error.message().render(|setting| match setting {
        Setting::To => "--camera".to_owned(),
        other => format!("--{}", other.name()),
    }))
}

fn wrong(error: cosmorama_scene::SceneError) -> anyhow::Error {
    usage(format!("--camera, --eye, --target: {error}"))
}
