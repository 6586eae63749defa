use super::words::{Word, Words};
use super::{Calibration, Distortion, brief, side};

/// Names of the camera matrix in various files.
const MATRIX: [&str; 7] =
    ["cameramatrix", "intrinsicmatrix", "intrinsicsmatrix", "k", "mtx", "cameramatrix1", "intrinsics"];

/// Names of the distortion coefficients.
const COEFFICIENTS: [&str; 8] = [
    "distortioncoefficients",
    "distcoeffs",
    "distcoeff",
    "distortioncoeffs",
    "d",
    "dist",
    "distortion",
    "distortioncoefficients1",
];

/// Names that only a stereo calibration has, which describes two cameras.
const SECOND: [&str; 6] = ["m2", "k2", "d2", "cameramatrix2", "distcoeffs2", "distortioncoefficients2"];

/// Lengths of OpenCV's coefficient vectors; the last includes a tilted sensor.
const LENGTHS: [usize; 5] = [4, 5, 8, 12, 14];

/// Interprets a calibration as written by OpenCV's `FileStorage`, its samples, ROS and common scripts.
pub(super) fn interpret(words: &Words) -> Result<Calibration, String> {
    if let Some((name, _)) = words.find(&SECOND) {
        return Err(format!("the calibration of two cameras ({name}); give each camera a file of its own"));
    }
    let (name, matrix) = words.find(&MATRIX).ok_or("no camera_matrix; expected OpenCV's YAML, JSON or XML")?;
    let line = matrix.first().map_or(0, |word| word.line);
    let matrix = self::matrix(name, &numbers(name, matrix)?).map_err(|reason| format!("line {line}: {reason}"))?;
    let (name, coefficients) = words.find(&COEFFICIENTS).ok_or("no distortion_coefficients")?;
    let mut coefficients = numbers(name, coefficients)?;
    if !LENGTHS.contains(&coefficients.len()) {
        return Err(format!("{name} has {} numbers; expected 4, 5, 8, 12 or 14", coefficients.len()));
    }
    if coefficients.iter().skip(12).any(|tilt| *tilt != 0.0) {
        return Err(format!("{name} has a tilted sensor (tau_x, tau_y), which is not supported; calibrate without it"));
    }
    coefficients.truncate(12);
    let is_fisheye = is_fisheye(words)?;
    Ok(Calibration { distortion: Distortion::OpenCv { coefficients, is_fisheye }, matrix, size: size(words)? })
}

fn numbers(what: &str, words: &[Word]) -> Result<Vec<f64>, String> {
    super::numbers(what, words.iter().map(|word| (word.text.as_str(), word.line)))
}

/// Least focal length in pixels: lenses have many, and a matrix in other units has less.
const LEAST: f64 = 1.0;

/// Greatest skew, in focal lengths. That of sensors is far below one.
const MOST_SKEW: f64 = 10.0;

/// Returns the first two rows of the matrix; the last must be 0, 0, 1.
fn matrix(name: &str, numbers: &[f64]) -> Result<[[f64; 3]; 2], String> {
    let [a, b, c, d, e, f, 0.0, 0.0, 1.0] = numbers[..] else {
        return Err(format!("{name} is {}; expected fx, skew, cx, 0, fy, cy, 0, 0, 1", brief(numbers)));
    };
    if d != 0.0 || a < LEAST || e < LEAST || b.abs() > MOST_SKEW * a {
        return Err(format!(
            "{name} begins {a}, {b}, {c}, {d}, {e}, {f}; expected fx >= {LEAST}, skew, cx, 0, fy >= {LEAST}, cy in pixels, and a \
             skew up to {MOST_SKEW} fx"
        ));
    }
    Ok([[a, b, c], [d, e, f]])
}

/// Returns whether the file names the fisheye model; `None` if it names no model, as OpenCV's own files do.
fn is_fisheye(words: &Words) -> Result<Option<bool>, String> {
    let word = |name: &str| words.find(&[name])?.1.first().map(|word| word.text.as_str());
    if let Some(model) = word("distortionmodel") {
        return match model.to_lowercase().as_str() {
            "equidistant" | "fisheye" => Ok(Some(true)),
            "plumb_bob" | "rational_polynomial" | "radtan" | "brown_conrady" => Ok(Some(false)),
            _ => Err(format!("distortion_model is {model}; expected equidistant, plumb_bob or rational_polynomial")),
        };
    }
    Ok(word("fisheyemodel").and_then(|flag| match flag {
        "1" => Some(true),
        "0" => Some(false),
        _ => None,
    }))
}

fn size(words: &Words) -> Result<Option<(usize, usize)>, String> {
    let first = |names: &[&str]| words.find(names).map(|(name, words)| (name, numbers(name, words)));
    let sides = (first(&["imagewidth", "width"]), first(&["imageheight", "height"]));
    let sides = match sides {
        (Some((_, width)), Some((_, height))) => [width?, height?].concat(),
        _ => match first(&["imagesize", "resolution", "size"]) {
            Some((_, sides)) => sides?,
            None => return Ok(None),
        },
    };
    match sides[..] {
        [width, height] => Ok(Some((side("the image's width", width)?, side("the image's height", height)?))),
        _ => Err(format!("the image's size is {}; expected its width and height", brief(&sides))),
    }
}
