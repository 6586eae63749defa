//! Decision on the kind of picture that an image is, where nothing is declared.

use std::path::Path;

use cosmorama::camera::{CameraModel, EquirectCamera, FulldomeCamera, Placement, SamplePositions};
use cosmorama::circle::Found;
use cosmorama::layout::{Arrangement, FaceOrder, LayoutKind, Stereo};
use cosmorama::sphere::Angle;
use cosmorama_io::{EnvMap, Format, Header, Window};
use cosmorama_spec::{Cube, Shape, Single, Spec, StereoSpec};

use crate::detect::{Circles, Continuity, Evidence, Readings, Seen, disc, seams};
use crate::packing::canvas::canvas_of;
use crate::source::{DecodedPicture, Files};

/// Kind of picture, as far as metadata, shape and pixels tell.
pub(crate) enum Guess {
    /// Kind that the metadata names.
    Said(EnvMap),
    /// Part of a panorama, by its metadata.
    Panorama(Window),
    /// Panorama, because it is twice as wide as high. If its halves are alike, it may hold two pictures.
    TwoToOne(Option<Arrangement>),
    /// One panorama for each eye, by shape and by halves that are alike.
    Stereo(Spec),
    /// Strip of faces, by its shape.
    Strip(LayoutKind),
    /// Faces of a cube, by its shape and because their borders meet.
    Seams(Spec),
    /// Cross of faces, circles or an oval, by blank areas around them.
    Blank(Evidence),
    /// Unknown. By its shape it may be one of these layouts or anything else, and the pixels did not decide.
    Unknown(Vec<LayoutKind>, Seen),
}

/// Kinds of pictures, besides domemasters, that are black around a circle that fills a square.
pub(crate) const ROUND_ONES: &str = "fisheye:fov=DEGREES, mirror-ball or angular-map";

/// Suggestion for a mirror ball whose circle was not found.
const BALL: &str = "mirror-ball (with center= and radius= unless the ball touches the borders)";

/// Kinds of pictures of 2:1 with one colour around an oval.
pub(crate) const OVAL_ONES: &str = "hammer, mollweide or sinusoidal";

/// Result of an examination.
pub(crate) struct Examined {
    /// Kind of picture.
    pub(crate) guess: Guess,
    /// Damage, if the pixels were needed but cannot be read.
    pub(crate) damage: Option<String>,
    /// Findings about its faces, if its shape allows a cube.
    pub(crate) borders: Option<Continuity>,
}

impl Examined {
    /// Examines a header, and the pixels where nothing else decides.
    pub(crate) fn of(files: &dyn Files, path: &Path, header: &Header, decoded: &DecodedPicture) -> Self {
        let by_header = |guess| Self { guess, damage: None, borders: None };
        if let Some(envmap) = header.metadata.envmap {
            return by_header(Guess::Said(envmap));
        }
        if let Some(window) = header.metadata.panorama {
            return by_header(Guess::Panorama(window));
        }
        let (width, height) = size(header);
        let layouts: Vec<LayoutKind> = layouts_of_shape(width, height).collect();
        if let [kind @ (LayoutKind::StripH | LayoutKind::StripV)] = layouts[..] {
            return by_header(Guess::Strip(kind));
        }
        let (seen, borders) = Seen::of(files, path, (header, &layouts), decoded);
        let damage = match &seen {
            Seen::Damaged(damage) => Some(damage.clone()),
            _ => None,
        };
        let guess = match borders.as_ref().and_then(seams::sure) {
            Some(spec) => Guess::Seams(spec),
            None => Guess::by_pixels((width, height), layouts, seen),
        };
        Self { guess, damage, borders }
    }
}

impl Guess {
    fn by_pixels((width, height): (usize, usize), layouts: Vec<LayoutKind>, seen: Seen) -> Self {
        match seen {
            Seen::Evidence(evidence @ (Evidence::Circles(_) | Evidence::Oval)) => Self::Blank(evidence),
            Seen::Evidence(Evidence::Twins(arrangement)) if width == 2 * height => Self::TwoToOne(Some(arrangement)),
            _ if width == 2 * height => Self::TwoToOne(None),
            Seen::Evidence(Evidence::Twins(arrangement)) => match (arrangement, width, height) {
                (Arrangement::TopBottom, w, h) if w != h => Self::Unknown(layouts, seen),
                (Arrangement::SideBySide, w, h) if w != 4 * h => Self::Unknown(layouts, seen),
                _ => Self::Stereo(for_eyes(whole_sphere(), arrangement, false)),
            },
            Seen::Evidence(evidence) => Self::Blank(evidence),
            Seen::Nothing | Seen::Unseen(_) | Seen::Damaged(_) => Self::Unknown(layouts, seen),
        }
    }

    /// Returns whether the pixels were needed for the decision.
    pub(crate) fn has_looked(&self) -> bool {
        !matches!(self, Self::Said(_) | Self::Panorama(_) | Self::Strip(_))
    }

    /// Returns the cubes whose faces the image may hold, if more than its shape suggests them.
    pub(crate) fn cubes(&self) -> Vec<Cube> {
        match self {
            Self::Said(EnvMap::Cube) => vec![openexr_strip()],
            Self::Said(EnvMap::GlCube) => vec![LayoutKind::StripV.into()],
            Self::Strip(kind) | Self::Blank(Evidence::Cross(kind) | Evidence::CrossElsewhere(kind, _)) => {
                vec![(*kind).into()]
            }
            _ => Vec::new(),
        }
    }

    /// Describes the kind in words.
    pub(crate) fn describe(&self, header: &Header) -> String {
        match self {
            Self::Said(EnvMap::LatLong) => "equirect, samples on the edges (envmap attribute)".to_owned(),
            Self::Said(EnvMap::Cube) => {
                format!("{}, samples on the edges (envmap attribute)", Spec::from(openexr_strip()))
            }
            Self::Said(EnvMap::GlCube) => "cube (the file's own six faces, one below the other)".to_owned(),
            Self::Panorama(window) => {
                let is_whole = (window.canvas_width, window.canvas_height) == (header.width, header.height);
                let part = Some(*window).filter(|_| !is_whole);
                format!("{} (GPano metadata)", Spec::from(panorama(SamplePositions::Centres, part)))
            }
            Self::TwoToOne(None) if header.format == Format::Exr => {
                "equirect (2:1), samples at pixel centres (no envmap attribute)".to_owned()
            }
            Self::TwoToOne(None) => "equirect (2:1)".to_owned(),
            Self::TwoToOne(Some(halves)) => {
                format!("equirect (2:1), or, since its halves are alike, {}", two_eyes(*halves))
            }
            Self::Stereo(spec) => format!("{spec} (by its shape, and since its halves are alike)"),
            Self::Strip(kind) => format!("{} (by its shape)", in_layout(*kind)),
            Self::Seams(spec) => format!("{spec} (by its shape, and because the borders of its faces meet)"),
            Self::Blank(evidence) => describe_blank(evidence),
            Self::Unknown(kinds, seen) => {
                let (width, height) = size(header);
                let face = if width == height { "a face of a cube (a pattern with {face}), " } else { "" };
                format!("unknown: {face}{}? ({})", candidates(header, kinds), describe_nothing(seen))
            }
        }
    }
}

fn describe_blank(evidence: &Evidence) -> String {
    match evidence {
        Evidence::Cross(kind) => format!("{} (one colour surrounds a cross)", in_layout(*kind)),
        Evidence::CrossElsewhere(kind, mirror) => {
            let Readings { mirrored, upright, on_its_head } = Readings::new(*kind, *mirror);
            format!(
                "{mirrored} (one colour surrounds a cross that is mirrored), or {upright} (or one that is not), or \
                 {on_its_head} (or one that stands on its head)"
            )
        }
        Evidence::Disc(found) => {
            let how = match found {
                Found::Measured(_) => "a circle on black",
                Found::Roughly(_) => "roughly: a disc on black, too dark at its rim to measure",
            };
            let [fisheye, ball] = disc::specs(found, "180");
            format!("{fisheye} ({how}; 180 degrees are a guess), or {ball}")
        }
        Evidence::Circle => format!("fulldome (square, black around a circle), or {ROUND_ONES}"),
        Evidence::Omnimax => "omnimax (black around a circle that is cut off below)".to_owned(),
        Evidence::Circles(circles) if circles.are_alike => {
            format!("{} (a circle on black for each eye: alike), or {}", dome_spec(circles), circles.dual_spec())
        }
        Evidence::Circles(circles) => {
            format!("{} (two circles on black; 195 degrees are a guess)", circles.dual_spec())
        }
        Evidence::Oval => format!("{OVAL_ONES} (2:1, one colour around an oval), or equirect"),
        Evidence::Twins(_) => "two pictures that are alike".to_owned(),
    }
}

/// Returns the SPEC of two domemasters in one image.
pub(crate) fn dome_spec(circles: &Circles) -> Spec {
    for_eyes(CameraModel::Fulldome(FulldomeCamera::default()), circles.arrangement, false)
}

/// Returns the SPECs of a picture of 2:1 that is for two eyes.
pub(crate) fn two_eyes(halves: Arrangement) -> String {
    let squeezed = for_eyes(whole_sphere(), halves, true);
    let half = CameraModel::Equirect(EquirectCamera { horizontal: Angle::HALF_TURN, ..EquirectCamera::default() });
    match halves {
        Arrangement::SideBySide => format!("{} or {squeezed}", for_eyes(half, halves, false)),
        Arrangement::TopBottom => squeezed.to_string(),
    }
}

fn for_eyes(frame: CameraModel, arrangement: Arrangement, is_half: bool) -> Spec {
    let packing = Stereo { arrangement, is_half, is_swapped: false };
    Spec { stereo: Some(StereoSpec { packing, eye: None }), ..frame.into() }
}

fn whole_sphere() -> CameraModel {
    CameraModel::Equirect(EquirectCamera::default())
}

/// Returns a panorama, perhaps a part of one.
pub(crate) fn panorama(samples: SamplePositions, window: Option<Window>) -> Shape {
    let frame = CameraModel::Equirect(EquirectCamera { samples, ..EquirectCamera::default() });
    let placement = Placement { canvas: window.map(canvas_of), ..Placement::new(frame.clone()) };
    Shape::Single(Single { placement, ..frame.into() })
}

/// Returns the SPEC of faces in one image.
pub(crate) fn in_layout(kind: LayoutKind) -> Spec {
    Cube::from(kind).into()
}

/// Returns the strip that OpenEXR's attribute for environments names.
fn openexr_strip() -> Cube {
    Cube { order: Some(FaceOrder::OPENEXR), ..LayoutKind::StripV.into() }
}

/// Returns the reason why nothing is known.
fn describe_nothing(seen: &Seen) -> &str {
    match seen {
        Seen::Nothing => "no circle on black",
        Seen::Unseen(why) => why,
        Seen::Damaged(_) => "its pixels cannot be read",
        Seen::Evidence(_) => "its halves are alike, as for two eyes: stereo= may belong to it",
    }
}

/// Lists possible projections of an unknown image: names for `--from`.
pub(crate) fn candidates(header: &Header, layouts: &[LayoutKind]) -> String {
    let (width, height) = size(header);
    let mut names: Vec<String> = layouts.iter().map(|kind| in_layout(*kind).to_string()).collect();
    let by_shape: &[&str] = if width == height {
        &[
            "fulldome",
            "fisheye:fov=DEGREES",
            BALL,
            "angular-map",
            "octahedral",
            "equirect:stereo=tb",
            "perspective:fov=DEGREES",
            "omnimax",
            "equirect",
        ]
    } else if width == 4 * height {
        &["equirect:stereo=sbs", "perspective:fov=DEGREES", "cylinder", "equirect"]
    } else if height == 2 * width {
        &[
            "dual-fisheye:layout=top-bottom",
            "fulldome:stereo=tb",
            "equirect:hfov=180,stereo=tb",
            "perspective:fov=DEGREES",
        ]
    } else {
        &["perspective:fov=DEGREES", "equirect", "fisheye:fov=DEGREES", BALL, "fulldome", "omnimax"]
    };
    names.extend(by_shape.iter().map(|name| (*name).to_owned()));
    let last = names.pop().unwrap_or_default();
    if names.is_empty() { last } else { format!("{} or {last}", names.join(", ")) }
}

/// Returns the size of the whole picture.
fn size(header: &Header) -> (usize, usize) {
    header.window.map_or((header.width, header.height), |window| (window.canvas_width, window.canvas_height))
}

/// Returns the layouts of cube faces with this shape.
pub(crate) fn layouts_of_shape(width: usize, height: usize) -> impl Iterator<Item = LayoutKind> {
    LayoutKind::ALL.into_iter().filter(move |kind| kind.has_shape(width, height))
}
