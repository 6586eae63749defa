//! Conversion of arguments to settings; all later code sees only these.

use std::path::{Path, PathBuf};

use cosmorama::filter::FilterKind;
use cosmorama::motion::{Ramp, Shutter};
use cosmorama::raster::Depth;
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_convert::{
    Backdrop, BlurMethod, CameraMovement, Conversion, Existing, ExplanationSettings, GeometrySettings, LayerSettings,
    LimitSettings, MotionBlur, PoseFile, is_video,
};
use cosmorama_spec::{FilterName, FrameRate};

use super::geometry::{CameraArgs, GeometryArgs, MotionKind, ShutterArgs};
use super::{ConvertArgs, FramesAsked, LimitArgs};
use crate::args::ExplainArgs;

impl From<ConvertArgs> for Conversion {
    fn from(args: ConvertArgs) -> Self {
        let (frames, times) = FramesAsked::parted(args.files.frames);
        let video = args.video.settings(args.camera.fps);
        Self {
            input: args.input,
            output: args.output,
            geometry: GeometrySettings { blur: args.shutter.into(), ..moved(args.geometry, args.camera) },
            st_map: args.st_map,
            transfer: args.transfer,
            in_transfer: args.in_transfer,
            out_transfer: args.out_transfer,
            primaries: args.primaries.map(|name| name.0),
            in_primaries: args.in_primaries.map(|name| name.0),
            ignore_profile: args.ignore_profile,
            ocio: args.ocio.into(),
            part: args.part,
            channels: args.channels.iter().map(|name| name.trim().to_owned()).collect(),
            layers: LayerSettings { depth: args.depth_kind, normals: args.normals },
            depth: args.depth.map(Depth::from),
            background: args.background.map(|colour| colour.0),
            missing: args.missing,
            backdrop: args.backdrop.map(|input| Backdrop {
                from: args.backdrop_from,
                frames: args.backdrop_frames.unwrap_or_default(),
                ..Backdrop::new(input)
            }),
            frames,
            times,
            video,
            existing: existing(args.files.overwrite, args.files.resume),
            make_folders: !args.files.no_mkdir,
            to_stream: args.format.is_some(),
            mips: args.mips,
            quality: args.quality,
            compression: args.compression,
            strip: args.strip,
            limits: args.run.limits.into(),
            ..Self::default()
        }
    }
}

impl From<ExplainArgs> for ExplanationSettings {
    fn from(args: ExplainArgs) -> Self {
        Self {
            input: args.input,
            input_size: args.input_size,
            geometry: GeometrySettings { blur: args.shutter.into(), ..moved(args.geometry, args.camera) },
            frames: args.frames,
            limits: args.limits.into(),
            ..Self::default()
        }
    }
}

impl ConvertArgs {
    /// Returns the output's name, which is that of a file of its format for standard output.
    pub(crate) fn named_output(&self) -> PathBuf {
        let of_stream = |format: &String| format!("{}.{}", self.output, format.trim_start_matches('.')).into();
        self.format.as_ref().map_or_else(|| self.output.path().to_owned(), of_stream)
    }
}

/// Returns the geometry of a camera that may move.
fn moved(geometry: GeometryArgs, camera: CameraArgs) -> GeometrySettings {
    let angles = [geometry.yaw, geometry.pitch, geometry.roll];
    let moves = angles.iter().chain(&camera.fov).any(Ramp::moves);
    let poses = |file: String| PoseFile {
        file,
        fps: camera.fps.map(FrameRate::per_second),
        smoothness: camera.path_curve.unwrap_or_default(),
    };
    let in_path = camera.in_path.map(poses);
    let movement = match camera.path {
        Some(file) => Some(CameraMovement::Path(poses(file))),
        None if moves => {
            Some(CameraMovement::Turn { angles, fov: camera.fov, easing: camera.easing.unwrap_or_default() })
        }
        None => None,
    };
    let still = GeometrySettings::from(geometry);
    let orientation = if movement.is_some() { Orientation::IDENTITY } else { still.orientation };
    GeometrySettings { orientation, camera: movement, in_path, ..still }
}

/// Returns the geometry of a camera that stands still, as it is at the beginning of a turn.
impl From<GeometryArgs> for GeometrySettings {
    fn from(args: GeometryArgs) -> Self {
        let [yaw, pitch, roll] = [args.yaw, args.pitch, args.roll].map(|ramp| Angle::from_degrees(ramp.from));
        Self {
            from: args.from,
            to: args.to,
            size: args.size,
            orientation: Orientation::from_yaw_pitch_roll(yaw, pitch, roll),
            camera: None,
            in_path: None,
            blur: None,
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

impl From<ShutterArgs> for Option<MotionBlur> {
    fn from(args: ShutterArgs) -> Self {
        let MotionKind::By(method) = args.motion.unwrap_or(MotionKind::By(BlurMethod::default())) else { return None };
        let phase = args.shutter_phase.unwrap_or(0.5);
        let shutter = Shutter { fraction: args.shutter?, phase, curve: args.shutter_curve.unwrap_or_default() };
        Some(MotionBlur { shutter, method })
    }
}

impl ShutterArgs {
    /// Returns an option that has no effect without a shutter, and why.
    pub(crate) fn idle(&self) -> Option<String> {
        let given = [
            (self.shutter_phase.is_some(), "--shutter-phase"),
            (self.shutter_curve.is_some(), "--shutter-curve"),
            (matches!(self.motion, Some(MotionKind::By(_))), "--motion"),
        ];
        let (_, option) = given.into_iter().find(|(is_given, _)| *is_given && self.shutter.is_none())?;
        Some(format!("{option} is for motion blur; give --shutter F, as in --shutter 0.5, or leave {option} out"))
    }
}

impl CameraArgs {
    /// Returns an option that has no effect without another, and why.
    pub(crate) fn idle(&self, geometry: &GeometryArgs, output: Option<&Path>) -> Option<String> {
        let turns = [geometry.yaw, geometry.pitch, geometry.roll].iter().chain(&self.fov).any(Ramp::moves);
        let has_poses = self.path.is_some() || self.in_path.is_some();
        if !has_poses && self.fps.is_some() && !output.is_some_and(is_video) {
            return Some(
                "--fps is for a video, or for a --path with times in seconds; leave it out: pictures have no frame rate; name the \
                 output .mp4, .mov, .mkv or .webm for a video"
                    .to_owned(),
            );
        }
        if !has_poses && self.path_curve.is_some() {
            return Some("--path-curve is for the poses of a --path; leave it out, or give that".to_owned());
        }
        (self.easing.is_some() && !turns).then(|| {
            "--easing is for a turn, as in --yaw 0..360, but nothing turns; leave it out, or give one".to_owned()
        })
    }
}

/// Returns what becomes of outputs that exist.
pub(in crate::args) fn existing(overwrite: bool, resume: bool) -> Existing {
    match (overwrite, resume) {
        (true, _) => Existing::Replace,
        (false, true) => Existing::Resume,
        (false, false) => Existing::Refuse,
    }
}
