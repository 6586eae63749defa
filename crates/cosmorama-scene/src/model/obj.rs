//! Wavefront OBJ. Read here, since errors then name the line, and nothing in a file can stop the program.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use cosmorama::sphere::Angle;
use glam::{DVec2, DVec3};

use super::file::{self, beside};
use super::mtl::{Entry, Library};
use super::polygon::{self, Cut};
use super::{Contents, ModelFault, ModelSettings};
use crate::material::{Material, PictureReader};
use crate::scene::Part;
use crate::shape::Face;

/// Crease of normals that a file lacks.
const CREASE: Angle = Angle::from_degrees(40.0);

/// State of the reading of a file.
struct Reader<'a> {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<DVec2>,
    /// Name of the group or object that lines are in.
    group: String,
    /// Name of the material, if any.
    material: Option<String>,
    /// Parts by group and material.
    parts: HashMap<(String, Option<String>), usize>,
    contents: Contents,
    /// Materials of the libraries so far; `None` if the file's own do not count.
    materials: Option<HashMap<String, Entry>>,
    pictures: &'a mut dyn PictureReader,
    /// Materials that parts have, with their pictures.
    made: HashMap<String, Material>,
    /// Names of materials that no library has.
    lost: BTreeSet<String>,
    /// Keys of lines that are not read.
    ignored: BTreeSet<String>,
    /// Whether vertices have colours.
    has_colours: bool,
    /// Number of faces that cross themselves.
    crossed: usize,
    /// Folder of the file.
    folder: PathBuf,
}

/// Greatest number of bytes of a library of materials.
const LARGEST_LIBRARY: u64 = 1 << 24;

/// A corner of a face: indices of its point, texture coordinates and normal.
type Corner = (usize, Option<usize>, Option<usize>);

/// Reads the triangles of a file; other polygons are cut into triangles.
pub(super) fn read(
    path: &Path,
    settings: &ModelSettings,
    pictures: &mut dyn PictureReader,
) -> Result<Contents, ModelFault> {
    let text = file::read(path, settings.most_bytes())?;
    let text = String::from_utf8_lossy(&text);
    settings.check_counts(text.lines().map(triangles).sum(), text.lines().filter(|line| is_vertex(line)).count())?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut reader = Reader::new(folder, settings.material.is_none(), pictures);
    for (number, line) in text.lines().enumerate() {
        reader.line(line).map_err(|why| ModelFault::Line { line: number + 1, why })?;
    }
    reader.name_parts();
    let ignored = ignored(&reader);
    reader.contents.notes.extend(ignored);
    if reader.crossed > 0 {
        reader.contents.notes.push(format!("{} faces cross themselves, and are not filled as drawn", reader.crossed));
    }
    let lost = reader.lost.into_iter().map(|name| format!("material {name} is in no library: its parts are mirrors"));
    reader.contents.notes.extend(lost);
    Ok(reader.contents)
}

/// Returns the number of triangles that a line makes.
fn triangles(line: &str) -> usize {
    let mut words = line.split_ascii_whitespace();
    if words.next() == Some("f") { words.count().saturating_sub(2) } else { 0 }
}

/// Returns whether a line is a point, a normal or texture coordinates.
fn is_vertex(line: &str) -> bool {
    keyed(line).is_some_and(|(key, _)| matches!(key, "v" | "vn" | "vt"))
}

/// Lists what lines say that is not read. Groups of smoothing count where normals are made.
fn ignored(reader: &Reader) -> Option<String> {
    /// Most keys that are told.
    const MOST: usize = 12;
    let has_normals = reader.contents.faces.iter().all(|face| face.normals.is_some());
    let keys = reader.ignored.iter().map(String::as_str).filter(|key| *key != "s" || !has_normals);
    let colours = reader.has_colours.then_some("colours of vertices");
    let all: Vec<&str> = keys.take(MOST).chain(colours).collect();
    (!all.is_empty()).then(|| format!("these are not read: {}", all.join(", ")))
}

impl<'a> Reader<'a> {
    fn new(folder: PathBuf, has_materials: bool, pictures: &'a mut dyn PictureReader) -> Self {
        Self {
            points: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            group: String::new(),
            material: None,
            parts: HashMap::new(),
            contents: Contents::new(CREASE),
            materials: has_materials.then(HashMap::new),
            pictures,
            made: HashMap::new(),
            lost: BTreeSet::new(),
            ignored: BTreeSet::new(),
            has_colours: false,
            crossed: 0,
            folder,
        }
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        let Some((key, rest)) = keyed(line) else { return Ok(()) };
        match key {
            "v" => {
                // Behind a point is a weight, or a colour.
                self.has_colours |= rest.split_ascii_whitespace().nth(5).is_some();
                self.points.push(numbers(rest)?.into());
            }
            "vn" => self.normals.push(numbers(rest)?.into()),
            "vt" => self.uvs.push(texture_coordinates(rest)?),
            "f" => return self.face(rest),
            "g" | "o" => self.group = rest.to_owned(),
            "mtllib" => return self.library(rest),
            "usemtl" => self.material = Some(rest.to_owned()),
            // Comments, and what is no key.
            _ if !key.starts_with(|letter: char| letter.is_ascii_alphabetic()) || self.ignored.contains(key) => {}
            _ => {
                self.ignored.insert(key.to_owned());
            }
        }
        Ok(())
    }

    /// Reads a library of materials; one that is missing is told.
    fn library(&mut self, name: &str) -> Result<(), String> {
        let Some(materials) = &mut self.materials else { return Ok(()) };
        let found = beside(&self.folder, name);
        let bytes = match found.and_then(|path| file::read(&path, LARGEST_LIBRARY).map_err(|error| error.to_string())) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.contents.notes.push(format!("its materials are not read: {name} {why}"));
                return Ok(());
            }
        };
        let library = Library::parse(&String::from_utf8_lossy(&bytes))
            .map_err(|(line, why)| format!("in {name}, line {line}: {why}"))?;
        materials.extend(library.materials);
        if !library.ignored.is_empty() {
            let ignored: Vec<String> = library.ignored.into_iter().collect();
            self.contents.notes.push(format!("of {name} these are not read: {}", ignored.join(", ")));
        }
        Ok(())
    }

    fn face(&mut self, text: &str) -> Result<(), String> {
        let corners =
            text.split_ascii_whitespace().map(|word| self.corner(word)).collect::<Result<Vec<Corner>, _>>()?;
        if corners.len() < 3 {
            return Err(format!("the face has {} corners; expected at least 3", corners.len()));
        }
        let part = self.part()?;
        let points: Vec<DVec3> = corners.iter().map(|corner| self.points[corner.0]).collect();
        let Cut { triangles, is_crossed } = polygon::cut(&points)?;
        self.crossed += usize::from(is_crossed);
        for face in triangles {
            let face = face.map(|corner| corners[corner]);
            let normals = face.map(|corner| corner.2.map(|index| self.normals[index]));
            let uvs = face.map(|corner| corner.1.map(|index| self.uvs[index]));
            self.contents.faces.push(Face {
                corners: face.map(|corner| self.points[corner.0]),
                normals: all(normals),
                uvs: all(uvs),
                tangents: None,
                part,
            });
        }
        Ok(())
    }

    /// Reads a corner: `point`, `point/uv`, `point//normal` or `point/uv/normal`.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut fields = word.split('/');
        let mut index = |what: &str, count: usize| match fields.next() {
            None | Some("") => Ok(None),
            Some(text) => index(text, count).map(Some).map_err(|why| format!("{what} '{text}' {why}")),
        };
        let point = index("vertex", self.points.len())?;
        let uv = index("texture coordinates", self.uvs.len())?;
        let normal = index("normal", self.normals.len())?;
        let point = point.ok_or_else(|| format!("'{word}' names no vertex"))?;
        Ok((point, uv, normal))
    }

    /// Returns the part that the lines are in.
    fn part(&mut self) -> Result<usize, String> {
        let key = (self.group.clone(), self.material.clone());
        if let Some(part) = self.parts.get(&key) {
            return Ok(*part);
        }
        let material = self.made()?;
        let part = self.parts.len();
        self.parts.insert(key, part);
        self.contents.parts.push(Part { name: self.group.clone(), material, world: 0 });
        Ok(part)
    }

    /// Returns the material of the lines; a mirror if they name none, or one that no library has.
    fn made(&mut self) -> Result<Material, String> {
        let Some((name, all)) = self.material.as_ref().zip(self.materials.as_ref()) else {
            return Ok(Material::MIRROR);
        };
        if let Some(made) = self.made.get(name) {
            return Ok(made.clone());
        }
        let Some(entry) = all.get(name) else {
            self.lost.insert(name.clone());
            return Ok(Material::MIRROR);
        };
        let made = entry.material(&self.folder, self.pictures).map_err(|why| format!("material {name}: {why}"))?;
        self.made.insert(name.clone(), made.clone());
        Ok(made)
    }

    /// Names parts by their materials where their groups do not tell them apart.
    fn name_parts(&mut self) {
        let mut counts: HashMap<&String, usize> = HashMap::new();
        self.parts.keys().for_each(|(group, _)| *counts.entry(group).or_default() += 1);
        for ((group, material), part) in &self.parts {
            let is_shared = group.is_empty() || counts[group] > 1;
            if let (true, Some(material)) = (is_shared, material) {
                self.contents.parts[*part].name = material.clone();
            }
        }
    }
}

/// Splits a line into its key and the rest; `None` if it is blank.
pub(super) fn keyed(line: &str) -> Option<(&str, &str)> {
    let line = line.trim_ascii();
    let (key, rest) = line.split_once(|letter: char| letter.is_ascii_whitespace()).unwrap_or((line, ""));
    (!key.is_empty()).then_some((key, rest.trim_ascii()))
}

/// Reads u, and v, which counts from the bottom and may be left out.
fn texture_coordinates(text: &str) -> Result<DVec2, String> {
    let [u, v] =
        if text.split_ascii_whitespace().count() == 1 { numbers(text).map(|[u]| [u, 0.0])? } else { numbers(text)? };
    Ok(DVec2::new(u, 1.0 - v))
}

/// Reads the first numbers of a line.
pub(super) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let mut words = text.split_ascii_whitespace();
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        let word = words.next().ok_or_else(|| format!("expected {N} numbers, but found '{text}'"))?;
        let found = word.parse().ok().filter(|number: &f64| number.is_finite());
        *number = found.ok_or_else(|| format!("expected a number, but found '{word}'"))?;
    }
    Ok(numbers)
}

/// Reads an index: from 1, or from −1 backwards.
fn index(text: &str, count: usize) -> Result<usize, String> {
    let number: i64 = text.parse().map_err(|_| "is not a whole number".to_owned())?;
    let index = if number > 0 { number - 1 } else { count as i64 + number };
    let index = usize::try_from(index).ok().filter(|index| number != 0 && *index < count);
    index.ok_or_else(|| format!("is not there: {count} are before this line"))
}

fn all<T: Copy>(corners: [Option<T>; 3]) -> Option<[T; 3]> {
    Some([corners[0]?, corners[1]?, corners[2]?])
}
