use anyhow::{Result, anyhow};
use cosmorama::camera::View;
use cosmorama_convert::{
    ConvertError, ExplanationSettings, GeometrySettings, MemoryBudget, Part as MessagePart, Picture,
    Place as SheetPlace, Setting,
};
use cosmorama_scene::{Camera, Located, ModelCamera, Orthographic, Place, Scene, SceneError, SceneFile};
use cosmorama_spec::{Size, Spec};

use super::things::Things;
use crate::args::{CameraName, Point, ShadeArgs};
use crate::failure::{message, usage};

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
    places: Places,
}

/// Places in the scene file of what it says of the camera, where no option says it.
struct Places {
    projection: Option<String>,
    eye: Option<String>,
    size: Option<String>,
}

impl Places {
    /// Returns the error of a setting: of its line in the scene file, or of its option.
    fn wrong(place: Option<&String>, option: &str, message: String) -> anyhow::Error {
        match place {
            Some(place) => anyhow!("{place}: {message}"),
            None => usage(format!("{option} {message}")),
        }
    }

    /// Returns the error of a camera that cannot be.
    fn of_camera(&self, error: &SceneError) -> anyhow::Error {
        let place = match error {
            SceneError::NoDirection { .. } => &self.eye,
            SceneError::NoPixels(_) => &self.size,
            _ => &self.projection,
        };
        Self::wrong(place.as_ref(), "--camera, --eye, --target:", error.to_string())
    }
}

impl Asked {
    fn of(args: &ShadeArgs, things: &Things) -> Result<Self> {
        let file = things.file.as_ref().map(SceneFile::camera).unwrap_or_default();
        let written = |text: &Located, error: String| anyhow!("{}: '{}': {error}", text.place, text.value);
        // What options say goes before.
        let projection = file.projection.filter(|_| args.camera.is_none());
        let size_text = file.size.filter(|_| args.size.is_none());
        let [eye, target] =
            [(file.eye, args.eye), (file.target, args.target)].map(|(file, option)| file.filter(|_| option.is_none()));
        let camera = match (&args.camera, &projection) {
            (Some(camera), _) => camera.clone(),
            (None, Some(text)) => text.value.parse().map_err(|error| written(text, error))?,
            (None, None) => USUAL.parse().map_err(usage)?,
        };
        let size = match (args.size, &size_text) {
            (Some(size), _) => size,
            (None, Some(text)) => text.value.parse().map_err(|error: String| written(text, error))?,
            (None, None) => Size { width: WIDTH, height: None },
        };
        let point = |option: Option<Point>, file: &Option<Located<[f64; 3]>>| {
            option.map(|point| point.0).or(file.as_ref().map(|file| file.value))
        };
        Ok(Self {
            camera,
            eye: point(args.eye, &eye),
            target: point(args.target, &target),
            size,
            places: Places {
                projection: projection.map(|text| text.place),
                eye: eye.or(target).map(|point| point.place),
                size: size_text.map(|text| text.place),
            },
        })
    }

    /// Returns the camera's place, as far as it is given.
    fn placed(&self, usual: Place) -> Place {
        Place { eye: self.eye.map_or(usual.eye, Into::into), target: self.target.map_or(usual.target, Into::into) }
    }

    /// Checks that a picture fits into memory.
    fn check_picture(&self, args: &ShadeArgs, size: (usize, usize)) -> Result<()> {
        let checked = MemoryBudget::new(args.limits.memory).check_picture(size);
        checked.map_err(|error| match &self.places.size {
            Some(place) => anyhow!("{place}: {}", message(&error.into())),
            None => error.into(),
        })
    }
}

/// Returns the pictures that the camera makes: one, or the parts of an image.
pub(super) fn shots(args: &ShadeArgs, things: &Things) -> Result<Vec<Shot>> {
    let (asked, scene) = (Asked::of(args, things)?, &things.scene);
    let size = asked.size;
    match &asked.camera {
        CameraName::Orthographic(height) => {
            let pixels = [size.width, size.height.unwrap_or_else(|| (size.width * 3).div_ceil(4))];
            asked.check_picture(args, pixels.into())?;
            let (place, usual) = scene.place_before_parallel(pixels);
            let camera = Orthographic::new(asked.placed(place), height.unwrap_or(usual), pixels);
            let camera = camera.map_err(|error| asked.places.of_camera(&error))?;
            Ok(vec![Shot { camera: Camera::Orthographic(camera), place: None }])
        }
        CameraName::Model(name) => {
            let camera = of_model(name.as_deref(), &things.cameras)
                .map_err(|why| Places::wrong(asked.places.projection.as_ref(), "--camera", why))?;
            if asked.eye.is_some() || asked.target.is_some() {
                let message =
                    "a model's camera has its own place: leave out eye and target, or take another camera".to_owned();
                return Err(Places::wrong(asked.places.eye.as_ref(), "--eye, --target:", message));
            }
            let pixels = [size.width, size.height.unwrap_or_else(|| camera.rows(size.width))];
            asked.check_picture(args, pixels.into())?;
            let wrong = |error| {
                let name = &camera.name;
                anyhow!(
                    "the model's camera '{name}': {error}; mend it in the model's file, or take another, as in --camera {USUAL}"
                )
            };
            Ok(vec![Shot { camera: camera.camera(pixels).map_err(wrong)?, place: None }])
        }
        CameraName::Lens(spec) => lens(args, (**spec).clone(), &asked, scene),
    }
}

/// Returns the camera of a name, or the first of all.
fn of_model<'a>(name: Option<&str>, cameras: &'a [ModelCamera]) -> Result<&'a ModelCamera, String> {
    let is_it = |camera: &&ModelCamera| name.is_none_or(|name| camera.name == name);
    if let Some(camera) = cameras.iter().find(is_it) {
        return Ok(camera);
    }
    let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
    Err(match name {
        Some(name) if !names.is_empty() => {
            format!("gltf:{name}: no model has such a camera; there are {}", names.join(", "))
        }
        _ => "gltf: no model here has a camera; take another, as in perspective:fov=40".to_owned(),
    })
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
    let places = &asked.places;
    let explanation = settings.check().result.map_err(|error| of_target(error, places))?;
    let pictures = explanation.pictures();
    let size = |picture: &Picture| (picture.view.width(), picture.view.height());
    pictures.iter().try_for_each(|picture| asked.check_picture(args, size(picture)))?;
    if pictures.len() > 1 && pictures.iter().any(|picture| picture.place.is_none()) {
        let message = "one picture is made, but a cube has six; put them into one image, as in cube:layout=3x2";
        return Err(Places::wrong(places.projection.as_ref(), "--camera:", message.to_owned()));
    }
    let view = |index: usize| -> &View { &pictures[index].view };
    let place = asked.placed(scene.place_before(view(0)));
    let shot = |index: usize| {
        let camera = Camera::lens(place, view(index).clone()).map_err(|error| places.of_camera(&error))?;
        Ok(Shot { camera, place: pictures[index].place })
    };
    (0..pictures.len()).map(shot).collect()
}

/// Returns an error about a target as one about the camera.
fn of_target(error: ConvertError, places: &Places) -> anyhow::Error {
    if !error.is_of_settings() {
        return error.into();
    }
    let is_of_size = error.message().parts().any(|part| part == MessagePart::Setting(Setting::Size));
    let place = if is_of_size { &places.size } else { &places.projection };
    let option = |setting: Setting| match (setting, place) {
        (Setting::To, Some(_)) => "projection".to_owned(),
        (Setting::To, None) => "--camera".to_owned(),
        (other, Some(_)) => other.name().to_owned(),
        (other, None) => format!("--{}", other.name()),
    };
    let message = error.message().render(option);
    match place {
        Some(place) => anyhow!("{place}: {message}"),
        None => usage(message),
    }
}
