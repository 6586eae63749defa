//! Calibrations: what programs that measure cameras write. One file per format; numbers are given as they are
//! written, and what they mean to a projection is said in the library.

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

/// A camera that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// How its lens bends.
    pub distortion: Distortion,
    /// Columns and rows of the image, from 0 at the centre of its first pixel, of a point (right, down, 1) of the lens's
    /// plane.
    pub matrix: [[f64; 3]; 2],
    /// Columns and rows of the image that was measured.
    pub size: Option<(usize, usize)>,
}

/// The model of a lens with its numbers, in its program's own order.
#[derive(Clone, Debug, PartialEq)]
pub enum Distortion {
    /// OpenCV's k1 k2 p1 p2, k3 and so on, or its fisheye's k1 to k4: four numbers are either.
    OpenCv {
        /// The numbers.
        coefficients: Vec<f64>,
        /// Whether the file says that they are (or are not) a fisheye's.
        is_fisheye: Option<bool>,
    },
    /// OCamCalib's polynomial, a0 first.
    Ocam(Vec<f64>),
}

/// No calibration is as long as that.
const LONGEST: u64 = 1 << 20;

impl Calibration {
    /// Reads a file: OpenCV's YAML, JSON or XML, or OCamCalib's `calib_results.txt`, told apart by what they begin with.
    ///
    /// # Errors
    /// When the file cannot be read, is of no such kind, or lacks what a calibration needs.
    pub fn read(path: &Path) -> Result<Self, CalibrationError> {
        let text = text(path)?;
        let found = match text.trim_start_matches('\u{feff}').trim_start().as_bytes() {
            [b'#', ..] if ocam::is_ocam(&text) => ocam::parse(&text),
            [b'<', ..] => xml::words(&text).and_then(|words| opencv::interpret(&words)),
            _ => yaml::words(&text).and_then(|words| opencv::interpret(&words)),
        };
        found.map_err(|reason| CalibrationError::Wrong { path: path.to_owned(), reason })
    }
}

fn text(path: &Path) -> Result<String, CalibrationError> {
    let open = |source| CalibrationError::Open { path: path.to_owned(), source };
    let wrong = |reason: &str| CalibrationError::Wrong { path: path.to_owned(), reason: reason.to_owned() };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes)).map_err(open)?;
    if bytes.len() as u64 > LONGEST {
        return Err(wrong("more than a megabyte, which no calibration is"));
    }
    String::from_utf8(bytes).map_err(|_| wrong("not a text; expected OpenCV's YAML, JSON or XML, or OCamCalib's text"))
}

/// A list of numbers, all of them finite.
fn numbers<'a>(what: &str, words: impl IntoIterator<Item = &'a str>) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("{what} holds '{word}'; expected a finite number")),
    };
    words.into_iter().map(number).collect()
}

/// Numbers as a message shows them: the first, and how many.
fn brief(numbers: &[f64]) -> String {
    const SHOWN: usize = 9;
    match numbers.get(..SHOWN) {
        Some(first) if numbers.len() > SHOWN => format!("{first:?} and so on, {} numbers", numbers.len()),
        _ => format!("{numbers:?}"),
    }
}

/// Columns and rows: whole numbers above zero that an image may have.
fn side(what: &str, number: f64) -> Result<usize, String> {
    if (1.0..=f64::from(u32::MAX)).contains(&number) && number.fract() == 0.0 {
        return Ok(number as usize);
    }
    Err(format!("{what} is {number}; expected a whole number of pixels"))
}
