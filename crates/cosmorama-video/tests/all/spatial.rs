//! Tags of spherical video.

use cosmorama_video::{
    Bounds, Ratio, SpatialTags, SphericalPose, SphericalProjection, StereoMode, VideoError, WriteSettings,
};

use crate::common::{ffmpeg, frames, moving, probed, run};
use crate::writing::write;

fn all() -> Vec<(SpatialTags, &'static str)> {
    let quarter = Bounds { left: 1 << 30, right: 1 << 30, ..Bounds::default() };
    let pose = SphericalPose { yaw: 90 << 16, pitch: -10 << 16, roll: 0 };
    vec![
        (SpatialTags::panorama(StereoMode::Mono), "equirectangular"),
        (SpatialTags::panorama(StereoMode::TopBottom), "top and bottom"),
        (SpatialTags::vr180(), "side by side"),
        (SpatialTags { pose, ..SpatialTags::panorama(StereoMode::Mono) }, "90"),
        (
            SpatialTags {
                stereo: Some(StereoMode::LeftRight),
                projection: Some(SphericalProjection::Equirect(quarter)),
                pose: SphericalPose::default(),
            },
            "tiled equirectangular",
        ),
    ]
}

/// Our tags are those that ffprobe reads, in every container, and we read them again.
#[test]
fn tags_are_seen_by_ffprobe() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.mp4", "a.mov", "a.mkv", "a.webm"] {
        for (tags, word) in all() {
            let path = folder.path().join(name);
            let settings =
                WriteSettings { spatial: Some(tags), ..WriteSettings::new((128, 64), Ratio::new(25, 1).unwrap()) };
            write(&ffmpeg, &path, &settings, 3).unwrap();
            let text = probed(&path, "-show_streams");
            assert!(text.contains("Spherical Mapping") && text.contains(word), "{name}: {word}: {text}");
            let found = ffmpeg.probe(&path).unwrap().spatial.unwrap();
            assert_eq!(found.stereo.unwrap_or(StereoMode::Mono), tags.stereo.unwrap(), "{name} {word}");
            assert_eq!(found.pose, tags.pose, "{name} {word}");
            let (Some(SphericalProjection::Equirect(a)), Some(SphericalProjection::Equirect(b))) =
                (found.projection, tags.projection)
            else {
                panic!("{name} {word}: {found:?}")
            };
            // ffprobe tells bounds in pixels, rounded to one side.
            assert_eq!(a, b, "{name} {word}");
            assert_eq!(frames(&ffmpeg, &path, Default::default()).unwrap().len(), 3);
        }
    }
}

/// Tags of a finished file are replaced; its frames stay in their places.
#[test]
fn tags_are_replaced_wherever_the_description_stands() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for flags in ["", "-movflags +faststart"] {
        let path = folder.path().join("a.mp4");
        run(&format!("{} -f lavfi -i sine=duration=1 -c:v libx264 -c:a aac {flags}", moving(64, 32, "25", 25)), &path);
        let before = frames(&ffmpeg, &path, Default::default()).unwrap();
        assert_eq!(SpatialTags::read(&path).unwrap(), None);
        for tags in [SpatialTags::panorama(StereoMode::Mono), SpatialTags::vr180()] {
            tags.write(&path).unwrap();
            assert_eq!(SpatialTags::read(&path).unwrap(), Some(tags));
            assert!(frames(&ffmpeg, &path, Default::default()).unwrap() == before, "{flags}");
        }
        SpatialTags::default().write(&path).unwrap();
        assert_eq!(SpatialTags::read(&path).unwrap(), None);
    }
}

#[test]
fn damaged_boxes_are_refused_and_never_a_panic() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    let settings = WriteSettings {
        spatial: Some(SpatialTags::vr180()),
        ..WriteSettings::new((64, 32), Ratio::new(25, 1).unwrap())
    };
    write(&ffmpeg, &path, &settings, 2).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let start = whole.windows(4).position(|name| name == b"moov").unwrap();
    for seed in 0..3000_usize {
        let mut bytes = whole.clone();
        let at = start + seed.wrapping_mul(7919) % (bytes.len() - start);
        bytes[at] ^= 1 << (seed % 8);
        if seed % 5 == 0 {
            bytes.truncate(at);
        }
        std::fs::write(&path, bytes).unwrap();
        if let Err(error) = SpatialTags::read(&path).and_then(|_| SpatialTags::panorama(StereoMode::Mono).write(&path))
        {
            assert!(matches!(error, VideoError::Boxes { .. } | VideoError::Read { .. }), "{error}");
        }
    }
    std::fs::write(&path, b"no boxes at all").unwrap();
    assert!(SpatialTags::read(&path).unwrap_err().to_string().contains("moov"));
}
