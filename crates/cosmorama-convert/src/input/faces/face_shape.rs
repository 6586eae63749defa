use std::path::PathBuf;

use cosmorama::camera::Canvas;
use cosmorama::layout::{FacePart, FacePlacement};
use cosmorama::sphere::CubeFace;

use crate::diagnostic::{Code, ConvertError, Diagnostic, FROM, Result, failure};

/// Picture of a face, as in its file.
pub(crate) struct FacePicture {
    pub(crate) face: CubeFace,
    pub(crate) path: PathBuf,
    pub(crate) canvas: Canvas,
    /// Columns and rows of the file.
    pub(crate) size: (usize, usize),
    /// Placement in the file.
    pub(crate) lies: FacePlacement,
    /// Whether `canvas=` declares its shape, which then is not checked.
    pub(crate) is_declared: bool,
}

/// Greatest stretch of a face. A face spans 90° both ways whatever its pixels, but a picture that is stretched more is
/// something else, or a crop without its window.
const MOST_STRETCH: f64 = 1.5;

/// Greatest difference in shape at which a face among others still counts as whole; it allows for television's pixels
/// (1024x960 beside 1024x1024 is 1.07). Beyond it, the face looks cropped.
const MOST_DIFFERENCE: f64 = 1.125;

/// Difference below which shapes are equal but for rounding to whole pixels.
const SAME: f64 = 1.01;

/// Returns the size of a face without a file: that of the first face with the most common shape. A face that looks
/// cropped is an error; one that differs a little is reported. `half` is the half of a cube that the files are declared
/// to hold.
pub(crate) fn size_of_missing(
    pictures: &[FacePicture],
    half: Option<CubeFace>,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(usize, usize)> {
    let usual = usual(pictures);
    let size = usual.map_or((1, 1), |canvas| (canvas.width, canvas.height));
    let expected = usual.filter(|canvas| is_face(canvas)).map_or("a square, or nearly so".to_owned(), shape);
    let looks_cropped = |picture: &&FacePicture| {
        let differs = usual.is_some_and(|usual| difference(&picture.canvas, usual) > MOST_DIFFERENCE);
        !picture.is_declared && (!is_face(&picture.canvas) || differs)
    };
    let wrong: Vec<&FacePicture> = pictures.iter().filter(looks_cropped).collect();
    if let [first, others @ ..] = &wrong[..] {
        return Err(
            other_half_error(first, pictures, half).unwrap_or_else(|| looks_cropped_error(first, others, &expected))
        );
    }
    let odd = |picture: &&FacePicture| {
        !picture.is_declared && usual.is_some_and(|usual| difference(&picture.canvas, usual) > SAME)
    };
    warnings.extend(pictures.iter().filter(odd).map(|picture| taken_as_whole(picture, &expected)));
    let of_other_size = |picture: &&FacePicture| {
        let Canvas { width, height, .. } = picture.canvas;
        !picture.is_declared && !odd(picture) && (width, height) != size
    };
    warnings.extend(of_several_sizes(&pictures.iter().filter(of_other_size).collect::<Vec<_>>(), size));
    Ok(size)
}

/// Returns whether files fit a half of a cube, or a whole one if `half` is `None`. Whole faces are nearly square and
/// alike. Half faces have one size, unlike crops a little beyond the middle.
fn are_of(pictures: &[FacePicture], half: Option<CubeFace>) -> bool {
    let canvas = |picture: &FacePicture| {
        let part = FacePart::of(picture.face, picture.lies, half)?;
        Some(part.canvas(picture.size.0, picture.size.1))
    };
    let canvases: Option<Vec<Canvas>> = pictures.iter().map(canvas).collect();
    let is_alike = |one: &Canvas, other: &Canvas| match half {
        // Half of an odd number is rounded.
        Some(_) => one.width.abs_diff(other.width) <= 1 && one.height.abs_diff(other.height) <= 1,
        None => difference(one, other) < MOST_DIFFERENCE,
    };
    canvases.is_some_and(|all| all.iter().all(|one| is_face(one) && is_alike(one, &all[0])))
}

/// Returns the error for files that would fit if another half of a cube, or a whole one, were declared.
fn other_half_error(first: &FacePicture, pictures: &[FacePicture], half: Option<CubeFace>) -> Option<ConvertError> {
    let FacePicture { face, path, size: (width, height), .. } = first;
    let found = format!("{}: the {face} face's file is {width}x{height}", path.display());
    if let (Some(half), true) = (half, are_of(pictures, None)) {
        return Some(failure!(
            WrongSize: "{found}, a whole face, but half={half} says that it holds a half; leave half= out: of whole faces, too, only \
             what is needed is used"
        ));
    }
    let halves: Vec<_> = CubeFace::ALL.into_iter().filter(|other| are_of(pictures, Some(*other))).collect();
    let names: Vec<_> = halves.iter().map(|half| format!("half={half} ({})", about(*half))).collect();
    (!names.is_empty()).then(
        || failure!(WrongSize: "{found}, half a face, and so are others: give {FROM} cube:{}", names.join(" or ")),
    )
}

/// Describes what half a cube holds.
fn about(half: CubeFace) -> &'static str {
    match half {
        CubeFace::Up => "the sky: the upper halves of the sides and the top",
        CubeFace::Down => "the ground: the lower halves of the sides and the bottom",
        CubeFace::Front => "the front, and the half beside it of each neighbour",
        CubeFace::Back => "the back, and the half beside it of each neighbour",
        CubeFace::Left => "the left face, and the half beside it of each neighbour",
        CubeFace::Right => "the right face, and the half beside it of each neighbour",
    }
}

/// Returns the most common shape among pictures that look like faces.
fn usual(pictures: &[FacePicture]) -> Option<&Canvas> {
    let alike = |canvas: &Canvas| pictures.iter().filter(|other| difference(canvas, &other.canvas) < SAME).count();
    let rank = |canvas: &&Canvas| (is_face(canvas), alike(canvas));
    // Of equals `max_by_key` returns the last, hence the reversed order.
    pictures.iter().rev().map(|picture| &picture.canvas).max_by_key(rank)
}

fn is_face(canvas: &Canvas) -> bool {
    (MOST_STRETCH.recip()..=MOST_STRETCH).contains(&ratio(canvas))
}

/// Returns the ratio of two stretches, at least 1.
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

fn looks_cropped_error(first: &FacePicture, others: &[&FacePicture], expected: &str) -> ConvertError {
    let FacePicture { face, path, canvas, .. } = first;
    let also: Vec<_> = others.iter().map(|other| format!("{} is {}", other.face, shape(&other.canvas))).collect();
    let also = if also.is_empty() { String::new() } else { format!(" ({}, too)", also.join(", ")) };
    failure!(
        WrongSize: "{}: the {face} face is {}, the wrong shape for a face{also}; expected {expected}; if it is a cropped file, declare \
         its place in the whole face with {FROM} cube:canvas.{face}=WxH+X+Y; if it is all of the face, say so with \
         canvas.{face}={}+0+0",
        path.display(),
        shape(canvas),
        shape(canvas),
    )
}

fn of_several_sizes(others: &[&FacePicture], (width, height): (usize, usize)) -> Option<Diagnostic> {
    let names = |picture: &&FacePicture| format!("{} {}x{}", picture.face, picture.canvas.width, picture.canvas.height);
    let list = others.iter().map(names).collect::<Vec<_>>().join(", ");
    let path = others.first()?.path.display();
    let message = format!(
        "{path}: faces have different sizes: {list}, the others {width}x{height}; each is used as sharp as it is; if they are \
         to be alike, render them again"
    );
    Some(Diagnostic::warning(Code::FaceShape, message).about(path))
}

fn taken_as_whole(picture: &FacePicture, expected: &str) -> Diagnostic {
    let FacePicture { face, path, canvas, .. } = picture;
    let message = format!(
        "{}: the {face} face is {}, others are {expected}; it is taken as whole, its pixels not square; if it is cropped, \
         declare its place with {FROM} cube:canvas.{face}=WxH+X+Y",
        path.display(),
        shape(canvas),
    );
    Diagnostic::warning(Code::FaceShape, message).about(path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the error or the warnings of faces of these sizes.
    fn judge(sizes: &[(usize, usize)], declared: &[CubeFace]) -> Result<Vec<String>, String> {
        let picture = |(face, &(width, height)): (CubeFace, &(usize, usize))| FacePicture {
            face,
            path: format!("{face}.png").into(),
            canvas: Canvas { width, height, left: 0, top: 0 },
            size: (width, height),
            lies: FacePlacement::UPRIGHT,
            is_declared: declared.contains(&face),
        };
        let pictures: Vec<_> = CubeFace::ALL.into_iter().zip(sizes).map(picture).collect();
        let mut warnings = Vec::new();
        size_of_missing(&pictures, None, &mut warnings).map_err(|error| error.to_string())?;
        Ok(warnings.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn whole_faces_of_any_size_and_nearly_any_pixels() {
        let warnings = judge(&[(1024, 1024), (512, 512), (2048, 2048)], &[]).unwrap();
        assert!(warnings.len() == 1 && warnings[0].contains("faces have different sizes"), "{warnings:?}");
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
    fn halves_of_faces_are_the_files_of_half_a_cube() {
        // Front, right, back, left, up.
        let error = judge(&[(64, 32), (64, 32), (64, 32), (64, 32), (64, 64)], &[]).unwrap_err();
        assert!(
            error.contains("front face's file is 64x32, half a face") && error.contains("half=up (the sky"),
            "{error}"
        );
        // Crops of a little more than a half, as the demo renders them.
        let error = judge(&[(64, 64), (35, 64), (64, 64), (35, 64), (64, 35)], &[]).unwrap_err();
        assert!(error.contains("declare its place") && !error.contains("half="), "{error}");
        // With half faces at the sides alone, the half may be the upper or the lower one.
        let error = judge(&[(64, 32); 4], &[]).unwrap_err();
        assert!(error.contains("cube:half=up (the sky") && error.contains(" or half=down (the ground"), "{error}");
        let pictures = |size: (usize, usize), canvas: (usize, usize)| {
            let canvas = Canvas { width: canvas.0, height: canvas.1, left: 0, top: 0 };
            let lies = FacePlacement::UPRIGHT;
            [FacePicture { face: CubeFace::Left, path: "left.png".into(), canvas, size, lies, is_declared: false }]
        };
        // A whole face, of which half=up made one of twice its height.
        let error = size_of_missing(&pictures((64, 64), (64, 128)), Some(CubeFace::Up), &mut Vec::new()).unwrap_err();
        assert!(error.to_string().contains("64x64, a whole face, but half=up"), "{error}");
    }

    #[test]
    fn what_is_declared_is_believed() {
        assert_eq!(judge(&[(1024, 1024), (512, 1024)], &[CubeFace::Right]), Ok(Vec::new()));
    }
}
