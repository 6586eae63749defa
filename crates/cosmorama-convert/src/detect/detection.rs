use std::path::Path;

use cosmorama::camera::{CameraModel, EquirectCamera, FulldomeCamera, OmnimaxCamera, SamplePositions};
use cosmorama::circle::Found;
use cosmorama::layout::{FaceOrder, LayoutKind};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_io::{EnvMap, Header, Pose};
use cosmorama_spec::{Cube, Packing, Shape, Single, Spec, StereoSpec};

use crate::detect::decision::{
    OVAL_ONES, ROUND_ONES, candidates, dome_spec, in_layout, layouts_of_shape, panorama, two_eyes,
};
use crate::detect::pixels::{damage_of, is_small, light_of};
use crate::detect::{Continuity, Evidence, Examined, Guess, Readings, Seen, disc, seams};
use crate::diagnostic::{Code, Diagnostic, FROM, Remedy, Result, Setting, Severity, bail, usage, usage_as};
use crate::packing::canvas::canvas_of;
use crate::source::{Access, DecodedPicture, Files, MemoryBudget};

/// Detects the projection of an image without `--from`, which may hold a picture for each eye. A guess is announced.
pub(crate) fn detect(
    access: Access,
    path: &Path,
    header: &Header,
    warnings: &mut Vec<Diagnostic>,
) -> Result<(Shape, Option<StereoSpec>)> {
    let Examined { guess, damage, borders } = Examined::of(access.files, path, header, access.decoded);
    if let Some(damage) = damage {
        bail!(Damaged: "{damage}");
    }
    let mono = |shape: Shape| Ok((shape, None));
    // A guess that is plain from the shape needs no warning.
    let is_plain = matches!(guess, Guess::TwoToOne(None));
    let mut announced = |what: &str, spec: Spec, why: &str| {
        let remedy = Remedy::Set(Setting::From, spec.to_string());
        let what = format!("{what} ({FROM} {spec})");
        let message = format!("{} is taken for {what}, because {why}", path.display());
        let severity = if is_plain { Severity::Note } else { Severity::Warning };
        let told = Diagnostic { severity, ..Diagnostic::warning(Code::Detected, message) };
        warnings.push(told.about(path.display()).with_remedy(remedy));
        Ok((spec.shape, spec.stereo))
    };
    match guess {
        Guess::Said(EnvMap::LatLong) => mono(panorama(SamplePositions::Edges, None)),
        Guess::Said(EnvMap::Cube | EnvMap::GlCube) => {
            mono(Shape::Cube(declared_cube(&Cube::default(), &path.to_string_lossy(), header, warnings)?))
        }
        Guess::Panorama(window) => mono(panorama(SamplePositions::Centres, Some(window))),
        Guess::TwoToOne(halves) => {
            let else_what = halves.map(|halves| {
                format!("; its halves are alike: if they are for two eyes, give {FROM} {}", two_eyes(halves))
            });
            let why = format!("it is twice as wide as high{}", else_what.unwrap_or_default());
            announced("a panorama", panorama(SamplePositions::Centres, None).into(), &why)
        }
        Guess::Stereo(spec) => {
            announced("a panorama for each eye", spec, "of its shape and because its halves are alike")
        }
        Guess::Strip(kind) => announced("the faces of a cube", in_layout(kind), "of its shape"),
        Guess::Seams(spec) => {
            announced("the faces of a cube", spec, "of its shape and because the borders of its faces meet")
        }
        Guess::Blank(evidence) => {
            let (spec, what, why) = guessed(path, evidence)?;
            announced(what, spec, &why)
        }
        Guess::Unknown(kinds, seen) => {
            let fit = borders
                .and_then(|found| found.spec)
                .map(|spec| format!("; as the faces of a cube, their borders would meet by {FROM} {spec}"));
            bail!(Ambiguous: "{}{}", ambiguous(path, header, &kinds, &seen), fit.unwrap_or_default())
        }
    }
}

/// Returns the guess from blank areas: the SPEC, its name in messages, and the reason.
fn guessed(path: &Path, evidence: Evidence) -> Result<(Spec, &'static str, String)> {
    Ok(match evidence {
        Evidence::Cross(kind) => {
            let why = "of its shape and because one colour surrounds a cross".to_owned();
            (in_layout(kind), "the faces of a cube", why)
        }
        Evidence::CrossElsewhere(kind, mirror) => {
            let Readings { mirrored, upright, on_its_head } = Readings::new(kind, mirror);
            bail!(
                Ambiguous: "{}: one colour surrounds a cross whose long arm is at the other end; give {FROM} {mirrored} if the picture is \
                 mirrored, so that writing in it reads backwards, {FROM} {on_its_head} if it stands on its head, or {FROM} \
                 {upright} if it does neither",
                path.display()
            )
        }
        Evidence::Circle => {
            let why =
                format!("it is square and black around a circle; so may {ROUND_ONES} be, which {FROM} has to say");
            (CameraModel::Fulldome(FulldomeCamera::default()).into(), "a domemaster", why)
        }
        Evidence::Omnimax => {
            let why = "it is black around a circle that is cut off below".to_owned();
            (CameraModel::Omnimax(OmnimaxCamera::default()).into(), "an Omnimax frame", why)
        }
        Evidence::Circles(circles) if circles.are_alike => {
            let why = format!(
                "it has two circles on black that are alike; two cameras back to back would be {FROM} {}",
                circles.dual_spec()
            );
            (dome_spec(&circles), "a domemaster for each eye", why)
        }
        Evidence::Circles(circles) => {
            let why =
                "it has two circles on black; that each sees 195 degrees is a guess, which fov= can mend".to_owned();
            (circles.dual_spec(), "two fisheyes", why)
        }
        Evidence::Disc(found) => {
            let [fisheye, ball] = disc::specs(&found, "DEGREES");
            bail!(
                Ambiguous: "{}: a circle on black, as a fisheye lens leaves it, whose field of view is not known; give {FROM} \
                 {fisheye}, or, for a mirror ball, {FROM} {ball}",
                path.display()
            )
        }
        Evidence::Oval => bail!(
            Ambiguous: "{}: twice as wide as high, with one colour around an oval, as oval maps have it; give {FROM} {OVAL_ONES}, or \
             {FROM} equirect if it is a panorama all the same",
            path.display()
        ),
        Evidence::Twins(_) => {
            bail!(Ambiguous: "{}: two pictures that are alike; give {FROM} SPEC with stereo=", path.display())
        }
    })
}

/// Returns the error that lists possible projections of an unknown image.
fn ambiguous(path: &Path, header: &Header, layouts: &[LayoutKind], seen: &Seen) -> String {
    let halves = match seen {
        Seen::Evidence(Evidence::Twins(_)) => "; its halves are alike: for two eyes add stereo= to it",
        _ => "",
    };
    format!(
        "{}: {}x{} pixels do not tell the projection; give {FROM} {}, or a pattern with {{face}} for the faces of a \
         cube{halves}",
        path.display(),
        header.width,
        header.height,
        candidates(header, layouts)
    )
}

/// Completes the projection of `--from` by the metadata of the file.
pub(crate) fn declared(shape: &Shape, pattern: &str, header: &Header, warnings: &mut Vec<Diagnostic>) -> Result<Shape> {
    match shape {
        Shape::Single(single) if header.metadata.envmap == Some(EnvMap::LatLong) => {
            let single = posed(single.clone(), pattern, header, warnings);
            Ok(Shape::Single(single.with_samples(SamplePositions::Edges)))
        }
        Shape::Single(single) => {
            let single = posed(single.clone(), pattern, header, warnings);
            if let Some(other) = content_by_metadata(header, &single) {
                let message =
                    format!("{pattern} holds {other}, but {FROM} says otherwise; it is read as {FROM} has it");
                warnings.push(Diagnostic::warning(Code::Declared, message).about(pattern));
            }
            Ok(Shape::Single(windowed(single, header)))
        }
        Shape::StMap(_) | Shape::Calibrated(_) => Ok(shape.clone()),
        Shape::Cube(Cube { layout: Some(Packing::Files), .. }) => Err(usage(format!(
            "{FROM} cube:layout=faces wants a file for each face, but {pattern} has no {{face}} or %c where a face's name \
             stands"
        ))),
        Shape::Dual(_) => Ok(shape.clone()),
        Shape::Cube(cube) => Ok(Shape::Cube(declared_cube(cube, pattern, header, warnings)?)),
    }
}

/// Returns the content that a file's metadata tell of, where a declared projection does not fit it.
fn content_by_metadata(header: &Header, declared: &Single) -> Option<&'static str> {
    let is_panorama = matches!(declared.placement.frame, CameraModel::Equirect(_));
    match (header.metadata.envmap, header.metadata.panorama) {
        (Some(EnvMap::Cube | EnvMap::GlCube), _) => {
            Some("the six faces of a cube, as its format or its envmap attribute says")
        }
        (_, Some(_)) if !is_panorama => Some("an equirect panorama, as its GPano metadata say"),
        _ => None,
    }
}

/// Turns a panorama by its camera's pose, if the SPEC says so.
fn posed(mut single: Single, pattern: &str, header: &Header, warnings: &mut Vec<Diagnostic>) -> Single {
    if !single.pose {
        return single;
    }
    let Some(Pose { heading, pitch, roll }) = header.metadata.pose else {
        let message =
            format!("{pattern} has no GPano pose, or one that is level and heads north: pose=yes turns nothing");
        warnings.push(Diagnostic::warning(Code::NoEffect, message).about(pattern));
        return single;
    };
    let [yaw, pitch, roll] = [heading, pitch, roll].map(Angle::from_degrees);
    single.placement.orientation = Orientation::from_yaw_pitch_roll(yaw, pitch, roll);
    single
}

/// Crops a whole panorama to the part that its file declares.
fn windowed(mut single: Single, header: &Header) -> Single {
    let whole = CameraModel::Equirect(EquirectCamera::default());
    if let (Some(window), None) = (header.metadata.panorama, single.placement.canvas)
        && single.placement.frame == whole
    {
        single.placement.canvas = Some(canvas_of(window));
    }
    single
}

/// Completes a cube by the layout and the order of the file's format, unless they are given.
fn declared_cube(cube: &Cube, pattern: &str, header: &Header, warnings: &mut Vec<Diagnostic>) -> Result<Cube> {
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
            let spec = in_layout(kind).to_string();
            let message = format!("{pattern} is read as {FROM} {spec}, because of its shape");
            let remedy = Remedy::Set(Setting::From, spec);
            warnings.push(Diagnostic::warning(Code::Detected, message).about(pattern).with_remedy(remedy));
            Ok(Cube { layout: Some(Packing::OneImage(kind)), ..cube.clone() })
        }
        _ => {
            let names = if kinds.is_empty() { LayoutKind::ALL.to_vec() } else { kinds };
            let names: Vec<String> = names.into_iter().map(|kind| in_layout(kind).to_string()).collect();
            Err(usage_as(
                Code::Ambiguous,
                format!(
                    "{FROM} cube: {pattern} has no {{face}} or %c where a face's name stands, and its {}x{} pixels do not tell \
                 how the faces lie in it; if it holds them all, give {FROM} {}",
                    header.width,
                    header.height,
                    names.join(" or ")
                ),
            ))
        }
    }
}

/// Guesses about an image that the verb `info` reports.
pub struct Likely {
    /// Projection of the image.
    pub projection: String,
    /// Circle of a lens on black.
    pub circle: Option<Found>,
    /// Findings about the faces that the image holds, or may hold.
    pub arrangement: Option<Continuity>,
    /// Damage, if its pixels cannot be read.
    pub damage: Option<String>,
    /// Whether its pixels were read, or tried to be.
    pub is_read: bool,
}

/// Examines an image. With `reads_all`, its pixels are read even where its header tells what it is: to find damage, and
/// how faces lie.
pub fn likely(files: &dyn Files, path: &Path, header: &Header, reads_all: bool) -> Likely {
    let Examined { guess, damage, borders } = Examined::of(files, path, header, &DecodedPicture::default());
    // A part of a larger picture is not looked at, whatever the guess says.
    let has_looked = guess.has_looked() && header.window.is_none() && is_small(header);
    let is_unread = reads_all && !has_looked && is_small(header);
    let damage = damage.or_else(|| if is_unread { damage_of(files, path, MemoryBudget::new(None)) } else { None });
    let circle = match guess {
        Guess::Blank(Evidence::Disc(found)) => Some(found),
        _ => None,
    };
    let cubes = if reads_all { guess.cubes() } else { Vec::new() };
    let picture = if cubes.is_empty() { None } else { light_of(files, path) };
    let judged = picture.and_then(|picture| seams::judged(&cubes, header.metadata.envmap, &picture));
    Likely {
        projection: guess.describe(header),
        circle,
        arrangement: borders.or(judged),
        damage,
        is_read: has_looked || is_unread,
    }
}
