use std::path::Path;

use anyhow::{Result, anyhow, bail};
use cosmorama::sphere::Orientation;
use cosmorama::world::Blend;
use cosmorama_io::Header;

use super::face_view::face_placement;
use super::{Files, InputView};
use crate::failure::usage;
use crate::spec::Cube;

/// The part of a file's image that a view is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FilePart {
    /// Its first column and row.
    pub(crate) corner: (usize, usize),
    /// Columns and rows of the whole image.
    pub(crate) of: (usize, usize),
}

/// The faces of a cube in one image, whose layout is known.
pub(super) fn views(files: &Files, path: &Path, header: &Header, cube: &Cube) -> Result<Vec<InputView>> {
    let Some(layout) = cube.one_image() else { bail!("{}: no layout is known", path.display()) };
    if let Some(window) = header.window {
        bail!(
            "{}: only a part of a picture of {}x{} pixels; faces in one image are read from whole pictures",
            path.display(),
            window.canvas_width,
            window.canvas_height
        );
    }
    let edge = layout.edge(header.width, header.height).map_err(|error| {
        anyhow!("{}: {error}; give --from cube:layout= the picture's own, or another projection", path.display())
    })?;
    let wrong = |error| usage(format!("--from: {error}"));
    let mut views = Vec::new();
    for placed in layout.faces(edge).into_iter().filter(|placed| cube.faces.contains(&placed.face)) {
        let place = |canvas| face_placement(cube, placed.face, placed.lies, canvas, Orientation::IDENTITY);
        let (width, height) = (placed.rect.width(), placed.rect.height());
        views.push(InputView {
            name: placed.face.name().to_owned(),
            files: files.clone(),
            part: Some(FilePart { corner: (placed.rect.left, placed.rect.top), of: (header.width, header.height) }),
            header: Some(Header { width, height, ..header.clone() }),
            nominal: place(None).view(edge, edge).map_err(wrong)?,
            window: Some((place(Some(placed.canvas)).view(width, height).map_err(wrong)?, placed.canvas)),
            blend: Blend::default(),
            mask: None,
            wanted: true,
        });
    }
    if views.is_empty() {
        bail!("{}: none of the faces asked for is in its half of the cube", path.display());
    }
    Ok(views)
}
