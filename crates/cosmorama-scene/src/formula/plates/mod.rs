mod things;

use cosmorama::camera::{
    CameraModel, CylinderCamera, CylinderKind, FieldOfView, FisheyeCamera, Footprint, OmnimaxCamera, PerspectiveCamera,
    Placement, View,
};
use cosmorama::filter::{Bilinear, Filter, Prepared};
use cosmorama::layout::{CubeLayout, LayoutKind, PlacedFace};
use cosmorama::lighting::{Lobe, LobeAverages, PreparedLight};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Resampler;
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama::world::{Light, World};
use cosmorama_builtin::{DemoScenery, DemoSky, PaintedSky, Radiance, picture};

use crate::error::SceneError;
use crate::shade::Sky;

/// The seven plates of N. Greene, *Applications of world projections* (Graphics Interface '86), made anew of worlds and a model
/// by formula.
///
/// A sky is photographed, projected onto half a cube, and stands behind a scene: the environment.
pub struct Plates {
    /// Edge of the environment's faces, in pixels.
    edge: usize,
    sky: Image<Rgba>,
    half: Lit,
    faces: Vec<(CubeFace, Image<Rgba>)>,
    environment: Lit,
}

/// A plate, or the figure that is a picture.
#[derive(Clone, Copy)]
pub struct Plate {
    /// Name: `plate1` to `plate7`, or `figure1`.
    pub name: &'static str,
    /// Content.
    pub about: &'static str,
    make: fn(&Plates) -> Result<Image<Rgba>>,
}

type Result<T> = std::result::Result<T, SceneError>;

/// A world with its light.
struct Lit {
    world: World,
    light: Light,
}

/// Field of view of the fisheye that photographs the sky: a little more than half of the world, so that its rim is not
/// seen on the horizon.
const FISHEYE: Angle = Angle::from_degrees(184.0);

/// Size of the plates where an edge has 768 pixels: of frames, of Omnimax's film, and of the diffuse map.
const EDGE: usize = 768;
const FRAME: (usize, usize) = (1024, 768);
const FILM: (usize, usize) = (1966, 1436);
const MAP: usize = 512;

/// Camera of Plate 5.
const PAINTED: (f64, f64, f64) = (75.0, 22.0, 12.0);

/// Light of the map of matt surfaces where nothing is seen.
const UNSEEN: Rgba = Rgba::TRANSPARENT;

impl Plates {
    /// All plates, and the figure that is a picture.
    pub const ALL: [Plate; 8] = [
        Plate { name: "plate1", about: "a lizard that reflects its environment", make: things::lizard },
        Plate { name: "plate2", about: "the environment on an unfolded cube", make: Self::unfolded_cube },
        Plate {
            name: "plate3",
            about: "its diffuse illumination map, in Mercator's projection",
            make: Self::diffuse_map,
        },
        Plate { name: "plate4", about: "spheres that reflect it: matt, mixed, mirror", make: things::spheres },
        Plate { name: "plate5", about: "a frame with a painted sky on half a cube", make: Self::painted_frame },
        Plate { name: "plate6", about: "a sky on half a cube, from a fisheye picture", make: Self::half_cube },
        Plate { name: "plate7", about: "the environment in Omnimax's projection", make: Self::omnimax },
        Plate {
            name: "figure1",
            about: "the rays of a pixel, and their reflection cone",
            make: things::reflection_cone,
        },
    ];

    /// Makes the worlds, of faces with an edge of so many pixels, which is made even.
    ///
    /// # Errors
    /// If the edge is 0.
    pub fn new(edge: usize) -> Result<Self> {
        let edge = edge.next_multiple_of(2);
        let camera = CameraModel::from(FisheyeCamera { field_of_view: FISHEYE, ..FisheyeCamera::default() });
        let upward = Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::from_degrees(90.0), Angle::ZERO);
        let view = Placement { orientation: upward, ..Placement::new(camera) }.view(2 * edge, 2 * edge)?;
        let sky = picture(&DemoSky, &view);
        let photograph = Lit::of([("sky".to_owned(), view, sky.clone())])?;
        let half = Lit::on_half_cube(edge, |view| photograph.seen(view))?;
        let behind = half.sky()?;
        let scene = DemoScenery { sky: behind };
        let view = |face: PlacedFace| Ok((face.face, view_of(&face)?));
        let views: Vec<(CubeFace, View)> = cross(None).faces(edge).into_iter().map(view).collect::<Result<_>>()?;
        let faces: Vec<(CubeFace, Image<Rgba>)> =
            views.iter().map(|(face, view)| (*face, picture(&scene, view))).collect();
        drop(scene);
        let named = views.into_iter().zip(&faces);
        let environment =
            Lit::of(named.map(|((face, view), (_, picture))| (face.name().to_owned(), view, picture.clone())))?;
        Ok(Self { edge, sky, half, faces, environment })
    }

    /// Returns the photograph of the sky.
    pub fn sky(&self) -> &Image<Rgba> {
        &self.sky
    }

    /// Lists the pictures of the environment's faces.
    pub fn faces(&self) -> impl Iterator<Item = (CubeFace, &Image<Rgba>)> {
        self.faces.iter().map(|(face, picture)| (*face, picture))
    }

    /// Makes a plate.
    ///
    /// # Errors
    /// If the plate is too small to have pixels.
    pub fn picture(&self, plate: &Plate) -> Result<Image<Rgba>> {
        (plate.make)(self)
    }

    /// Returns the environment, for things to stand under.
    pub fn environment(&self) -> Sky<'_> {
        Sky::new(&self.environment.world, &self.environment.light)
    }

    /// Returns the number of pixels that is this many where an edge has 768.
    fn scaled(&self, pixels: usize) -> usize {
        (pixels * self.edge / EDGE).max(1)
    }

    /// Returns a view of a frame's size.
    fn frame(&self, camera: impl Into<CameraModel>, orientation: Orientation) -> Result<View> {
        let (width, height) = (self.scaled(FRAME.0), self.scaled(FRAME.1));
        Ok(Placement { orientation, ..Placement::new(camera.into()) }.view(width, height)?)
    }

    /// Returns Mercator's map, so many pixels wide where an edge has 768.
    ///
    /// # Errors
    /// If the map has no pixels.
    pub fn map(&self, width: usize) -> Result<View> {
        let camera = CameraModel::from(CylinderCamera::new(CylinderKind::Mercator));
        Ok(camera.view(self.scaled(width), self.scaled(width))?)
    }

    /// Makes the environment's map by Mercator.
    ///
    /// # Errors
    /// If the map has no pixels.
    pub fn mercator(&self) -> Result<Image<Rgba>> {
        Ok(self.environment.seen(&self.map(EDGE)?))
    }

    /// Makes Plate 2: the environment on an unfolded cube.
    fn unfolded_cube(&self) -> Result<Image<Rgba>> {
        self.environment.sheet(&cross(None), self.edge / 4 * 2)
    }

    /// Makes Plate 3: the light that falls on what is matt.
    fn diffuse_map(&self) -> Result<Image<Rgba>> {
        let Lit { world, light } = &self.environment;
        let prepared = PreparedLight::new(world, light, &[Lobe::LAMBERT])?;
        Ok(prepared.picture(&self.map(MAP)?, &Lobe::LAMBERT, UNSEEN))
    }

    /// Makes Plate 5: a frame with a painted sky.
    fn painted_frame(&self) -> Result<Image<Rgba>> {
        let painted = Lit::on_half_cube(self.edge, |view| picture(&PaintedSky, view))?;
        let (field, yaw, pitch) = PAINTED;
        let [yaw, pitch] = [yaw, pitch].map(Angle::from_degrees);
        let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(field)));
        let view = self.frame(camera, Orientation::from_yaw_pitch_roll(yaw, pitch, Angle::ZERO))?;
        let scene = DemoScenery { sky: painted.sky()? };
        Ok(picture(&scene, &view))
    }

    /// Makes Plate 6: the sky on half a cube.
    fn half_cube(&self) -> Result<Image<Rgba>> {
        self.half.sheet(&cross(Some(CubeFace::Up)), self.edge / 4 * 2)
    }

    /// Makes Plate 7: the environment as a frame of film.
    fn omnimax(&self) -> Result<Image<Rgba>> {
        let camera = CameraModel::Omnimax(OmnimaxCamera::default());
        let mut film = self.environment.seen(&camera.view(self.scaled(FILM.0), self.scaled(FILM.1))?);
        film.lay_over(Rgba::BLACK);
        Ok(film)
    }
}

impl Lit {
    fn of(pictures: impl IntoIterator<Item = (String, View, Image<Rgba>)>) -> Result<Self> {
        let (world, light) = World::from_pictures(pictures)?;
        Ok(Self { world, light })
    }

    /// Makes the upper half of a cube.
    fn on_half_cube(edge: usize, make: impl Fn(&View) -> Image<Rgba>) -> Result<Self> {
        let made = |face: PlacedFace| {
            let view = view_of(&face)?;
            let picture = make(&view);
            Ok((face.face.name().to_owned(), view, picture))
        };
        let faces = cross(Some(CubeFace::Up)).faces(edge).into_iter().map(made);
        Self::of(faces.collect::<Result<Vec<_>>>()?)
    }

    /// Makes what a view sees of it.
    fn seen(&self, view: &View) -> Image<Rgba> {
        Resampler::new(&self.world, view).render(self.light.texels())
    }

    /// Makes a picture of faces of an edge.
    fn sheet(&self, layout: &CubeLayout, edge: usize) -> Result<Image<Rgba>> {
        let (width, height) = layout.size(edge)?;
        let mut sheet = Image::filled(width, height, Rgba::BLACK);
        for face in layout.faces(edge) {
            let (picture, rect) = (self.seen(&view_of(&face)?), face.rect);
            for j in 0..picture.height() {
                let start = (rect.top + j) * width + rect.left;
                sheet.pixels_mut()[start..start + picture.width()].copy_from_slice(picture.row(j));
            }
        }
        Ok(sheet)
    }

    /// Returns it as the sky of a scene.
    fn sky(&self) -> Result<HalfWorld<'_>> {
        Ok(HalfWorld(Bilinear.prepare(&self.world, &self.light)?))
    }
}

/// A sky that is looked up in half a world.
struct HalfWorld<'a>(Box<dyn Prepared + 'a>);

impl Radiance for HalfWorld<'_> {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        self.0.average(&Footprint::point(direction)).unpremultiplied()
    }
}

/// Returns the layout of a cross, whole or of half a cube.
fn cross(half: Option<CubeFace>) -> CubeLayout {
    let layout = CubeLayout::new(LayoutKind::CrossH);
    match half {
        Some(half) => layout.with_half(half),
        None => layout,
    }
}

fn view_of(face: &PlacedFace) -> Result<View> {
    Ok(face.placement().view(face.rect.width(), face.rect.height())?)
}
