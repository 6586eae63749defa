use super::{Calibration, Distortion, brief, numbers, side};

/// Largest number of coefficients that are read; more have no effect in double precision.
const MOST: usize = 8;

/// Returns whether a text is OCamCalib's `calib_results.txt`, by the comments that introduce its parts.
pub(super) fn is_ocam(text: &str) -> bool {
    text.lines().any(|line| line.starts_with('#') && line.contains("polynomial coefficients for the DIRECT mapping"))
}

/// Parses the lines of numbers, in this order: the polynomial and its inverse, each after its count; the centre (row
/// and column from 0); c, d and e of the affine matrix; the image's height and width.
pub(super) fn parse(text: &str) -> Result<Calibration, String> {
    let lines = text.lines().map(str::trim).zip(1..);
    let mut lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    let mut line = |what: &str| {
        let (line, number) = lines.next().ok_or_else(|| format!("the file ends before {what}"))?;
        numbers(what, line.split_whitespace().map(|word| (word, number)))
    };
    let polynomial = counted("the polynomial", &line("the polynomial")?)?;
    if polynomial.len() > MOST {
        return Err(format!("a polynomial of {} coefficients; expected at most {MOST}", polynomial.len()));
    }
    // OCamCalib's inverse is an approximation; the library inverts the polynomial itself.
    line("the inverse polynomial")?;
    let [row, column] = exactly("the centre", &line("the centre")?)?;
    let [c, d, e] = exactly("c, d, e", &line("c, d, e")?)?;
    let [height, width] = exactly("the image's height and width", &line("the image's height and width")?)?;
    let size = (side("the image's width", width)?, side("the image's height", height)?);
    // row = c·down + d·right + row₀, column = e·down + right + column₀.
    let matrix = [[1.0, e, column], [d, c, row]];
    Ok(Calibration { distortion: Distortion::Ocam(polynomial), matrix, size: Some(size) })
}

/// Reads as many numbers as the first of them says.
fn counted(what: &str, numbers: &[f64]) -> Result<Vec<f64>, String> {
    match numbers.split_first() {
        Some((count, rest)) if *count == rest.len() as f64 && !rest.is_empty() => Ok(rest.to_vec()),
        _ => Err(format!("{what} is {}; expected their count and then so many numbers", brief(numbers))),
    }
}

fn exactly<const N: usize>(what: &str, numbers: &[f64]) -> Result<[f64; N], String> {
    numbers.try_into().map_err(|_| format!("{what}: {}; expected {N} numbers", brief(numbers)))
}
