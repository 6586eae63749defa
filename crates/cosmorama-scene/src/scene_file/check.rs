//! Checks of what a scene file says, before any file that it names is read.

use std::collections::HashMap;
use std::ops::Range;

use cosmorama_spec::did_you_mean;
use toml::Spanned;

use super::error::SceneFileError;
use super::written::{Key, Kind, LightEntry, ObjectEntry, place, value};
use super::{CHROME, SceneFile, USUAL};
use crate::material::{Highlight, HighlightError};

/// Most things of a file, most lights, and most tables of chrome, which take memory.
const MOST_OBJECTS: usize = 100_000;
const MOST_LIGHTS: usize = 1000;
const MOST_TABLES: usize = 256;

/// Greatest number of places, angles and sizes: products of a few of them are finite.
const MOST: f64 = 1e30;

impl SceneFile {
    /// Checks that all that is named is there, and that numbers of things, lights and worlds are some.
    pub(super) fn check(&self) -> Result<(), SceneFileError> {
        let written = &self.written;
        if written.object.is_empty() {
            let message = "there is no [[object]] in it; one is shape = \"sphere\" and a material";
            return Err(self.source.error(None, message));
        }
        let tables = written.material.values().filter(|material| material.get_ref().chrome.is_some()).count();
        self.check_count("objects", written.object.len(), MOST_OBJECTS)?;
        self.check_count("lights", written.light.len(), MOST_LIGHTS)?;
        self.check_count("tables of chrome", tables, MOST_TABLES)?;
        self.check_point("eye", &written.camera.eye)?;
        self.check_point("target", &written.camera.target)?;
        self.worlds()?;
        written.object.iter().try_for_each(|object| self.check_object(object))?;
        self.check_names()?;
        self.check_lights()
    }

    fn check_count(&self, what: &str, count: usize, most: usize) -> Result<(), SceneFileError> {
        let message = || format!("{count} {what}, but {most} are the most");
        if count > most { Err(self.source.error(None, message())) } else { Ok(()) }
    }

    /// Checks that a point has finite numbers, if it is given.
    pub(super) fn check_point(&self, name: &str, point: &Key<[f64; 3]>) -> Result<(), SceneFileError> {
        match value(point) {
            Some(numbers) if !numbers.iter().all(|number| number.abs() <= MOST) => {
                Err(self.source.error(place(point), format!("{name} takes finite numbers, up to {MOST:e}")))
            }
            _ => Ok(()),
        }
    }

    /// Checks that what an object names is there, and that its numbers are some.
    fn check_object(&self, object: &Spanned<ObjectEntry>) -> Result<(), SceneFileError> {
        let entry = object.get_ref();
        let materials = self.written.material.keys().map(String::as_str).chain(USUAL);
        self.known("material", entry.material.as_ref(), materials.collect())?;
        self.known("world", entry.world.as_ref(), self.written.world.keys().map(String::as_str).collect())?;
        let wrong = |message: &str, at: Option<Range<usize>>| Err(self.source.error(at, message));
        if entry.shape.is_some() == entry.file.is_some() {
            return wrong("an object has a shape = \"sphere\", or a file = \"model.obj\"", Some(object.span()));
        }
        if value(&entry.crease).is_some_and(|crease| entry.file.is_none() || !(0.0..=180.0).contains(&crease)) {
            return wrong("crease is an angle from 0 to 180 degrees, of a model's file", place(&entry.crease));
        }
        self.check_point("translate", &entry.translate)?;
        self.check_point("rotate", &entry.rotate)?;
        match value(&entry.scale) {
            Some(scale) if !(scale > 0.0 && scale <= MOST) => {
                wrong(&format!("scale = {scale:?}: expected a number more than 0, up to {MOST:e}"), place(&entry.scale))
            }
            _ => Ok(()),
        }
    }

    /// Checks that no two objects have one name: `--part` would put both under its world. Models without a name have none.
    fn check_names(&self) -> Result<(), SceneFileError> {
        let mut known: HashMap<String, Range<usize>> = HashMap::new();
        for (index, object) in self.written.object.iter().enumerate() {
            let entry = object.get_ref();
            if entry.name.is_none() && entry.file.is_some() {
                continue;
            }
            let (name, at) = (entry.name_of_sphere(index), place(&entry.name).unwrap_or_else(|| object.span()));
            if let Some(first) = known.insert(name.clone(), at.clone()) {
                let line = self.source.line(&first);
                let message = format!("'{name}' is the name of the object of line {line}, too; give each its own");
                return Err(self.source.error(Some(at), message));
            }
        }
        Ok(())
    }

    /// Checks that lights are some, and that there is chrome for them.
    fn check_lights(&self) -> Result<(), SceneFileError> {
        let Some(first) = self.written.light.first() else { return Ok(()) };
        for light in &self.written.light {
            light.highlight().map_err(|error| self.source.error(light.key_of(&error), error.to_string()))?;
        }
        let is_chrome = |name: &Spanned<String>| match self.written.material.get(name.get_ref()) {
            Some(material) => material.get_ref().kind == Some(Kind::Chrome),
            None => name.get_ref() == CHROME,
        };
        let mut materials = self.written.object.iter().filter_map(|object| object.get_ref().material.as_ref());
        if materials.any(is_chrome) {
            return Ok(());
        }
        let message = "lights shine on chrome, and no object is of it; add material = \"chrome\"";
        Err(self.source.error(Some(first.yaw.span()), message))
    }

    fn known(&self, what: &str, name: Option<&Spanned<String>>, known: Vec<&str>) -> Result<(), SceneFileError> {
        let Some(name) = name.filter(|name| !known.contains(&name.get_ref().as_str())) else { return Ok(()) };
        let all = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let meant = did_you_mean(name.get_ref(), &known);
        let message = format!("there is no {what} '{}'; there is {all}{meant}", name.get_ref());
        Err(self.source.error(Some(name.span()), message))
    }
}

impl LightEntry {
    /// Returns the light, as `--highlight` makes it.
    pub(super) fn highlight(&self) -> Result<Highlight, HighlightError> {
        let power = value(&self.power).unwrap_or(Highlight::USUAL_POWER);
        let white = Highlight::new([*self.yaw.get_ref(), *self.pitch.get_ref()], power)?;
        Ok(self.color.map_or(white, |color| Highlight { colour: color.0, ..white }))
    }

    /// Returns the place of the number that is out of range.
    fn key_of(&self, error: &HighlightError) -> Option<Range<usize>> {
        match error {
            HighlightError::Yaw(_) => Some(self.yaw.span()),
            HighlightError::Pitch(_) => Some(self.pitch.span()),
            HighlightError::Power(_) => place(&self.power),
        }
    }
}
