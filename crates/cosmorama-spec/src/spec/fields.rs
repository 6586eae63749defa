use std::path::{Path, PathBuf};

use cosmorama::camera::{Canvas, LensCircle, Mirror, PixelPoint, SamplePositions};
use cosmorama::sphere::{Angle, Orientation};

use crate::angle::parse_degrees;
use crate::window::parse_window;
use crate::{SpecError, did_you_mean};

/// Greatest aspect of a pixel, either way; more is a typing error.
const LONGEST_PIXEL: f64 = 1000.0;

/// Keys and values of a SPEC, whose names have been checked, and the folder of the files that it names.
pub(super) struct Fields<'a>(Vec<(String, String)>, &'a Path);

impl<'f> Fields<'f> {
    pub(super) fn new(pairs: Vec<(String, String)>, folder: &'f Path) -> Self {
        Self(pairs, folder)
    }

    /// Returns the folder of files that the SPEC names.
    pub(super) fn folder(&self) -> &Path {
        self.1
    }

    /// Returns the path of a file that the SPEC names.
    pub(super) fn file(&self, key: &str) -> Option<PathBuf> {
        self.get(key).map(|name| self.1.join(name))
    }

    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    /// Visits the keys with a prefix, without the prefix, and their values.
    pub(super) fn with_prefix<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.0.iter().filter_map(move |(key, value)| Some((key.strip_prefix(prefix)?, value.as_str())))
    }

    /// Reads a value with `parse`, if there is one.
    pub(super) fn read<T>(
        &self,
        key: &str,
        expected: &str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, SpecError> {
        self.get(key).map(|value| parse(value).ok_or_else(|| wrong(key, value, expected))).transpose()
    }

    pub(super) fn angle(&self, key: &str) -> Result<Option<Angle>, SpecError> {
        self.read(key, &format!("an angle in degrees, as in {key}=90"), parse_degrees)
    }

    pub(super) fn angle_or(&self, key: &str, default: f64) -> Result<Angle, SpecError> {
        Ok(self.angle(key)?.unwrap_or(Angle::from_degrees(default)))
    }

    /// Reads an angle between an axis and the vertical or the horizontal; none unless given.
    pub(super) fn slope(&self, key: &str) -> Result<Angle, SpecError> {
        let expected = format!("an angle from -90 to 90 degrees, as in {key}=20");
        let parse = |value: &str| parse_degrees(value).filter(|angle| angle.degrees().abs() <= 90.0);
        Ok(self.read(key, &expected, parse)?.unwrap_or(Angle::ZERO))
    }

    /// Reads one of a list of words.
    pub(super) fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>, SpecError> {
        let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        let find = |value: &str| choices.iter().find(|(name, _)| *name == value).map(|(_, choice)| *choice);
        let expected = |value: &str| format!("one of {}{}", names.join(", "), did_you_mean(value, &names));
        self.get(key).map(|value| find(value).ok_or_else(|| wrong(key, value, expected(value)))).transpose()
    }

    pub(super) fn positive(&self, key: &str, expected: &str) -> Result<Option<f64>, SpecError> {
        self.read(key, expected, |value| value.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite()))
    }

    pub(super) fn aspect(&self) -> Result<f64, SpecError> {
        let expected = "a pixel's width over its height, from 0.001 to 1000, as in aspect=1.2";
        let aspect = self.read("aspect", expected, |value| {
            value.parse().ok().filter(|aspect| (LONGEST_PIXEL.recip()..=LONGEST_PIXEL).contains(aspect))
        });
        Ok(aspect?.unwrap_or(1.0))
    }

    pub(super) fn circle(&self) -> Result<LensCircle, SpecError> {
        self.circle_of("")
    }

    /// Reads the circle whose keys have a prefix.
    pub(super) fn circle_of(&self, prefix: &str) -> Result<LensCircle, SpecError> {
        let key = format!("{prefix}center");
        let centre = self.read(&key, &format!("X:Y in pixels, as in {key}=983:921.5"), |value| {
            let (x, y) = value.split_once(':')?;
            let (x, y): (f64, f64) = (x.parse().ok()?, y.parse().ok()?);
            (x.is_finite() && y.is_finite()).then(|| PixelPoint::new(x, y))
        })?;
        let radius = self.positive(&format!("{prefix}radius"), "a radius in pixels, more than 0")?;
        Ok(LensCircle { centre, radius })
    }

    pub(super) fn orientation(&self) -> Result<Orientation, SpecError> {
        self.orientation_of("")
    }

    /// Reads the orientation whose keys have a prefix.
    pub(super) fn orientation_of(&self, prefix: &str) -> Result<Orientation, SpecError> {
        let [yaw, pitch, roll] = ["yaw", "pitch", "roll"].map(|key| self.angle_or(&format!("{prefix}{key}"), 0.0));
        Ok(Orientation::from_yaw_pitch_roll(yaw?, pitch?, roll?))
    }

    /// Reads the width of the band over which overlapping pictures fade out.
    pub(super) fn feather(&self) -> Result<Option<Angle>, SpecError> {
        self.read("feather", "degrees more than 0, at most 180, as in feather=5", |value| {
            parse_degrees(value).filter(|angle| angle.degrees() > 0.0 && angle.degrees() <= 180.0)
        })
    }

    pub(super) fn mirror(&self) -> Result<Mirror, SpecError> {
        let mirror = |x, y| Mirror { x, y };
        let choices = [
            ("x", mirror(true, false)),
            ("y", mirror(false, true)),
            ("xy", mirror(true, true)),
            ("yx", mirror(true, true)),
        ];
        Ok(self.choice("flip", &choices)?.unwrap_or_default())
    }

    /// Reads the position of the outermost samples.
    pub(super) fn samples(&self) -> Result<Option<SamplePositions>, SpecError> {
        let positions = [
            ("centres", SamplePositions::Centres),
            ("centers", SamplePositions::Centres),
            ("edges", SamplePositions::Edges),
        ];
        self.choice("samples", &positions)
    }

    pub(super) fn canvas(&self, key: &str) -> Result<Option<Canvas>, SpecError> {
        let expected = format!("WxH+X+Y: the canvas's size and the image's place in it, as in {key}=1024x1024+512+0");
        self.read(key, &expected, parse_window)
    }
}

/// Returns the word for the position of the outermost samples.
pub(super) fn samples_name(samples: SamplePositions) -> &'static str {
    match samples {
        SamplePositions::Centres => "centres",
        SamplePositions::Edges => "edges",
    }
}

pub(super) fn wrong(key: &str, value: &str, expected: impl Into<String>) -> SpecError {
    SpecError::Value { key: key.to_owned(), value: value.to_owned(), expected: expected.into() }
}
