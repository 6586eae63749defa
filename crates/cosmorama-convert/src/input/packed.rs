use std::path::Path;

use cosmorama::camera::{Canvas, FisheyeFit, LensCircle, LensScale};
use cosmorama::layout::{Arrangement, DualFisheye, DualLens};
use cosmorama::sphere::Orientation;
use cosmorama_io::Header;
use cosmorama_spec::{Cube, Dual};

use crate::diagnostic::{Code, FROM, Result, bail, failure, usage, usage_as};
use crate::input::InputView;
use crate::packing::canvas::check_whole;
use crate::packing::{Piece, Place};
use crate::source::ViewFiles;

/// Returns the faces of a cube in one image of a known layout.
pub(crate) fn faces(files: &ViewFiles, path: &Path, header: &Header, cube: &Cube) -> Result<Vec<InputView>> {
    let Some(layout) = cube.one_image() else { bail!(Ambiguous: "{}: no layout is known", path.display()) };
    check_whole(path, header)?;
    let edge = layout.edge(header.width, header.height).map_err(|error| {
        failure!(WrongSize: "{}: {error}; give {FROM} cube:layout= the picture's own, or another projection", path.display())
    })?;
    let pieces = Piece::faces(cube, &layout, edge);
    if pieces.is_empty() {
        bail!(Uncovered: "{}: none of the faces asked for is in its half of the cube", path.display());
    }
    views(files, header, &pieces)
}

/// Returns the two fisheyes in one image.
pub(crate) fn lenses(files: &ViewFiles, path: &Path, header: &Header, dual: &Dual) -> Result<Vec<InputView>> {
    check_whole(path, header)?;
    check_halves(path, header, dual)?;
    let pieces = Piece::lenses(dual, (header.width, header.height)).map_err(
        |error| failure!(WrongSize: "{}: {error}; give {FROM} dual-fisheye:layout= the picture's own", path.display()),
    )?;
    views(files, header, &pieces)
}

/// Checks that circles without a declared place have square halves; otherwise the layout is another.
fn check_halves(path: &Path, header: &Header, dual: &Dual) -> Result<()> {
    let Header { width, height, .. } = *header;
    let DualFisheye { arrangement, front, back, .. } = dual.picture;
    let is_fitted = |lens: &DualLens| {
        lens.frame.circle == LensCircle::FITTED && lens.frame.scale == LensScale::Circle(FisheyeFit::Short)
    };
    // The size of the squares beside or above each other, by the longer side and by the shorter one.
    let (long, short, other) = match arrangement {
        Arrangement::SideBySide => (width, height, "top-bottom"),
        Arrangement::TopBottom => (height, width, "side-by-side"),
    };
    if long > short || !is_fitted(&front) || !is_fitted(&back) {
        return Ok(());
    }
    let way = if arrangement == Arrangement::SideBySide { "side by side" } else { "one above the other" };
    Err(usage_as(
        Code::WrongSize,
        format!(
            "{}: {width}x{height} pixels hold no two circles {way}; give {FROM} dual-fisheye:layout={other}, or say where the \
         circles are with front.center=, front.radius=, back.center= and back.radius=",
            path.display()
        ),
    ))
}

fn views(files: &ViewFiles, header: &Header, pieces: &[Piece]) -> Result<Vec<InputView>> {
    let wrong = |error| usage(format!("{FROM}: {error}"));
    let view = |piece: &Piece| {
        let rect = piece.rect;
        let view = piece.view(Orientation::IDENTITY).map_err(wrong)?;
        // The other half of a divided face is a view of its own, which nothing lacks.
        let (nominal, canvas) = if piece.is_divided {
            (view.clone(), Canvas { width: rect.width(), height: rect.height(), left: 0, top: 0 })
        } else {
            (piece.nominal().map_err(wrong)?, piece.canvas)
        };
        Ok(InputView {
            name: piece.name.to_owned(),
            files: files.clone(),
            part: Some(Place { corner: (rect.left, rect.top), of: (header.width, header.height) }),
            header: Some(Header { width: rect.width(), height: rect.height(), ..header.clone() }),
            nominal,
            window: Some((view, canvas)),
            blend: piece.blend,
            mask: None,
            wanted: true,
        })
    };
    pieces.iter().map(view).collect()
}
