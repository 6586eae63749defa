use anyhow::{Result, anyhow};
use cosmorama::camera::View;
use cosmorama_convert::{
    ConvertError, ExplanationSettings, GeometrySettings, MemoryBudget, Place as SheetPlace, Setting,
};
use cosmorama_scene::{Camera, Located, ModelCamera, Orthographic, Place, Scene, SceneFile};
use cosmorama_spec::{Size, Spec};

use super::things::Things;
use crate::args::{CameraName, Point, ShadeArgs};
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

/// Field of view of a camera of which nothing is said.
const USUAL: &str = "perspective:fov=40";

/// The camera as it was asked for: by options, or by the scene file.
struct Asked {
    camera: CameraName,
    eye: Option<[f64; 3]>,
    target: Option<[f64; 3]>,
    size: Size,
}

impl Asked {
    fn of(args: &ShadeArgs, things: &Things) -> Result<Self> {
        let file = things.file.as_ref().map(SceneFile::camera);
        let written = |text: &Located, error: String| anyhow!("{}: '{}': {error}", text.place, text.text);
        let camera = match (&args.camera, file.as_ref().and_then(|file| file.projection.as_ref())) {
            (Some(camera), _) => camera.clone(),
            (None, Some(text)) => text.text.parse().map_err(|error| written(text, error))?,
            (None, None) => USUAL.parse().map_err(usage)?,
        };
        let size = match (args.size, file.as_ref().and_then(|file| file.size.as_ref())) {
            (Some(size), _) => size,
            (None, Some(text)) => text.text.parse().map_err(|error: String| written(text, error))?,
            (None, None) => Size { width: WIDTH, height: None },
        };
        let place = |option: Option<Point>, file: Option<[f64; 3]>| option.map(|point| point.0).or(file);
        Ok(Self {
            camera,
            eye: place(args.eye, file.as_ref().and_then(|file| file.eye)),
            target: place(args.target, file.as_ref().and_then(|file| file.target)),
            size,
        })
    }

    /// Returns the camera's place, as far as it is given.
    fn placed(&self, usual: Place) -> Place {
        Place { eye: self.eye.map_or(usual.eye, Into::into), target: self.target.map_or(usual.target, Into::into) }
    }
}

/// Returns the pictures that the camera makes: one, or the parts of an image.
pub(super) fn shots(args: &ShadeArgs, things: &Things) -> Result<Vec<Shot>> {
    let (asked, scene) = (Asked::of(args, things)?, &things.scene);
    let size = asked.size;
    match &asked.camera {
        CameraName::Orthographic(height) => {
            let pixels = [size.width, size.height.unwrap_or_else(|| (size.width * 3).div_ceil(4))];
            MemoryBudget::new(args.limits.memory).check_picture(pixels.into())?;
            let (place, usual) = scene.place_before_parallel(pixels);
            let camera = Orthographic::new(asked.placed(place), height.unwrap_or(usual), pixels).map_err(wrong)?;
            Ok(vec![Shot { camera: Camera::Orthographic(camera), place: None }])
        }
        CameraName::Model(name) => {
            let camera = of_model(name.as_deref(), &things.cameras)?;
            if asked.eye.is_some() || asked.target.is_some() {
                return Err(usage(
                    "--eye, --target: a model's camera has a place; leave them out, or take another --camera",
                ));
            }
            let pixels = [size.width, size.height.unwrap_or_else(|| camera.rows(size.width))];
            MemoryBudget::new(args.limits.memory).check_picture(pixels.into())?;
            Ok(vec![Shot { camera: camera.camera(pixels).map_err(wrong)?, place: None }])
        }
        CameraName::Lens(spec) => lens(args, (**spec).clone(), &asked, scene),
    }
}

/// Returns the camera of a name, or the first of all.
fn of_model<'a>(name: Option<&str>, cameras: &'a [ModelCamera]) -> Result<&'a ModelCamera> {
    let is_it = |camera: &&ModelCamera| name.is_none_or(|name| camera.name == name);
    if let Some(camera) = cameras.iter().find(is_it) {
        return Ok(camera);
    }
    let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
    Err(usage(match name {
        Some(name) if !names.is_empty() => {
            format!("--camera gltf:{name}: no model has such a camera; there are {}", names.join(", "))
        }
        _ => "--camera gltf: no model here has a camera; take another, as in --camera perspective:fov=40".to_owned(),
    }))
}

fn lens(args: &ShadeArgs, spec: Spec, asked: &Asked, scene: &Scene) -> Result<Vec<Shot>> {
    let geometry = GeometrySettings {
        from: Some(ANY_WORLD.parse()?),
        to: Some(spec),
        size: Some(asked.size),
        ..GeometrySettings::default()
    };
    let settings =
        ExplanationSettings { geometry, limits: args.limits.clone().into(), ..ExplanationSettings::default() };
    let explanation = settings.check().result.map_err(of_camera)?;
    let pictures = explanation.pictures();
    let budget = MemoryBudget::new(args.limits.memory);
    pictures.iter().try_for_each(|picture| budget.check_picture((picture.view.width(), picture.view.height())))?;
    if pictures.len() > 1 && pictures.iter().any(|picture| picture.place.is_none()) {
        return Err(usage(
            "--camera: one picture is made, but a cube has six; put them into one image, as in --camera cube:layout=3x2",
        ));
    }
    let view = |index: usize| -> &View { &pictures[index].view };
    let place = asked.placed(scene.place_before(view(0)));
    let shot = |index: usize| {
        let camera = Camera::lens(place, view(index).clone()).map_err(wrong)?;
        Ok(Shot { camera, place: pictures[index].place })
    };
    (0..pictures.len()).map(shot).collect()
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
