use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::PtoError;
use super::line::{Line, Value};

/// A project: its pictures, and the panorama that is made of them.
#[derive(Clone, Debug, PartialEq)]
pub struct PtoProject {
    /// Pictures, in the project's order.
    pub images: Vec<PtoImage>,
    /// Panorama, if there is a p-line.
    pub panorama: Option<PtoPanorama>,
    /// Notes on harmless statements that are ignored.
    pub warnings: Vec<String>,
}

/// A picture, from an i-line. Angles are in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct PtoImage {
    /// Number of the picture's line, from 1.
    pub line: usize,
    /// File, relative to the project.
    pub file: PathBuf,
    /// Columns and rows.
    pub size: (usize, usize),
    /// Lens type: f.
    pub lens: u32,
    /// Field of view across the width: v.
    pub field_of_view: f64,
    /// Orientation: y, p, r.
    pub yaw_pitch_roll: [f64; 3],
    /// Lens correction: a, b, c.
    pub correction: [f64; 3],
    /// Offset of the axis in pixels: d, e.
    pub shift: [f64; 2],
    /// Crop: left, right, top and bottom (S).
    pub crop: Option<[i64; 4]>,
    /// Corners, in pixels, of masked-out polygons: k-lines.
    pub holes: Vec<Vec<[f64; 2]>>,
}

/// The panorama, from the p-line.
#[derive(Clone, Debug, PartialEq)]
pub struct PtoPanorama {
    /// Number of the panorama's line, from 1.
    pub line: usize,
    /// Projection: f.
    pub projection: u32,
    /// Columns and rows of the whole panorama.
    pub size: (usize, usize),
    /// Field of view across the width, in degrees: v.
    pub field_of_view: f64,
    /// Crop: left, right, top and bottom of the part to make (S).
    pub crop: Option<[i64; 4]>,
}

/// Greatest length of a project in bytes.
const LONGEST: u64 = 16 << 20;

/// Unsupported distortions of a picture, and their names.
const BENDS: [(&str, &str); 8] = [
    ("g", "shear"),
    ("t", "shear"),
    ("TrX", "translation of the camera"),
    ("TrY", "translation of the camera"),
    ("TrZ", "translation of the camera"),
    ("Tpy", "translation plane"),
    ("Tpp", "translation plane"),
    ("X", "translation of the camera"),
];

/// Parameters of vignetting, each with the value that has no effect.
const VIGNETTING: [(&str, f64); 6] = [("Va", 1.0), ("Vb", 0.0), ("Vc", 0.0), ("Vd", 0.0), ("Vx", 0.0), ("Vy", 0.0)];

/// Parameters of exposure and response. They have no effect if they are equal in all pictures.
const EXPOSURE: [&str; 8] = ["Eev", "Er", "Eb", "Ra", "Rb", "Rc", "Rd", "Re"];

impl PtoProject {
    /// Reads a project.
    ///
    /// # Errors
    /// When the file cannot be read, a line cannot be understood, or it asks for something unsupported; the message
    /// names it.
    pub fn read(path: &Path) -> Result<Self, PtoError> {
        let file = File::open(path).map_err(|source| PtoError::Open { path: path.to_owned(), source })?;
        Self::read_from(file, path)
    }

    /// Reads a project in memory, or from any other reader. `name` is the name in messages.
    ///
    /// # Errors
    /// When the project cannot be read, a line cannot be understood, or it asks for something unsupported; the message
    /// names it.
    pub fn read_from(source: impl Read, name: &Path) -> Result<Self, PtoError> {
        if !cfg!(feature = "hugin") {
            return Err(PtoError::NotBuilt { path: name.to_owned() });
        }
        let open = |source| PtoError::Open { path: name.to_owned(), source };
        let project = |reason: &str| PtoError::Project { path: name.to_owned(), reason: reason.to_owned() };
        let mut bytes = Vec::new();
        source.take(LONGEST + 1).read_to_end(&mut bytes).map_err(open)?;
        if bytes.len() as u64 > LONGEST {
            return Err(project("more than 16 megabytes, which no Hugin project is"));
        }
        if bytes.contains(&0) {
            return Err(project("not a text; expected a project as Hugin saves it"));
        }
        let text = String::from_utf8_lossy(&bytes);
        Self::parse(&text).map_err(|(line, reason)| match line {
            0 => project(&reason),
            line => PtoError::Line { path: name.to_owned(), line, reason },
        })
    }

    /// Parses the text; an error has its line, 0 for the whole project.
    fn parse(text: &str) -> Result<Self, (usize, String)> {
        let mut images: Vec<(usize, Line)> = Vec::new();
        let mut panorama = None;
        let mut holes: Vec<(usize, Hole)> = Vec::new();
        for (line, text) in text.lines().enumerate().map(|(index, text)| (index + 1, text.trim_end())) {
            let told = |reason: String| (line, reason);
            match text.split_at_checked(1) {
                Some(("i", rest)) => images.push((line, Line::parse(rest).map_err(told)?)),
                Some(("p", rest)) => {
                    panorama = Some(Line::parse(rest).and_then(|words| self::panorama(line, &words)).map_err(told)?)
                }
                Some(("k", rest)) => holes.push((line, hole(rest).map_err(told)?)),
                // In projects of PTStitcher, o-lines hold what i-lines hold in others.
                Some(("o", rest)) if rest.starts_with(' ') => {
                    return Err((
                        line,
                        "o-lines of old projects are not supported; save the project with Hugin".into(),
                    ));
                }
                // Options (m), variables (v), control points (c), comments and the end of a script (*) place no picture.
                None | Some(("m" | "v" | "c" | "#" | "*", _)) => {}
                Some((letter, _)) => {
                    return Err((
                        line,
                        format!(
                            "'{letter}' begins no line that is known; there are p, i, k, and m, v, c and #, which place no \
                             picture"
                        ),
                    ));
                }
            }
        }
        if images.is_empty() {
            return Err((0, "no i-line in it; a Hugin project has one for each picture".into()));
        }
        let warnings = photometry(&images)?;
        let read = |index: usize| image(&images, index).map_err(|reason| (images[index].0, reason));
        let mut images: Vec<PtoImage> = (0..images.len()).map(read).collect::<Result<_, _>>()?;
        for (line, hole) in holes {
            let count = images.len();
            let reason = || format!("i{}: expected an image, from 0 to {}", hole.image, count - 1);
            images.get_mut(hole.image).ok_or_else(|| (line, reason()))?.holes.push(hole.corners);
        }
        Ok(Self { images, panorama, warnings })
    }
}

/// Returns a parameter of an image, its own or that of the image it refers to.
fn number(images: &[(usize, Line)], index: usize, name: &str, absent: f64) -> Result<f64, String> {
    match images[index].1.value(name)? {
        None => Ok(absent),
        Some(Value::Number(number)) => Ok(number),
        Some(Value::Of(other)) if other < images.len() && other != index => match images[other].1.value(name)? {
            Some(Value::Number(number)) => Ok(number),
            _ => Err(format!("{name}={other}: image {other} has no {name} of its own")),
        },
        Some(Value::Of(other)) => {
            Err(format!("{name}={other}: expected another image, from 0 to {}", images.len() - 1))
        }
    }
}

fn image(images: &[(usize, Line)], index: usize) -> Result<PtoImage, String> {
    let (line, words) = &images[index];
    let read = |name: &str| number(images, index, name, 0.0);
    for (name, what) in BENDS {
        if read(name)? != 0.0 {
            return Err(format!("{name}: {what} is not supported; expected 0"));
        }
    }
    for (name, neutral) in VIGNETTING {
        if number(images, index, name, neutral)? != neutral {
            return Err(format!(
                "{name}: vignetting is not supported; correct the pictures first and set it to {neutral}"
            ));
        }
    }
    if words.get("C").is_some() {
        return Err("C (a crop of old projects) is not supported; save the project with Hugin, which writes S".into());
    }
    let name = words.get("n").ok_or("n, the picture's file, is missing")?.trim_matches('"');
    Ok(PtoImage {
        line: *line,
        file: name.into(),
        size: (words.side("w")?, words.side("h")?),
        lens: kind(read("f")?)?,
        field_of_view: read("v")?,
        yaw_pitch_roll: [read("y")?, read("p")?, read("r")?],
        correction: [read("a")?, read("b")?, read("c")?],
        shift: [read("d")?, read("e")?],
        crop: words.crop("S")?,
        holes: Vec::new(),
    })
}

/// A k-line: a masked polygon of an image.
struct Hole {
    image: usize,
    corners: Vec<[f64; 2]>,
}

/// Parses `k i0 t0 p"x y x y x y"`.
fn hole(text: &str) -> Result<Hole, String> {
    let (words, points) = text.split_once("p\"").ok_or("p, the mask's corners, are missing")?;
    let mut image = None;
    for word in words.split_whitespace() {
        let number = |word: &str| word.parse::<usize>().map_err(|_| format!("{word}: expected a whole number"));
        match word.split_at_checked(1) {
            Some(("i", index)) => image = Some(number(index)?),
            Some(("t", "0")) => {}
            Some(("t", kind)) => {
                return Err(format!(
                    "a mask of the kind t{kind} is not supported; there is t0, that excludes a region"
                ));
            }
            _ => return Err(format!("'{word}' is no parameter of a mask that is known")),
        }
    }
    let numbers = points.trim_end().trim_end_matches('"').split_whitespace().map(|word| match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("'{word}' is no coordinate")),
    });
    let numbers = numbers.collect::<Result<Vec<f64>, _>>()?;
    let (corners, rest) = numbers.as_chunks::<2>();
    if corners.len() < 3 || !rest.is_empty() {
        return Err(format!("a mask of {} numbers; expected x and y of three corners or more", numbers.len()));
    }
    Ok(Hole { image: image.ok_or("i, the mask's image, is missing")?, corners: corners.to_vec() })
}

fn panorama(line: usize, words: &Line) -> Result<PtoPanorama, String> {
    Ok(PtoPanorama {
        line,
        projection: kind(words.number("f")?)?,
        size: (words.side("w")?, words.side("h")?),
        field_of_view: words.number("v")?,
        crop: words.crop("S")?,
    })
}

fn kind(number: f64) -> Result<u32, String> {
    if (0.0..=1000.0).contains(&number) && number.fract() == 0.0 {
        return Ok(number as u32);
    }
    Err(format!("f{number}: expected the number of a projection"))
}

/// Checks exposure and response: equal in all pictures they have no effect, different ones are not supported.
fn photometry(images: &[(usize, Line)]) -> Result<Vec<String>, (usize, String)> {
    let mut warnings = Vec::new();
    for name in EXPOSURE {
        let absent = if matches!(name, "Er" | "Eb") { 1.0 } else { 0.0 };
        let value = |index: usize| number(images, index, name, absent).map_err(|reason| (images[index].0, reason));
        let first = value(0)?;
        for (index, (line, _)) in images.iter().enumerate() {
            let found = value(index)?;
            if found != first {
                let reason = format!(
                    "{name}{found}, but image 0 has {name}{first}: exposure, white balance and response by picture are not supported; make the pictures alike first"
                );
                return Err((*line, reason));
            }
        }
        if first != absent {
            warnings.push(format!("{name}{first} of the project is left out: it is the same in all pictures"));
        }
    }
    Ok(warnings)
}
