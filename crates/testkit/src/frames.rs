use cosmorama::camera::{
    CalibratedCamera, CalibratedLens, CameraMatrix, CameraModel, CylinderCamera, CylinderKind, FieldStop,
    FisheyeCamera, MirrorBallCamera, OctahedralCamera, OmnimaxFraming, PanniniCamera, PixelGrid, PixelPoint,
    StereographicCamera, View, WorldMapCamera,
};
use cosmorama::projection::OctahedralKind;
use cosmorama::projection::azimuthal::{FisheyeLens, Lens};
use cosmorama::projection::{BrownConrady, BrownConradyCoefficients, PlanePoint, PlaneRect, ProjectionKind};
use cosmorama::sphere::{Angle, CubeFace, Orientation};
use cosmorama::world::World;
use glam::DVec2;

/// Returns a face of the cube, 90° both ways whatever its pixels.
pub fn cube_face(face: CubeFace, width: usize, height: usize) -> View {
    let square = PlaneRect { min: PlanePoint::new(-1.0, -1.0), max: PlanePoint::new(1.0, 1.0) };
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: face.orientation(),
        grid: PixelGrid::spanning(width, height, square),
        stop: FieldStop::NONE,
    }
}

/// Returns a world of some faces of one size.
pub fn cube(faces: &[CubeFace], width: usize, height: usize) -> World {
    let views = faces.iter().map(|&face| (face.name().to_owned(), cube_face(face, width, height)));
    World::new(views).expect("faces make a world")
}

/// Returns an equidistant fisheye that fills a square frame.
pub fn fisheye(size: usize, fov: f64) -> View {
    let half = Angle::from_degrees(fov / 2.0).radians();
    View {
        projection: ProjectionKind::EQUIDISTANT,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::centred(size, size, middle(size, size), DVec2::splat(2.0 * half / size as f64)),
        stop: FieldStop::circle(half),
    }
}

/// Returns an Omnimax frame with the paper's lower cut.
pub fn omnimax(width: usize, height: usize) -> View {
    View {
        projection: ProjectionKind::OMNIMAX,
        orientation: Orientation::IDENTITY,
        grid: OmnimaxFraming::Fit.grid(width, height, 1.0),
        stop: FieldStop::circle(1.0).with_lower(Angle::from_degrees(45.0)),
    }
}

/// Returns a full panorama, twice as wide as high.
pub fn equirect(width: usize) -> View {
    use std::f64::consts::{FRAC_PI_2, PI};
    let sphere = PlaneRect { min: PlanePoint::new(-PI, -FRAC_PI_2), max: PlanePoint::new(PI, FRAC_PI_2) };
    View {
        projection: ProjectionKind::EQUIRECTANGULAR,
        orientation: Orientation::IDENTITY,
        grid: PixelGrid::spanning(width, width / 2, sphere),
        stop: FieldStop::NONE,
    }
}

/// Returns a turned pinhole camera; angles are in degrees, and `fov` is horizontal.
pub fn perspective(width: usize, height: usize, fov: f64, yaw: f64, pitch: f64, roll: f64) -> View {
    let step = 2.0 * Angle::from_degrees(fov / 2.0).tan() / width as f64;
    View {
        projection: ProjectionKind::PERSPECTIVE,
        orientation: turned([yaw, pitch, roll]),
        grid: PixelGrid::centred(width, height, middle(width, height), DVec2::splat(step)),
        stop: FieldStop::NONE,
    }
}

/// Returns views that show the whole world, about so many pixels high.
pub fn whole_worlds(height: usize) -> Vec<(&'static str, View)> {
    let fisheye =
        |lens| CameraModel::Fisheye(FisheyeCamera { lens, field_of_view: Angle::TURN, ..FisheyeCamera::default() });
    let octahedral = |kind| CameraModel::Octahedral(OctahedralCamera { kind });
    let frames = [
        ("equidistant", fisheye(FisheyeLens::EQUIDISTANT)),
        ("equisolid", fisheye(FisheyeLens::EQUISOLID)),
        ("equal-area", CameraModel::Cylinder(CylinderCamera::new(CylinderKind::EqualArea))),
        ("mirror ball", CameraModel::MirrorBall(MirrorBallCamera::default())),
        ("hammer", CameraModel::WorldMap(WorldMapCamera::Hammer)),
        ("mollweide", CameraModel::WorldMap(WorldMapCamera::Mollweide)),
        ("sinusoidal", CameraModel::WorldMap(WorldMapCamera::Sinusoidal)),
        ("octahedral", octahedral(OctahedralKind::EqualArea)),
        ("octahedral, plain", octahedral(OctahedralKind::Plain)),
    ];
    frames.into_iter().map(|(name, frame)| (name, in_shape(frame, height))).collect()
}

/// Returns views that show a part of the world, about so many pixels high.
pub fn partial_worlds(height: usize) -> Vec<(&'static str, View)> {
    let cylinder = |kind| CameraModel::Cylinder(CylinderCamera::new(kind));
    let ball = MirrorBallCamera { distance: Some(3.0), ..MirrorBallCamera::default() };
    let lenses = FisheyeLens::all().into_iter().map(|lens| {
        let field_of_view = Angle::from_radians((1.9 * lens.reach()).min(4.0));
        ("a lens", CameraModel::Fisheye(FisheyeCamera { lens, field_of_view, ..FisheyeCamera::default() }))
    });
    let frames = [
        ("mercator", cylinder(CylinderKind::Mercator)),
        ("central cylinder", cylinder(CylinderKind::Central)),
        ("near mirror ball", CameraModel::MirrorBall(ball)),
        ("pannini", CameraModel::Pannini(PanniniCamera::default())),
        ("stereographic", CameraModel::Stereographic(StereographicCamera::default())),
    ];
    frames.into_iter().chain(lenses).chain(cameras()).map(|(name, frame)| (name, in_shape(frame, height))).collect()
}

/// Returns calibrated cameras: a pinhole camera with distortion, and a fisheye with skewed rows.
fn cameras() -> [(&'static str, CameraModel); 2] {
    let matrix = CameraMatrix::from_rows([[210.0, 2.0, 215.0], [0.0, 200.0, 140.0]]).expect("a camera");
    let camera =
        |lens| CameraModel::Calibrated(CalibratedCamera { lens, matrix, size: Some((400, 300)), field_of_view: None });
    let bent = BrownConradyCoefficients::from_opencv(&[-0.2, 0.04, 0.002, -0.001]);
    let pinhole = CalibratedLens::Pinhole(BrownConrady::new(bent).expect("a lens"));
    [("a bent pinhole", camera(pinhole)), ("a skewed fisheye", camera(CalibratedLens::Fisheye(FisheyeLens::EQUISOLID)))]
}

/// Returns a view of the camera model's natural shape, about so many pixels high.
pub(crate) fn in_shape(frame: CameraModel, height: usize) -> View {
    let ratio = frame.natural_height(1 << 20) as f64 / f64::from(1 << 20);
    frame.view((height as f64 / ratio).round() as usize, height).expect("a frame with its usual parameters")
}

fn middle(width: usize, height: usize) -> PixelPoint {
    PixelPoint::new(width as f64 / 2.0, height as f64 / 2.0)
}

/// Returns the orientation of yaw, pitch and roll in degrees.
pub fn turned(degrees: [f64; 3]) -> Orientation {
    let [yaw, pitch, roll] = degrees.map(Angle::from_degrees);
    Orientation::from_yaw_pitch_roll(yaw, pitch, roll)
}
