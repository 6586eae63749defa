use cosmorama::projection::OctahedralKind;
use cosmorama::projection::azimuthal::FisheyeLens;
use cosmorama::sphere::{Angle, CubeFace};
use cosmorama::world::{
    CylinderFrame, CylinderKind, EquirectFrame, FaceMapping, FieldOfView, FisheyeFrame, Frame, FulldomeFrame,
    LayoutFaceFrame, MirrorBallFrame, OctahedralFrame, OmnimaxFrame, PanniniFrame, PerspectiveFrame,
    StereographicFrame, View, World, WorldMapFrame,
};

use crate::frames::in_shape;

/// A form that a world can have: one view, or the six of a cube.
#[derive(Clone, Debug)]
pub struct Form {
    /// What tables call it.
    pub name: &'static str,
    /// Its views.
    pub views: Vec<View>,
    /// Whether it shows the whole world.
    pub is_whole: bool,
}

/// How many rows a view has by which the size that a form needs is found.
const TRIAL: usize = 256;

impl Form {
    /// The world that it makes.
    ///
    /// # Panics
    /// Never: a form has views, and they have pixels.
    pub fn world(&self) -> World {
        let views = self.views.iter().enumerate().map(|(index, view)| (format!("{} {index}", self.name), *view));
        World::new(views).expect("a form has views")
    }

    /// Every form of a world, with about so many pixels for each steradian that it shows.
    pub fn all(pixels_per_steradian: f64) -> Vec<Self> {
        let one = |(name, frame): (&'static str, Frame)| {
            Self::of(name, pixels_per_steradian, |rows| vec![in_shape(frame, rows)])
        };
        let cube = |mapping| {
            let frame = Frame::LayoutFace(LayoutFaceFrame { mapping, ..LayoutFaceFrame::default() });
            move |rows| {
                CubeFace::ALL.map(|face| View { orientation: face.orientation(), ..in_shape(frame, rows) }).to_vec()
            }
        };
        let cubes = [
            Self::of("cube", pixels_per_steradian, cube(FaceMapping::Perspective)),
            Self::of("eac", pixels_per_steradian, cube(FaceMapping::EquiAngular)),
        ];
        cubes.into_iter().chain(frames().into_iter().map(one)).collect()
    }

    fn of(name: &'static str, pixels_per_steradian: f64, views: impl Fn(usize) -> Vec<View>) -> Self {
        let trial = Self { name, views: views(TRIAL), is_whole: false }.world();
        let shown: Vec<f64> = trial.solid_angles().map(f64::from).filter(|&s| s > 0.0).collect();
        let solid_angle: f64 = shown.iter().sum();
        let enlarged = (pixels_per_steradian * solid_angle / shown.len() as f64).sqrt();
        let views = views((TRIAL as f64 * enlarged / 2.0).round() as usize * 2);
        Self { name, views, is_whole: solid_angle > 0.999 * 4.0 * std::f64::consts::PI }
    }
}

/// Those of one view, as the command line names them.
fn frames() -> Vec<(&'static str, Frame)> {
    let fisheye = |lens: FisheyeLens, fov: f64| {
        Frame::Fisheye(FisheyeFrame { lens, field_of_view: Angle::from_degrees(fov), ..FisheyeFrame::default() })
    };
    let cylinder = |kind| Frame::Cylinder(CylinderFrame::new(kind));
    let octahedral = |kind| Frame::Octahedral(OctahedralFrame { kind });
    let camera = PerspectiveFrame::new(FieldOfView::Horizontal(Angle::from_degrees(90.0)));
    let ball = |distance| Frame::MirrorBall(MirrorBallFrame { distance, ..MirrorBallFrame::default() });
    let mut frames = vec![
        ("perspective", Frame::Perspective(camera)),
        ("omnimax", Frame::Omnimax(OmnimaxFrame::default())),
        ("fulldome", Frame::Fulldome(FulldomeFrame::default())),
        ("equirect", Frame::Equirect(EquirectFrame::default())),
        ("mercator", cylinder(CylinderKind::Mercator)),
        ("cylinder", cylinder(CylinderKind::Central)),
        ("equal-area", cylinder(CylinderKind::EqualArea)),
        ("angular-map", fisheye(FisheyeLens::EQUIDISTANT, 360.0)),
        ("equisolid", fisheye(FisheyeLens::EQUISOLID, 360.0)),
        ("orthographic", fisheye(FisheyeLens::ORTHOGRAPHIC, 180.0)),
        ("stereographic", Frame::Stereographic(StereographicFrame::default())),
        ("mirror-ball", ball(None)),
        ("ball, near", ball(Some(3.0))),
        ("hammer", Frame::WorldMap(WorldMapFrame::Hammer)),
        ("mollweide", Frame::WorldMap(WorldMapFrame::Mollweide)),
        ("sinusoidal", Frame::WorldMap(WorldMapFrame::Sinusoidal)),
        ("pannini", Frame::Pannini(PanniniFrame::default())),
        ("octahedral", octahedral(OctahedralKind::EqualArea)),
        ("oct. plain", octahedral(OctahedralKind::Plain)),
    ];
    // Two that somebody measured; the other models of lenses differ from these by as much as these from each other.
    let measured = FisheyeLens::all()
        .into_iter()
        .filter(|lens| matches!(lens, FisheyeLens::Polynomial(_) | FisheyeLens::KannalaBrandt(_)));
    frames.extend(["blender", "kannala"].into_iter().zip(measured).map(|(name, lens)| (name, fisheye(lens, 200.0))));
    frames
}
