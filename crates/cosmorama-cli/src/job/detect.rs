use std::path::Path;

use anyhow::{Result, bail};
use cosmorama::circle::{Circle, Found};
use cosmorama::world::{EquirectFrame, FaceOrder, Frame, FulldomeFrame, LayoutKind, Placement, SamplePositions};
use cosmorama_io::{EnvMap, Header, Window};

use super::canvas::canvas_of;
use super::evidence::Evidence;

use crate::failure::usage;
use crate::spec::{Cube, Packing, Shape, Single, SphereSamples};

/// What one image is a picture of, as far as its metadata, its shape and its blank parts tell.
enum Guess {
    /// What its metadata say.
    Said(EnvMap),
    /// A part of a panorama, say its metadata.
    Panorama(Window),
    /// A panorama, by its shape: twice as wide as high.
    TwoToOne,
    /// A strip of faces, by its shape: no camera makes pictures so long.
    Strip(LayoutKind),
    /// A cross of faces or a circle, by what is blank around it.
    Blank(Evidence),
    /// One of these layouts of faces, by its shape, or anything else.
    Layouts(Vec<LayoutKind>),
}

impl Guess {
    /// Looks at a header, and at the pixels where nothing else tells.
    fn of(path: &Path, header: &Header) -> Self {
        let (width, height) =
            header.window.map_or((header.width, header.height), |window| (window.canvas_width, window.canvas_height));
        if let Some(envmap) = header.metadata.envmap {
            return Self::Said(envmap);
        }
        if let Some(window) = header.metadata.panorama {
            return Self::Panorama(window);
        }
        if width == 2 * height {
            return Self::TwoToOne;
        }
        let layouts: Vec<LayoutKind> = layouts_of_shape(width, height).collect();
        match layouts[..] {
            [kind @ (LayoutKind::StripH | LayoutKind::StripV)] => Self::Strip(kind),
            _ => Evidence::of(path, header).map_or(Self::Layouts(layouts), Self::Blank),
        }
    }

    /// The cubes that an image may hold the faces of.
    fn cubes(self) -> Vec<Cube> {
        let of = |kind: LayoutKind| Cube { layout: Some(Packing::OneImage(kind)), ..Cube::default() };
        match self {
            Self::Said(EnvMap::Cube) => vec![Cube { order: Some(FaceOrder::OPENEXR), ..of(LayoutKind::StripV) }],
            Self::Said(EnvMap::GlCube) => vec![of(LayoutKind::StripV)],
            Self::Strip(kind) | Self::Blank(Evidence::Cross(kind)) => vec![of(kind)],
            Self::Layouts(kinds) => kinds.into_iter().map(of).collect(),
            Self::Said(EnvMap::LatLong) | Self::Panorama(_) | Self::TwoToOne => Vec::new(),
            Self::Blank(Evidence::Circle | Evidence::Disc(_)) => Vec::new(),
        }
    }

    /// In words.
    fn describe(&self, header: &Header) -> String {
        match self {
            Self::Said(EnvMap::LatLong) => "equirect, samples on the edges (envmap attribute)".to_owned(),
            Self::Said(EnvMap::Cube) => {
                "cube:layout=strip-v,order=openexr, samples on the edges (envmap attribute)".to_owned()
            }
            Self::Said(EnvMap::GlCube) => "cube (the file's own six faces, one below the other)".to_owned(),
            Self::Panorama(Window { canvas_width, canvas_height, x, y }) => {
                let whole = (*canvas_width, *canvas_height) == (header.width, header.height);
                let canvas =
                    if whole { String::new() } else { format!(":canvas={canvas_width}x{canvas_height}+{x}+{y}") };
                format!("equirect{canvas} (GPano metadata)")
            }
            Self::TwoToOne => "equirect (2:1)".to_owned(),
            Self::Strip(kind) => format!("cube:layout={kind} (by its shape)"),
            Self::Blank(Evidence::Cross(kind)) => format!("cube:layout={kind} (one colour surrounds a cross)"),
            Self::Blank(Evidence::Disc(found)) => {
                let how = match found {
                    Found::Measured(_) => "a circle on black",
                    Found::Roughly(_) => "roughly: a disc on black, too dark at its rim to measure",
                };
                format!("{} ({how}; 180 degrees are a guess)", fisheye_spec(found, "180"))
            }
            Self::Blank(Evidence::Circle) => "fulldome (square, black around a circle)".to_owned(),
            Self::Layouts(kinds) if kinds.is_empty() && header.width == header.height => {
                "unknown: a face of a cube, a mirror ball, fisheye or octahedral? (no circle on black)".to_owned()
            }
            Self::Layouts(kinds) => {
                let names: String = kinds.iter().map(|kind| format!("cube:layout={kind}, ")).collect();
                format!("unknown: {names}perspective, fisheye or omnimax? (no circle on black)")
            }
        }
    }
}

fn layouts_of_shape(width: usize, height: usize) -> impl Iterator<Item = LayoutKind> {
    LayoutKind::ALL.into_iter().filter(move |kind| kind.has_shape(width, height))
}

/// The projection of an image for which no `--from` was given. What is only guessed is announced.
pub(super) fn detect(path: &Path, header: &Header, warnings: &mut Vec<String>) -> Result<Shape> {
    let mut announce = |what: &str, why: &str| {
        warnings.push(format!("{} is taken for {what}, because {why}", path.display()));
    };
    match Guess::of(path, header) {
        Guess::Said(EnvMap::LatLong) => Ok(panorama(SamplePositions::Edges, None)),
        Guess::Said(EnvMap::Cube | EnvMap::GlCube) => {
            declared_cube(&Cube::default(), &path.to_string_lossy(), header, warnings).map(Shape::Cube)
        }
        Guess::Panorama(window) => Ok(panorama(SamplePositions::Centres, Some(window))),
        Guess::TwoToOne => {
            announce("a panorama (--from equirect)", "it is twice as wide as high");
            Ok(panorama(SamplePositions::Centres, None))
        }
        Guess::Strip(kind) => {
            announce(&format!("the faces of a cube (--from cube:layout={kind})"), "of its shape");
            Ok(one_image(kind))
        }
        Guess::Blank(Evidence::Cross(kind)) => {
            let why = "of its shape and because one colour surrounds a cross";
            announce(&format!("the faces of a cube (--from cube:layout={kind})"), why);
            Ok(one_image(kind))
        }
        Guess::Blank(Evidence::Circle) => {
            announce("a domemaster (--from fulldome)", "it is square and black around a circle");
            let placement = Placement::new(Frame::Fulldome(FulldomeFrame::default()));
            Ok(Shape::Single(Single { placement, samples: SphereSamples::NotAPanorama, any_shape: false }))
        }
        Guess::Blank(Evidence::Disc(circle)) => bail!(
            "{}: a circle on black, as a fisheye lens leaves it, whose field of view is not known; give --from {}",
            path.display(),
            fisheye_spec(&circle, "DEGREES")
        ),
        Guess::Layouts(kinds) => bail!("{}", ambiguous(path, header, &kinds)),
    }
}

/// The SPEC of a fisheye photograph.
fn fisheye_spec(found: &Found, fov: &str) -> String {
    let Circle { centre: (x, y), radius } = found.circle();
    match found {
        Found::Measured(_) => format!("fisheye:fov={fov},center={x:.1}:{y:.1},radius={radius:.1}"),
        Found::Roughly(_) => format!("fisheye:fov={fov},center={x:.0}:{y:.0},radius={radius:.0}"),
    }
}

fn panorama(samples: SamplePositions, window: Option<Window>) -> Shape {
    let frame = Frame::Equirect(EquirectFrame { samples, ..EquirectFrame::default() });
    let placement = Placement { canvas: window.map(canvas_of), ..Placement::new(frame) };
    Shape::Single(Single { placement, samples: SphereSamples::ByFormat, any_shape: false })
}

fn one_image(kind: LayoutKind) -> Shape {
    Shape::Cube(Cube { layout: Some(Packing::OneImage(kind)), ..Cube::default() })
}

/// What an image of unknown projection could be.
fn ambiguous(path: &Path, header: &Header, layouts: &[LayoutKind]) -> String {
    let layouts = layouts.iter().map(|kind| format!("cube:layout={kind}, ")).collect::<String>();
    let others = if header.width == header.height {
        "fulldome, fisheye:fov=DEGREES, mirror-ball, angular-map, octahedral, perspective:fov=DEGREES, omnimax or equirect"
    } else {
        "perspective:fov=DEGREES, equirect, fisheye, fulldome or omnimax"
    };
    format!(
        "{}: {}x{} pixels do not tell the projection; give --from {layouts}{others}, or a pattern with {{face}} for the \
         faces of a cube",
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
        Shape::Single(single) => Ok(Shape::Single(windowed(*single, header))),
        Shape::StMap(map) => Ok(Shape::StMap(map.clone())),
        Shape::Cube(Cube { layout: Some(Packing::Files), .. }) => Err(usage(format!(
            "--from cube:layout=faces wants a file for each face, but {pattern} has no {{face}} or %c where a face's name \
             stands"
        ))),
        Shape::Dual(_) => Ok(shape.clone()),
        Shape::Cube(cube) => Ok(Shape::Cube(declared_cube(cube, pattern, header, warnings)?)),
    }
}

/// A whole panorama of which the file says that it is only a part of it.
fn windowed(mut single: Single, header: &Header) -> Single {
    let whole = Frame::Equirect(EquirectFrame::default());
    if let (Some(window), None) = (header.metadata.panorama, single.placement.canvas)
        && single.placement.frame == whole
    {
        single.placement.canvas = Some(canvas_of(window));
    }
    single
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

/// What `info` says of an image.
pub(crate) struct Likely {
    /// Its projection.
    pub(crate) projection: String,
    /// The circle that a lens left on black.
    pub(crate) circle: Option<Found>,
    /// The cubes that it may hold the faces of.
    pub(crate) cubes: Vec<Cube>,
    /// Whether its shape alone says that it may hold any.
    pub(crate) may_be_none: bool,
}

/// Looks at an image.
pub(crate) fn likely(path: &Path, header: &Header) -> Likely {
    let guess = Guess::of(path, header);
    let circle = match guess {
        Guess::Blank(Evidence::Disc(found)) => Some(found),
        _ => None,
    };
    let may_be_none = matches!(guess, Guess::Layouts(_));
    Likely { projection: guess.describe(header), circle, cubes: guess.cubes(), may_be_none }
}
