use cosmorama::camera::{
    CameraModel, CylinderCamera, CylinderKind, EquirectCamera, FaceMapping, FieldOfView, FisheyeCamera, FulldomeCamera,
    LayoutFaceCamera, Mirror, MirrorBallCamera, OctahedralCamera, OmnimaxCamera, PanniniCamera, PerspectiveCamera,
    StereographicCamera, View, WorldMapCamera,
};
use cosmorama::layout::{Arrangement, DualFisheye, DualLens, LensSide, PlacedLens};
use cosmorama::projection::OctahedralKind;
use cosmorama::projection::azimuthal::{FisheyeLens, Lens};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::{Blend, World, WorldView};

use crate::frames::in_shape;

/// A form of a world: one view, the two of a camera that looks both ways, or the six of a cube.
#[derive(Clone, Debug)]
pub struct Form {
    /// Name in tables.
    pub name: &'static str,
    /// Views that show the world.
    pub views: Vec<View>,
    /// Blending of the views where they overlap.
    pub blend: Blend,
    /// Whether the form shows the whole world.
    pub is_whole: bool,
}

/// Rows of a trial view, from which the size that a form needs is computed.
const TRIAL: usize = 256;

impl Form {
    /// Returns the world of this form.
    ///
    /// # Panics
    /// Never: a form has views, and they have pixels.
    pub fn world(&self) -> World {
        let part = |(index, view): (usize, &View)| WorldView {
            name: format!("{} {index}", self.name),
            view: view.clone(),
            blend: self.blend,
            mask: None,
        };
        World::blended(self.views.iter().enumerate().map(part)).expect("a form has views")
    }

    /// Returns every camera of a single view, with its name in tables.
    pub fn cameras() -> Vec<(&'static str, CameraModel)> {
        frames()
    }

    /// Returns every form of a world, with about so many pixels for each steradian that it shows.
    pub fn all(pixels_per_steradian: f64) -> Vec<Self> {
        let one = |(name, frame): (&'static str, CameraModel)| {
            Self::of(name, pixels_per_steradian, Blend::default(), |rows| vec![in_shape(frame.clone(), rows)])
        };
        let cube = |mapping| {
            let frame = CameraModel::LayoutFace(LayoutFaceCamera { mapping, ..LayoutFaceCamera::default() });
            move |rows| {
                CubeFace::ALL
                    .map(|face| View { orientation: face.orientation(), ..in_shape(frame.clone(), rows) })
                    .to_vec()
            }
        };
        let (camera, circles) = (both_ways(), |rows| both_circles(&both_ways(), rows));
        let of_several = [
            Self::of("cube", pixels_per_steradian, Blend::default(), cube(FaceMapping::Perspective)),
            Self::of("eac", pixels_per_steradian, Blend::default(), cube(FaceMapping::EquiAngular)),
            Self::of("dual-fisheye", pixels_per_steradian, camera.blend(), circles),
        ];
        of_several.into_iter().chain(frames().into_iter().map(one)).collect()
    }

    fn of(name: &'static str, pixels_per_steradian: f64, blend: Blend, views: impl Fn(usize) -> Vec<View>) -> Self {
        let trial = Self { name, views: views(TRIAL), blend, is_whole: false }.world();
        let shown: Vec<f64> = trial.solid_angles().map(f64::from).filter(|&s| s > 0.0).collect();
        let solid_angle: f64 = shown.iter().sum();
        let enlarged = (pixels_per_steradian * solid_angle / shown.len() as f64).sqrt();
        let views = views((TRIAL as f64 * enlarged / 2.0).round() as usize * 2);
        Self { name, views, blend, is_whole: solid_angle > 0.999 * 4.0 * std::f64::consts::PI }
    }
}

/// Returns a camera whose two circles overlap by a band of 15°, in which they are blended.
fn both_ways() -> DualFisheye {
    let frame = FisheyeCamera { field_of_view: DualFisheye::FIELD_OF_VIEW, ..FisheyeCamera::default() };
    let lens = DualLens { frame, turned: Orientation::IDENTITY };
    DualFisheye { arrangement: Arrangement::SideBySide, first: LensSide::Front, front: lens, back: lens, feather: None }
}

fn both_circles(camera: &DualFisheye, rows: usize) -> Vec<View> {
    let lenses = camera.lenses(2 * rows, rows, Mirror::default()).expect("two squares");
    let view = |lens: &PlacedLens| lens.placement.view(rows, rows).expect("a circle in its square");
    lenses.iter().map(view).collect()
}

/// Returns forms of a single view, with their names on the command line.
fn frames() -> Vec<(&'static str, CameraModel)> {
    let fisheye = |lens: FisheyeLens, fov: f64| {
        CameraModel::Fisheye(FisheyeCamera {
            lens,
            field_of_view: Angle::from_degrees(fov),
            ..FisheyeCamera::default()
        })
    };
    let cylinder = |kind| CameraModel::Cylinder(CylinderCamera::new(kind));
    let octahedral = |kind| CameraModel::Octahedral(OctahedralCamera { kind });
    let camera = PerspectiveCamera::new(FieldOfView::Horizontal(Angle::from_degrees(90.0)));
    let ball = |distance| CameraModel::MirrorBall(MirrorBallCamera { distance, ..MirrorBallCamera::default() });
    let mut frames = vec![
        ("perspective", CameraModel::Perspective(camera)),
        ("omnimax", CameraModel::Omnimax(OmnimaxCamera::default())),
        ("fulldome", CameraModel::Fulldome(FulldomeCamera::default())),
        ("equirect", CameraModel::Equirect(EquirectCamera::default())),
        ("mercator", cylinder(CylinderKind::Mercator)),
        ("cylinder", cylinder(CylinderKind::Central)),
        ("equal-area", cylinder(CylinderKind::EqualArea)),
        ("angular-map", fisheye(FisheyeLens::EQUIDISTANT, 360.0)),
        ("equisolid", fisheye(FisheyeLens::EQUISOLID, 360.0)),
        ("orthographic", fisheye(FisheyeLens::ORTHOGRAPHIC, 180.0)),
        ("stereographic", CameraModel::Stereographic(StereographicCamera::default())),
        ("mirror-ball", ball(None)),
        ("ball, near", ball(Some(3.0))),
        ("hammer", CameraModel::WorldMap(WorldMapCamera::Hammer)),
        ("mollweide", CameraModel::WorldMap(WorldMapCamera::Mollweide)),
        ("sinusoidal", CameraModel::WorldMap(WorldMapCamera::Sinusoidal)),
        ("pannini", CameraModel::Pannini(PanniniCamera::default())),
        ("octahedral", octahedral(OctahedralKind::EqualArea)),
        ("oct. plain", octahedral(OctahedralKind::Plain)),
    ];
    frames.extend(measured().into_iter().map(|(name, lens)| {
        let reach = 2.0 * lens.reach().to_degrees();
        (name, fisheye(lens, if reach > WIDE { WIDE } else { 0.95 * reach }))
    }));
    frames
}

/// Field of view, in degrees, of lenses that permit it.
const WIDE: f64 = 200.0;

/// Returns calibrated lenses, one of each model.
fn measured() -> Vec<(&'static str, FisheyeLens)> {
    let is_ideal = |lens: &FisheyeLens| {
        use FisheyeLens::{Equidistant, Equisolid, Orthographic, Stereographic};
        matches!(lens, Equidistant(_) | Equisolid(_) | Orthographic(_) | Stereographic(_))
    };
    let names =
        ["blender", "kannala", "ocam", "ucm", "eucm", "double sphere", "field of view", "hugin abc", "flat abc"];
    let lenses: Vec<_> = FisheyeLens::all().into_iter().filter(|lens| !is_ideal(lens)).collect();
    assert_eq!(lenses.len(), names.len(), "every model has its name here");
    names.into_iter().zip(lenses).collect()
}
