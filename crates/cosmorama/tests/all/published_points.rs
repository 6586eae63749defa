//! Points of published references, to the digits that those print.

use cosmorama::camera::{CalibratedCamera, CalibratedLens, CameraMatrix, CameraModel, PixelPoint};
use cosmorama::projection::azimuthal::{FisheyeLens, KannalaBrandt, Ocam};
use cosmorama::projection::{
    BrownConrady, BrownConradyCoefficients, Octahedral, OctahedralKind, PlanePoint, Projection, ProjectionKind,
};
use cosmorama::sphere::{Angle, Direction};
use glam::DVec3;

/// PROJ's test/gie/builtins.gie, on the sphere of 6 400 000 m: longitude 2°, latitude 1°, and where that lands in metres.
/// PROJ compares to 0.1 mm.
#[test]
fn maps_are_those_of_proj() {
    const RADIUS: f64 = 6_400_000.0;
    for (projection, x, y) in [
        (ProjectionKind::MERCATOR, 223_402.144_255_274, 111_706.743_574_944),
        (ProjectionKind::EQUAL_AREA_CYLINDER, 223_402.144_255_274, 111_695.401_198_614),
        (ProjectionKind::MOLLWEIDE, 201_113.698_641_813, 124_066.283_433_860),
        (ProjectionKind::HAMMER, 223_373.788_703_241, 111_703.907_397_767),
        (ProjectionKind::SINUSOIDAL, 223_368.119_026_632, 111_701.072_127_637),
    ] {
        for (sign_x, sign_y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let (longitude, latitude) = (Angle::from_degrees(2.0 * sign_x), Angle::from_degrees(sign_y));
            let direction = Direction::from_longitude_latitude(longitude, latitude);
            let point = projection.project(direction).expect("on the map");
            let error = (point.x * RADIUS - x * sign_x).hypot(point.y * RADIUS - y * sign_y);
            assert!(error < 1e-8, "{projection:?}: {error} m");
        }
    }
}

/// pbrt-v4's `EqualAreaSquareToSphere` (src/pbrt/util/math.cpp), evaluated independently: r = 1 − |1 − u − v|,
/// φ = ((v − u)/r + 1) π/4, z = ±(1 − r²), its z where our front is.
#[test]
fn the_equal_area_octahedron_is_pbrt_s() {
    let pbrt = |x: f64, y: f64| {
        let (u, v) = (x.abs(), y.abs());
        let signed = 1.0 - (u + v);
        let r = 1.0 - signed.abs();
        let phi = ((v - u) / r + 1.0) * std::f64::consts::FRAC_PI_4;
        let across = r * (2.0 - r * r).sqrt();
        (phi.cos().copysign(x) * across, phi.sin().copysign(y) * across, (1.0 - r * r).copysign(signed))
    };
    let octahedron = ProjectionKind::Octahedral(Octahedral(OctahedralKind::EqualArea));
    for step in 0..400 {
        let (x, y) = (f64::from(step % 20) / 10.0 - 0.93, f64::from(step / 20) / 10.0 - 0.97);
        let (px, py, pz) = pbrt(x, y);
        let seen = octahedron.unproject(PlanePoint::new(x, y)).expect("in the square").vector();
        let error = (seen.x - px).abs() + (seen.y - py).abs() + (seen.z + pz).abs();
        assert!(error < 1e-14, "({x}, {y}): {seen}, not ({px}, {py}, {pz})");
    }
}

/// Points (x right, y down, z ahead) whose images OpenCV 5.0 computed.
const POINTS: [[f64; 3]; 3] = [[0.3, -0.2, 1.0], [-0.5, 0.4, 1.0], [0.05, 0.6, 1.0]];

/// The images of those points by a camera of focal lengths 500 and 510 and the axis at (330, 250), in OpenCV's pixels: the
/// first one's CENTRE is at (0, 0).
fn is_seen_as(lens: CalibratedLens, skew: f64, expected: [[f64; 2]; 3]) {
    let matrix = CameraMatrix::from_rows([[500.0, 500.0 * skew, 330.0], [0.0, 510.0, 250.0]]).expect("a camera");
    let frame = CalibratedCamera { lens, matrix, size: Some((640, 480)), field_of_view: None };
    let view = CameraModel::Calibrated(frame).view(640, 480).expect("a view");
    // Of twice the size, the same.
    let large = CameraModel::Calibrated(frame).view(1280, 960).expect("a view");
    for ([x, y, z], [column, row]) in POINTS.into_iter().zip(expected) {
        let direction = Direction::new(DVec3::new(x, -y, -z)).expect("a direction");
        let PixelPoint { x, y } = view.pixel(direction).expect("in the picture");
        assert!((x - 0.5 - column).hypot(y - 0.5 - row) < 1e-9, "({x}, {y}), not ({column}, {row})");
        let back = view.direction(PixelPoint::new(column + 0.5, row + 0.5)).expect("in the picture");
        assert!(back.angle_to(direction).radians() < 1e-12);
        let twice = large.pixel(direction).expect("in the picture");
        assert!((twice.x - 2.0 * x).hypot(twice.y - 2.0 * y) < 1e-9);
    }
}

/// `cv2.projectPoints(P, zeros(3), zeros(3), [[500,0,330],[0,510,250],[0,0,1]], D)` of opencv-python-headless 5.0.0.
#[test]
fn bending_pinholes_are_those_of_opencv() {
    let cases: [(&[f64], [[f64; 2]; 3]); 4] = [
        (
            &[-0.28, 0.07, 0.001, -0.0005],
            [
                [474.579_95, 151.729_833_999_999_98],
                [105.330_750_000_000_02, 433.455_568],
                [352.630_585_937_5, 528.292_496_875_000_1],
            ],
        ),
        (
            &[-0.265, -0.047, 0.0018, -0.0003, 0.252],
            [
                [474.641_901_6, 151.749_586_911_999_98],
                [104.299_151_999_999_99, 434.498_087_968_000_05],
                [352.743_009_179_687_5, 529.372_757_359_375_1],
            ],
        ),
        (
            &[10.7, 5.9, 1e-4, -2e-4, 0.28, 11.1, 9.9, 1.5],
            [
                [472.945_088_918_928_26, 152.795_129_535_128_75],
                [111.332_418_295_496_61, 428.420_200_670_874_8],
                [352.117_886_634_185_94, 521.185_119_902_436_1],
            ],
        ),
        (
            &[10.7, 5.9, 1e-4, -2e-4, 0.28, 11.1, 9.9, 1.5, 1e-3, -2e-4, 5e-4, 1e-4],
            [
                [473.008_398_918_928_26, 152.829_141_435_128_78],
                [111.520_608_295_496_6, 428.533_323_770_874_74],
                [352.285_996_009_185_96, 521.284_259_121_186_2],
            ],
        ),
    ];
    for (numbers, expected) in cases {
        let lens = BrownConrady::new(BrownConradyCoefficients::from_opencv(numbers)).expect("a lens");
        is_seen_as(CalibratedLens::Pinhole(lens), 0.0, expected);
    }
}

/// `cv2.fisheye.projectPoints` of the same, D of OpenCV's own test, then with alpha=0.005.
#[test]
fn fisheyes_are_those_of_opencv() {
    let k = [-0.001_443_158_604_254_17, -0.003_206_632_575_51, 0.004_266_118_817_27, -0.001_640_443_139_6];
    let lens = CalibratedLens::Fisheye(FisheyeLens::KannalaBrandt(KannalaBrandt::from_opencv(k).expect("a lens")));
    let rows = [152.125_062_035_689_27, 431.327_604_141_929_95, 525.271_868_808_045_8];
    let upright = [473.933_732_300_456_94, 107.784_798_845_674_09, 352.489_531_765_363_2];
    let skewed = [473.453_953_192_788_73, 108.673_659_650_291_4, 353.838_903_671_285_04];
    for (skew, columns) in [(0.0, upright), (0.005, skewed)] {
        is_seen_as(lens, skew, [0, 1, 2].map(|at| [columns[at], rows[at]]));
    }
}

/// Scaramuzza's `cam2world` (OCamCalib's C source, ocam_functions.c) with its example calibration, evaluated
/// independently: the inverse of (c d; e 1) takes row and column, from 0 at a pixel's centre, to the lens's plane; the ray
/// is that and the polynomial of its length. Their x is down, y to the right, z away from the scene.
#[test]
fn ocamcalib_s_rays_are_its_own() {
    let polynomial = [-263.6177, 0.0, 1.191_79e-3, -1.207_311e-7, 4.085_07e-9, 0.0, 0.0, 0.0];
    let (row, column) = (383.0926, 510.8651);
    // Larger than the example's, so that a mistake shows.
    let (c, d, e) = (1.01, 0.02, -0.03);
    let lens = CalibratedLens::Fisheye(FisheyeLens::Ocam(Ocam::from_coefficients(polynomial).expect("a lens")));
    let matrix = CameraMatrix::from_rows([[1.0, e, column], [d, c, row]]).expect("a camera");
    let frame = CalibratedCamera { lens, matrix, size: Some((1024, 768)), field_of_view: None };
    let view = CameraModel::Calibrated(frame).view(1024, 768).expect("a view");
    for (i, j) in [(510.0, 383.0), (700.0, 300.0), (200.0, 600.0), (430.0, 50.0), (900.0, 390.0)] {
        let (down, right) = (j - row, i - column);
        let determinant = c - d * e;
        let (x, y) = ((down - d * right) / determinant, (c * right - e * down) / determinant);
        let z = polynomial.iter().rev().fold(0.0, |sum, a| sum * x.hypot(y) + a);
        let theirs = Direction::new(DVec3::new(y, -x, z)).expect("a ray");
        let ours = view.direction(PixelPoint::new(i + 0.5, j + 0.5)).expect("in the picture");
        assert!(ours.angle_to(theirs).radians() < 1e-12, "({i}, {j}): {ours:?}, not {theirs:?}");
        let pixel = view.pixel(theirs).expect("in the picture");
        assert!((pixel.x - 0.5 - i).hypot(pixel.y - 0.5 - j) < 1e-9, "({i}, {j}): {pixel:?}");
    }
}
