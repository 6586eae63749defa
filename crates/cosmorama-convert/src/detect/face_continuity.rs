use cosmorama::arrange::{Border, Change, Fit, Mismatch, Pose, Verdict, changes, fits_as_well, is_continuous, judge};
use cosmorama::camera::{LayoutFaceCamera, Mirror, SamplePositions};
use cosmorama::layout::{CubeLayout, FaceOrder, FacePlacement, LayoutKind, PlacedFace};
use cosmorama::raster::{Image, Rgba};
use cosmorama::sphere::CubeFace;
use cosmorama_io::{EnvMap, Naming};
use cosmorama_spec::{Cube, Packing, Spec};

use crate::detect::cross_variants::told_elsewhere;
use crate::detect::mirrored_faces::ACROSS;
use crate::detect::{cross_variants, mirrored_faces};
use crate::diagnostic::{FROM, Message};

/// Declared or assumed arrangement of pictures as the faces of a cube.
#[derive(Clone, Debug)]
pub struct GivenFaces {
    /// Placement of each picture, in the order of the input's views.
    poses: Vec<Pose>,
    packing: GivenPacking,
    /// Mirroring of the image that holds them; placements apply after it is undone.
    mirror: Mirror,
    /// Declared or assumed position of the outermost samples, which borders do not tell.
    samples: SamplePositions,
}

/// Tool whose files, or places in one image, have this arrangement.
struct Preset {
    cube: Cube,
    /// Layout, if it differs from the declared one.
    other: Option<LayoutKind>,
}

#[derive(Clone, Copy, Debug)]
enum GivenPacking {
    /// Files with a naming.
    Files(&'static Naming),
    /// Places in one image.
    OneImage(LayoutKind),
}

/// Findings from the borders of faces.
pub struct Continuity {
    /// Message in one line.
    pub told: Message,
    /// Whether the faces fit as they are; `None` if that cannot be decided.
    pub fits: Option<bool>,
    /// Confidence from 0 to 1.
    pub confidence: Option<f64>,
    /// Changes that would make the faces fit.
    pub changes: Vec<String>,
    /// SPEC under which the faces fit, if there is one.
    pub spec: Option<Spec>,
}

/// Size of a picture, and its light by column and row.
pub struct FacePixels<'a> {
    /// Columns and rows.
    pub size: (usize, usize),
    /// Returns the light of the pixel in a column and a row.
    pub light: &'a dyn Fn(usize, usize) -> Rgba,
}

impl GivenFaces {
    /// Least number of faces; fewer have too few common borders.
    pub(crate) const LEAST: usize = 4;

    /// Describes whole faces in files; `None` for crops, whose borders do not meet.
    pub fn of_files(cube: &Cube, naming: &'static Naming, faces: &[(CubeFace, FacePlacement)]) -> Option<Self> {
        Self::new(cube, GivenPacking::Files(naming), SamplePositions::Centres, faces.iter().copied())
    }

    /// Describes the faces in an image of a layout, whose file may have metadata of its own; `None` for faces that lie as halves.
    pub fn of_image(cube: &Cube, envmap: Option<EnvMap>) -> Option<Self> {
        let (Some(Packing::OneImage(kind)), Some(layout)) = (cube.layout, cube.one_image()) else { return None };
        if cube.overlap > 0 {
            return None;
        }
        let faces = layout.faces(2).into_iter().map(|placed| (placed.face, placed.lies));
        let by_file = if envmap == Some(EnvMap::Cube) { SamplePositions::Edges } else { SamplePositions::Centres };
        let chosen = faces.filter(|(face, _)| cube.faces.contains(face));
        Self::new(cube, GivenPacking::OneImage(kind), by_file, chosen)
    }

    fn new(
        cube: &Cube,
        packing: GivenPacking,
        by_file: SamplePositions,
        faces: impl Iterator<Item = (CubeFace, FacePlacement)>,
    ) -> Option<Self> {
        let meet = cube.field_of_view == LayoutFaceCamera::RIGHT_ANGLE;
        let is_one_image = matches!(packing, GivenPacking::OneImage(_));
        let is_plain = meet && cube.half.is_none() && (is_one_image || cube.mirror == Mirror::default());
        let poses = faces.map(|(face, lies)| Pose::new(face, lies)).collect();
        is_plain.then_some(Self { poses, packing, mirror: cube.mirror, samples: cube.samples.unwrap_or(by_file) })
    }

    /// Judges the faces whose pictures are given, by index. `None` if they are too few or too small.
    pub fn judge(&self, pictures: &[(usize, FacePixels<'_>)]) -> Option<Continuity> {
        let (mismatch, given) = self.compare(pictures)?;
        let verdict = judge(&mismatch, &given);
        Some(self.continuity(&mismatch, &given, verdict))
    }

    /// Judges all faces of an image, whose shape must fit the layout. They may lie in other places than declared.
    pub fn judge_image(&self, picture: &Image<Rgba>) -> Option<Continuity> {
        let found = self.judge_places(picture);
        if found.as_ref().is_some_and(|found| found.fits == Some(true)) {
            return found.map(|found| self.beside_mirror_image(found));
        }
        let elsewhere = self.elsewhere(picture, found.as_ref().is_some_and(|found| found.fits == Some(false)));
        elsewhere.or(found)
    }

    fn beside_mirror_image(&self, found: Continuity) -> Continuity {
        match self.packing {
            GivenPacking::OneImage(kind)
                if cross_variants::axis(kind).is_some() && self.poses == poses(CubeLayout::new(kind)) =>
            {
                let told = format!("{}{}", found.told.marked(), cross_variants::mirror_image(kind, self.mirror));
                Continuity { told: told.into(), ..found }
            }
            _ => found,
        }
    }

    fn judge_places(&self, picture: &Image<Rgba>) -> Option<Continuity> {
        let GivenPacking::OneImage(kind) = self.packing else { return None };
        let layout = CubeLayout::new(kind).mirrored(self.mirror);
        let edge = layout.edge(picture.width(), picture.height()).ok()?;
        let places = Some(layout.faces(edge)).filter(|places| places.len() == self.poses.len())?;
        let pixel = |place: &PlacedFace| {
            let rect = place.rect;
            move |i: usize, j: usize| *picture.get(rect.left + i, rect.top + j)
        };
        let lights: Vec<_> = places.iter().map(pixel).collect();
        let pixels = lights.iter().enumerate().map(|(index, light)| (index, FacePixels { size: (edge, edge), light }));
        self.judge(&pixels.collect::<Vec<_>>())
    }

    /// Returns the findings for the places that faces have in the mirrored image. With `is_known`, only if they fit
    /// there as they are.
    fn elsewhere(&self, picture: &Image<Rgba>, is_known: bool) -> Option<Continuity> {
        let GivenPacking::OneImage(kind) = self.packing else { return None };
        let mirror = self.mirror.and(cross_variants::axis(kind)?);
        let found = Self { mirror, ..self.clone() }.judge_places(picture)?;
        let is_found = found.fits == Some(true) || (found.fits == Some(false) && !is_known);
        is_found.then(|| told_elsewhere(kind, mirror, found))
    }

    /// Returns a warning if faces clearly do not fit as declared. They may also be found in other places of `whole`,
    /// the image that holds all of them.
    pub(crate) fn warning(
        &self,
        pictures: &[(usize, FacePixels<'_>)],
        whole: impl FnOnce() -> Option<Image<Rgba>>,
    ) -> Option<Message> {
        let (mismatch, given) = self.compare(pictures)?;
        // Faces whose borders all match need no search.
        if is_continuous(&mismatch, &given) {
            return None;
        }
        let found = self.continuity(&mismatch, &given, judge(&mismatch, &given));
        if found.fits == Some(true) {
            return None;
        }
        let is_known = found.fits == Some(false);
        let may_lie_elsewhere =
            matches!(self.packing, GivenPacking::OneImage(kind) if cross_variants::axis(kind).is_some());
        let elsewhere =
            if may_lie_elsewhere { whole().and_then(|whole| self.elsewhere(&whole, is_known)) } else { None };
        elsewhere.or(is_known.then_some(found)).map(|found| found.told)
    }

    fn compare(&self, pictures: &[(usize, FacePixels<'_>)]) -> Option<(Mismatch, Vec<Pose>)> {
        let least = pictures.iter().map(|(_, picture)| picture.size.0.min(picture.size.1)).min()?;
        if pictures.len() < Self::LEAST || least < 8 {
            return None;
        }
        let samples = Border::samples_for(least);
        let border = |(_, picture): &(usize, FacePixels<'_>)| {
            let (width, height) = picture.size;
            let across = |i: usize| if self.mirror.x { width - 1 - i } else { i };
            let down = |j: usize| if self.mirror.y { height - 1 - j } else { j };
            Border::of(picture.size, samples, |i, j| (picture.light)(across(i), down(j)))
        };
        let borders: Vec<Border> = pictures.iter().map(border).collect();
        let given = pictures.iter().map(|(index, _)| self.poses.get(*index).copied()).collect::<Option<_>>()?;
        Some((Mismatch::new(&borders), given))
    }

    fn continuity(&self, mismatch: &Mismatch, given: &[Pose], verdict: Verdict) -> Continuity {
        let nothing =
            Continuity { told: Message::from(""), fits: None, confidence: None, changes: Vec::new(), spec: None };
        match verdict {
            Verdict::CannotTell => {
                let told = "the borders of the faces do not tell whether they lie rightly".into();
                Continuity { told, ..nothing }
            }
            Verdict::Fits(fit) => {
                let told = format!("the borders of the faces meet{}{}", sure(&fit), undetermined(&fit, given));
                Continuity { told: told.into(), fits: Some(true), confidence: Some(fit.confidence), ..nothing }
            }
            Verdict::Wrong { fits, fit } => self.wrong(mismatch, given, &fits, &fit),
        }
    }

    fn wrong(&self, mismatch: &Mismatch, given: &[Pose], fits: &[Pose], fit: &Fit) -> Continuity {
        let is_mirrored = fits.iter().all(|pose| pose.is_mirrored());
        let plain = self.preset(mismatch, given, fits, false);
        let flipped = self.preset(mismatch, given, fits, true).filter(|_| !is_mirrored);
        let other = plain.iter().chain(&flipped).find_map(|preset| preset.other);
        let plain = plain.map(|preset| preset.cube).or_else(|| self.placed(fits, other)).map(Spec::from);
        let flipped = flipped.map(|preset| Spec::from(preset.cube));
        let (changes, calls) = match other {
            Some(other) => (vec![format!("they lie as layout={other} has them")], ""),
            None => {
                let changes = changes(given, fits);
                (changes.iter().map(Change::to_string).collect(), calls(&changes))
            }
        };
        let advice = match (&self.packing, &plain, &flipped) {
            (GivenPacking::Files(_), None, None) => "; do that with the files".to_owned(),
            _ => advice(plain.as_ref(), flipped.as_ref(), self.mirror.is_backwards()),
        };
        let told = format!(
            "the borders of the faces do not meet as they lie{}: {}{calls}{advice}{}",
            sure(fit),
            changes.join(", "),
            undetermined(fit, given)
        );
        let spec = plain.or(flipped);
        Continuity { told: told.into(), fits: Some(false), confidence: Some(fit.confidence), changes, spec }
    }

    /// Finds the cube of a tool with this arrangement, as it is or with every picture mirrored. A layout's own order is
    /// preferred.
    fn preset(&self, mismatch: &Mismatch, given: &[Pose], fits: &[Pose], is_flipped: bool) -> Option<Preset> {
        let all_given = self.poses.len() == given.len();
        let is_it = |poses: &Vec<Pose>| all_given && fits_as_well(mismatch, fits, poses);
        let mirror = if is_flipped { self.mirror.and(ACROSS) } else { self.mirror };
        let own = |cube: Cube| Preset { cube: Cube { mirror, ..cube }, other: None };
        match self.packing {
            GivenPacking::Files(naming) => {
                let lies = |other: &'static Naming| {
                    let pose = |given: &Pose| Pose::new(given.face, other.placement(given.face));
                    let flipped = |pose: Pose| if is_flipped { mirrored_faces::of(pose) } else { pose };
                    given.iter().map(|given| flipped(pose(given))).collect::<Vec<_>>()
                };
                let same_names = Naming::presets().iter().filter(|other| other.names == naming.names);
                let found = same_names.into_iter().find(|other| is_it(&lies(other)))?;
                Some(own(Cube { naming: Some(found), ..Cube::default() }))
            }
            GivenPacking::OneImage(kind) => {
                let fits = |layout: CubeLayout| {
                    if is_flipped { mirrored_faces::poses(layout.kind(), layout) } else { Some(poses(layout)) }
                        .is_some_and(|poses| is_it(&poses))
                };
                if let Some(found) = same_places(kind).find(|other| fits(CubeLayout::new(*other))) {
                    return Some(Preset { other: Some(found).filter(|found| *found != kind), ..own(found.into()) });
                }
                let (likely, other): (Vec<_>, Vec<_>) =
                    FaceOrder::presets().iter().partition(|order| order.samples == self.samples);
                let mut orders = likely.into_iter().chain(other);
                if let Some(found) = orders.find(|order| fits(CubeLayout::new(kind).with_order(order))) {
                    return Some(own(Cube { order: Some(found), ..kind.into() }));
                }
                // Each picture may be mirrored in its own place.
                let given: Vec<Pose> = given.iter().map(|pose| mirrored_faces::of(*pose)).collect();
                let cube = if is_flipped && is_it(&given) { mirrored_faces::cube(kind, &given) } else { None };
                cube.map(own)
            }
        }
    }

    /// Returns the cube that describes the arrangement place by place, perhaps in another layout. `None` if a picture
    /// is mirrored, or has another face's name.
    fn placed(&self, fits: &[Pose], other: Option<LayoutKind>) -> Option<Cube> {
        if fits.len() != 6 || fits.iter().any(|pose| pose.is_mirrored()) {
            return None;
        }
        // A picture that has to be turned one way lies turned the other way.
        let turns = |pose: &Pose| (4 - pose.placement().quarter_turns) % 4;
        match self.packing {
            GivenPacking::OneImage(kind) => {
                let letters: String = fits.iter().filter_map(|pose| pose.face.name().chars().next()).collect();
                let rotate: Vec<u8> = fits.iter().map(turns).collect();
                let (order, rotate) = (FaceOrder::parse(&letters), rotate.try_into().ok());
                Some(Cube { order, rotate, mirror: self.mirror, ..other.unwrap_or(kind).into() })
            }
            GivenPacking::Files(naming) => {
                let is_named = |(fits, given): (&Pose, &Pose)| fits.face == given.face;
                let is_upright = |face: &CubeFace| naming.placement(*face) == FacePlacement::UPRIGHT;
                if !fits.iter().zip(&self.poses).all(is_named) || !CubeFace::ALL.iter().all(is_upright) {
                    return None;
                }
                let order = FaceOrder::parse("rludfb")?.faces;
                let poses = order.iter().filter_map(|face| fits.iter().find(|pose| pose.face == *face));
                let rotate = poses.map(turns).collect::<Vec<_>>().try_into().ok();
                Some(Cube { naming: Some(naming), rotate, ..Cube::default() })
            }
        }
    }
}

/// Returns the layouts with the places of a kind, beginning with the kind itself.
fn same_places(kind: LayoutKind) -> impl Iterator<Item = LayoutKind> {
    let places = |kind: LayoutKind| CubeLayout::new(kind).faces(2).into_iter().map(|placed| placed.rect);
    let others = LayoutKind::ALL.into_iter().filter(move |other| *other != kind);
    [kind].into_iter().chain(others.filter(move |other| places(*other).eq(places(kind))))
}

/// Returns the noun for pictures of which some are moved and some, perhaps the same, are turned.
fn calls(changes: &[Change]) -> &'static str {
    let goes = |change: &&Change| matches!(change, Change::Swapped(..) | Change::Moved { .. });
    let moved = changes.iter().filter(goes).count();
    if moved == 0 || moved == changes.len() {
        return "";
    }
    " (each is called by the face that it was given as throughout: turn pictures before they change places)"
}

/// Returns the placements of a layout's pictures, in the order of its places.
fn poses(layout: CubeLayout) -> Vec<Pose> {
    layout.faces(2).iter().map(|placed| Pose::new(placed.face, placed.lies)).collect()
}

/// Returns the advice for faces that fit as in `plain` or, if all were mirrored, as in `flipped`. `is_mirrored` says
/// that mirroring is declared already. Borders cannot tell a cube from its mirror image.
fn advice(plain: Option<&Spec>, flipped: Option<&Spec>, is_mirrored: bool) -> String {
    let when = if is_mirrored {
        "no face is mirrored, so that writing in it does not read backwards"
    } else {
        "every face is mirrored instead, so that writing in it reads backwards"
    };
    let mirrored = |spec: &Spec| format!("if {when}, they fit {FROM} {spec}: borders do not tell");
    match (plain, flipped) {
        (Some(plain), None) => format!("; they fit {FROM} {plain}"),
        (Some(plain), Some(flipped)) => format!("; they fit {FROM} {plain}; {}", mirrored(flipped)),
        (None, Some(flipped)) => format!("; do that with the files, or, {}", mirrored(flipped)),
        (None, None) => String::new(),
    }
}

fn sure(fit: &Fit) -> String {
    format!(" (confidence {:.1} %)", 100.0 * fit.confidence.min(0.999))
}

/// Lists faces whose own rotation the borders do not show.
fn undetermined(fit: &Fit, given: &[Pose]) -> String {
    let names: Vec<&str> = fit.free.iter().map(|picture| given[*picture].face.name()).collect();
    if names.is_empty() { String::new() } else { format!("; how {} is turned does not show", names.join(", ")) }
}
