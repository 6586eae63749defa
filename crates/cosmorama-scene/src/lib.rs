//! Objects under a world: reflected, refracted and lit by a projection of it (N. Greene, *Applications of world
//! projections*, Graphics Interface '86).
//!
//! A pixel's beam is a [`Ray`] with its derivatives along the screen. Surfaces turn it with their curvature; what
//! leaves them is a [`Footprint`](cosmorama::camera::Footprint), over which the library averages the world. What balls of
//! few pixels reflect goes the other way: parts of the world are averaged, and added to the pixels that show them.
//!
//! ```
//! use cosmorama::prelude::*;
//! use cosmorama_scene::{Background, Camera, LightMaps, Material, Place, Scene, Sky, Surroundings, picture};
//!
//! let (world, light) = World::from_panorama(Image::filled(64, 32, Rgba::opaque(0.5, 0.25, 1.0)))?;
//! let scene = Scene::sphere(Material::MIRROR);
//! let place = Place { eye: [0.0, 0.0, 5.0].into(), target: [0.0; 3].into() };
//! let lens = CameraModel::from(PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(40.0))));
//! let camera = Camera::lens(place, Placement::new(lens).view(32, 32)?)?;
//!
//! let sky = Sky::new(&world, &light);
//! let maps = LightMaps::of(&scene, 0, sky)?;
//! let surroundings = Surroundings::new(sky, &maps, FilterSettings::DEFAULT)?;
//! let image = picture(&scene, &camera, &[surroundings], Background::Colour(Rgba::TRANSPARENT))?;
//! // A mirror has the colour of a world that has but one; beside it there is nothing.
//! assert!((image.get(16, 16).0[1] - 0.25).abs() < 1e-5);
//! assert_eq!(*image.get(0, 0), Rgba::TRANSPARENT);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod camera;
mod error;
mod formula;
mod material;
mod model;
mod picture;
mod ray;
mod scene;
mod scene_file;
mod shade;
mod shape;

pub use camera::{Camera, Orthographic, Place};
pub use error::SceneError;
pub use formula::{Plate, Plates};
pub use material::{
    Chrome, Finish, Glass, Highlight, HighlightError, Material, MaterialError, NormalMap, Paint, PictureKind,
    PictureReader, PictureSource, Refraction,
};
pub use model::{EXTENSIONS as MODEL_EXTENSIONS, Model, ModelCamera, ModelError, ModelFault, ModelLens, ModelSettings};
pub use picture::{Background, backdrop, picture, picture_over};
pub use ray::{Normal, Ray, RayChange};
pub use scene::{Object, Part, Scene};
pub use scene_file::{FileBackdrop, FileCamera, Located, NamedWorld, SceneFile, SceneFileError, SceneReader};
pub use shade::{LightMaps, Proxy, Sky, Surroundings, Walls};
pub use shape::{Face, Mesh, MeshError, Normals, Placing, Shape, Sphere};
