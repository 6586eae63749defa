//! Conversion of arguments to settings; all later code sees only these.

use cosmorama::filter::FilterKind;
use cosmorama::raster::Depth;
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_convert::{Conversion, Existing, ExplanationSettings, GeometrySettings, LayerSettings, LimitSettings};
use cosmorama_io::Compression;
use cosmorama_spec::{CompressionLevel, FilterName};

use super::convert::LimitArgs;
use super::geometry::GeometryArgs;
use super::{ConvertArgs, ExplainArgs};

impl From<ConvertArgs> for Conversion {
    fn from(args: ConvertArgs) -> Self {
        Self {
            input: args.input,
            output: args.output,
            geometry: args.geometry.into(),
            st_map: args.st_map,
            transfer: args.transfer,
            in_transfer: args.in_transfer,
            out_transfer: args.out_transfer,
            primaries: args.primaries.map(|name| name.0),
            in_primaries: args.in_primaries.map(|name| name.0),
            ignore_profile: args.ignore_profile,
            part: args.part,
            channels: args.channels,
            layers: LayerSettings { depth: args.depth_kind, normals: args.normals },
            depth: args.depth.map(Depth::from),
            background: args.background.map(|colour| colour.0),
            missing: args.missing,
            frames: args.frames,
            existing: existing(args.overwrite, args.resume),
            make_folders: !args.no_mkdir,
            to_stream: args.format.is_some(),
            mips: args.mips,
            quality: args.quality,
            compression: args.compression.map(compression),
            strip: args.strip,
            limits: args.limits.into(),
            ..Self::default()
        }
    }
}

impl From<ExplainArgs> for ExplanationSettings {
    fn from(args: ExplainArgs) -> Self {
        Self {
            input: args.input,
            input_size: args.input_size,
            geometry: args.geometry.into(),
            limits: args.limits.into(),
            ..Self::default()
        }
    }
}

impl From<GeometryArgs> for GeometrySettings {
    fn from(args: GeometryArgs) -> Self {
        let [yaw, pitch, roll] = [args.yaw, args.pitch, args.roll].map(Angle::from_degrees);
        Self {
            from: args.from,
            to: args.to,
            size: args.size,
            orientation: Orientation::from_yaw_pitch_roll(yaw, pitch, roll),
            filter: args.labels.map_or(args.filter, |rule| FilterName(FilterKind::Labels(rule))),
            kernel: args.kernel,
            anti_ringing: args.anti_ringing,
        }
    }
}

impl From<LimitArgs> for LimitSettings {
    fn from(args: LimitArgs) -> Self {
        Self { threads: args.threads, memory: args.memory }
    }
}

/// Returns what becomes of outputs that exist.
pub(super) fn existing(overwrite: bool, resume: bool) -> Existing {
    match (overwrite, resume) {
        (true, _) => Existing::Replace,
        (false, true) => Existing::Resume,
        (false, false) => Existing::Refuse,
    }
}

fn compression(level: CompressionLevel) -> Compression {
    match level {
        CompressionLevel::None => Compression::None,
        CompressionLevel::Fast => Compression::Fast,
        CompressionLevel::Balanced => Compression::Balanced,
        CompressionLevel::High => Compression::High,
    }
}
