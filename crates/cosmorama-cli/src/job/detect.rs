use std::path::Path;

use anyhow::{Result, bail};
use cosmorama::world::{EquirectFrame, FaceOrder, Frame, LayoutKind, Placement, SamplePositions};
use cosmorama_io::{EnvMap, Header};

use crate::failure::usage;
use crate::spec::{Cube, Packing, Shape, Single, SphereSamples};

/// What one image is a picture of, as far as its metadata and shape tell.
enum Guess {
    /// What its metadata say.
    Said(EnvMap),
    /// A panorama, by its shape: twice as wide as high.
    TwoToOne,
    /// Faces in one image, by its shape: of these layouts.
    Layouts(Vec<LayoutKind>),
    /// Nothing tells.
    Unknown,
}

impl Guess {
    /// Looks at a header.
    fn of(header: &Header) -> Self {
        let (width, height) = canvas(header);
        let layouts: Vec<LayoutKind> = layouts_of_shape(width, height).collect();
        match header.metadata.envmap {
            Some(envmap) => Self::Said(envmap),
            None if width == 2 * height => Self::TwoToOne,
            None if !layouts.is_empty() => Self::Layouts(layouts),
            None => Self::Unknown,
        }
    }
}

fn canvas(header: &Header) -> (usize, usize) {
    header.window.map_or((header.width, header.height), |window| (window.canvas_width, window.canvas_height))
}

fn layouts_of_shape(width: usize, height: usize) -> impl Iterator<Item = LayoutKind> {
    LayoutKind::ALL.into_iter().filter(move |kind| kind.has_shape(width, height))
}

/// The projection of an image for which no `--from` was given.
pub(super) fn detect(path: &Path, header: &Header, warnings: &mut Vec<String>) -> Result<Shape> {
    let panorama = |samples| {
        let frame = Frame::Equirect(EquirectFrame { samples, ..EquirectFrame::default() });
        Shape::Single(Single { placement: Placement::new(frame), samples: SphereSamples::ByFormat })
    };
    let mut announce = |what: &str, why: &str| {
        warnings.push(format!("{} is taken for {what}, because {why}", path.display()));
    };
    match Guess::of(header) {
        Guess::Said(EnvMap::LatLong) => Ok(panorama(SamplePositions::Edges)),
        Guess::Said(EnvMap::Cube | EnvMap::GlCube) => {
            let cube = declared_cube(&Cube::default(), &path.to_string_lossy(), header, warnings)?;
            Ok(Shape::Cube(cube))
        }
        Guess::TwoToOne => {
            announce("a panorama (--from equirect)", "it is twice as wide as high");
            Ok(panorama(SamplePositions::Centres))
        }
        Guess::Layouts(kinds) => match kinds[..] {
            // No camera makes pictures so long.
            [kind @ (LayoutKind::StripH | LayoutKind::StripV)] => {
                announce(&format!("the faces of a cube (--from cube:layout={kind})"), "of its shape");
                Ok(Shape::Cube(Cube { layout: Some(Packing::OneImage(kind)), ..Cube::default() }))
            }
            _ => bail!("{}", ambiguous(path, header, &kinds)),
        },
        Guess::Unknown => bail!("{}", ambiguous(path, header, &[])),
    }
}

/// What an image of unknown projection could be.
fn ambiguous(path: &Path, header: &Header, layouts: &[LayoutKind]) -> String {
    let layouts = layouts.iter().map(|kind| format!("cube:layout={kind}, ")).collect::<String>();
    format!(
        "{}: {}x{} pixels do not tell the projection; give --from {layouts}perspective:fov=DEGREES, equirect, fisheye, \
         fulldome or omnimax, or a pattern with {{face}} for the faces of a cube",
        path.display(),
        header.width,
        header.height
    )
}

/// What `--from` says of a file, completed by what the file says of itself.
pub(super) fn declared(shape: &Shape, pattern: &str, header: &Header, warnings: &mut Vec<String>) -> Result<Shape> {
    match shape {
        Shape::Single(single) if header.metadata.envmap == Some(EnvMap::LatLong) => {
            Ok(Shape::Single(single.with_samples(SamplePositions::Edges)))
        }
        Shape::Single(single) => Ok(Shape::Single(*single)),
        Shape::Cube(Cube { layout: Some(Packing::Files), .. }) => Err(usage(format!(
            "--from cube:layout=faces wants a file for each face, but {pattern} has no {{face}} or %c where a face's name \
             stands"
        ))),
        Shape::Cube(cube) => Ok(Shape::Cube(declared_cube(cube, pattern, header, warnings)?)),
    }
}

/// The layout and the order that the file's format has, where none is given.
fn declared_cube(cube: &Cube, pattern: &str, header: &Header, warnings: &mut Vec<String>) -> Result<Cube> {
    let strip = |order: Option<FaceOrder>| Cube {
        layout: cube.layout.or(Some(Packing::OneImage(LayoutKind::StripV))),
        order: cube.order.or(order),
        ..cube.clone()
    };
    match header.metadata.envmap {
        Some(EnvMap::Cube) => return Ok(strip(Some(FaceOrder::OPENEXR))),
        Some(EnvMap::GlCube) => return Ok(strip(None)),
        Some(EnvMap::LatLong) | None if cube.layout.is_some() => return Ok(cube.clone()),
        Some(EnvMap::LatLong) | None => {}
    }
    let kinds: Vec<LayoutKind> = layouts_of_shape(header.width, header.height).collect();
    match kinds[..] {
        [kind] => {
            warnings.push(format!("{pattern} is read as --from cube:layout={kind}, because of its shape"));
            Ok(Cube { layout: Some(Packing::OneImage(kind)), ..cube.clone() })
        }
        _ => {
            let names = if kinds.is_empty() { LayoutKind::ALL.to_vec() } else { kinds };
            let names: Vec<String> = names.iter().map(|kind| format!("cube:layout={kind}")).collect();
            Err(usage(format!(
                "--from cube: {pattern} has no {{face}} or %c where a face's name stands, and its {}x{} pixels do not tell \
                 how the faces lie in it; if it holds them all, give --from {}",
                header.width,
                header.height,
                names.join(" or ")
            )))
        }
    }
}

/// What `info` says.
pub(crate) fn likely(header: &Header) -> String {
    match Guess::of(header) {
        Guess::Said(EnvMap::LatLong) => "equirect, samples on the edges (envmap attribute)".to_owned(),
        Guess::Said(EnvMap::Cube) => {
            "cube:layout=strip-v,order=openexr, samples on the edges (envmap attribute)".to_owned()
        }
        Guess::Said(EnvMap::GlCube) => "cube (the file's own six faces, one below the other)".to_owned(),
        Guess::TwoToOne => "equirect (2:1)".to_owned(),
        Guess::Layouts(kinds) => {
            let names: Vec<String> = kinds.iter().map(|kind| format!("cube:layout={kind}")).collect();
            format!("{} (by its shape)?", names.join(" or "))
        }
        Guess::Unknown if header.width == header.height => "unknown: a face of a cube, fisheye or fulldome?".to_owned(),
        Guess::Unknown => "unknown: perspective, fisheye or omnimax?".to_owned(),
    }
}
