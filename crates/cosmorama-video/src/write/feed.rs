//! Frames on their way to ffmpeg: Matroska with raw pictures. Unlike other raw streams it tells each frame's own time, and tags
//! which ffmpeg then writes into any container that can hold them.

use std::borrow::Cow;
use std::io::{self, Write};

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};

use crate::colour::{Coding, RgbToYuv420};
use crate::{Bounds, HdrTags, MasteringDisplay, Ratio, SpatialTags, SphericalProjection, StereoMode};

/// Header of the stream.
pub(super) struct Header<'a> {
    pub(super) size: (usize, usize),
    pub(super) format: RawFormat,
    pub(super) rate: Ratio,
    pub(super) hdr: &'a HdrTags,
    pub(super) spatial: Option<&'a SpatialTags>,
}

/// Format of raw pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RawFormat {
    pub(super) depth: Depth,
    pub(super) has_alpha: bool,
    /// Planes of YUV that are made of pixels; `None` for RGB.
    pub(super) planes: Option<Planes>,
}

/// Planes of YUV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Planes {
    /// Planes of 10 bits with all chroma samples. ffmpeg would convert more than 8 bits with errors of the size of a code of 8 bits.
    Deep(Coding),
    /// Planes of 8 bits with a quarter of the chroma samples, which are half as many bytes as RGB.
    Yuv420(RgbToYuv420),
}

impl RawFormat {
    /// Returns the code by which ffmpeg knows the format.
    fn code(self) -> &'static [u8; 4] {
        match (self.planes, self.is_deep(), self.has_alpha) {
            (Some(Planes::Yuv420(_)), ..) => b"I420",
            (Some(Planes::Deep(_)), _, false) => b"Y3\0\x0a",
            (Some(Planes::Deep(_)), _, true) => b"Y4\0\x0a",
            (None, false, false) => b"RGB\x18",
            (None, false, true) => b"RGBA",
            (None, true, false) => b"RGB0",
            (None, true, true) => b"RBA\x40",
        }
    }

    /// Returns whether frames have samples of 16 bits.
    pub(super) fn is_deep(self) -> bool {
        self.depth != Depth::Eight
    }

    pub(super) fn channels(self) -> Channels {
        if self.has_alpha { Channels::Rgba } else { Channels::Rgb }
    }
}

/// Returns the bytes of integers, the least significant first.
fn bytes_of(samples: &[u16]) -> Cow<'_, [u8]> {
    if cfg!(target_endian = "little") {
        return bytemuck::cast_slice(samples).into();
    }
    samples.iter().flat_map(|sample| sample.to_le_bytes()).collect()
}

/// Nanoseconds in a second: times are told in them.
const NANOSECONDS: f64 = 1e9;

/// Size of an element that goes on to the end.
const UNKNOWN: [u8; 8] = [0x01, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff];

// Elements, by their names in RFC 9559.
const EBML: &[u8] = &[0x1a, 0x45, 0xdf, 0xa3];
const EBML_VERSION: &[u8] = &[0x42, 0x86];
const EBML_READ_VERSION: &[u8] = &[0x42, 0xf7];
const DOC_TYPE: &[u8] = &[0x42, 0x82];
const DOC_TYPE_VERSION: &[u8] = &[0x42, 0x87];
const DOC_TYPE_READ_VERSION: &[u8] = &[0x42, 0x85];
const SEGMENT: &[u8] = &[0x18, 0x53, 0x80, 0x67];
const INFO: &[u8] = &[0x15, 0x49, 0xa9, 0x66];
const TIMESTAMP_SCALE: &[u8] = &[0x2a, 0xd7, 0xb1];
const MUXING_APP: &[u8] = &[0x4d, 0x80];
const WRITING_APP: &[u8] = &[0x57, 0x41];
const TRACKS: &[u8] = &[0x16, 0x54, 0xae, 0x6b];
const TRACK_ENTRY: &[u8] = &[0xae];
const TRACK_NUMBER: &[u8] = &[0xd7];
const TRACK_UID: &[u8] = &[0x73, 0xc5];
const TRACK_TYPE: &[u8] = &[0x83];
const FLAG_LACING: &[u8] = &[0x9c];
const DEFAULT_DURATION: &[u8] = &[0x23, 0xe3, 0x83];
const LANGUAGE: &[u8] = &[0x22, 0xb5, 0x9c];
const CODEC_ID: &[u8] = &[0x86];
const VIDEO: &[u8] = &[0xe0];
const PIXEL_WIDTH: &[u8] = &[0xb0];
const PIXEL_HEIGHT: &[u8] = &[0xba];
const UNCOMPRESSED_FOURCC: &[u8] = &[0x2e, 0xb5, 0x24];
const STEREO_MODE: &[u8] = &[0x53, 0xb8];
const COLOUR: &[u8] = &[0x55, 0xb0];
const MAX_CLL: &[u8] = &[0x55, 0xbc];
const MAX_FALL: &[u8] = &[0x55, 0xbd];
const MASTERING_METADATA: &[u8] = &[0x55, 0xd0];
const PROJECTION: &[u8] = &[0x76, 0x70];
const PROJECTION_TYPE: &[u8] = &[0x76, 0x71];
const PROJECTION_PRIVATE: &[u8] = &[0x76, 0x72];
const PROJECTION_POSE_YAW: &[u8] = &[0x76, 0x73];
const PROJECTION_POSE_PITCH: &[u8] = &[0x76, 0x74];
const PROJECTION_POSE_ROLL: &[u8] = &[0x76, 0x75];
const CLUSTER: &[u8] = &[0x1f, 0x43, 0xb6, 0x75];
const TIMESTAMP: &[u8] = &[0xe7];
const SIMPLE_BLOCK: &[u8] = &[0xa3];

/// Track, relative time and flags of a block: the first track, at its cluster's time, a key frame.
const BLOCK: [u8; 4] = [0x81, 0, 0, 0x80];

fn element(id: &[u8], content: &[u8]) -> Vec<u8> {
    [id, &size(content.len() as u64), content].concat()
}

/// Returns a size of eight bytes.
fn size(length: u64) -> [u8; 8] {
    (length | 1 << 56).to_be_bytes()
}

fn whole(id: &[u8], number: u64) -> Vec<u8> {
    element(id, &number.to_be_bytes())
}

fn float(id: &[u8], number: f64) -> Vec<u8> {
    element(id, &number.to_be_bytes())
}

impl Header<'_> {
    pub(super) fn write(&self, sink: &mut impl Write) -> io::Result<()> {
        let head = [
            whole(EBML_VERSION, 1),
            whole(EBML_READ_VERSION, 1),
            element(DOC_TYPE, b"matroska"),
            whole(DOC_TYPE_VERSION, 4),
            whole(DOC_TYPE_READ_VERSION, 2),
        ];
        sink.write_all(&element(EBML, &head.concat()))?;
        sink.write_all(SEGMENT)?;
        sink.write_all(&UNKNOWN)?;
        let program = b"cosmorama";
        let info = [whole(TIMESTAMP_SCALE, 1), element(MUXING_APP, program), element(WRITING_APP, program)];
        sink.write_all(&element(INFO, &info.concat()))?;
        sink.write_all(&element(TRACKS, &element(TRACK_ENTRY, &self.track())))
    }

    fn track(&self) -> Vec<u8> {
        let duration = (NANOSECONDS / self.rate.to_f64()).round().max(1.0) as u64;
        let track = [
            whole(TRACK_NUMBER, 1),
            whole(TRACK_UID, 1),
            whole(TRACK_TYPE, 1),
            whole(FLAG_LACING, 0),
            whole(DEFAULT_DURATION, duration),
            // Without it, tracks are English.
            element(LANGUAGE, b"und"),
            element(CODEC_ID, b"V_UNCOMPRESSED"),
            element(VIDEO, &self.video()),
        ];
        track.concat()
    }

    fn video(&self) -> Vec<u8> {
        let (width, height) = self.size;
        let mut video = [
            whole(PIXEL_WIDTH, width as u64),
            whole(PIXEL_HEIGHT, height as u64),
            element(UNCOMPRESSED_FOURCC, self.format.code()),
        ]
        .concat();
        let colour = colour(self.hdr);
        if !colour.is_empty() {
            video.extend(element(COLOUR, &colour));
        }
        if let Some(spatial) = self.spatial {
            video.extend(spherical(spatial));
        }
        video
    }
}

fn colour(hdr: &HdrTags) -> Vec<u8> {
    let mut colour = Vec::new();
    if let Some(light) = hdr.light {
        colour.extend(whole(MAX_CLL, light.brightest.into()));
        colour.extend(whole(MAX_FALL, light.mean.into()));
    }
    if let Some(MasteringDisplay { red, green, blue, white, brightest, darkest }) = hdr.mastering {
        // Chromaticities have the numbers from 55D1 on, luminances follow.
        let chromaticities = [red, green, blue, white].into_iter().flatten().map(|units| f64::from(units) / 50_000.0);
        let luminances = [brightest, darkest].into_iter().map(|units| f64::from(units) / 10_000.0);
        let numbers = chromaticities.chain(luminances).zip(0xd1..);
        let display = numbers.flat_map(|(number, id)| float(&[0x55, id], number)).collect::<Vec<_>>();
        colour.extend(element(MASTERING_METADATA, &display));
    }
    colour
}

fn spherical(spatial: &SpatialTags) -> Vec<u8> {
    let mut elements = Vec::new();
    if let Some(stereo) = spatial.stereo {
        let mode = match stereo {
            StereoMode::Mono => 0,
            StereoMode::LeftRight => 1,
            StereoMode::TopBottom => 3,
        };
        elements.extend(whole(STEREO_MODE, mode));
    }
    let words = |kind: u64, words: &[u32]| {
        let bytes = words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<_>>();
        // Version and flags come first.
        [whole(PROJECTION_TYPE, kind), element(PROJECTION_PRIVATE, &[&[0; 4], bytes.as_slice()].concat())].concat()
    };
    let projection = match spatial.projection {
        Some(SphericalProjection::Equirect(Bounds { top, bottom, left, right })) => {
            words(1, &[top, bottom, left, right])
        }
        Some(SphericalProjection::Cubemap { layout, padding }) => words(2, &[layout, padding]),
        Some(SphericalProjection::Mesh) | None => return elements,
    };
    let degrees = |units: i32| f64::from(units) / 65536.0;
    let pose = [
        float(PROJECTION_POSE_YAW, degrees(spatial.pose.yaw)),
        float(PROJECTION_POSE_PITCH, degrees(spatial.pose.pitch)),
        float(PROJECTION_POSE_ROLL, degrees(spatial.pose.roll)),
    ];
    elements.extend(element(PROJECTION, &[projection, pose.concat()].concat()));
    elements
}

/// Time of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stamp {
    /// Number of ticks.
    pub(super) time: i64,
    /// Seconds a tick.
    pub(super) tick: Ratio,
}

/// Writes a frame.
pub(super) fn write_frame(
    sink: &mut impl Write,
    frame: &EncodedImage,
    format: RawFormat,
    stamp: Stamp,
) -> io::Result<()> {
    let deep;
    let bytes = match (format.planes, frame.samples()) {
        (Some(Planes::Deep(coding)), samples) => {
            deep = coding.planes(samples, frame.channels().count());
            bytes_of(&deep)
        }
        (Some(Planes::Yuv420(coding)), Samples::U8(samples)) => {
            coding.planes(samples, (frame.width(), frame.height())).into()
        }
        (None, Samples::U8(samples)) => samples.as_slice().into(),
        (None, Samples::U16(samples)) => bytes_of(samples),
        // Frames of floats are refused before, and those of 16 bits where planes have 8.
        (None, Samples::Half(_) | Samples::Float(_)) | (Some(Planes::Yuv420(_)), _) => (&[] as &[u8]).into(),
    };
    let nanosecond = Ratio::new(1, NANOSECONDS as u64).unwrap_or(Ratio::ONE);
    let time = whole(TIMESTAMP, stamp.tick.rescale(stamp.time, nanosecond).max(0).cast_unsigned());
    let block = BLOCK.len() as u64 + bytes.len() as u64;
    let head = SIMPLE_BLOCK.len() as u64 + 8;
    sink.write_all(CLUSTER)?;
    sink.write_all(&size(time.len() as u64 + head + block))?;
    sink.write_all(&time)?;
    sink.write_all(SIMPLE_BLOCK)?;
    sink.write_all(&size(block))?;
    sink.write_all(&BLOCK)?;
    sink.write_all(&bytes)
}
