use std::path::PathBuf;

use anyhow::{Result, anyhow};
use cosmorama::sphere::CubeFace;
use cosmorama::world::Canvas;

/// A face's picture as its file has it.
pub(super) struct FacePicture {
    pub(super) face: CubeFace,
    pub(super) path: PathBuf,
    pub(super) canvas: Canvas,
    /// Whether `canvas=` says so: then it is right, whatever its shape.
    pub(super) is_declared: bool,
}

/// Faces span 90° both ways whatever their pixels, but one that is stretched more than this is none: it is the whole
/// picture of something else, or a crop without its window.
const MOST_STRETCH: f64 = 1.5;

/// Beside faces of another shape, one is taken as whole up to this difference, the most that television's pixels differ
/// from squares (1024x960 beside 1024x1024 is 1.07). Beyond it, it looks cropped.
const MOST_DIFFERENCE: f64 = 1.125;

/// Under this, shapes are the same but for whole pixels.
const SAME: f64 = 1.01;

/// The size of a face that has no file: that of the first of the shape which most faces have. A face that looks cropped
/// is an error; one that differs by a little is told.
pub(super) fn size_of_missing(pictures: &[FacePicture], warnings: &mut Vec<String>) -> Result<(usize, usize)> {
    let usual = usual(pictures);
    let size = usual.map_or((1, 1), |canvas| (canvas.width, canvas.height));
    let expected = usual.filter(|canvas| is_face(canvas)).map_or("a square, or nearly so".to_owned(), shape);
    let looks_cropped = |picture: &&FacePicture| {
        let differs = usual.is_some_and(|usual| difference(&picture.canvas, usual) > MOST_DIFFERENCE);
        !picture.is_declared && (!is_face(&picture.canvas) || differs)
    };
    let wrong: Vec<&FacePicture> = pictures.iter().filter(looks_cropped).collect();
    if let [first, others @ ..] = &wrong[..] {
        return Err(looks_cropped_error(first, others, &expected));
    }
    let odd = |picture: &&FacePicture| {
        !picture.is_declared && usual.is_some_and(|usual| difference(&picture.canvas, usual) > SAME)
    };
    warnings.extend(pictures.iter().filter(odd).map(|picture| taken_as_whole(picture, &expected)));
    Ok(size)
}

/// What most faces look like, of those that look like faces, if any do.
fn usual(pictures: &[FacePicture]) -> Option<&Canvas> {
    let alike = |canvas: &Canvas| pictures.iter().filter(|other| difference(canvas, &other.canvas) < SAME).count();
    let rank = |canvas: &&Canvas| (is_face(canvas), alike(canvas));
    // Of equals the last counts, so the first of all is put there.
    pictures.iter().rev().map(|picture| &picture.canvas).max_by_key(rank)
}

fn is_face(canvas: &Canvas) -> bool {
    (MOST_STRETCH.recip()..=MOST_STRETCH).contains(&ratio(canvas))
}

/// How much more stretched one is than the other, at least 1.
fn difference(a: &Canvas, b: &Canvas) -> f64 {
    let quotient = ratio(a) / ratio(b);
    quotient.max(quotient.recip())
}

fn ratio(canvas: &Canvas) -> f64 {
    canvas.width as f64 / canvas.height as f64
}

fn shape(canvas: &Canvas) -> String {
    format!("{}x{}", canvas.width, canvas.height)
}

fn looks_cropped_error(first: &FacePicture, others: &[&FacePicture], expected: &str) -> anyhow::Error {
    let FacePicture { face, path, canvas, .. } = first;
    let also: Vec<_> = others.iter().map(|other| format!("{} is {}", other.face, shape(&other.canvas))).collect();
    let also = if also.is_empty() { String::new() } else { format!(" ({}, too)", also.join(", ")) };
    anyhow!(
        "{}: the {face} face is {}, the wrong shape for a face{also}; expected {expected}; if it is a cropped file, declare \
         its place in the whole face with --from cube:canvas.{face}=WxH+X+Y; if it is all of the face, say so with \
         canvas.{face}={}+0+0",
        path.display(),
        shape(canvas),
        shape(canvas),
    )
}

fn taken_as_whole(picture: &FacePicture, expected: &str) -> String {
    let FacePicture { face, path, canvas, .. } = picture;
    format!(
        "{}: the {face} face is {}, others are {expected}; it is taken as whole, its pixels not square; if it is cropped, \
         declare its place with --from cube:canvas.{face}=WxH+X+Y",
        path.display(),
        shape(canvas),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error or the warnings of faces of these sizes.
    fn judge(sizes: &[(usize, usize)], declared: &[CubeFace]) -> Result<Vec<String>, String> {
        let picture = |(face, &(width, height)): (CubeFace, &(usize, usize))| FacePicture {
            face,
            path: format!("{face}.png").into(),
            canvas: Canvas { width, height, left: 0, top: 0 },
            is_declared: declared.contains(&face),
        };
        let pictures: Vec<_> = CubeFace::ALL.into_iter().zip(sizes).map(picture).collect();
        let mut warnings = Vec::new();
        size_of_missing(&pictures, &mut warnings).map_err(|error| error.to_string())?;
        Ok(warnings)
    }

    #[test]
    fn whole_faces_of_any_size_and_nearly_any_pixels() {
        assert_eq!(judge(&[(1024, 1024), (512, 512), (2048, 2048)], &[]), Ok(Vec::new()));
        assert_eq!(judge(&[(1024, 960); 4], &[]), Ok(Vec::new()));
        assert_eq!(judge(&[(720, 486); 6], &[]), Ok(Vec::new()));
        let warnings = judge(&[(1024, 1024), (1024, 960), (1024, 1024)], &[]).unwrap();
        assert!(
            warnings.len() == 1 && warnings[0].starts_with("right.png: the right face is 1024x960"),
            "{warnings:?}"
        );
    }

    #[test]
    fn what_looks_cropped_is_named_and_nothing_else() {
        let error = judge(&[(1024, 1024), (512, 1024), (1024, 1024), (1024, 1024)], &[]).unwrap_err();
        assert!(error.starts_with("right.png: the right face is 512x1024"), "{error}");
        assert!(error.contains("expected 1024x1024") && error.contains("canvas.right=WxH+X+Y"), "{error}");
        // Most of them are cropped; the front is not.
        let error = judge(&[(1024, 1024), (512, 1024), (512, 1024), (512, 1024), (1024, 512)], &[]).unwrap_err();
        assert!(error.starts_with("right.png") && error.contains("back is 512x1024"), "{error}");
        assert!(error.contains("up is 1024x512") && !error.contains("front"), "{error}");
        let error = judge(&[(1024, 1024), (1024, 768)], &[]).unwrap_err();
        assert!(error.starts_with("right.png"), "{error}");
        let error = judge(&[(128, 64); 6], &[]).unwrap_err();
        assert!(error.contains("a square, or nearly so"), "{error}");
    }

    #[test]
    fn what_is_declared_is_believed() {
        assert_eq!(judge(&[(1024, 1024), (512, 1024)], &[CubeFace::Right]), Ok(Vec::new()));
    }
}
