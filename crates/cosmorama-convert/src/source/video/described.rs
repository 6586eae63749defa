//! Statements of a video about itself, in the words of pictures and SPECs.

use cosmorama::camera::{CameraModel, Canvas, Mirror};
use cosmorama::layout::Arrangement;
use cosmorama::raster::{Channels, Depth, Transfer};
use cosmorama_io::{Format, FrameList, Header, Metadata};
use cosmorama_spec::{Shape, Spec};
use cosmorama_video::{
    Bounds, HalfPlace, Labels, OtherStream, SpatialTags, SphericalPose, SphericalProjection, StereoMode, StreamKind,
    Turn, VideoInfo,
};

/// Returns the header that all frames of a video share.
pub(super) fn header(info: &VideoInfo) -> Header {
    let (width, height) = info.size();
    let channels = if info.has_alpha { Channels::Rgba } else { Channels::Rgb };
    Header {
        format: Format::Video,
        width,
        height,
        channels,
        depth: depth(info.bits),
        metadata: metadata(info),
        window: None,
    }
}

fn depth(bits: u32) -> Depth {
    match bits {
        0..=8 => Depth::Eight,
        9..=10 => Depth::Ten,
        11..=12 => Depth::Twelve,
        _ => Depth::Sixteen,
    }
}

/// Returns the metadata of a frame. YUV without a tag is shown as television is, and RGB as pictures are.
pub(super) fn metadata(info: &VideoInfo) -> Metadata {
    let untagged = if info.is_rgb { None } else { Some(Transfer::Bt1886) };
    let cut_off = (info.left_out > 0).then(|| {
        format!(
            "frames that took after others, which were cut off, are left out at its beginning, as in players: {}",
            info.left_out
        )
    });
    let lacking = (!info.empty_places.is_empty()).then(|| {
        format!(
            "of the first places for {} frames a second it leaves some empty, and its rate is taken to vary: its encoder left frames out, \
             or they are lost: {}",
            info.rate,
            FrameList::new(info.empty_places.iter().copied())
        )
    });
    let ignored = info.spatial.as_ref().and_then(|tags| not_followed(tags, info.size()));
    Metadata {
        transfer: info.colour.known_transfer().or(untagged),
        primaries: info.colour.known_primaries(),
        complaints: cut_off.into_iter().chain(lacking).chain(ignored).collect(),
        notes: info.notes.clone(),
        ..Metadata::default()
    }
}

/// Returns what a video says of itself beside its pictures, each under a name, in the order of a report.
pub(super) fn facts(info: &VideoInfo, half: Option<HalfPlace>) -> Vec<(&'static str, String)> {
    let varies = if info.is_variable { " on average; it varies" } else { "" };
    let turned = info.turn != Turn::default();
    let of_kind = |kind: StreamKind| -> Option<String> {
        let found: Vec<String> = info.others.iter().filter(|other| other.kind == kind).map(told).collect();
        (!found.is_empty()).then(|| found.join(", "))
    };
    let facts = [
        ("container", Some(info.container.clone())),
        ("codec", Some(info.codec.clone())),
        ("pixel_format", Some(info.pixel_format.clone())),
        ("frame_rate", Some(format!("{}{varies}", info.rate))),
        ("seconds", info.duration.map(|seconds| format!("{seconds:.3}"))),
        ("range", Some(info.range().name().to_owned())),
        (
            "turned",
            turned.then(|| "as its rotation asks (width and height are those of the upright picture)".to_owned()),
        ),
        (
            "streams",
            half.map(|place| {
                let way = if place == HalfPlace::Below { "one above the other" } else { "side by side" };
                format!("two, the halves of each picture, {way} (width and height are those of both)")
            }),
        ),
        ("spherical", info.spatial.as_ref().map(spherical)),
        ("sound", of_kind(StreamKind::Audio)),
        ("subtitles", of_kind(StreamKind::Subtitle)),
        ("chapters", (info.chapters > 0).then(|| info.chapters.to_string())),
        ("timecode", info.timecode.clone()),
    ];
    facts.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
}

fn told(stream: &OtherStream) -> String {
    let channels = if stream.channels > 0 { format!(", {} channels", stream.channels) } else { String::new() };
    let Labels { language, title, roles, .. } = &stream.labels;
    let labels: Vec<&str> = language.iter().chain(title).chain(roles).map(String::as_str).collect();
    let labels = if labels.is_empty() { String::new() } else { format!(" ({})", labels.join(", ")) };
    format!("{}{channels}{labels}", stream.codec)
}

/// Describes spherical tags in words.
fn spherical(tags: &SpatialTags) -> String {
    let projection = match tags.projection {
        None => "flat".to_owned(),
        Some(SphericalProjection::Mesh) => "mesh".to_owned(),
        Some(SphericalProjection::Cubemap { layout, padding }) => {
            format!("cubemap, layout {layout}, padding {padding}")
        }
        Some(SphericalProjection::Equirect(bounds)) if bounds == Bounds::default() => "equirectangular".to_owned(),
        Some(SphericalProjection::Equirect(Bounds { top, bottom, left, right })) => {
            let part = |cut: u32| format!("{:.2} %", f64::from(cut) / WHOLE * 100.0);
            format!(
                "equirectangular without {} above, {} below, {} left and {} right",
                part(top),
                part(bottom),
                part(left),
                part(right)
            )
        }
    };
    let stereo = match tags.stereo {
        None => "",
        Some(StereoMode::Mono) => ", for one eye",
        Some(StereoMode::TopBottom) => ", the left eye above the right",
        Some(StereoMode::LeftRight) => ", the left eye beside the right",
    };
    format!("{projection}{stereo}")
}

/// Returns the complaint about spherical tags that are not followed.
fn not_followed(tags: &SpatialTags, size: (usize, usize)) -> Option<String> {
    if tags.pose != SphericalPose::default() {
        let degrees = |part: i32| f64::from(part) / 65536.0;
        let SphericalPose { yaw, pitch, roll } = tags.pose;
        return Some(format!(
            "its spherical tags turn it by yaw {}, pitch {} and roll {} degrees, which is not followed; turn it with yaw=, pitch= and \
             roll= in its SPEC",
            degrees(yaw),
            degrees(pitch),
            degrees(roll)
        ));
    }
    (tags.projection.is_some() && text_of(tags, size).is_none()).then(|| {
        "its spherical tags name a projection that is not read: a mesh, padded faces, or a part that is no window of whole pixels"
            .to_owned()
    })
}

/// Returns the projection that the tags of a video name, if they do.
pub(super) fn spec(info: &VideoInfo) -> Option<Spec> {
    text_of(info.spatial.as_ref()?, info.size())?.parse().ok()
}

/// Returns the projection of a camera whose pictures come in two streams: the rows of GoPro MAX, the circles of Insta360.
pub(super) fn paired(place: HalfPlace) -> Option<Spec> {
    let name = match place {
        HalfPlace::Below => "gopro-max",
        HalfPlace::Beside => "insta360",
    };
    name.parse().ok()
}

/// Whole circle in the units of bounds.
const WHOLE: f64 = 4_294_967_296.0;

/// Returns the SPEC of spherical tags for frames of this size.
fn text_of(tags: &SpatialTags, size: (usize, usize)) -> Option<String> {
    match tags.projection? {
        SphericalProjection::Equirect(bounds) if middle_part(bounds).is_none() => window(bounds, tags.stereo, size),
        SphericalProjection::Equirect(bounds) => {
            let [horizontal, vertical] = middle_part(bounds)?;
            // A unit of the bounds is a twelfth of a millionth of a degree.
            let tidy = |degrees: f64| (degrees * 1e6).round() / 1e6;
            let (hfov, vfov) = (tidy(360.0 * horizontal), tidy(180.0 * vertical));
            let mut keys = Vec::new();
            if horizontal < 1.0 {
                keys.push(format!("hfov={hfov}"));
            }
            if vertical < 1.0 {
                keys.push(format!("vfov={vfov}"));
            }
            keys.extend(stereo_of(tags.stereo, size, hfov / vfov).map(|packing| format!("stereo={packing}")));
            Some(if keys.is_empty() { "equirect".to_owned() } else { format!("equirect:{}", keys.join(",")) })
        }
        SphericalProjection::Cubemap { layout: 0, padding: 0 } => match stereo_of(tags.stereo, size, 1.5) {
            Some(packing) => Some(format!("cube:layout=3x2,stereo={packing}")),
            None => Some("cube:layout=3x2".to_owned()),
        },
        SphericalProjection::Cubemap { .. } | SphericalProjection::Mesh => None,
    }
}

/// Returns the SPEC of a part of a panorama beside its middle, as a window of the whole; `None` if that has no whole pixels.
fn window(bounds: Bounds, stereo: Option<StereoMode>, (width, height): (usize, usize)) -> Option<String> {
    let Bounds { top, bottom, left, right } = bounds;
    let of = |before: u32, behind: u32, count: usize| {
        let [before, behind] = [before, behind].map(|cut| f64::from(cut) / WHOLE);
        let all = count as f64 / (1.0 - before - behind);
        let [whole, first] = [all, before * all].map(f64::round);
        let is_whole = (whole - all).abs() < 0.01 && (first - before * all).abs() < 0.01;
        (before + behind < 1.0 && is_whole && whole <= MOST_COLUMNS).then_some((whole as usize, first as usize))
    };
    let ((columns, x), (rows, y)) = (of(left, right, width)?, of(top, bottom, height)?);
    (!matches!(stereo, Some(StereoMode::TopBottom | StereoMode::LeftRight)))
        .then(|| format!("equirect:canvas={columns}x{rows}+{x}+{y}"))
}

/// Part of a circle that rounding may be off by.
const ROUNDED: f64 = 1e-9;

/// Greatest width of a panorama of which a video is a part.
const MOST_COLUMNS: f64 = 1_000_000.0;

/// Returns the parts of the circle that bounds leave, if that is in the middle.
fn middle_part(bounds: Bounds) -> Option<[f64; 2]> {
    let Bounds { top, bottom, left, right } = bounds;
    let left_over = |cut: u32| 1.0 - 2.0 * f64::from(cut) / WHOLE;
    let is_middle = top == bottom && left == right && top < 1 << 31 && left < 1 << 31;
    is_middle.then(|| [left_over(left), left_over(top)])
}

/// Returns the packing of two eyes, each of which is so many times as wide as high when it is not squeezed.
fn stereo_of(mode: Option<StereoMode>, (width, height): (usize, usize), aspect: f64) -> Option<&'static str> {
    let is = |aspect_of_one: f64| (aspect_of_one / aspect - 1.0).abs() < 0.01;
    let (width, height) = (width as f64, height as f64);
    match mode? {
        StereoMode::Mono => None,
        StereoMode::TopBottom if is(width / height) => Some("tb-half"),
        StereoMode::TopBottom => Some("tb"),
        StereoMode::LeftRight if is(width / height) => Some("sbs-half"),
        StereoMode::LeftRight => Some("sbs"),
    }
}

/// Returns the spherical tags of a video whose pictures of this size have a projection; `None` where there are none for it.
pub(super) fn tags(to: Option<&Spec>, size: (usize, usize)) -> Option<SpatialTags> {
    let spec = to?;
    let Shape::Single(single) = &spec.shape else { return None };
    let CameraModel::Equirect(frame) = &single.placement.frame else { return None };
    if single.placement.mirror != Mirror::default() {
        return None;
    }
    let stereo = match spec.stereo.map(|stereo| (stereo.packing.is_swapped, stereo.packing.arrangement)) {
        None => StereoMode::Mono,
        Some((false, Arrangement::TopBottom)) => StereoMode::TopBottom,
        Some((false, Arrangement::SideBySide)) => StereoMode::LeftRight,
        Some((true, _)) => return None,
    };
    let parts = [frame.horizontal.degrees() / 360.0, frame.vertical.degrees() / 180.0];
    let [[left, right], [top, bottom]] = match single.placement.canvas {
        None => parts.map(|part| [(1.0 - part) / 2.0; 2]),
        // Of two eyes, each is a window.
        Some(_) if stereo != StereoMode::Mono => return None,
        Some(Canvas { width, height, left, top }) => {
            let of = |part: f64, (first, count, all): (i64, usize, usize)| {
                let pixel = part / all as f64;
                let before = (1.0 - part) / 2.0 + pixel * first as f64;
                [before, 1.0 - before - pixel * count as f64]
            };
            [of(parts[0], (left, size.0, width)), of(parts[1], (top, size.1, height))]
        }
    };
    let cut = |part: f64| (-ROUNDED..1.0).contains(&part).then(|| (part.max(0.0) * WHOLE).round() as u32);
    let bounds = Bounds { top: cut(top)?, bottom: cut(bottom)?, left: cut(left)?, right: cut(right)? };
    Some(SpatialTags {
        stereo: Some(stereo),
        projection: Some(SphericalProjection::Equirect(bounds)),
        pose: SphericalPose::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags_of(spec: &str) -> Option<SpatialTags> {
        tags(Some(&spec.parse().unwrap()), (256, 128))
    }

    #[test]
    fn tags_name_the_projection_that_they_were_made_of() {
        for (spec, size) in [
            ("equirect", (4096, 2048)),
            ("equirect:stereo=tb", (2048, 2048)),
            ("equirect:stereo=tb-half", (4096, 2048)),
            ("equirect:stereo=sbs-half", (4096, 2048)),
            ("equirect:hfov=180,stereo=sbs", (4096, 2048)),
            ("equirect:hfov=180,vfov=90", (1000, 500)),
            ("equirect:canvas=512x256+160+31", (256, 128)),
            ("equirect:canvas=300x150+0+22", (256, 128)),
        ] {
            let text = text_of(&tags_of(spec).unwrap(), size).unwrap();
            assert_eq!(text.parse::<Spec>().unwrap().to_string(), spec.parse::<Spec>().unwrap().to_string(), "{text}");
        }
        assert_eq!(tags_of("equirect:hfov=180,stereo=sbs"), Some(SpatialTags::vr180()));
        assert_eq!(tags_of("equirect"), Some(SpatialTags::panorama(StereoMode::Mono)));
    }

    #[test]
    fn nothing_is_said_of_pictures_that_players_would_show_wrongly() {
        for spec in [
            "fulldome",
            "perspective:fov=90",
            "equirect:flip=x",
            "equirect:stereo=sbs,swap=yes",
            "mercator",
            "equirect:canvas=300x150+-8+0",
        ] {
            assert_eq!(tags_of(spec), None, "{spec}");
        }
        assert_eq!(tags(None, (2, 1)), None);
    }

    #[test]
    fn tags_that_are_not_followed_are_told() {
        let panorama = SpatialTags::panorama(StereoMode::Mono);
        assert_eq!(not_followed(&panorama, (2, 1)), None);
        let turned = SpatialTags { pose: SphericalPose { yaw: 90 * 65536, ..SphericalPose::default() }, ..panorama };
        assert!(not_followed(&turned, (2, 1)).unwrap().contains("yaw 90, pitch 0"));
        let mesh = SpatialTags { projection: Some(SphericalProjection::Mesh), ..panorama };
        assert!(not_followed(&mesh, (2, 1)).unwrap().contains("not read"));
        let aside = Bounds { left: 1 << 29, ..Bounds::default() };
        let aside = SpatialTags { projection: Some(SphericalProjection::Equirect(aside)), ..panorama };
        assert!(not_followed(&aside, (3, 2)).is_some() && text_of(&aside, (3, 2)).is_none());
    }
}
