//! Calibrations as camera calibration programs write them, one file per format. Numbers are returned as written; the
//! library interprets them.

mod error;
mod ocam;
mod opencv;
mod words;
mod xml;
mod yaml;

pub use error::CalibrationError;

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// A calibrated camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Distortion of the lens.
    pub distortion: Distortion,
    /// First two rows of the camera matrix. They map a point (right, down, 1) of the lens's plane to columns and rows
    /// of the image, counted from 0 at the centre of its first pixel.
    pub matrix: [[f64; 3]; 2],
    /// Columns and rows of the calibrated image.
    pub size: Option<(usize, usize)>,
}

/// Distortion model of a lens, with its coefficients in the program's own order.
#[derive(Clone, Debug, PartialEq)]
pub enum Distortion {
    /// OpenCV's k1 k2 p1 p2, k3 and so on, or k1 to k4 of its fisheye model; four numbers may be either.
    OpenCv {
        /// The numbers.
        coefficients: Vec<f64>,
        /// Whether the file says that they belong to the fisheye model; `None` if it does not say.
        is_fisheye: Option<bool>,
    },
    /// OCamCalib's polynomial, beginning with a0.
    Ocam(Vec<f64>),
}

/// Greatest length of a calibration file in bytes.
const LONGEST: u64 = 1 << 20;

impl Calibration {
    /// Reads OpenCV's YAML, JSON or XML, or OCamCalib's `calib_results.txt`. The file's first characters tell which it
    /// is.
    ///
    /// # Errors
    /// When the file cannot be read, is none of these, or lacks what a calibration needs.
    pub fn read(path: &Path) -> Result<Self, CalibrationError> {
        let file = File::open(path).map_err(|source| CalibrationError::Open { path: path.to_owned(), source })?;
        Self::read_from(file, path)
    }

    /// Reads a calibration in memory, or from any other reader. `name` is the name in messages.
    ///
    /// # Errors
    /// When the file cannot be read, is of no kind that [`read`](Self::read) reads, or lacks what a calibration needs.
    pub fn read_from(source: impl Read, name: &Path) -> Result<Self, CalibrationError> {
        let text = text(source, name)?;
        let found = match text.trim_start_matches('\u{feff}').trim_start().as_bytes() {
            [b'#', ..] if ocam::is_ocam(&text) => ocam::parse(&text),
            [b'<', ..] => xml::words(&text).and_then(|words| opencv::interpret(&words)),
            _ => yaml::words(&text).and_then(|words| opencv::interpret(&words)),
        };
        found.map_err(|reason| CalibrationError::Wrong { path: name.to_owned(), reason })
    }
}

fn text(source: impl Read, path: &Path) -> Result<String, CalibrationError> {
    let open = |source| CalibrationError::Open { path: path.to_owned(), source };
    let wrong = |reason: &str| CalibrationError::Wrong { path: path.to_owned(), reason: reason.to_owned() };
    let mut bytes = Vec::new();
    source.take(LONGEST + 1).read_to_end(&mut bytes).map_err(open)?;
    if bytes.len() as u64 > LONGEST {
        return Err(wrong("more than a megabyte, which no calibration is"));
    }
    String::from_utf8(bytes).map_err(|_| wrong("not a text; expected OpenCV's YAML, JSON or XML, or OCamCalib's text"))
}

/// Greatest number of a calibration. Greater ones make directions of a picture's pixels that are none.
const GREATEST: f64 = 1e15;

/// Parses a list of finite numbers, each with its line.
fn numbers<'a>(what: &str, words: impl IntoIterator<Item = (&'a str, usize)>) -> Result<Vec<f64>, String> {
    let number = |(word, line): (&str, usize)| match word.parse::<f64>() {
        Ok(number) if number.abs() <= GREATEST => Ok(number),
        _ => Err(format!(
            "line {line}: {what} holds '{word}'; expected a finite number, from -{GREATEST:e} to {GREATEST:e}"
        )),
    };
    words.into_iter().map(number).collect()
}

/// Formats numbers for a message: the first ones, and how many there are.
fn brief(numbers: &[f64]) -> String {
    const SHOWN: usize = 9;
    match numbers.get(..SHOWN) {
        Some(first) if numbers.len() > SHOWN => format!("{first:?} and so on, {} numbers", numbers.len()),
        _ => format!("{numbers:?}"),
    }
}

/// Converts a number of columns or rows: whole, above zero, and possible for an image.
fn side(what: &str, number: f64) -> Result<usize, String> {
    if (1.0..=f64::from(u32::MAX)).contains(&number) && number.fract() == 0.0 {
        return Ok(number as usize);
    }
    Err(format!("{what} is {number}; expected a whole number of pixels"))
}
