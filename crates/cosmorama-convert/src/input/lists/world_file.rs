//! World files: many views, each an image or a pattern with its SPEC, in TOML.

use std::ops::Range;
use std::path::Path;

use cosmorama::motion::Smoothness;
use cosmorama::sphere::Angle;
use cosmorama::world::Blend;
use cosmorama_io::{FrameList, FramePattern};
use cosmorama_spec::{FrameMap, Spec};
use serde::Deserialize;
use toml::Spanned;

use crate::diagnostic::{
    ConvertError, Diagnostic, FRAMES, FROM, InPlace, Result, SIZE, TO, bail, failed_as, failure, of_opening,
};
use crate::input::spec_files::calibration::read_calibrations;
use crate::input::spec_files::st_map;
use crate::input::{Builtin, Input, InputView, Listed};
use crate::settings::{Backdrop, PoseFile};
use crate::source::{Access, DecodedPicture, Files, MemoryBudget, Name};

/// A world file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WorldFile {
    #[serde(default)]
    view: Vec<Entry>,
    #[serde(default)]
    layer: Vec<Layer>,
}

/// One of several worlds, one before the other; the first is nearest.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Layer {
    /// File, or pattern of faces or frames, relative to the world file; or another world file, or `builtin:NAME`.
    image: Spanned<String>,
    /// Projection and orientation; detected as for any input if omitted.
    spec: Option<Spanned<String>>,
    /// Factor of light and alpha.
    opacity: Option<Spanned<f64>>,
    /// Poses that turn it, relative to the world file.
    path: Option<Spanned<String>>,
    /// Frames a second, where the path has time instead of frame.
    fps: Option<Spanned<f64>>,
    /// Rule for its frames; the first layer has the output's.
    frames: Option<Spanned<String>>,
}

/// One view, or one set of faces.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// File, or pattern of faces or frames, relative to the world file.
    image: Spanned<String>,
    /// Projection and orientation; detected as for any input if omitted.
    spec: Option<Spanned<String>>,
    /// Priority: views of higher priority cover those of lower priority.
    #[serde(default)]
    priority: i32,
    /// Mask, a picture of the same size; black hides.
    mask: Option<Spanned<String>>,
    /// Degrees over which the view fades out at its border.
    feather: Option<Spanned<f64>>,
}

/// Text and name of a world file, for messages with places.
struct Text<'a> {
    name: &'a Name,
    text: &'a str,
    /// Places at which lines end.
    ends: Vec<usize>,
}

/// Greatest length of a world file in bytes: of tens of thousands of views.
const LONGEST: u64 = 4 << 20;

/// Description of a world file's content.
const SCHEMA: &str = "a [[view]] for each image, with image = \"FILE\", and where wanted spec = \"SPEC\", priority = WHOLE \
                      NUMBER, feather = DEGREES, mask = \"FILE\"; or a [[layer]] for each world, the nearest first, with \
                      image, and where wanted spec, opacity = 0 to 1, path = \"FILE\", fps = NUMBER, frames = \"hold\"";

/// Rewrites a message of the TOML reader without programming terms.
fn in_words(message: &str) -> String {
    message.replace("expected i32", "expected a whole number").replace("expected f64", "expected a number")
}

/// Name in a world file of the setting for an input's projection.
const SPEC_KEY: &str = "spec =";

/// Returns whether an input names a world file.
pub(crate) fn is_world_file(pattern: &Name) -> bool {
    Path::new(pattern).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Finds and probes the files of all views of a world file.
pub(crate) fn find(
    name: &Name,
    wanted: Option<&FrameList>,
    access: Access,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Input> {
    let mut world = Input { worlds: vec![Vec::new()], frames: vec![None], faces: None, beside: vec![name.into()] };
    for Listed { image, place, input, .. } in listed(name, wanted, access, warnings)? {
        world.frames = common_frames(&world.frames, &input.frames)
            .at(|| format!("{image} has other frames than the views before it"))
            .at(|| place)?;
        world.beside.extend(input.beside);
        join(&mut world.worlds, input.worlds);
    }
    Ok(world)
}

/// Returns each view of a world file by itself.
pub(crate) fn listed(
    name: &Name,
    wanted: Option<&FrameList>,
    access: Access,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Listed>> {
    let text = read(name, access)?;
    let source = Text::new(name, &text);
    let file = source.parse()?;
    source.layers(&file)?;
    if let Some(layer) = file.layer.first() {
        let message =
            "layers of layers are not read, nor are layers where one world is expected; name a file of [[view]]s";
        return Err(source.error(Some(layer.image.span()), message));
    }
    if file.view.is_empty() {
        bail!(
            Malformed: "{name}: no [[view]] in it; a world file has one for each image, with image = \"FILE\" and spec = \"SPEC\""
        );
    }
    let list = |entry: &Entry| {
        Ok(Listed {
            image: entry.image.get_ref().clone(),
            place: source.place(Some(entry.image.span())),
            spec: entry.spec.as_ref().map(|spec| spec.get_ref().clone()),
            input: entry.find(&source, wanted, access, warnings)?,
        })
    };
    file.view.iter().map(list).collect()
}

/// Returns the layers of a world file, the nearest first; none where an input is no world file, or one of views.
pub(crate) fn layers(name: &Name, files: &dyn Files) -> Result<Vec<Backdrop>> {
    if !is_world_file(name) {
        return Ok(Vec::new());
    }
    let access = Access { files, memory: MemoryBudget::new(None), decoded: &DecodedPicture::default() };
    let text = read(name, access)?;
    let source = Text::new(name, &text);
    source.layers(&source.parse()?)
}

fn read(name: &Name, access: Access) -> Result<String> {
    let cannot_open = |error| failed_as(of_opening(&error), format!("cannot open the world file {name}: {error}"));
    let bytes = access.read_most(Path::new(name), LONGEST + 1).map_err(cannot_open)?;
    if bytes.len() as u64 > LONGEST {
        bail!(Malformed: "{name}: a world file of more than 4 MiB, the most that is read; divide it into several, of fewer views each");
    }
    String::from_utf8(bytes)
        .map_err(|_| failure!(Malformed: "{name}: not a text; expected a world file in TOML: {SCHEMA}"))
}

impl Layer {
    fn backdrop(&self, source: &Text, is_first: bool) -> Result<Backdrop> {
        let beside = |name: &str| Name::from(source.folder().join(name));
        let image = self.image.get_ref();
        let input = if Builtin::named(image)?.is_some() { image.into() } else { beside(image) };
        let spec = |spec: &Spanned<String>| {
            let text = spec.get_ref();
            let wrong = |error| source.error(Some(spec.span()), &format!("spec = \"{text}\": {error}"));
            Spec::parse_in(source.folder(), text).map_err(wrong)
        };
        let frames = |rule: &Spanned<String>| {
            if is_first {
                let message =
                    "frames is for the layers behind the first, which has the output's own frames; leave it out";
                return Err(source.error(Some(rule.span()), message));
            }
            rule.get_ref().parse::<FrameMap>().map_err(|message| source.error(Some(rule.span()), &message))
        };
        let opacity = self.opacity.as_ref().map_or(1.0, |opacity| *opacity.get_ref());
        if let (false, Some(given)) = ((0.0..=1.0).contains(&opacity), &self.opacity) {
            return Err(
                source.error(Some(given.span()), &format!("opacity = {opacity}: expected a number from 0 to 1"))
            );
        }
        let fps = self.fps.as_ref().map(|fps| *fps.get_ref());
        if let (Some(number), Some(given)) = (fps.filter(|fps| !(fps.is_finite() && *fps > 0.0)), &self.fps) {
            return Err(source.error(Some(given.span()), &format!("fps = {number}: expected a number more than 0")));
        }
        let poses = |path: &Spanned<String>| PoseFile {
            file: beside(path.get_ref()).to_string(),
            fps,
            smoothness: Smoothness::default(),
        };
        Ok(Backdrop {
            from: self.spec.as_ref().map(spec).transpose()?,
            frames: self.frames.as_ref().map(frames).transpose()?.unwrap_or_default(),
            in_path: self.path.as_ref().map(poses),
            opacity: opacity as f32,
            ..Backdrop::new(input)
        })
    }
}

impl Entry {
    fn find(
        &self,
        source: &Text,
        wanted: Option<&FrameList>,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Input> {
        let feather = self.feather(source)?;
        let spec = self.spec(source, access)?;
        let named = spec.as_ref().map_or_else(Vec::new, |spec| spec.files.clone());
        let spec = spec.map(|spec| st_map::read_map(spec, access)).transpose();
        let spec = spec.at(|| source.place(self.spec.as_ref().map(Spanned::span)))?;
        let pattern = Name::from(source.folder().join(self.image.get_ref()));
        pattern.check()?;
        if is_world_file(&pattern) {
            let message = format!("{pattern} is a world file itself; list its views here");
            return Err(source.error(Some(self.image.span()), &message));
        }
        if let Some(builtin) = Builtin::named(self.image.get_ref())? {
            let message = format!(
                "{} is a formula without pixels ({}); make a picture of it first, as in cosmorama convert {0} picture.exr \
                 {TO} equirect {SIZE} 4096, and name that here",
                self.image.get_ref(),
                builtin.about()
            );
            return Err(source.error(Some(self.image.span()), &message));
        }
        // A still stays what it is in all frames.
        let wanted = wanted.filter(|_| FramePattern::parse(&pattern).is_some());
        let mut said = Vec::new();
        let found = Input::of_pictures(&pattern, spec.as_ref(), wanted, access, &mut said);
        warnings.extend(said.into_iter().map(|warning| {
            let message = warning.message.reworded(FROM, SPEC_KEY);
            Diagnostic { message, ..warning }
        }));
        let mut input =
            found.map_err(|error| error.reworded(FROM, SPEC_KEY)).at(|| source.place(Some(self.image.span())))?;
        for view in input.worlds.iter_mut().flatten() {
            // A SPEC's own blending holds unless the entry gives another.
            view.blend = Blend { priority: self.priority, feather: feather.unwrap_or(view.blend.feather) };
        }
        input.beside.extend(named);
        self.mask(source, &mut input, access)?;
        Ok(input)
    }

    fn spec(&self, source: &Text, access: Access) -> Result<Option<Spec>> {
        let Some(spec) = &self.spec else { return Ok(None) };
        let text = spec.get_ref();
        let place = || source.place(Some(spec.span()));
        let parsed = Spec::parse_in(source.folder(), text)
            .map_err(|error| source.error(Some(spec.span()), &format!("spec = \"{text}\": {error}")))?;
        let told = |error: ConvertError| error.after(&format!("spec = \"{text}\": "));
        read_calibrations(parsed, access).map_err(told).at(place).map(Some)
    }

    /// Applies the mask of a single picture.
    fn mask(&self, source: &Text, input: &mut Input, access: Access) -> Result<()> {
        let Some(mask) = &self.mask else { return Ok(()) };
        let place = || source.place(Some(mask.span()));
        let [views] = input.worlds.as_mut_slice() else {
            let message =
                format!("mask = \"{}\" is for one picture, but the view has one for each eye", mask.get_ref());
            return Err(source.error(Some(mask.span()), &message));
        };
        let [view] = views.as_mut_slice() else {
            let message = format!("mask = \"{}\" is for one picture, but the view has several", mask.get_ref());
            return Err(source.error(Some(mask.span()), &message));
        };
        let path = source.folder().join(mask.get_ref());
        let found = crate::input::lists::mask::of_file(&path, view, access).at(place)?;
        crate::input::lists::mask::hide(view, found);
        input.beside.push(path);
        Ok(())
    }

    fn feather(&self, source: &Text) -> Result<Option<Angle>> {
        let Some(feather) = &self.feather else { return Ok(None) };
        let degrees = *feather.get_ref();
        if !(0.0..=180.0).contains(&degrees) {
            let message = format!("feather = {degrees}: expected degrees from 0 to 180");
            return Err(source.error(Some(feather.span()), &message));
        }
        Ok(Some(Angle::from_degrees(degrees)))
    }
}

impl<'a> Text<'a> {
    fn new(name: &'a Name, text: &'a str) -> Self {
        Self { name, text, ends: text.match_indices('\n').map(|(at, _)| at).collect() }
    }

    /// Returns the layers of a file, the nearest first.
    fn layers(&self, file: &WorldFile) -> Result<Vec<Backdrop>> {
        if let (Some(view), Some(_)) = (file.view.first(), file.layer.first()) {
            let message =
                "both [[view]] and [[layer]]; name the views in a file of their own, and that as the image of a layer";
            return Err(self.error(Some(view.image.span()), message));
        }
        file.layer.iter().enumerate().map(|(index, layer)| layer.backdrop(self, index == 0)).collect()
    }

    fn parse(&self) -> Result<WorldFile> {
        toml::from_str(self.text)
            .map_err(|error| self.error(error.span(), &format!("{}; expected {SCHEMA}", in_words(error.message()))))
    }

    /// Returns the folder to which names of files are relative.
    fn folder(&self) -> &Path {
        Path::new(self.name).parent().unwrap_or(Path::new(""))
    }

    fn error(&self, span: Option<Range<usize>>, message: &str) -> ConvertError {
        failure!(Malformed: "{}: {message}", self.place(span))
    }

    /// Returns the file and the line.
    fn place(&self, span: Option<Range<usize>>) -> String {
        let line = |span: Range<usize>| 1 + self.ends.partition_point(|end| *end < span.start);
        span.map_or_else(|| self.name.to_string(), |span| format!("{}, line {}", self.name, line(span)))
    }
}

/// Adds views to the worlds. If one side has a world for each eye, both eyes see the other side's views.
fn join(worlds: &mut Vec<Vec<InputView>>, mut more: Vec<Vec<InputView>>) {
    let count = worlds.len().max(more.len());
    for side in [&mut *worlds, &mut more] {
        if side.len() < count {
            let first = side.first().cloned().unwrap_or_default();
            side.resize(count, first);
        }
    }
    worlds.iter_mut().zip(more).for_each(|(world, views)| world.extend(views));
}

/// Returns the common frames of two sequences; a still goes with any.
fn common_frames(a: &[Option<u64>], b: &[Option<u64>]) -> Result<Vec<Option<u64>>> {
    match (a, b) {
        ([None], other) | (other, [None]) => Ok(other.to_vec()),
        _ if a == b => Ok(a.to_vec()),
        _ => bail!(
            Malformed: "{} frames and {}; all sequences of a world must have the same, or name them with {FRAMES}",
            a.len(),
            b.len()
        ),
    }
}
