use cosmorama::camera::Canvas;
use cosmorama::layout::{FacePart, FacePlacement};
use cosmorama::sphere::{CubeFace, Orientation};
use cosmorama_io::{FaceFile, Header};
use cosmorama_spec::Cube;

use crate::diagnostic::Result;
use crate::input::eye_view::header;
use crate::input::{FacePicture, InputView};
use crate::packing::EyePart;
use crate::packing::canvas::{canvas_of, fits_canvas, lies_on_canvas, whole};
use crate::packing::face_view::face_placement;
use crate::source::{Access, ViewFiles};

/// A face whose file has been probed.
pub(crate) struct Face {
    face: CubeFace,
    placement: FacePlacement,
    files: ViewFiles,
    header: Option<Header>,
    canvas: Option<Canvas>,
}

impl Face {
    /// Probes the file, if there is one.
    pub(crate) fn probe(
        cube: &Cube,
        file: &FaceFile,
        files: ViewFiles,
        (eye, access): (Option<EyePart>, Access),
        frame: Option<u64>,
    ) -> Result<Self> {
        let header = file.present.then(|| header(access, &files.path(frame), eye)).transpose()?;
        let placement = cube.file_placement(file.face, file.placement);
        let part = FacePart::of(file.face, placement, cube.half);
        let canvas = header.as_ref().map(|header| {
            let declared = cube.canvas_of(file.face).or(header.window.map(canvas_of));
            let whole = || part.map_or_else(|| whole(header), |part| part.canvas(header.width, header.height));
            declared.unwrap_or_else(whole)
        });
        if let (Some(header), Some(canvas)) = (&header, canvas) {
            fits_canvas(&files.path(frame), header, canvas)?;
            lies_on_canvas(files.path(frame).display(), (header.width, header.height), canvas)?;
        }
        Ok(Self { face: file.face, placement, files, header, canvas })
    }

    /// Returns the face, and the placement of its picture.
    pub(crate) fn lies(&self) -> (CubeFace, FacePlacement) {
        (self.face, self.placement)
    }

    /// Returns whether the face's file, if there is one, holds the whole face.
    pub(crate) fn is_whole(&self) -> bool {
        let same = |header: &Header| self.canvas == Some(whole(header));
        self.header.as_ref().is_none_or(same)
    }

    /// Returns the face's picture, if there is a file.
    pub(crate) fn picture(&self, cube: &Cube, frame: Option<u64>) -> Option<FacePicture> {
        let is_declared = cube.canvas_of(self.face).is_some();
        let header = self.header.as_ref()?;
        Some(FacePicture {
            face: self.face,
            path: self.files.path(frame),
            canvas: self.canvas?,
            size: (header.width, header.height),
            lies: self.placement,
            is_declared,
        })
    }

    /// Converts the face to a view; `size` is that of faces without a file.
    pub(crate) fn into_view(self, cube: &Cube, (width, height): (usize, usize)) -> Result<InputView> {
        let outer = Orientation::IDENTITY;
        let canvas = self.canvas.unwrap_or(Canvas { width, height, left: 0, top: 0 });
        let nominal = face_placement(cube, self.face, self.placement, None, outer).view(canvas.width, canvas.height)?;
        let windowed = face_placement(cube, self.face, self.placement, Some(canvas), outer);
        let window = match &self.header {
            Some(header) => Some((windowed.view(header.width, header.height)?, canvas)),
            None => None,
        };
        Ok(InputView {
            name: self.face.name().to_owned(),
            files: self.files,
            part: None,
            header: self.header,
            nominal,
            window,
            blend: cube.blend(),
            mask: None,
            wanted: true,
        })
    }
}
