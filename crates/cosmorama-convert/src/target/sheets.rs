use std::path::{Path, PathBuf};

use cosmorama::camera::View;
use cosmorama::layout::Eye;
use cosmorama_io::{EnvMap, FacePattern, FaceSet, Format, IoError, Naming, Window};
use cosmorama_spec::{Cube, Packing, Shape, Size, Spec};

use crate::diagnostic::{Code, MIPS, Result, SIZE, TO, usage, usage_as};
use crate::packing::Place;
use crate::settings::{Conversion, GeometrySettings};
use crate::source::video::{MadeVideos, RawKind, extensions, is_video};
use crate::source::{Name, ViewFiles};
use crate::target::Picture;
use crate::target::picture::world_of;

/// An image to make.
#[derive(Clone)]
pub(crate) struct TargetView {
    /// Name in messages.
    pub(crate) name: String,
    /// Geometry.
    pub(crate) view: View,
    /// Eye, if there are two.
    pub(crate) eye: Option<Eye>,
    /// Level of a chain of maps, from 0.
    pub(crate) level: usize,
}

impl TargetView {
    /// Returns the index of the world that it shows, among so many; the right eye's picture shows the second of two.
    pub(crate) fn world(&self, count: usize) -> usize {
        world_of(self.eye, count)
    }
}

/// A file to make.
#[derive(Clone)]
pub(crate) struct TargetFile {
    /// Name, by frame.
    pub(crate) files: ViewFiles,
    /// Picture.
    pub(crate) sheet: Sheet,
    /// Mip levels, each half as large as the one before.
    pub(crate) mips: Vec<Sheet>,
}

/// A picture of one image, or of several images laid into it.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    /// Columns and rows.
    pub(crate) size: (usize, usize),
    /// Images by index, each with the place of its first column and row.
    pub(crate) pieces: Vec<(usize, (usize, usize))>,
}

impl TargetFile {
    /// Visits its picture and its mip levels.
    pub(crate) fn levels(&self) -> impl Iterator<Item = &Sheet> {
        std::iter::once(&self.sheet).chain(&self.mips)
    }
}

/// Everything that a conversion makes for a frame.
#[derive(Clone)]
pub(crate) struct Target {
    /// Images of a frame: one, or the faces of a cube.
    pub(crate) views: Vec<TargetView>,
    /// Files of a frame.
    pub(crate) files: Vec<TargetFile>,
    /// File format.
    pub(crate) format: Format,
    /// Environment map that the files declare.
    pub(crate) envmap: Option<EnvMap>,
    /// Whole panorama of which the file is a part, or all.
    pub(crate) panorama: Option<Window>,
}

impl Target {
    /// Returns whether its files are videos that keep alpha, by their names and the codec that is chosen.
    pub(crate) fn is_video_with_alpha(&self, settings: &Conversion, is_deep: bool) -> bool {
        let codec = settings.video.codec.as_deref();
        self.format == Format::Video && MadeVideos::holds_alpha(Path::new(&settings.output), codec, is_deep)
    }
}

impl Target {
    /// Checks that an output's name is consistent with `--to`.
    pub(crate) fn check_names(output: &Name, geometry: &GeometrySettings) -> Result<Format> {
        let format = format_of(output)?;
        output.check()?;
        let faces = FacePattern::parse(output).is_some();
        check_markers(output)?;
        match geometry.to.as_ref() {
            None if !faces => Err(usage_as(
                Code::MissingSetting,
                format!(
                    "{TO} is missing: say which projection the output is to have, as in {TO} omnimax, {TO} fulldome, \
                 {TO} equirect or {TO} perspective:fov=60"
                ),
            )),
            Some(Spec { shape: Shape::Cube(cube), stereo, .. }) => {
                check_cube(output, faces, cube, stereo.is_some(), format)
            }
            Some(Spec { name, .. }) if format.is_cube_map() => Err(usage(format!(
                "{output} is a {format} file, which holds the six whole faces of a cube, but {TO} is {name}; expected {TO} \
                 cube, or an output of another format"
            ))),
            Some(Spec { name, .. }) if faces => {
                Err(usage(format!("{output} names the faces of a cube, but {TO} is {name}; expected {TO} cube")))
            }
            _ => Ok(format),
        }
    }

    /// Returns the target for an output's name, its projection and size. Without a size, the centre gets so many pixels
    /// per radian.
    pub(crate) fn resolve(output: &Name, geometry: &GeometrySettings, pixels_per_radian: Option<f64>) -> Result<Self> {
        let format = Self::check_names(output, geometry)?;
        let container = FacePattern::parse(output).is_none().then_some(format);
        let pictures = Picture::all(geometry, container, pixels_per_radian)?;
        let given = match geometry.to.as_ref().map(|spec| &spec.shape) {
            Some(Shape::Cube(cube)) => cube.naming,
            _ => None,
        };
        // `%c` is Bourke's mark: one letter a face.
        let marked = || Naming::named("bourke").filter(|_| output.contains("%c"));
        let naming = given.or_else(marked).unwrap_or_else(|| crate::target::picture::naming(&Cube::default()));
        let named = FacePattern::parse(output).is_some();
        let (mut views, mut files): (Vec<TargetView>, Vec<TargetFile>) = (Vec::new(), Vec::new());
        let mut paths: Vec<PathBuf> = Vec::new();
        for (index, picture) in pictures.iter().enumerate() {
            let path = match picture.face.filter(|_| named) {
                Some(face) => FaceSet::named(output, naming)?.face(face).path.clone(),
                None => output.into(),
            };
            let size = (picture.view.width(), picture.view.height());
            let Place { corner, of } = picture.place.unwrap_or(Place::whole(size));
            let name = picture.label().unwrap_or_else(|| output.to_string());
            views.push(TargetView { name, view: picture.view.clone(), eye: picture.eye, level: 0 });
            match paths.iter().position(|other| *other == path) {
                Some(shared) => files[shared].sheet.pieces.push((index, corner)),
                None => {
                    let sheet = Sheet { size: of, pieces: vec![(index, corner)] };
                    files.push(TargetFile { files: ViewFiles::new(&path), sheet, mips: Vec::new() });
                    paths.push(path);
                }
            }
        }
        for TargetFile { sheet: Sheet { size: (width, height), .. }, .. } in &files {
            if let Some(most) = format.longest_side().filter(|most| width.max(height) > most) {
                return Err(usage_as(
                    Code::OutputFormat,
                    format!(
                        "{output}: {format} counts no more than {most} pixels on a side, but {width}x{height} are asked for; give a \
                     smaller {SIZE}, or name the output .png or .tif"
                    ),
                ));
            }
        }
        let envmap = pictures.first().and_then(|picture| picture.envmap);
        let panorama = pictures.first().and_then(|picture| picture.panorama);
        Ok(Self { views, files, format, envmap, panorama })
    }

    /// Returns the target of light that goes into no picture.
    pub(crate) fn none(format: Format) -> Self {
        Self { views: Vec::new(), files: Vec::new(), format, envmap: None, panorama: None }
    }

    /// Adds the mip levels of its cube, down to faces of one pixel.
    ///
    /// Each level is converted at its own size, so that its faces match at the edges like the largest ones.
    pub(crate) fn with_mips(mut self, output: &Name, geometry: &GeometrySettings) -> Result<Self> {
        if !self.format.is_cube_map() {
            return Err(usage(format!(
                "{MIPS} is for textures, but {output} is {}; leave it out, or name the output .ktx2 or .dds",
                self.format
            )));
        }
        let mut edge = self.views.first().map_or(0, |target| target.view.width());
        while edge > 1 {
            edge /= 2;
            let size = Some(Size { width: edge, height: None });
            let level = Self::resolve(output, &GeometrySettings { size, ..geometry.clone() }, None)?;
            let first = self.views.len();
            self.views.extend(level.views);
            for (file, smaller) in self.files.iter_mut().zip(level.files) {
                let pieces = smaller.sheet.pieces.into_iter().map(|(index, corner)| (first + index, corner)).collect();
                file.mips.push(Sheet { pieces, ..smaller.sheet });
            }
        }
        Ok(self)
    }

    /// Returns whether there is a picture for each eye.
    pub(crate) fn is_stereo(&self) -> bool {
        self.views.iter().any(|target| target.eye.is_some())
    }
}

/// Returns the format of an output, by its extension.
fn format_of(output: &Name) -> Result<Format> {
    let path = Path::new(output);
    if is_video(path) {
        return Ok(RawKind::of(path).map_or(Format::Video, RawKind::format));
    }
    let is_folder = path.is_dir() || output.ends_with('/');
    Format::from_extension(path).map_err(|error| {
        let is_unknown = matches!(error, IoError::UnknownExtension { .. }) && !is_folder;
        let videos = if is_unknown { extensions() } else { "" };
        usage_as(Code::OutputFormat, format!("{error}{videos}"))
    })
}

/// Refuses names that contain an invalid marker, which would become part of a file's name. Existing folders may have
/// any name.
fn check_markers(output: &Name) -> Result<()> {
    let path = Path::new(output);
    let is_in_folder = path.parent().is_some_and(Path::is_dir);
    let made = path.file_name().and_then(|name| name.to_str()).filter(|_| is_in_folder).unwrap_or(output);
    let marked = |at: usize| Some(&made[at..=at + made[at..].find('}')?]);
    let unknown = made.match_indices('{').filter_map(|(at, _)| marked(at)).find(|marker| *marker != "{face}");
    match unknown.or(made.contains('*').then_some("*")) {
        None => Ok(()),
        Some(marker) => Err(usage(format!(
            "{output}: {marker} stands for nothing in an output's name; write {{face}} or %c where a face's name stands, #### or \
             %04d where a frame's number does"
        ))),
    }
}

/// Checks that the faces of a cube go into files of their own, or into one file with a known layout.
fn check_cube(output: &Name, faces: bool, cube: &Cube, stereo: bool, format: Format) -> Result<Format> {
    match (faces, cube.layout) {
        (true, Some(Packing::OneImage(kind))) => Err(usage(format!(
            "{TO} cube:layout={kind} makes one image, but {output} names a file for each face; leave {{face}} or %c out"
        ))),
        (true, _) if cube.order.is_some() => Err(usage(format!(
            "{TO} cube has order=, but {output} names a file for each face; leave {{face}} or %c out, or give naming="
        ))),
        (true, _) | (false, Some(Packing::OneImage(_))) => Ok(format),
        (false, None) if crate::target::picture::own_layout(format).is_some() && !stereo => Ok(format),
        (false, _) => Err(usage(format!(
            "{TO} cube makes a file for each face, but {output} has no {{face}} or %c where a face's name stands; for one \
             image give {TO} cube:layout=strip-h, strip-v, 3x2, 2x3, cross-h, cross-v or eac"
        ))),
    }
}
