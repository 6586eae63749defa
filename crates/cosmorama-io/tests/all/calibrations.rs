//! Calibrations as OpenCV, ROS and OCamCalib write them, and what is wrong with others.

use cosmorama_io::{Calibration, Distortion};

/// What `cv2.FileStorage` of OpenCV 5.0 writes.
const YAML: &str = "%YAML 1.2\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   \
                    cols: 3\n   dt: d\n   data: [ 500., 0., 330., 0., 510., 250., 0., 0., 1. ]\n\
                    distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   \
                    data: [ -0.26500000000000001, -0.047, 0.0018, -0.00029999999999999997,\n       0.252 ]\n";
const JSON: &str = r#"{"image_width": 640, "image_height": 480, "camera_matrix": {"type_id": "opencv-matrix", "rows": 3,
    "cols": 3, "dt": "d", "data": [ 500.0, 0.0, 330.0, 0.0, 510.0, 250.0, 0.0, 0.0, 1.0 ]}, "distortion_coefficients": {
    "rows": 1, "cols": 5, "dt": "d", "data": [ -0.265, -0.047, 0.0018, -0.0003, 0.252 ] } }"#;
const XML: &str = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n<image_height>480</image_height>\n\
                   <camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt><data>\n \
                   500. 0. 330. 0. 510. 250. 0. 0. 1.</data></camera_matrix>\n<distortion_coefficients>\n<data>\n    \
                   -0.265 -0.047 0.0018 -0.0003 0.252</data></distortion_coefficients>\n</opencv_storage>\n";
/// The example of OCamCalib's own C++ source, shortened in its inverse polynomial.
const OCAM: &str = "#polynomial coefficients for the DIRECT mapping function (ocam_model.ss in MATLAB). These are used by \
                    cam2world\n\n5 -2.636177e+02 0.000000e+00 1.191790e-03 -1.207311e-07 4.085070e-09 \n\n\
                    #polynomial coefficients for the inverse mapping function\n\n3 381.4 240.2 -8.9 \n\n#center: \"row\" and \
                    \"column\", starting from 0 (C convention)\n\n383.092600 510.865100\n\n#affine parameters \"c\", \"d\", \
                    \"e\"\n\n1.000134 0.000103 -0.000042\n\n#image size: \"height\" and \"width\"\n\n768 1024\n\n";

fn read(text: &str) -> Result<Calibration, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera.txt");
    std::fs::write(&path, text).unwrap();
    Calibration::read(&path).map_err(|error| error.to_string())
}

#[test]
fn what_opencv_writes_is_read() {
    let expected = Calibration {
        distortion: Distortion::OpenCv { coefficients: vec![-0.265, -0.047, 0.0018, -0.0003, 0.252], is_fisheye: None },
        matrix: [[500.0, 0.0, 330.0], [0.0, 510.0, 250.0]],
        size: Some((640, 480)),
    };
    let old = YAML.replace("%YAML 1.2", "%YAML:1.0");
    for text in [YAML, &old, JSON, XML] {
        assert_eq!(read(text).as_ref(), Ok(&expected), "{text}");
    }
    let ros = JSON.replacen('{', "{\"distortion_model\": \"plumb_bob\",", 1);
    let Distortion::OpenCv { is_fisheye, .. } = read(&ros).unwrap().distortion else { panic!("OpenCV's") };
    assert_eq!(is_fisheye, Some(false));
    // A plain list of lists, as scripts dump it.
    let plain = r#"{"K": [[500, 0, 330], [0, 510, 250], [0, 0, 1]], "D": [[0.1], [0.2], [0.3], [0.4]]}"#;
    let plain = read(plain).unwrap();
    assert_eq!((plain.matrix, plain.size), (expected.matrix, None));
}

#[test]
fn what_ocamcalib_writes_is_read() {
    let calibration = read(OCAM).unwrap();
    let polynomial = vec![-263.6177, 0.0, 1.191_79e-3, -1.207_311e-7, 4.085_07e-9];
    assert_eq!(calibration.distortion, Distortion::Ocam(polynomial));
    assert_eq!(calibration.matrix, [[1.0, -0.000_042, 510.8651], [0.000_103, 1.000_134, 383.0926]]);
    assert_eq!(calibration.size, Some((1024, 768)));
}

/// Numbers that no lens has, which would make directions that are none, with their lines.
#[test]
fn absurd_numbers_are_refused_with_their_lines() {
    for (text, expected) in [
        (YAML.replace("500.,", "1e308,"), "line 9: "),
        (YAML.replace("0.252", "-1e308"), "line 15: "),
        (YAML.replace("510.,", "1e-308,"), "line 9: "),
        (JSON.replace("-0.047", "1e100"), "line 3: "),
        (XML.replace("500. 0.", "500. 1e16"), "line 6: "),
        (XML.replace("0.252", "1e308"), "line 9: "),
        (OCAM.replace("-1.207311e-07", "1e300"), "line 3: "),
        (OCAM.replace("383.092600", "-1e16"), "line 11: "),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.contains("camera.txt") && error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn what_is_no_calibration_says_why() {
    for (text, expected) in [
        (String::new(), "no camera_matrix"),
        ("\u{0}\u{1}".to_owned(), "YAML"),
        (YAML.replace("0.0018", ".nan"), "'.nan'"),
        (YAML.replace("0.0018", "1e999"), "finite"),
        (YAML.replace(",\n       0.252", ", 1., 2."), "6 numbers"),
        (YAML.replace("500.,", "-500.,"), "fx >= 1"),
        (YAML.replace("330., 0.,", "330., 7.,"), "fx >= 1"),
        (YAML.replace("0., 0., 1. ]", "0., 0. ]"), "fx, skew"),
        // In other units than pixels, and a skew of no sensor.
        (YAML.replace("500.,", "0.78,"), "fx >= 1"),
        (XML.replace("500. 0.", "500. 5001."), "up to 10 fx"),
        (YAML.replace("640", "640.5"), "whole number"),
        (YAML.replace("camera_matrix", "M1").replace("distortion_coefficients", "M2"), "two cameras"),
        (XML.replace("</opencv_storage>", ""), "no XML"),
        (OCAM.replace("5 -2.6", "6 -2.6"), "count"),
        (OCAM.replace("768 1024", ""), "ends before the image's height"),
        (OCAM.replace("1.000134 ", ""), "3 numbers"),
        (" ".repeat(2 << 20), "megabyte"),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.contains("camera.txt") && error.contains(expected), "{expected}: {error}");
    }
}
